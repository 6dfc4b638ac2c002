"""The values of the games on the worlds with m edges: what the best robot pays.

What a robot **knows** says when its game ends, beside the history. What is **drawn** says in which
worlds its cost counts. The robot that attains a value may be another one for each value.

    nothing         the history has to prove the map among all worlds: no dart of its fold is open.
                    This is the least that a sound mapper can pay: the best robot plays as if the
                    world had m edges, and as any sound mapper as soon as that is refuted
    n               … among all worlds with n vertices; the robot is told n, whatever it is
    planar          … among all planar worlds
    m               … among all worlds with m edges
    m and n         … among those with m edges and n vertices
    m and planar    … among the planar ones with m edges
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Literal, TypeVar

from topo_verify.algorithms import NAMED
from topo_verify.campaign.judge import judge
from topo_verify.campaign.run import explore
from topo_verify.studies.game.drawn import DrawnWorld
from topo_verify.studies.game.folds import is_closed, is_single_of_vertices, is_single_planar
from topo_verify.studies.game.rules import ClassRules, GameEnding, ProofRules
from topo_verify.studies.game.search import Least, Rules, Solver
from topo_verify.world.enumeration.pruned import worlds
from topo_verify.world.rooted_map import World

S = TypeVar("S", bound=Hashable)

Knowledge = Literal["nothing", "n", "planar", "m", "m and n", "m and planar"]

DrawnClass = Literal["any", "planar"]

GAMES: tuple[tuple[DrawnClass, Knowledge], ...] = (
    ("any", "nothing"),
    ("any", "n"),
    ("any", "m"),
    ("any", "m and n"),
    ("planar", "nothing"),
    ("planar", "planar"),
    ("planar", "m"),
    ("planar", "m and planar"),
)
"""What is drawn and what is known, of each game."""

MOST_EDGES = 4
"""The largest games. With five edges there are 8162 worlds."""

ENDLESS: tuple[Knowledge, ...] = ("n", "planar")
"""Games that are left out where m is more than `MOST_ENDLESS`: their bounds are too weak."""

MOST_ENDLESS = 3

MOST_STATES = 300_000
"""After so many states a search is cut short: more than any game of four edges that ends needs."""

MOST_FOLDS = 100_000
"""The same where the states are folds, which take longer."""


@dataclass(frozen=True)
class GameValue:
    """What the best robot pays: one that minimises the worst case, and one that does the mean.

    Attributes:
        edges: of each world.
        knows: what the robot is told.
        drawn: which of the worlds with so many edges count.
        worlds: how many that are.
        worst, total: the cost in the worst of them, and in all of them together.
        states: how many states were searched.
    """

    edges: int
    knows: Knowledge
    drawn: DrawnClass
    worlds: int
    worst: Least
    total: Least
    states: int

    @property
    def mean(self) -> float:
        """The cost in the mean over the worlds."""
        return self.total.cost / self.worlds


def drawn_worlds(edges: int, drawn: DrawnClass) -> list[World]:
    """The worlds that count in a game."""
    return list(worlds(edges=edges, cls=drawn))


def game_values(edges: int, *, most_states: float = MOST_STATES) -> Iterator[GameValue]:
    """The values of the games on the worlds with so many edges, in the order of `GAMES`."""
    for drawn, knows in GAMES:
        if knows not in ENDLESS or edges <= MOST_ENDLESS:
            yield game_value(edges, knows, drawn, most_states=most_states)


def game_value(
    edges: int, knows: Knowledge, drawn: DrawnClass = "any", *, most_states: float = MOST_STATES
) -> GameValue:
    """The value of one game.

    Raises:
        InputError: there are no worlds with so many edges.
    """
    games = list(_games(edges, knows, drawn))
    (worst, few), (total, many) = (
        _least(games, mean=mean, most_states=most_states) for mean in (False, True)
    )
    count = len(drawn_worlds(edges, drawn))
    return GameValue(edges, knows, drawn, count, worst, total, few + many)


def _games(edges: int, knows: Knowledge, drawn: DrawnClass) -> Iterator[ProofRules | ClassRules]:
    """The rules of the games that are played, one for each thing that the robot may be told."""
    counted = [DrawnWorld(world.code) for world in drawn_worlds(edges, drawn)]
    match knows:
        case "nothing":
            yield ProofRules(counted, GameEnding(is_closed, DrawnWorld.proof_bound))
        case "planar":
            yield ProofRules(counted, GameEnding(is_single_planar, DrawnWorld.crossing_bound))
        case "n":
            for n, group in _by_vertices(counted).items():
                is_single = partial(is_single_of_vertices, n=n)
                yield ProofRules(group, GameEnding(is_single, DrawnWorld.visit_bound))
        case "m":
            known = [DrawnWorld(world.code) for world in drawn_worlds(edges, "any")]
            tables = {world.table for world in counted}
            numbers = (number for number, world in enumerate(known) if world.table in tables)
            yield ClassRules(known, frozenset(numbers))
        case "m and n":
            for group in _by_vertices(counted).values():
                yield ClassRules(group, frozenset(range(len(group))))
        case "m and planar":
            yield ClassRules(counted, frozenset(range(len(counted))))


def _by_vertices(found: Sequence[DrawnWorld]) -> dict[int, list[DrawnWorld]]:
    groups = defaultdict[int, list[DrawnWorld]](list)
    for world in found:
        groups[len(world.degrees)].append(world)
    return groups


def _least(
    games: Sequence[ProofRules | ClassRules], *, mean: bool, most_states: float
) -> tuple[Least, int]:
    """The value over all games and their first percepts; and how many states were met."""
    met: list[tuple[Least, int]] = []
    for rules in games:
        met += _by_start(rules, mean=mean, most_states=most_states)
    return _joined(met, mean=mean)


def _joined(met: Sequence[tuple[Least, int]], *, mean: bool) -> tuple[Least, int]:
    """The value over several states, and how many states were met for all of them."""
    costs = [one.cost for one, _ in met]
    cost = sum(costs) if mean else max(costs, default=0)
    is_value = all(one.is_value for one, _ in met)
    return Least(cost, is_value=is_value), sum(states for _, states in met)


def _by_start(
    rules: ProofRules | ClassRules, *, mean: bool, most_states: float
) -> Iterator[tuple[Least, int]]:
    """The value after each first percept, and the states met."""
    if isinstance(rules, ProofRules):
        most_states = min(most_states, MOST_FOLDS)
        yield from (
            _after(rules, start, mean=mean, most_states=most_states) for start in rules.starts()
        )
    else:
        yield from (
            _after(rules, start, mean=mean, most_states=most_states) for start in rules.starts()
        )


def _after(rules: Rules[S], start: S, *, mean: bool, most_states: float) -> tuple[Least, int]:
    """The value of a state, and the states met.

    The one choice at a vertex of degree 1 is made here. So each answer is searched apart, and if
    one search is cut short, the others still tell their values. What was searched is forgotten.
    """
    forced = tuple(rules.choices(start))
    paid = forced[0].moves if len(forced) == 1 else 0
    met: list[tuple[Least, int]] = []
    for state in forced[0].left if paid else (start,):
        solver = Solver(rules, mean=mean, most_states=most_states)
        met.append((solver.least(state), solver.states))
    (cost, is_value), states = _joined(met, mean=mean)
    paid *= rules.worlds(start) if mean else 1
    return Least(paid + cost, is_value=is_value), states


# ---------------------------------------------------------------- what the catalogue pays


PLAYERS = tuple(NAMED)
"""The mappers whose costs are set beside the values: the catalogue."""


@dataclass(frozen=True)
class MapperCosts:
    """The costs of a mapper in the worlds of a game.

    Attributes:
        mapper: a name of the catalogue.
        edges: of each world.
        knows: what the mapper assumes: nothing, or that the world is planar.
        drawn: the worlds in which it promises to be right.
        worlds: how many that are.
        worst, total: its cost in the worst of them, and in all together.
        failing: the id of the first world in which a claim fails, or None.
    """

    mapper: str
    edges: int
    knows: Knowledge
    drawn: DrawnClass
    worlds: int
    worst: int
    total: int
    failing: str | None

    @property
    def mean(self) -> float:
        """The cost in the mean over the worlds."""
        return self.total / self.worlds


def mapper_costs(mapper: str, edges: int) -> MapperCosts:
    """The costs of a mapper of the catalogue in the worlds with so many edges."""
    known = NAMED.get(mapper)
    planar = known is not None and known.assumes == "planar"
    drawn: DrawnClass = "planar" if planar else "any"
    runs = [explore(world, mapper) for world in drawn_worlds(edges, drawn)]
    costs = [run.cost for run in runs]
    failing = next((run.world.id for run in runs if not judge(run).ok), None)
    knows: Knowledge = "planar" if planar else "nothing"
    return MapperCosts(mapper, edges, knows, drawn, len(runs), max(costs), sum(costs), failing)


def least_costs(edges: int, drawn: DrawnClass) -> Sequence[int]:
    """The least cost of a proof in each world of a game, with the map in hand."""
    return [world.least_cost() for world in drawn_worlds(edges, drawn)]
