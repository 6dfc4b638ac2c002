"""The fold of a history: closed exactly when the history proves the map."""

from __future__ import annotations

import re
import tracemalloc
from collections.abc import Sequence
from copy import deepcopy
from unittest.mock import patch

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.checkers.example import fold_history
from tests.helpers import EMPTY, any_world, trace_of, worlds
from topo_verify import World
from topo_verify.checkers import folding
from topo_verify.checkers.folding import Fold, Place
from topo_verify.robot.events import Event, Move, Start
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import SimulatedRobot, first_percept


def shows(world: World, history: Sequence[Event]) -> bool:
    """Does the world show this history to a robot that takes its doors?"""
    robot = SimulatedRobot(world, budget=len(history))
    seen = [robot.percept, *(robot.move(e.door) for e in history if isinstance(e, Move))]
    return seen == [e.percept for e in history if isinstance(e, Start | Move)]


@pytest.mark.parametrize("algorithm", ["basic", "enhancement-iii-all+i"])
@pytest.mark.no_cover
def test_the_whole_history_of_a_right_mapper_folds_to_the_world(algorithm: str) -> None:
    for world in worlds(range(1, 5)):
        fold, _ = fold_history(trace_of(world, algorithm))
        assert fold.open_darts() == 0
        assert fold.world().is_isomorphic(world)


def test_every_shorter_history_is_closed_or_has_two_worlds_that_tell() -> None:
    for world in worlds(range(1, 4)):
        trace = [e for e in trace_of(world) if isinstance(e, Start | Move)]
        for length in range(1, len(trace) + 1):
            history = trace[:length]
            fold, _ = fold_history(history)
            short, long = fold.world(1), fold.world(2)
            assert shows(short, history)
            assert shows(long, history)
            assert short.is_isomorphic(long) == (fold.open_darts() == 0)


@given(any_world(max_edges=12), st.lists(st.integers(0, 23), max_size=40))
def test_wandering_proves_the_world_or_leaves_two(world: World, doors: list[int]) -> None:
    robot = SimulatedRobot(world, budget=len(doors))
    fold = Fold(robot.percept)
    history: list[Event] = [Start(percept=robot.percept)]
    for door in doors:
        percept = robot.move(door % robot.percept.degree)
        history.append(robot.events[-1])
        fold.move(door % history_degree(history), percept)
    assert World.from_code(fold.table()) == fold.world()
    assert shows(fold.world(1), history)
    assert shows(fold.world(2), history)
    assert (fold.open_darts() == 0) == fold.world(1).is_isomorphic(fold.world(2))
    assert fold.open_darts() or fold.world().is_isomorphic(world)


def history_degree(history: Sequence[Event]) -> int:
    """The degree where the robot stood before its last move."""
    before = history[-2]
    assert isinstance(before, Start | Move)
    return before.percept.degree


def test_the_world_without_edges_is_proved_by_standing_in_it() -> None:
    fold = Fold(first_percept(EMPTY))
    assert fold.open_darts() == 0
    assert fold.world() == EMPTY


@pytest.mark.parametrize(
    ("percepts", "doors", "why"),
    [
        (
            [(2, 0), (3, None), (3, None)],
            [0, 0],
            "degree|marker",
        ),  # back at v0, but it is not there
        (
            [(1, 0), (2, None), (1, None)],
            [0, 0],
            "its absence, at one place: .*no marker.*marker at door 0",
        ),
        (
            [(1, 0), (2, None), (2, 0)],
            [0, 0],
            "two degrees.*: .*degree 2, marker.* and .*degree 1, marker",
        ),
        ([(2, 0), (2, 0)], [0], "its own other end"),  # door 0 of v0 would lead to itself
        # The second and the third vertex are one, for the same dart of v0 leads to both.
        ([(2, 0), (2, None), (2, None), (2, 1)], [1, 1, 1], "its own other end"),
        ([(3, 0), (3, 1), (3, 2)], [0, 0], "turned"),
        ([(1, 0), (1, None)], [-1], "degree 1 has no door -1"),
        ([(1, 0), (1, None)], [1], "degree 1 has no door 1"),
        ([(1, 0), (0, None)], [0], "no place behind a door shows .degree 0"),
    ],
)
def test_what_no_world_shows_contradicts(
    percepts: list[tuple[int, int | None]], doors: list[int], why: str
) -> None:
    history: list[Event] = [Start(percept=Percept(*percepts[0]))]
    history += map(Move, doors, (Percept(*percept) for percept in percepts[1:]))
    _, broken = fold_history(history)
    assert broken is not None
    when, told = broken
    assert when == len(doors)
    assert re.search(why, told)


