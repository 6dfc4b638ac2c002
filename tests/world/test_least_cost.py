"""The least cost of a proof, against brute force and against every run."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.helpers import EMPTY, any_world, path, worlds
from topo_verify import CATALOGUE, World, explore
from topo_verify.checkers import Fold
from topo_verify.robot.simulator import exit_dart, first_percept, percepts

State = tuple[object, ...]


def cheapest_proof(world: World, at_most: int) -> int | None:
    """The fewest moves whose fold is closed, if they are no more than `at_most`.

    Breadth-first search over folds and places. A walk is given up if it cannot be done in time even
    if every edge that it has not crossed yet takes one more move only.
    """
    seen: set[State] = set()
    frontier: list[tuple[int, ...]] = [()]
    for cost in range(at_most + 1):
        following: list[tuple[int, ...]] = []
        for doors in frontier:
            fold, at, _ = walked(world, doors)
            if fold.open_darts() == 0:
                return cost
            for door in range(percepts(world)[at].degree):
                longer, _, left = walked(world, (*doors, door))
                state = shape(longer)
                if state not in seen and cost + 1 + left <= at_most:
                    seen.add(state)
                    following.append((*doors, door))
        frontier = following
    return None


def walked(world: World, doors: tuple[int, ...]) -> tuple[Fold, int, int]:
    """The fold of this walk, the reference dart at its end, and how many edges it did not cross."""
    fold, at = Fold(first_percept(world)), world.root or 0
    crossed: set[int] = set()
    for door in doors:
        at = world.alpha[exit_dart(world, at, door)]
        crossed |= {at, world.alpha[at]}
        fold.move(door, percepts(world)[at])
    return fold, at, len(world.edges) - len(crossed) // 2


def shape(fold: Fold) -> State:
    """A fold and the robot's place in it, numbered breadth-first from the marked dart."""
    entries = [fold.find((0, 0))]
    rows: list[tuple[object, ...]] = []
    for node, first in entries:  # grows as it goes
        row: list[object] = []
        for door in range(fold.degree(node)):
            end = fold.partner((node, first + door))
            if end is not None and end[0] not in [n for n, _ in entries]:
                entries.append(end)
            row.append(end and place(fold, entries, end))
        rows.append(tuple(row))
    return tuple(rows), place(fold, entries, fold.find(fold.at))


def place(fold: Fold, entries: list[tuple[int, int]], end: tuple[int, int]) -> tuple[int, int]:
    """The number of a node and the door of a dart, counted from where its node was entered."""
    number = [node for node, _ in entries].index(end[0])
    return number, (end[1] - entries[number][1]) % fold.degree(end[0])


@pytest.mark.parametrize("edges", [1, 2, 3, pytest.param(4, marks=pytest.mark.slow)])
@pytest.mark.no_cover
def test_it_is_what_brute_force_finds(edges: int) -> None:
    for world in worlds([edges]):
        assert cheapest_proof(world, world.least_cost()) == world.least_cost(), world


@pytest.mark.no_cover
def test_no_run_costs_less() -> None:
    for world in worlds(range(5)):
        for name, algorithm in CATALOGUE.items():
            if "planar" not in name:
                assert explore(world, algorithm).cost >= world.least_cost(), (name, world)


@given(any_world(max_edges=25))
def test_no_run_costs_less_in_larger_worlds_either(world: World) -> None:
    assert explore(world, "folding").cost >= world.least_cost()


def test_a_tree_is_walked_there_and_back_but_for_its_deepest_way() -> None:
    assert path(6, marker=0).least_cost() == 5
    assert path(6, marker=2).least_cost() == 2 * 5 - 3
    assert EMPTY.least_cost() == 0


def test_a_cycle_is_walked_once() -> None:
    assert World.from_code(((2,) * 5, (2, 4, 0, 6, 1, 8, 3, 9, 5, 7))).least_cost() == 5
