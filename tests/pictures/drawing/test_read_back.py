"""The reader of finished pictures sees every fault that is planted in one."""

from __future__ import annotations

import re

import pytest

from topo_verify.pictures.drawing import lay_out, read_back, to_svg
from topo_verify.world.families import king, lattice
from topo_verify.world.rooted_map import World

pytestmark = pytest.mark.no_cover  # drawing is not trusted: it is left out of the measure


@pytest.fixture(scope="module")
def world() -> World:
    return lattice(3, 3)


@pytest.fixture(scope="module")
def svg(world: World) -> str:
    return to_svg(world, lay_out(world))


def untruths(svg: str, world: World) -> list[str]:
    return read_back.untruths(read_back.read(svg), world)


def curve(svg: str, a: int) -> str:
    """The path data of the edge whose lesser dart is `a`."""
    found = re.search(rf'data-darts="{a} \d+" d="([^"]*)"', svg)
    assert found
    return found[1]


def test_a_true_picture_has_no_untruth(svg: str, world: World) -> None:
    assert untruths(svg, world) == []


def test_two_edges_with_their_names_swapped_are_seen(svg: str, world: World) -> None:
    (a, b), (c, d) = world.edges[0], world.edges[1]
    names = (f'"{a} {b}"', f'"{c} {d}"')
    swapped = svg.replace(names[0], "here").replace(names[1], names[0]).replace("here", names[1])
    assert untruths(swapped, world)


def test_two_darts_of_a_vertex_that_change_places_are_seen(svg: str, world: World) -> None:
    # Vertex 4 in the middle: its darts are swapped in the world, not in the picture.
    rotations = [list(rotation) for rotation in world.vertices]
    rotations[4][0], rotations[4][1] = rotations[4][1], rotations[4][0]
    other = World.from_rotations(rotations, world.edges, world.marker)
    assert "the order of the darts at vertex 4 is not that of the world" in untruths(svg, other)


def test_a_moved_vertex_is_seen(svg: str, world: World) -> None:
    circle = re.search(r'data-vertex="4" cx="([\d.]+)"', svg)
    assert circle
    moved = svg.replace(circle[0], f'data-vertex="4" cx="{float(circle[1]) + 5}"')
    assert any("off the circle of vertex 4" in line for line in untruths(moved, world))


def test_a_missing_and_an_invented_edge_are_seen(svg: str, world: World) -> None:
    (a, b), *_ = world.edges
    assert untruths(svg.replace(f'"{a} {b}"', f'"{a} 99"'), world) == [
        f"edge ({a}, {b}) is not drawn",
        f"edge ({a}, 99) is drawn, and not there",
    ]


def test_a_missing_vertex_is_seen(svg: str, world: World) -> None:
    assert untruths(svg.replace('data-vertex="4"', ""), world) == ["vertex 4 is not drawn"]


def test_a_vertex_or_an_edge_that_is_drawn_twice_is_refused(svg: str) -> None:
    with pytest.raises(ValueError, match="vertex 4 is drawn twice"):
        read_back.read(svg.replace('data-vertex="5"', 'data-vertex="4"'))
    (first,) = re.findall(r'<path[^>]*data-darts="0 \d+"[^>]*>', svg)
    with pytest.raises(ValueError, match=r"part 0 of edge 0 \d+ is drawn twice"):
        read_back.read(svg.replace(first, first + first))


def through(svg: str, a: int, point: str) -> str:
    """The picture with the edge of dart `a` led through another point."""
    data = curve(svg, a)
    return svg.replace(f'd="{data}"', f'd="{data.replace("L", f"L{point}L")}"')


def test_an_edge_through_a_foreign_vertex_is_seen(svg: str, world: World) -> None:
    x, y, _ = read_back.read(svg).circles[8]
    assert f"edge {world.edges[0]} runs through vertex 8" in untruths(
        through(svg, 0, f"{x:.2f} {y:.2f}"), world
    )


def test_an_edge_that_comes_back_into_its_own_vertex_is_seen(svg: str, world: World) -> None:
    x, y, _ = read_back.read(svg).circles[world.vertex_of[world.edges[0][0]]]
    (line,) = untruths(through(svg, 0, f"{x:.2f} {y:.2f}"), world)
    assert "comes back into its own vertex" in line


def test_a_crossing_is_seen(svg: str, world: World) -> None:
    assert untruths(through(svg, 0, "-50 300"), world)[-1].endswith(" 0 are meant")


@pytest.mark.parametrize("missing", [1, 2, 4])
def test_a_crossing_without_its_bridge_is_seen(missing: int) -> None:
    world = king(3, 3)
    svg = to_svg(world, lay_out(world))
    assert untruths(svg, world) == []
    plain = re.sub('<path class="tv-halo".*', "", svg, count=missing)
    assert untruths(plain, world) == [f"{missing} of 4 crossings have no bridge"]


def test_circles_that_overlap_are_seen(svg: str, world: World) -> None:
    wide = re.sub(r' r="[\d.]+"', ' r="40"', svg)
    assert any("off the circle" in line for line in untruths(wide, world))
    picture = read_back.read(svg)
    (x, y, r) = picture.circles[1]
    picture.circles[0] = (x + r, y, r)
    assert "vertices 0 and 1 overlap" in list(read_back.overlaps(picture))


def test_path_data_of_another_kind_is_refused(svg: str) -> None:
    with pytest.raises(ValueError, match="expected absolute M, L and Q"):
        read_back.read(svg.replace(curve(svg, 0), "m1 1l2 2"))
