"""The least cost of a proof, against brute force and every run; and the walk that has this cost."""

from __future__ import annotations

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tests.helpers import EMPTY, any_world, path, worlds
from topo_verify import World, families
from topo_verify.checkers import Fold
from topo_verify.robot.simulator import SimulatedRobot, exit_dart, first_percept, percepts
from topo_verify.world.least_cost import BreadthFirstTree

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


@pytest.mark.parametrize(
    "edges",
    [1, 2, pytest.param(3, marks=pytest.mark.long), pytest.param(4, marks=pytest.mark.nightly)],
)
@pytest.mark.no_cover
def test_it_is_what_brute_force_finds(edges: int) -> None:
    for world in worlds([edges]):
        assert cheapest_proof(world, world.least_cost()) == world.least_cost(), world


def test_a_tree_is_walked_there_and_back_but_for_its_deepest_way() -> None:
    assert path(6, marker=0).least_cost() == 5
    assert path(6, marker=2).least_cost() == 2 * 5 - 3
    assert EMPTY.least_cost() == 0


def test_a_cycle_is_walked_once() -> None:
    assert World.from_code(((2,) * 5, (2, 4, 0, 6, 1, 8, 3, 9, 5, 7))).least_cost() == 5


# ---------------------------------------------------------------- the cheapest walk


def proved(world: World, doors: tuple[int, ...]) -> bool:
    """Does the log of a robot that takes these doors prove the map?"""
    robot = SimulatedRobot(world, len(doors))
    fold = Fold(robot.percept)
    for door in doors:
        fold.move(door, robot.move(door))
    return fold.open_darts() == 0 and fold.world().code == world.code


@pytest.mark.nightly
@pytest.mark.parametrize("edges", range(7))
@pytest.mark.no_cover
def test_it_proves_every_world_at_the_least_cost(edges: int) -> None:
    for world in worlds([edges]):
        doors = world.proof_tour()
        assert proved(world, doors), world
        assert len(doors) == world.least_cost(), world


@pytest.mark.no_cover
@given(
    any_world(max_edges=40)
    | st.sampled_from(
        [
            families.lattice(6, 6, holes=0.2, seed=1),
            families.torus(4, 5),
            families.random_genus(30, 3, seed=4),
            families.star(9),
        ]
    )
)
@example(path(2000, marker=700))
def test_it_proves_larger_worlds_at_the_least_cost(world: World) -> None:
    assert proved(world, world.proof_tour())
    assert len(world.proof_tour()) == world.least_cost()


@given(any_world(max_edges=20))
def test_the_weight_of_a_chord_is_the_length_of_its_loop(world: World) -> None:
    tree = BreadthFirstTree(world.code)
    for chord in tree.chords:
        assert tree.weight(chord) == len(tree.loop(chord))


def test_two_edges_between_two_vertices_are_one_walk_around() -> None:
    assert World.from_code(((2, 2), (2, 3, 0, 1))).proof_tour() == (1, 1)


def test_a_walk_along_a_path_ends_at_its_farther_end() -> None:
    assert path(4, marker=1).proof_tour() == (0, 0, 1, 1)


def test_the_doors_are_the_same_in_every_numbering() -> None:
    for world in worlds([3]):
        turned = world.renumbered([(dart + 2) % 6 for dart in range(6)])
        assert turned.proof_tour() == world.proof_tour()
