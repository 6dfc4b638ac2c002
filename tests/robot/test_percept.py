"""What the robot senses, and what its doors mean."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.helpers import EMPTY, any_world, worlds
from topo_verify import World
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import SimulatedRobot, exit_dart, first_percept, percepts


def turned(world: World, dart: int) -> Iterator[int]:
    """The dart, then each next one clockwise until it comes again: powers of sigma."""
    yield dart
    after = world.sigma[dart]
    while after != dart:
        yield after
        after = world.sigma[after]


def test_the_marker_is_at_the_door_that_leads_to_the_root_on_every_world_with_3_edges() -> None:
    for world in worlds(range(1, 4)):
        for dart, percept in enumerate(percepts(world)):
            row = list(turned(world, dart))
            assert percept.degree == len(row)
            assert percept.marker == (row.index(world.root) if world.root in row else None)


def test_door_k_is_the_k_th_exit_clockwise_after_the_reference_dart() -> None:
    for world in worlds(range(1, 4)):
        for dart in range(len(world.alpha)):
            row = list(turned(world, dart))
            assert [exit_dart(world, dart, door) for door in range(len(row))] == row


def test_the_robot_starts_at_the_marker_with_the_root_as_its_reference_dart() -> None:
    for world in worlds(range(1, 4)):
        degree = world.degrees[world.marker_vertex]
        assert first_percept(world) == SimulatedRobot(world, 0).percept == Percept(degree, 0)


def test_in_the_empty_world_there_is_neither_door_nor_marker() -> None:
    assert first_percept(EMPTY) == Percept(0, None)


def test_the_signature_says_whether_the_marker_is_here_but_not_where_it_points() -> None:
    assert Percept(3, 0).signature == Percept(3, 2).signature == (3, True)
    assert Percept(3, None).signature == (3, False)


@pytest.mark.parametrize("door", [0, 1, 2])
def test_a_move_leaves_by_the_door_and_arrives_at_the_other_end_of_its_edge(door: int) -> None:
    world = World.from_id("m2/5")  # v0 has a loop (darts 0 and 2) and a leaf (dart 1)
    percept = SimulatedRobot(world, 1).move(door)
    assert percept == [Percept(3, 1), Percept(1, None), Percept(3, 0)][door]


words = st.lists(st.integers(0, 15), min_size=1, max_size=8)


def walk(robot: SimulatedRobot, word: list[int], *, turned: int = 0) -> list[Percept]:
    """Walk these doors modulo each degree, counted from a reference dart that was turned back."""
    seen: list[Percept] = []
    for door in word:
        seen.append(robot.move((door - turned) % robot.percept.degree))
        turned = 0
    return seen


@given(world=any_world(), word=words, last=st.integers(0, 15), rest=words)
def test_door_0_goes_back_and_leaves_the_reference_dart_turned(
    world: World, word: list[int], last: int, rest: list[int]
) -> None:
    robot, other = SimulatedRobot(world, 20), SimulatedRobot(world, 20)
    walk(robot, word)
    walk(other, word)
    robot.move(last % robot.percept.degree)
    robot.move(0)
    assert walk(robot, rest, turned=last) == walk(other, rest)


@given(world=any_world(), word=words, rest=words)
def test_retracing_ends_where_it_began_turned_by_the_first_door(
    world: World, word: list[int], rest: list[int]
) -> None:
    robot, other = SimulatedRobot(world, 30), SimulatedRobot(world, 30)
    walk(robot, word)
    retracing = [0, *(-door for door in reversed(word[1:]))]
    assert walk(robot, retracing)[-1].signature == other.percept.signature
    assert robot.cost == 2 * len(word)
    assert walk(robot, rest, turned=word[0]) == walk(other, rest)
