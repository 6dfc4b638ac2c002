"""Folds, lower bounds and ends of the games; and mistakes planted in them, which are seen."""

from __future__ import annotations

from collections.abc import Callable
from random import Random

import pytest

import topo_verify as tv
from research.game import folds
from research.game.drawn import DrawnWorld
from research.game.folds import is_closed, is_planar, is_single_of_vertices
from research.game.rules import ClassRules, GameEnding, ProofRules
from research.game.search import Solver
from tests.helpers import worlds
from topo_verify.checkers import Fold
from topo_verify.errors import InternalError
from topo_verify.robot.percept import Percept
from topo_verify.world.rooted_map import World

Bound = Callable[[DrawnWorld, folds.FoldCode, int], int]

PROOF = GameEnding(is_closed, DrawnWorld.proof_bound)


def drawn(edges: int) -> list[DrawnWorld]:
    return [DrawnWorld(world.code) for world in worlds([edges])]


def total(ending: GameEnding, edges: int = 2, *, mean: bool = True) -> int:
    rules = ProofRules(drawn(edges), ending)
    values = [Solver(rules, mean=mean).value(start) for start in rules.starts()]
    return int(sum(values) if mean else max(values))


def with_leaves(code: folds.FoldCode) -> World:
    """The fold as a world, with a leaf on every open dart."""
    degrees, alpha = code
    vertices, edges, count = list[tuple[int, ...]](), list[tuple[int, int]](), 0
    for degree in degrees:
        vertices.append(tuple(range(count, count + degree)))
        count += degree
    for dart, end in enumerate(alpha):
        if end == folds.OPEN:
            vertices.append((count,))
            edges.append((dart, count))
            count += 1
        elif dart < end:
            edges.append((dart, end))
    return World.from_rotations(vertices, edges, 0)


def test_a_fold_is_that_of_the_trusted_checkers_on_every_walk() -> None:
    rng = Random(0)
    for world in worlds([1, 2, 3]):
        robot = DrawnWorld(world.code)
        dart, (degree, _) = 0, robot.sight(0)
        ours, at = folds.first_fold(degree), 0
        theirs = Fold(Percept(degree, 0))
        for _ in range(8):
            door = rng.randrange(robot.sight(dart)[0])
            here = next(
                d for d, image in _turns(robot, ours, at) if image == robot.turned(dart, door)
            )
            dart = robot.alpha[robot.turned(dart, door)]
            degree, marker = robot.sight(dart)
            theirs.move(door, Percept(degree, None if marker == folds.ABSENT else marker))
            end = ours[1][here]
            ours, at = (
                (ours, end) if end != folds.OPEN else folds.crossed(ours, here, (degree, marker))
            )
            assert robot.placed(ours)[at] == dart
            assert with_leaves(ours).code == theirs.world().code
            assert is_closed(ours) == (theirs.open_darts() == 0)
            if is_closed(ours):
                assert ours == world.code


def _turns(robot: DrawnWorld, code: folds.FoldCode, at: int) -> list[tuple[int, int]]:
    """The darts of the robot's vertex in the fold, each with the dart of the world that it is."""
    images = robot.placed(code)
    vertex = next(v for v in with_leaves(code).vertices if at in v)
    return [(dart, images[dart]) for dart in vertex]


@pytest.mark.parametrize("edges", [1, 2, 3])
def test_with_the_map_in_hand_the_game_costs_the_least_cost_of_a_proof(edges: int) -> None:
    rules = ProofRules(drawn(edges), PROOF)
    solver = Solver(rules, mean=True)
    for start in rules.starts():
        for number in start.open:
            least = tv.World.from_id(f"m{edges}/{number}").least_cost()
            assert solver.value(start._replace(open=(number,))) == least


def one_a_move(_world: DrawnWorld, _code: folds.FoldCode, _at: int) -> int:
    """The bound that needs no argument: the game is not over."""
    return 1


@pytest.mark.parametrize("mean", [False, True])
def test_the_bounds_change_no_value(mean: bool) -> None:
    assert total(PROOF, mean=mean) == total(GameEnding(is_closed, one_a_move), mean=mean)


@pytest.mark.nightly
@pytest.mark.parametrize("mean", [False, True])
def test_the_bounds_change_no_value_of_three_edges(mean: bool) -> None:
    crossing = GameEnding(is_closed, DrawnWorld.crossing_bound)
    assert total(PROOF, 3, mean=mean) == total(crossing, 3, mean=mean)


@pytest.mark.parametrize("edges", [2, pytest.param(3, marks=pytest.mark.long)])
def test_no_bound_is_above_the_value(edges: int) -> None:
    found = drawn(edges)
    rules = ProofRules(found, GameEnding(is_closed, DrawnWorld.crossing_bound))
    solver, todo = Solver(rules, mean=True), rules.starts()
    for state in todo:
        for number in state.open:
            value = solver.value(state._replace(open=(number,)))
            assert found[number].proof_bound(state.code, state.at) <= value
        if len(todo) < 30 ** (edges - 1):
            todo += [after for choice in rules.choices(state) for after in choice.states]


@pytest.mark.parametrize("edges", [2, 3])
def test_what_moves_cannot_tell_apart_is_bounded_below(edges: int) -> None:
    found = drawn(edges)
    rules = ClassRules(found, frozenset(range(len(found))))
    solver = Solver(rules, mean=False)
    for start in rules.starts():
        assert max(rules.bounds(start)) <= solver.value(start)
    pairs = [((0, 0), (other, 0)) for other in range(1, len(found))]
    alike = [pair for pair in pairs if found[pair[1][0]].sight(0) == found[0].sight(0)]
    for pair in alike:
        assert max(rules.bounds(pair)) == solver.value(pair)


def test_a_planted_bound_that_is_too_high_is_seen() -> None:
    def too_high(world: DrawnWorld, code: folds.FoldCode, at: int) -> int:
        return world.proof_bound(code, at) + 1

    with pytest.raises(InternalError, match="below its bound"):
        total(GameEnding(is_closed, too_high))


def test_a_planted_end_that_comes_too_early_is_seen() -> None:
    def too_early(code: folds.FoldCode) -> bool:
        return len(folds.open_darts(code)) <= 1

    with pytest.raises(InternalError, match="which proves one"):
        total(GameEnding(too_early, one_a_move))


# ---------------------------------------------------------------- quotients

TWO_ALIKE: folds.FoldCode = ((2, 2, 2), (2, 4, 0, folds.OPEN, 1, folds.OPEN))
"""The marker between two vertices of degree 2 that may be one."""


def test_the_quotients_of_a_path_of_three() -> None:
    assert set(folds.quotients(TWO_ALIKE)) == {TWO_ALIKE, ((2, 2), (2, 3, 0, 1))}


def test_three_vertices_leave_one_world_and_two_leave_one_and_four_do_not() -> None:
    assert is_single_of_vertices(TWO_ALIKE, 3)  # the two open darts can only be one edge
    assert is_single_of_vertices(TWO_ALIKE, 2)
    assert not is_single_of_vertices(TWO_ALIKE, 4)


@pytest.mark.parametrize("edges", [1, 2, 3, 4])
def test_planar_folds_are_those_of_genus_0(edges: int) -> None:
    assert all(is_planar(world.code) == world.is_planar for world in tv.worlds(edges=edges))


def test_leaves_change_nothing_about_genus() -> None:
    handle: folds.FoldCode = ((5,), (2, 3, 0, 1, folds.OPEN))
    assert not is_planar(handle)
    assert is_planar(TWO_ALIKE)
    assert with_leaves(TWO_ALIKE).is_planar
    assert not with_leaves(handle).is_planar
