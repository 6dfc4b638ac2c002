"""What must stay the same when the world is told otherwise: mirrored, or with other numbers.

A robot cannot see how darts are numbered; and in a mirror, with its doors mirrored, it cannot see
that it is in a mirror.
"""

from __future__ import annotations

from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.properties.worlds import STRATEGIES
from topo_verify import Algorithm, Percept, Robot, World, explore
from topo_verify.algorithms.chart import Survey
from topo_verify.robot.events import Decision, Move, Start, Trace
from topo_verify.robot.percept import Door, Purpose
from topo_verify.strategies import mappers, symmetric_worlds


class InAMirror:
    """A robot that counts its doors the other way round."""

    def __init__(self, robot: Robot) -> None:
        self._robot = robot

    @property
    def percept(self) -> Percept:
        return mirrored(self._robot.percept)

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:
        return mirrored(self._robot.move(-door % self.percept.degree, purpose))

    def declare(self, event: Decision) -> None:
        self._robot.declare(event)


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


@pytest.mark.parametrize("strategy", STRATEGIES)
@given(data=st.data(), mapper=mappers())
def test_the_mirror_image_with_mirrored_doors_gives_the_mirrored_run(
    strategy: str, data: st.DataObject, mapper: Algorithm
) -> None:
    world = data.draw(STRATEGIES[strategy])

    def in_a_mirror(robot: Robot) -> Survey:
        return mapper(InAMirror(robot))

    run, image = explore(world, mapper), explore(world.mirror(), in_a_mirror)
    assert mirrored_doors(image.trace) == walk(run.trace)
    assert image.map == run.map is not None
    assert [e for e in image.trace if isinstance(e, Decision)] == [
        e for e in run.trace if isinstance(e, Decision)
    ]


@pytest.mark.parametrize("strategy", STRATEGIES)
@given(data=st.data(), mapper=mappers(), seed=st.integers(0, 2**32))
def test_a_run_does_not_depend_on_how_darts_are_numbered(
    strategy: str, data: st.DataObject, mapper: Algorithm, seed: int
) -> None:
    world = data.draw(STRATEGIES[strategy])
    numbers = list(range(len(world.alpha)))
    Random(seed).shuffle(numbers)
    again = world.renumbered(numbers)
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
