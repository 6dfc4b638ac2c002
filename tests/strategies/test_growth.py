"""From bytes to worlds: nothing that was not asked for comes out, and everything that was."""

from __future__ import annotations

from itertools import product
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.helpers import some
from tests.helpers import worlds as every_world
from tests.strategies import features
from topo_verify import World
from topo_verify.strategies import growth, worlds
from topo_verify.strategies.growth import BALANCED, CROWDED, grow
from topo_verify.strategies.shapes import MANY, Shape

SHAPES = [
    Shape(),
    Shape(max_genus=0),
    Shape(min_genus=1),
    Shape(min_genus=1, max_genus=1),
    Shape(min_genus=2),
    Shape(max_loops=0),
    Shape(max_loops=0, max_parallel=1),
    Shape(max_loops=0, max_parallel=1, max_degree=3),
    Shape(max_loops=0, min_genus=1),
    Shape(max_loops=0, min_genus=1, max_degree=3),
    Shape(max_degree=1),
    Shape(max_degree=2),
    Shape(max_degree=3),
    Shape(max_degree=3, min_genus=1),
    Shape(max_degree=4, min_genus=1),
    Shape(max_cycles=0),
    Shape(max_cycles=0, max_degree=3),
    Shape(dense=True),
    Shape(dense=True, max_loops=0, max_parallel=1),
    Shape(min_cycles=1, max_loops=0, max_parallel=2),
    Shape(max_vertices=1),
    Shape(leaf=True),
    Shape(leaf=True, max_loops=0, max_parallel=1),
    Shape(leaf=True, max_degree=3),
    Shape(leaf=True, min_genus=1),
]


def keeps(world: World, shape: Shape) -> bool:
    """Does the world keep the bounds? Asked of the world, not of the way in which it grew."""
    shape = shape.at(len(world.edges))
    joins = features.joins(world)
    return (
        shape.min_genus <= world.genus <= shape.max_genus
        and max(world.degrees) <= shape.max_degree
        and all(n <= (shape.max_loops, shape.max_parallel)[u < v] for (u, v), n in joins.items())
        and shape.min_cycles <= 1 + len(world.edges) - len(world.vertices) <= shape.max_cycles
        and len(world.vertices) <= shape.max_vertices
        and (not shape.leaf or world.degrees[world.marker_vertex] == 1)
    )


def grown(shape: Shape, steps: bytes, root: int) -> World | None:
    it = grow(shape, BALANCED, steps)
    if it is None or not steps:
        return None
    return World(it.alpha, it.sigma, 0 if shape.leaf else root % len(it.sigma))


@pytest.mark.parametrize("edges", [1, 2, 3, pytest.param(4, marks=pytest.mark.long)])
@pytest.mark.parametrize("shape", SHAPES, ids=str)
def test_every_world_within_the_bounds_grows_and_no_other(shape: Shape, edges: int) -> None:
    wanted = {world.code for world in every_world([edges]) if keeps(world, shape)}
    random = Random(edges)
    tries = 60 * len(wanted) if shape.is_possible(edges) else 0
    found = (grown(shape, random.randbytes(edges), random.randrange(8)) for _ in range(tries))
    assert {world.code for world in found if world is not None} == wanted


@pytest.mark.parametrize("genus", [0, 1, 2])
@pytest.mark.parametrize("degree", [2, 3, 4, MANY])
def test_the_least_number_of_edges_is_right_up_to_five(genus: int, degree: int) -> None:
    for (loops, parallel), leaf in product([(MANY, MANY), (0, MANY), (0, 1)], [False, True]):
        shape = Shape(
            min_genus=genus, max_degree=degree, max_loops=loops, max_parallel=parallel, leaf=leaf
        )
        for edges in range(1, 6):
            exists = any(keeps(world, shape) for world in every_world([edges]))
            assert shape.is_possible(edges) == exists, f"{shape}, {edges} edges"


@pytest.mark.parametrize("genus", [1, 2, 3, 4])
@pytest.mark.parametrize("degree", [3, 4, 5])
@pytest.mark.parametrize("simple", [False, True])
def test_the_tightest_bounds_seldom_lead_into_a_dead_end(
    genus: int, degree: int, simple: bool
) -> None:
    shape = Shape(
        min_genus=genus,
        max_genus=genus,
        max_degree=degree,
        max_loops=0 if simple else MANY,
        max_parallel=1 if simple else MANY,
    )
    least, _ = shape.edges_between("test", 0, 100)
    random = Random(genus)
    drawn = [grown(shape, random.randbytes(least), 0) for _ in range(50)]
    kept = [world for world in drawn if world is not None]
    assert len(kept) >= 45
    assert all(keeps(world, shape) for world in kept)


@given(steps=st.binary(max_size=40), further=st.binary(min_size=1, max_size=40))
def test_a_grown_map_is_a_world_with_an_edge_a_byte(steps: bytes, further: bytes) -> None:
    for kinds in (BALANCED, CROWDED):
        it = some(grow(Shape(), kinds, steps, further))
        world = World(it.alpha, it.sigma, 0 if steps else None)  # connected, or it is refused
        assert len(world.edges) == len(steps)
        assert len(it.closings) == len(steps) - len(world.vertices) + 1


def test_zeros_grow_a_star_and_ones_a_path() -> None:
    star, path = (grow(Shape(), BALANCED, bytes([byte] * 4)) for byte in (0, 1))
    assert star is not None
    assert path is not None
    assert World(star.alpha, star.sigma, 0).degrees == (4, 1, 1, 1, 1)
    assert World(path.alpha, path.sigma, 0).degrees == (1, 2, 2, 2, 1)


@pytest.mark.parametrize("corners", [*range(1, 20), 64, 100])
def test_a_place_tells_all_corners_apart(corners: int) -> None:
    assert {growth.nth(place, corners) for place in range(128)} == set(range(corners))


def test_a_place_stays_the_same_while_later_corners_go_away() -> None:
    assert [growth.nth(5, corners) for corners in range(6, 100)] == [5] * 94


@given(worlds(min_edges=33, max_edges=200))
def test_large_worlds_grow_too(world: World) -> None:
    assert 33 <= len(world.edges) <= 200


def test_far_corners_of_large_worlds_are_reached() -> None:
    """A leaf at the oldest of 78 corners, the vertex of dart 0: out of reach for one byte."""
    steps, further = bytes([1] * 39 + [77 % 64]), bytes([0] * 39 + [77 // 64])
    it = some(grow(Shape(), BALANCED, steps, further))
    assert it.vertex[-2] in (0, 1)
    assert grow(Shape(), BALANCED, steps) != it
