"""The values of the games on the worlds with m edges: the cost of the best robot.

What a robot **knows** decides when its game ends; what is **drawn**, in which worlds its cost
counts.

    nothing         the history has to prove the map among all worlds: no dart of its fold is open.
                    No sound mapper pays less: the best robot assumes m edges until refuted
    n               … among all worlds with n vertices; the robot is told n
    planar, m       … among all planar worlds; among all worlds with m edges
    m and n         … among those with m edges and n vertices
    m and planar    … among the planar ones with m edges
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from typing import Any, Literal

import msgspec

from research.game.drawn import DrawnWorld
from research.game.folds import is_closed, is_single_of_vertices, is_single_planar
from research.game.rules import ClassRules, GameEnding, ProofRules
from research.game.search import Least, Rules, Solver
from topo_verify.algorithms import NAMED
from topo_verify.campaign import campaign as c
from topo_verify.campaign.backend import here
from topo_verify.errors import InternalError
from topo_verify.world.enumeration.pruned import worlds
from topo_verify.world.rooted_map import World

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
"""The games: the worlds that are drawn from, and the knowledge of the robot."""

MOST_EDGES = 4
"""With five edges there are 8162 worlds."""

ENDLESS: tuple[Knowledge, ...] = ("n", "planar")
"""Left out beyond `MOST_ENDLESS` edges: their bounds are too weak."""

MOST_ENDLESS = 3

MOST_STATES = 300_000
"""More than any finite game of four edges needs."""

MOST_FOLDS = 100_000
"""The same for folds, which take longer."""


class CostsOfRobot(msgspec.Struct, frozen=True):
    """The costs of a robot in the worlds of a game.

    Attributes:
        worst, mean: over these worlds.
        worst_is_value, mean_is_value: false where the search was cut short: it is a lower bound.
    """

    worst: int
    mean: float
    worst_is_value: bool = True
    mean_is_value: bool = True


class GameValue(msgspec.Struct, frozen=True, kw_only=True):
    """The value of a game.

    Attributes:
        edges: of each world.
        knows: what the robot is told.
        drawn: which of these worlds count.
        worlds: the number of worlds that count.
        value: what the best robots pay, one for the worst case and one for the mean.
        least: the same with the map in hand: the least cost of a proof.
        states: the number of states that were searched.
    """

    edges: int
    knows: Knowledge
    drawn: DrawnClass
    worlds: int
    value: CostsOfRobot
    least: CostsOfRobot
    states: int


class MapperCosts(msgspec.Struct, frozen=True, kw_only=True):
    """A mapper in a game.

    Attributes:
        edges, drawn, worlds: as of a value.
        knows: what the mapper assumes.
        worst, mean: its costs; None if a claim fails.
        value: of the best robots that know as much; None where it was not searched.
        failing: the first world in which a claim fails, or None.
    """

    edges: int
    mapper: str
    knows: Knowledge
    drawn: DrawnClass
    worlds: int
    worst: int | None
    mean: float | None
    value: CostsOfRobot | None
    failing: str | None


def drawn_worlds(edges: int, drawn: DrawnClass) -> list[World]:
    """The worlds that count in a game."""
    return list(worlds(edges=edges, cls=drawn))


def game_values(edges: int, *, most_states: float = MOST_STATES) -> Iterator[GameValue]:
    """The values of all games with this number of edges."""
    for drawn, knows in GAMES:
        if knows not in ENDLESS or edges <= MOST_ENDLESS:
            yield game_value(edges, knows, drawn, most_states=most_states)


def game_value(
    edges: int, knows: Knowledge, drawn: DrawnClass = "any", *, most_states: float = MOST_STATES
) -> GameValue:
    """The value of one game; InputError if no world has this number of edges."""
    games = list(_games(edges, knows, drawn))
    (worst, few), (total, many) = (
        _least(games, mean=mean, most_states=most_states) for mean in (False, True)
    )
    least = [world.least_cost() for world in drawn_worlds(edges, drawn)]
    return GameValue(
        edges=edges,
        knows=knows,
        drawn=drawn,
        worlds=len(least),
        value=CostsOfRobot(worst.cost, total.cost / len(least), worst.is_value, total.is_value),
        least=CostsOfRobot(max(least), sum(least) / len(least)),
        states=few + many,
    )


def _games(edges: int, knows: Knowledge, drawn: DrawnClass) -> Iterator[Rules[Any]]:
    """The rules of the games, one for each kind of knowledge."""
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


def _by_vertices(drawn: Sequence[DrawnWorld]) -> dict[int, list[DrawnWorld]]:
    groups = defaultdict[int, list[DrawnWorld]](list)
    for world in drawn:
        groups[len(world.degrees)].append(world)
    return groups


def _least(games: Sequence[Rules[Any]], *, mean: bool, most_states: float) -> tuple[Least, int]:
    """The value over all games and their first percepts, and the states met.

    A forced first move is made here: if the search of one answer is cut short, the others still
    give their values.
    """
    total = states = 0
    is_value = True
    for rules in games:
        most = min(most_states, MOST_FOLDS) if isinstance(rules, ProofRules) else most_states
        for start in rules.starts():
            forced = tuple(rules.choices(start))
            paid = forced[0].moves if len(forced) == 1 else 0
            costs: list[int] = []
            for state in forced[0].states if paid else (start,):
                solver = Solver(rules, mean=mean, most_states=most)
                least = solver.least(state)
                costs.append(least.cost)
                is_value &= least.is_value
                states += solver.states
            if mean:
                total += paid * rules.worlds(start) + sum(costs)
            else:
                total = max(total, paid + max(costs, default=0))
    return Least(total, is_value=is_value), states


# ---------------------------------------------------------------- what the catalogue pays


PLAYERS = tuple(NAMED)


def mapper_costs(mapper: str, edges: int, values: Iterable[GameValue] = ()) -> MapperCosts:
    """The costs of a catalogue mapper; InternalError if it is sound and beats a game's value."""
    known = NAMED.get(mapper)
    planar = known is not None and known.assumes == "planar"
    drawn: DrawnClass = "planar" if planar else "any"
    knows: Knowledge = "planar" if planar else "nothing"
    best = next((v.value for v in values if (v.knows, v.drawn) == (knows, drawn)), None)
    worlds = [(world.id, world) for world in drawn_worlds(edges, drawn)]
    campaign = c.Campaign(worlds=c.ListedWorlds(len(worlds)), mappers=(mapper,))
    rows = [row for _, result in c.results(campaign, here(), worlds) for row in result.rows]
    failing = next((row.world for row in rows if row.failed), None)
    costs = [row.cost for row in rows]
    worst, mean = max(costs), sum(costs) / len(costs)
    if failing is None and best and (worst < best.worst or mean < best.mean):
        raise InternalError(
            f"{mapper} costs less than the value of the game with {edges} edges, and every claim"
            " holds"
        )
    return MapperCosts(
        edges=edges,
        mapper=mapper,
        knows=knows,
        drawn=drawn,
        worlds=len(rows),
        worst=worst if failing is None else None,
        mean=mean if failing is None else None,
        value=best,
        failing=failing,
    )
