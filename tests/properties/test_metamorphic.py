"""What must stay the same when the world is told otherwise: mirrored, or with other numbers.

A robot cannot see how darts are numbered; and in a mirror, with its doors mirrored, it cannot see
that it is in a mirror.
"""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.properties.worlds import STRATEGIES
from topo_verify import Algorithm, Percept, Robot, World, explore
from topo_verify.algorithms import CATALOGUE
from topo_verify.algorithms.chart import Survey
from topo_verify.faults.fault import ForwardingRobot
from topo_verify.robot.events import Decision, Move, Start, Trace
from topo_verify.robot.percept import Door, Purpose
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.strategies import mappers, symmetric_worlds
from topo_verify.world.families import lattice


class InAMirror(ForwardingRobot):
    """A robot that counts its doors the other way round."""

    def seen(self, percept: Percept) -> Percept:
        return mirrored(percept)

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:
        return super().move(-door % self.percept.degree, purpose)


def mirrored(percept: Percept) -> Percept:
    marker = percept.marker
    return Percept(percept.degree, None if marker is None else -marker % percept.degree)


def mirrored_doors(trace: Trace) -> list[tuple[Door, Percept]]:
    """The doors and percepts of a trace, counted the other way round."""
    moves: list[tuple[Door, Percept]] = []
    degree = 1
    for event in trace:
        if isinstance(event, Start):
            degree = event.percept.degree
        if isinstance(event, Move):
            moves.append((-event.door % degree, mirrored(event.percept)))
            degree = event.percept.degree
    return moves


def walk(trace: Trace) -> list[tuple[Door, Percept]]:
    return [(event.door, event.percept) for event in trace if isinstance(event, Move)]


def is_the_same_in_a_mirror(
    world: World, mapper: Callable[[Robot], object], mirror: type[InAMirror]
) -> bool:
    """Does the mapper, its doors mirrored, do the same in the mirror image of the world?"""
    run = explore(world, mapper)
    image = explore(world.mirror(), lambda robot: mapper(mirror(robot)))
    return (
        mirrored_doors(image.trace) == walk(run.trace)
        and image.map == run.map is not None
        and decisions(image.trace) == decisions(run.trace)
    )


def decisions(trace: Trace) -> list[Decision]:
    return [event for event in trace if isinstance(event, Decision)]


def renumbered(world: World, seed: int) -> World:
    numbers = list(range(len(world.alpha)))
    Random(seed).shuffle(numbers)
    return world.renumbered(numbers)


@pytest.mark.parametrize("strategy", STRATEGIES)
@given(data=st.data(), mapper=mappers())
def test_the_mirror_image_with_mirrored_doors_gives_the_mirrored_run(
    strategy: str, data: st.DataObject, mapper: Algorithm
) -> None:
    assert is_the_same_in_a_mirror(data.draw(STRATEGIES[strategy]), mapper, InAMirror)


@pytest.mark.parametrize("strategy", STRATEGIES)
@given(data=st.data(), mapper=mappers(), seed=st.integers(0, 2**32))
def test_a_run_does_not_depend_on_how_darts_are_numbered(
    strategy: str, data: st.DataObject, mapper: Algorithm, seed: int
) -> None:
    world = data.draw(STRATEGIES[strategy])
    again = renumbered(world, seed)
    assert explore(again, mapper).trace == explore(world, mapper).trace


@given(world=symmetric_worlds(max_edges=12), mapper=mappers(), data=st.data())
def test_where_places_look_alike_the_marker_may_lie_at_any_of_them(
    world: World, mapper: Algorithm, data: st.DataObject
) -> None:
    """A marker moved to a place that no robot can tell from the first gives the same run."""
    darts = range(len(world.alpha))
    alike = [dart for dart in darts if world.with_marker(dart).code == world.code]
    moved = world.with_marker(data.draw(st.sampled_from(alike))) if alike else world
    assert explore(moved, mapper).trace == explore(world, mapper).trace


# ---------------------------------------------------------------- these statements can fail


class InABadMirror(InAMirror):
    """Percepts are mirrored, doors are not."""

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:
        return mirrored(self.robot.move(door, purpose))


def test_a_mirror_that_leaves_the_doors_is_seen() -> None:
    """In `m3/38`; the worlds before it give the same run in either."""
    basic = CATALOGUE["basic"]
    world = World.from_id("m3/38")
    assert is_the_same_in_a_mirror(world, basic, InAMirror)
    assert not is_the_same_in_a_mirror(world, basic, InABadMirror)


def peeks(robot: Robot) -> Survey:
    """Lets the number of the dart that it stands at decide in which order it goes on."""
    simulator = getattr(robot.move, "__self__", None)  # it looks behind the handle
    assert isinstance(simulator, SimulatedRobot)
    peeked: int = simulator._at  # pyright: ignore[reportPrivateUsage]
    return CATALOGUE["basic"].with_policies(pick=("nearest", "lifo")[peeked % 2])(robot)


def test_a_mapper_that_peeks_at_numbers_is_seen() -> None:
    world = lattice(3, 3)
    runs = [explore(renumbered(world, seed), peeks).trace for seed in range(9)]
    assert any(run != runs[0] for run in runs)
