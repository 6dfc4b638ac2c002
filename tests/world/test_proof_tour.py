"""The cheapest walk that proves a map: it is one, and it costs what the least cost says."""

from __future__ import annotations

import pytest
from hypothesis import given

from tests.helpers import EMPTY, any_world, path, worlds
from topo_verify import World, families
from topo_verify.checkers import Fold
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world.proof_tour import BreadthFirstTree


def proved(world: World, doors: tuple[int, ...]) -> bool:
    """Does the log of a robot that takes these doors prove the map?"""
    robot = SimulatedRobot(world, len(doors))
    fold = Fold(robot.percept)
    for door in doors:
        fold.move(door, robot.move(door))
    return fold.open_darts() == 0 and fold.world().code == world.code


@pytest.mark.parametrize("edges", [0, 1, 2, 3, 4, 5, pytest.param(6, marks=pytest.mark.slow)])
@pytest.mark.no_cover
def test_it_proves_every_world_at_the_least_cost(edges: int) -> None:
    for world in worlds([edges]):
        doors = world.proof_tour()
        assert proved(world, doors), world
        assert len(doors) == world.least_cost(), world


@given(any_world(max_edges=40))
def test_it_proves_larger_worlds_at_the_least_cost(world: World) -> None:
    assert proved(world, world.proof_tour())
    assert len(world.proof_tour()) == world.least_cost()


@pytest.mark.parametrize(
    "world",
    [
        families.lattice(6, 6, holes=0.2, seed=1),
        families.torus(4, 5),
        families.random_tree(30, seed=2),
        families.random_genus(30, 3, seed=4),
        families.star(9),
        families.complete(6),
        path(2000, marker=700),
    ],
    ids=lambda world: world.name or "path",
)
def test_it_proves_worlds_of_the_families_at_the_least_cost(world: World) -> None:
    assert proved(world, world.proof_tour())
    assert len(world.proof_tour()) == world.least_cost()


@given(any_world(max_edges=20))
def test_the_weight_of_a_chord_is_the_length_of_its_loop(world: World) -> None:
    tree = BreadthFirstTree(world.code)
    for chord in tree.chords:
        assert tree.weight(chord) == len(tree.loop(chord))


def test_one_vertex_is_proved_by_walking_each_of_its_loops_once() -> None:
    for world in worlds([3]):
        if len(world.vertices) == 1:
            assert len(world.proof_tour()) == 3


def test_two_edges_between_two_vertices_are_one_walk_around() -> None:
    assert World.from_code(((2, 2), (2, 3, 0, 1))).proof_tour() == (1, 1)


def test_the_world_without_a_dart_needs_no_move() -> None:
    assert EMPTY.proof_tour() == ()


def test_a_walk_along_a_path_ends_at_its_farther_end() -> None:
    assert path(4, marker=1).proof_tour() == (0, 0, 1, 1)


def test_the_doors_are_the_same_in_every_numbering() -> None:
    for world in worlds([3]):
        turned = world.renumbered([(dart + 2) % 6 for dart in range(6)])
        assert turned.proof_tour() == world.proof_tour()
