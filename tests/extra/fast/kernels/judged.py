"""Verdicts of the compiled judge beside those of the checkers, run by run."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from importlib import import_module
from random import Random

import pytest
from msgspec import structs

from topo_verify import World
from topo_verify.campaign.run import Exploration, explore
from topo_verify.campaign.tally import Tally
from topo_verify.checkers import check
from topo_verify.checkers.findings import Judgement
from topo_verify.extra.fast.checks import STATUSES
from topo_verify.extra.fast.kernels import workspace as ws
from topo_verify.extra.fast.kernels.events import decoded, spans, words
from topo_verify.extra.fast.kernels.judging import layout, verdict
from topo_verify.extra.fast.kernels.kernel import SOURCES
from topo_verify.programs.loader import Mapper
from topo_verify.robot.events import Event, Finish, MapData, Start
from topo_verify.robot.simulator import first_percept
from topo_verify.world.enumeration import rank_order

Judged = tuple[tuple[str, int, int], ...]
"""Of each claim: status, how much was judged, of how much."""


@dataclass(frozen=True)
class Run:
    """A run that is to be judged: right, wrong, or doctored.

    Attributes:
        events: the moves and decisions in words.
        cost: what was reported with the map.
    """

    what: str
    world: World
    events: tuple[int, ...]
    map: MapData | None
    cost: int | None

    @property
    def is_map_doctored(self) -> bool:
        """Whether edges of the map were crossed: then the judge may leave the verdict open."""
        return self.what.endswith(", map")


def run_of(world: World, mapper: Mapper | str, what: str) -> Run:
    """The run of a mapper of the reference."""
    made: Exploration = explore(world, mapper)
    last = made.trace[-1]
    cost = last.cost if isinstance(last, Finish) else None
    moves = made.trace[:-1] if isinstance(last, Finish) else made.trace
    return Run(f"{what} in {world.name}", world, tuple(words(moves)), made.map, cost)


def sampled(edges: int, number: int) -> Iterator[World]:
    """So many worlds of a size, drawn by a seed."""
    total, draw = rank_order.count(edges), Random(f"judged {edges}")
    for rank in sorted(draw.sample(range(total), min(number, total))):
        yield World.from_id(f"m{edges}/{rank}")


# ---------------------------------------------------------------- verdicts


def as_judged(judgements: Sequence[Judgement]) -> Judged:
    """The judgements of the checkers, without their sentences."""
    return tuple((one.status, one.judged, one.of) for one in judgements)


def counted(tally: Tally) -> Judged:
    """The judgements of a single run, from its tally."""
    assert tally.worlds == 1
    return tuple(
        (status, *tally.shares[claim])
        for claim, statuses in tally.statuses.items()
        for status in statuses
    )


def by_checkers(run: Run) -> Judged:
    """What the checkers say of a run."""
    world = run.world
    events: list[Event] = [Start(percept=first_percept(world))]
    events += decoded(run.events)
    if run.map is not None:
        events.append(Finish(run.cost, run.map))
    return as_judged(check(world, events, None if run.map is not None else "it was stopped"))


_CASE = [0] * layout.JUDGE_SIZE


def by_judge(
    run: Run,
    *,
    judge: Callable[[ws.RunWords, layout.CaseWords], int] | None = None,
    words: list[int] = _CASE,
) -> Judged | None:
    """What the kernels of the judge say of a run, as plain Python; None: the verdict is open.

    Args:
        judge: another judge than `verdict.judge`; `words` is its array.
    """
    case = layout.CaseWords(words)
    case.darts, case.vertices = len(run.world.alpha), len(run.world.degrees)
    case.bound, case.level = run.world.cost_bound, layout.CLAIM_COUNT
    case.delivered = run.map is not None
    case.reported = -1 if run.cost is None else run.cost
    if (judge or verdict.judge)(workspace_of(run), case) < 0:
        return None
    return tuple(
        (STATUSES[case.status[k]], case.judged[k], case.of[k]) for k in range(layout.CLAIM_COUNT)
    )


def workspace_of(run: Run) -> ws.RunWords:
    """The workspace that the judge reads: the world, the trace and the map."""
    end = ws.SMALL.at("trace.word")
    words = [0] * (end + len(run.events))
    words[end:] = run.events
    space = ws.RunWords(words)
    space.trace.size = len(run.events)
    degrees, alpha = run.world.code
    first = 0
    for v, degree in enumerate(degrees):
        space.world.first[v], space.world.degree[v] = first, degree
        for dart in range(first, first + degree):
            space.world.vertex[dart], space.world.alpha[dart] = v, alpha[dart]
        first += degree
    if run.map is not None:
        chart = space.chart
        chart.vertices, chart.darts = len(run.map.vertices), sum(map(len, run.map.vertices))
        for dart in range(chart.darts):
            chart.alpha[dart] = -1
        for v, darts in enumerate(run.map.vertices):
            chart.first[v], chart.degree[v] = darts[0] if darts else 0, len(darts)
            for dart in darts:
                chart.vertex[dart] = v
        for one, other in run.map.edges:
            chart.alpha[one], chart.alpha[other] = other, one
    return space


# ---------------------------------------------------------------- doctored traces


def doctored(run: Run, number: int) -> Iterator[Run]:
    """The run with one event changed, left out or told twice, in so many ways drawn by a seed.

    And with another cost, and with two edges of the map crossed.
    """
    draw = Random(f"{run.what} {run.world.name}")
    parts = [list(run.events[at:end]) for at, end in spans(run.events)]
    for _ in range(number if parts else 0):
        place = draw.randrange(len(parts))
        told = [list(part) for part in parts]
        how = draw.randrange(4)
        if how == 0:
            del told[place]
        elif how == 1:
            told.insert(place, list(told[place]))
        else:
            _change(told[place], draw, parts)
        events = tuple(word for part in told for word in part)
        yield replace(run, what=f"{run.what}, doctored", events=events)
    if run.cost is not None:
        yield replace(run, what=f"{run.what}, cost", cost=run.cost - 1)
    if run.map is not None and len(run.map.edges) > 1:
        at, other = draw.sample(range(len(run.map.edges)), 2)
        edges = list(run.map.edges)
        (a, b), (c, d) = edges[at], edges[other]
        edges[at], edges[other] = (a, c), (b, d)
        yield replace(
            run, what=f"{run.what}, map", map=structs.replace(run.map, edges=tuple(edges))
        )


CHANGED = {1: (1, 2), 2: (1, 3), 3: (1, 2, 5, 6, 7), 4: (1, 2), 5: (1, 2, 3, 4)}
"""Of each kind of event: the places of words that may be changed."""

PERCEPTS = {(1, 2), (3, 6), (3, 7)}
"""Where there are percepts."""


def _change(part: list[int], draw: Random, parts: Sequence[Sequence[int]]) -> None:
    """Change a number of an event, or the percept in it to another one of the trace."""
    kind = part[0]
    place = draw.choice([at for at in CHANGED[kind] if at < len(part)])
    if (kind, place) in PERCEPTS:
        part[place] = draw.choice([other[2] for other in parts if other[0] == 1])
    elif (kind, place) == (5, 2):
        part[place] = 3 - part[place]
    else:
        part[place] = max(0, part[place] + draw.choice((-1, 1)))


# ---------------------------------------------------------------- mistakes in the judge


def plant(monkeypatch: pytest.MonkeyPatch, place: str, right: str, wrong: str) -> None:
    """Let a kernel of the judge have other words in its source, wherever it is called.

    Args:
        place: its module in `judging`, a dot, and its name.
        right: words that its source has once.
    """
    module = import_module(f"topo_verify.extra.fast.kernels.judging.{place.partition('.')[0]}")
    name = place.partition(".")[2]
    kernel = getattr(module, name)
    source = inspect.getsource(kernel)
    assert source.count(right) == 1, f"{place} has {right!r} {source.count(right)} times"
    made: dict[str, object] = {}
    exec(source.replace(right, wrong), vars(module), made)  # noqa: S102  the mistake is in its text
    for source_name in SOURCES:
        caller = import_module(source_name)
        if vars(caller).get(name) is kernel:
            monkeypatch.setattr(caller, name, made[name])
