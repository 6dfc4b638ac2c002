"""Lattices: rectangles of the grid with holes, as they are drawn on paper."""

from __future__ import annotations

from math import atan2

import pytest
from hypothesis import find, given, settings

from topo_verify import World, families
from topo_verify.strategies import lattices


@settings(max_examples=200)
@given(lattices())
def test_they_are_what_a_grid_drawn_on_paper_is(world: World) -> None:
    assert world.is_planar
    assert world.is_simple
    assert max(world.degrees) <= 4
    assert len(set(world.positions)) == len(world.vertices)
    for a, b in world.edges:
        (ax, ay), (bx, by) = (world.positions[world.vertex_of[dart]] for dart in (a, b))
        assert abs(ax - bx) + abs(ay - by) == 1


@given(lattices(min_edges=4))
def test_exits_stand_clockwise(world: World) -> None:
    for vertex, rotation in enumerate(world.vertices):
        x, y = world.positions[vertex]
        ends = [world.positions[world.vertex_of[world.alpha[dart]]] for dart in rotation]
        angles = [atan2(ey - y, ex - x) for ex, ey in ends]
        turns = sum(
            before < after for before, after in zip(angles, angles[1:] + angles[:1], strict=True)
        )
        assert len(rotation) == 1 or turns == 1, "once around, clockwise: one jump upwards"


@pytest.mark.parametrize("edges", [*range(12), 23, 30, 31, 57])
def test_every_number_of_edges_can_be_had(edges: int) -> None:
    world = find(lattices(min_edges=edges, max_edges=edges), lambda _: True)
    assert len(world.edges) == edges


def test_whole_rectangles_come_out_as_the_family_draws_them() -> None:
    rectangle = families.lattice(3, 4)
    world = find(
        lattices(min_edges=17, max_edges=17),
        lambda w: sorted(w.degrees) == sorted(rectangle.degrees) and len(w.faces) == 7,
    )
    roots = range(len(rectangle.alpha))
    codes = {rectangle.with_marker(root).code for root in roots}
    assert world.code in codes


def test_there_are_holes() -> None:
    world = find(
        lattices(min_edges=12), lambda w: any(len(face) > 4 for face in w.faces if len(face) != 12)
    )
    assert max(map(len, world.faces)) > 4
