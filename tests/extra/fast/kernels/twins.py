"""Compares a compiled run with the reference's, event by event."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from itertools import zip_longest
from random import Random

from topo_verify import World
from topo_verify.algorithms import CATALOGUE
from topo_verify.extra.fast.kernels.events import words
from topo_verify.extra.fast.kernels.explore import CompiledRun, run_world
from topo_verify.robot.event_words import event_words
from topo_verify.robot.events import Event, Finish, MapData, Robot
from topo_verify.robot.limits import MapperStopped
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world.enumeration import rank_order

LOST = 100
"""Moves after which a mapper that assumes a planar world is stopped in another one, where it may
take its whole budget."""


def budget_for(world: World, algorithm: str) -> int:
    """The moves that a run is given: the bound of claim 7, or fewer where the mapper is lost."""
    lost = algorithm == "folding+planar" and not world.is_planar
    return min(world.cost_bound, LOST) if lost else world.cost_bound


def reference_events(
    world: World, mapper: Callable[[Robot], object], budget: int
) -> tuple[Event, ...]:
    """The events of a mapper's run after the start: with the map, if it delivers one."""
    robot = SimulatedRobot(world, budget)
    try:
        survey = mapper(robot.handle)
    except MapperStopped:
        return tuple(robot.events)
    vertices, edges, marker, cost = (
        getattr(survey, name) for name in ("vertices", "edges", "marker", "cost")
    )
    return (*robot.events, Finish(cost, MapData(vertices, edges, marker)))


def difference(
    world: World,
    algorithm: str,
    *,
    fault: str = "",
    mapper: Callable[[Robot], object] | None = None,
) -> str | None:
    """The first event in which the two runs differ, in words; None if there is none."""
    budget = budget_for(world, algorithm)
    expected = reference_events(world, mapper or CATALOGUE[algorithm], budget)
    run = run_world(world, algorithm, trace=True, fault=fault, budget=budget)
    if same(expected, run):
        return None
    for place, (one, other) in enumerate(zip_longest(expected, run.events)):
        if one != other:
            name = world.name or f"{len(world.edges)} edges"
            said = [f"event {place} of {fault or algorithm} in {name} differs"]
            said += [
                f"  {side}: {'nothing more' if event is None else f'{event_words(event)}  {event}'}"
                for side, event in (("reference", one), ("compiled", other))
            ]
            return "\n".join(said)
    return f"{fault or algorithm} in {world.name}: equal events, but the words differ"


def same(expected: tuple[Event, ...], run: CompiledRun) -> bool:
    """Whether the words of the events, the cost and the map are those of the run."""
    delivered = expected[-1] if expected and isinstance(expected[-1], Finish) else None
    if (None if delivered is None else delivered.map) != run.map:
        return False
    moves = expected if delivered is None else expected[:-1]
    return tuple(words(moves)) == run.trace and (delivered is None or delivered.cost == run.cost)


def differences(worlds: Iterable[World], algorithm: str) -> Iterator[str]:
    """The differences in these worlds."""
    for world in worlds:
        found = difference(world, algorithm)
        if found is not None:
            yield found


def uniform(edges: int, number: int, *, seed: int) -> Iterator[World]:
    """So many worlds of this size, drawn uniformly."""
    draw = Random(f"{edges} {seed}")
    for _ in range(number):
        yield World.from_id(f"m{edges}/{draw.randrange(rank_order.count(edges))}")
