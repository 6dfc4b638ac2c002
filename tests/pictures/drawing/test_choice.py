"""How a world is drawn: by its positions, without crossings, with bridges, as a cell or a ball."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from tests.helpers import some
from tests.pictures.drawing.pictures import drawn
from tests.python import python
from topo_verify.pictures.drawing import choice, curves, lay_out, read_back, to_svg
from topo_verify.pictures.drawing.layout import Layout, Sketch, fitted
from topo_verify.pictures.drawing.straight import given
from topo_verify.pictures.drawing.svg import leaving
from topo_verify.world import families
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import World

pytestmark = pytest.mark.no_cover  # drawing is not trusted: it is left out of the measure


def test_positions_that_show_the_order_are_kept() -> None:
    world = families.lattice(2, 3)
    layout = drawn(world)
    assert layout.kind == "positions"
    (ax, ay), (bx, by) = layout.centres[0], layout.centres[1]
    # Node 0 is at the top left, and node 1 on its right.
    assert ay == by == min(y for _, y in layout.centres)
    assert ax < bx


@pytest.mark.parametrize(
    ("world", "positions"),
    [
        (families.lattice(3, 3), [(-x, y) for x, y in families.lattice(3, 3).positions]),
        (families.lattice(1, 3), [(0.0, 0.0), (2.0, 0.0), (1.0, 0.0)]),
        (families.cycle(4), [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]),
    ],
    ids=["another order", "an edge through a vertex", "crossings in a planar world"],
)
def test_positions_that_are_not_true_are_not_used(
    world: World, positions: list[tuple[float, float]]
) -> None:
    assert drawn(replace(world, positions=tuple(positions))).kind == "planar"


def test_crowded_positions_are_spread() -> None:
    layout = drawn(resolve_world("nyc"))
    assert layout.kind == "planar"
    assert layout.radius / max(layout.width, layout.height) > 0.015


def test_diagonals_of_a_king_pass_over_each_other() -> None:
    layout = drawn(families.king(3, 3))
    assert (layout.kind, len(layout.bridges)) == ("positions", 4)
    assert all(bridge.over > bridge.under for bridge in layout.bridges)


def test_a_world_without_a_dart_is_one_circle() -> None:
    layout = drawn(World.from_id("m0/0"))
    assert (len(layout.centres), layout.paths) == (1, ())


def test_a_long_path_is_wound_up() -> None:
    layout = drawn(families.path(120))
    assert 0.6 < layout.width / layout.height < 1.6


def test_thirty_parallel_edges_and_their_loops_are_drawn_true() -> None:
    parallel = World.from_rotations(
        [list(range(30)), list(range(59, 29, -1))], [(k, 30 + k) for k in range(30)], 0
    )
    assert parallel.genus == 0
    assert drawn(parallel).kind == "planar"


def _k7() -> World:
    """The neighbours of i are i + 1, 3, 2, 6, 4, 5 in turn: seven vertices, fourteen triangles."""
    around = (1, 3, 2, 6, 4, 5)
    dart = {(i, (i + k) % 7): 6 * i + place for i in range(7) for place, k in enumerate(around)}
    rotations = [[dart[i, (i + k) % 7] for k in around] for i in range(7)]
    edges = [(dart[i, j], dart[j, i]) for i, j in dart if i < j]
    return World.from_rotations(rotations, edges, 0)


def test_k7_lies_flat_on_the_torus() -> None:
    world = _k7()
    assert (world.genus, len(world.faces)) == (1, 14)
    layout = drawn(world)
    assert layout.kind == "cell"
    assert any(len(parts) > 1 for parts in layout.paths)


@pytest.mark.parametrize(
    "world",
    [
        families.hexagonal_torus(2, 3),
        families.triangular_torus(3, 3),
        families.torus(3, 4),
        _k7(),
        _k7().dual(),
    ],
)
def test_the_seam_of_a_torus_leaves_room_for_the_marker_and_for_the_numbers(world: World) -> None:
    layout = drawn(world)
    lengths = {dart: curves.length(line) for dart, line in leaving(world, layout).items()}
    assert layout.kind == "cell"
    assert lengths[some(world.root)] > 2.5 * layout.radius
    assert min(lengths.values()) > 0.75 * layout.radius


def test_an_edge_that_comes_back_elsewhere_in_a_cell_is_seen() -> None:
    world = families.torus(3, 4)
    layout = lay_out(world)
    torn = next(k for k, parts in enumerate(layout.paths) if len(parts) == 2)
    first, second = layout.paths[torn]
    other = next(p for k, p in enumerate(layout.paths) if len(p) == 2 and k != torn)[1]
    end = second.split("L")[1]
    paths = list(layout.paths)
    paths[torn] = (first, f"{other.split('L')[0]}L{end}")
    picture = read_back.read(to_svg(world, replace(layout, paths=tuple(paths))))
    edge = world.edges[torn]
    assert read_back.untruths(picture, world) == [
        f"edge {edge} does not come back where it left the cell"
    ]


def test_a_sketch_whose_vertices_coincide_is_given_up_after_one_look(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    world = families.cycle(4)
    looks = list[float]()

    def looked(sketch: Sketch, rounding: float) -> Layout:
        looks.append(rounding)
        return fitted(sketch, rounding)

    monkeypatch.setattr(choice, "fitted", looked)
    heap = replace(world, positions=((0.0, 0.0), (1e-6, 0.0), (1.0, 0.0), (1.0, 1.0)))
    sketch = given(heap)
    assert choice._true(heap, some(sketch)) is None  # pyright: ignore[reportPrivateUsage]
    assert looks == [0.0]


@pytest.mark.parametrize(("name", "sides"), [("m4/629", 8), ("m6/108770", 12), ("m5/4000", 4)])
def test_a_world_with_one_face_is_a_polygon_with_4g_sides(name: str, sides: int) -> None:
    world = World.from_id(name)
    layout = drawn(world)
    assert layout.cell is not None
    assert len(layout.cell.corners) == len(layout.cell.sides) == sides == 4 * world.genus
    assert sum(len(parts) == 2 for parts in layout.paths) == sides / 2


@pytest.mark.parametrize(("name", "sides"), [("m4/629", "abacdcdb"), ("family:torus(3,4)", "abab")])
def test_each_side_has_its_letter(name: str, sides: str) -> None:
    world = resolve_world(name)
    svg = to_svg(world, lay_out(world))
    assert "".join(re.findall(r'<text class="tv-soft"[^>]*>([a-z])</text>', svg)) == sides


def test_sides_of_a_polygon_that_are_paired_wrongly_are_seen() -> None:
    world = World.from_id("m4/629")
    svg = to_svg(world, lay_out(world))
    assert 'data-sides="abacdcdb"' in svg
    wrong = read_back.read(svg.replace('"abacdcdb"', '"abacdcbd"'))
    assert "does not come back where it left the cell" in read_back.untruths(wrong, world)[0]
    with pytest.raises(ValueError, match="expected each side of the cell twice"):
        read_back.read(svg.replace('"abacdcdb"', '"abacdcda"'))


@pytest.mark.long
def test_a_map_of_loops_within_loops_is_shown_whole_with_marker_and_names() -> None:
    world = families.random_planar(250, seed=1)
    layout = drawn(world)
    assert (layout.kind, layout.hidden) == ("planar", frozenset())
    svg = to_svg(world, layout)
    reach = layout.width / 110
    (ring,) = re.findall(r'<circle class="tv-mark" .* r="([\d.]+)"', svg)
    assert reach / 2 < float(ring) < 2 * reach
    names = re.findall(r'<text class="tv-name"', svg)
    assert len(names) > 0.6 * len(world.vertices)  # those that have room
    assert f'font-size="{reach:.2f}"' in svg


@pytest.fixture
def large(monkeypatch: pytest.MonkeyPatch) -> World:
    """A world that counts as large here."""
    monkeypatch.setattr(choice, "WHOLE", 20)
    monkeypatch.setattr(choice, "LIMIT", 30)
    return families.random_planar(60, seed=1)


def test_of_a_large_world_a_ball_around_the_marker_is_shown(large: World) -> None:
    layout = drawn(large)
    assert layout.kind == "ball"
    assert large.marker_vertex not in layout.hidden
    assert layout.stubs
    shown = len(large.vertices) - len(layout.hidden)
    assert f"{shown} of {len(large.vertices)} vertices are shown" in to_svg(large, layout)


def test_a_ball_may_be_around_another_dart_of_a_world_of_any_size(large: World) -> None:
    hidden = min(lay_out(large).hidden)
    layout = drawn(large, centre=large.vertices[hidden][0])
    assert hidden not in layout.hidden
    small = families.random_planar(20, seed=1)
    assert drawn(small, centre=0).kind == "ball"


@pytest.mark.nightly
def test_the_same_bytes_in_every_process() -> None:
    code = (
        "import topo_verify as tv;"
        "print(tv.families.random_genus(8, 2, seed=3).draw(), tv.families.random_tree(9).draw())"
    )
    made = [python("-c", code, environment={"PYTHONHASHSEED": seed}) for seed in ("0", "1")]
    assert made[0].stdout == made[1].stdout != ""