@pytest.mark.long
@pytest.mark.no_cover
def test_what_contradicts_in_no_way_can_be_joined_and_looking_leaves_no_trace() -> None:
    joined = 0
    for world in worlds([3]):
        trace = trace_of(world)
        for length in range(1, len(trace)):
            fold, _ = fold_history(trace[:length])
            before = fold.open_darts(), fold.world(1).code, fold.world(2).code
            for end in range(fold.degree(0)):
                contradicts = any(fold.contradictions((0, 0), (0, end), ()))
                assert (fold.open_darts(), fold.world(1).code, fold.world(2).code) == before
                if not contradicts:
                    further = deepcopy(fold)
                    further.join((0, 0), (0, end))
                    assert further.partner((0, 0)) == further.find((0, end))
                    joined += 1
    assert joined


@pytest.mark.no_cover
@pytest.mark.parametrize("degree", [4, 1000])
def test_a_place_takes_few_bytes_and_no_more_where_it_has_more_doors(degree: int) -> None:
    start, beyond = Start(percept=Percept(degree, 0)), Move(1, Percept(degree, None))
    tracemalloc.start()
    try:
        fold, _ = fold_history([start, *([beyond] * 4000)])
        bytes_a_place = tracemalloc.get_traced_memory()[0] / 4000
    finally:
        tracemalloc.stop()
    assert len(fold.roots()) == 4001
    assert bytes_a_place < (80 if degree == 4 else 800)


@given(st.data())
def test_a_wide_place_folds_as_a_narrow_one_does(data: st.DataObject) -> None:
    world = data.draw(any_world(max_edges=6))
    doors = data.draw(st.lists(st.integers(0, 11), max_size=30))
    robot = SimulatedRobot(world, budget=len(doors))
    history: list[Event] = [Start(percept=robot.percept)]
    for door in doors:
        robot.move(door % robot.percept.degree)
        history.append(robot.events[-1])
    narrow, _ = fold_history(history)
    with patch.object(folding, "NARROW", 1):
        wide, _ = fold_history(history)
    assert wide.world(2) == narrow.world(2)
    for turn in range(1, narrow.degree(0)):
        ends = (0, 0), (0, turn)
        assert kinds(wide, *ends) == kinds(narrow, *ends)
    assert wide.world(2) == narrow.world(2)


def kinds(fold: Fold, one: Place, other: Place, *apart: Place) -> set[str]:
    """What contradicts if the two are ends of one edge."""
    return {kind for kind, _ in fold.contradictions(one, other, apart)}


def test_what_is_possible_is_what_some_world_has() -> None:
    fold = Fold(Percept(3, 0))
    fold.move(1, Percept(2, None))
    assert kinds(fold, (0, 0), (0, 2)) == set()
    assert kinds(fold, (0, 0), (0, 1)) == {
        "two degrees, or the marker and its absence, at one place"
    }
    assert fold.open_darts() == 3


def test_a_leaf_is_what_hangs_on_an_open_dart_unless_more_is_asked_for() -> None:
    fold = Fold(Percept(1, 0))
    assert fold.world() == fold.world(1)
    assert [len(fold.world(hang).edges) for hang in (1, 2, 3)] == [1, 2, 3]


def test_two_vertices_of_s_that_an_assumption_makes_one_are_a_contradiction() -> None:
    fold = Fold(Percept(3, 0))
    fold.move(0, Percept(2, None))
    first = fold.at
    fold.move(0, Percept(3, 0))
    fold.move(1, Percept(2, None))
    met = kinds(fold, (0, 0), fold.at, (0, 0), first, fold.at)
    assert met == {"a vertex would be itself, turned", "two vertices of S would be one"}


def test_every_contradiction_of_an_assumption_is_listed_not_only_those_up_to_the_first() -> None:
    fold = Fold(Percept(1, 0))
    for door in (0, 1, 2, 2):
        fold.move(door, Percept(3, None))
    assert kinds(fold, (1, 0), (4, 0)) == {
        "two degrees, or the marker and its absence, at one place",
        "a vertex would be itself, turned",
    }
