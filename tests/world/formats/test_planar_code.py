"""planar_code: other programs' files, there and back, and what is refused byte by byte."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.world.formats.worlds import sentence_of, simple_planar, world_or_sentence
from topo_verify.errors import InputError
from topo_verify.world import World, families
from topo_verify.world.formats import planar_code

DATA = Path(__file__).parents[2] / "data" / "planar_code"
HEAD = b">>planar_code<<"
TRIANGLE = HEAD + bytes([3, 2, 3, 0, 1, 3, 0, 1, 2, 0])


def refusal_of(data: bytes, graph: int | None = None) -> str:
    """The one sentence that refuses it."""
    return sentence_of(lambda: planar_code.decode(World, data, graph=graph), "planar_code")


def assert_comes_back(world: World | None) -> None:
    """A world that was read is written and read again, if it is planar."""
    if world is not None and world.is_planar:
        assert planar_code.decode(World, planar_code.encode(world)).code == world.code


# ---------------------------------------------------------------- other programs' files


@pytest.mark.parametrize(
    ("graph", "name"), [(0, "tetrahedron"), (1, "cube"), (2, "octahedron"), (3, "dodecahedron")]
)
def test_nautys_solids_are_ours(graph: int, name: str) -> None:
    """Their rotations are unique but for the mirror image, which is the same for them."""
    world = World.load(DATA / "solids.pc", graph=graph)
    assert world.code == families.FAMILIES[name]().code
    assert world.name == f"solids-{graph}"


@pytest.mark.long
@pytest.mark.no_cover
def test_nautys_grid_of_300_vertices_is_our_lattice() -> None:
    world = World.load(DATA / "grid_300.pc")
    lattice = families.lattice(15, 20, marker=0)
    codes = {lattice.with_marker(dart).code for dart in range(2 * len(lattice.edges))}
    assert world.code in codes
    assert world.name == "grid_300"


def test_all_graphs_of_a_file_are_read_and_no_more() -> None:
    data = (DATA / "connected_5.pc").read_bytes()
    worlds = [planar_code.decode(World, data, graph=graph) for graph in range(20)]
    assert all(len(world.vertices) == 5 and world.is_planar for world in worlds)
    assert max(len(world.edges) for world in worlds) == 9
    assert "holds 20 graphs, and graph 20 (counted from 0)" in refusal_of(data, graph=20)
    assert "holds 20 graphs: say which" in refusal_of(data)
    assert worlds == [*planar_code.worlds(DATA / "connected_5.pc")]


# ---------------------------------------------------------------- there and back


@pytest.mark.parametrize("edges", range(6))
def test_every_small_simple_planar_world_comes_back(edges: int) -> None:
    for world in simple_planar(edges):
        assert planar_code.decode(World, planar_code.encode(world)).code == world.code


def test_isomorphic_worlds_give_the_same_bytes() -> None:
    world = families.prism(3)
    other = world.renumbered([*range(2, 18), 0, 1])
    assert planar_code.encode(world) == planar_code.encode(other)


def test_the_bytes_are_the_documented_ones() -> None:
    assert planar_code.encode(families.cycle(3)) == TRIANGLE
    assert planar_code.encode(World((), (), None)) == HEAD + bytes([1, 0])


def test_the_first_dart_of_the_first_vertex_is_marked() -> None:
    world = planar_code.decode(World, TRIANGLE)
    assert world.root == world.vertices[0][0] == 0


@pytest.mark.parametrize("size", [255, 256])
def test_numbers_of_two_bytes_begin_with_256_vertices(size: int) -> None:
    world = families.path(size)
    data = planar_code.encode(world)
    assert planar_code.decode(World, data).code == world.code
    assert data.startswith(b">>planar_code be<<\0") == (size > 255)


@pytest.mark.parametrize(
    "data",
    [
        TRIANGLE.removeprefix(HEAD),
        b">>planar_code <<" + TRIANGLE.removeprefix(HEAD),
        b">>planar_code le<<\0\3\0\2\0\3\0\0\0\1\0\3\0\0\0\1\0\2\0\0\0",
        b">>planar_code be<<\0\0\3\0\2\0\3\0\0\0\1\0\3\0\0\0\1\0\2\0\0",
        HEAD + b"\0\0\3\0\2\0\3\0\0\0\1\0\3\0\0\0\1\0\2\0\0",
    ],
)
def test_every_head_and_byte_order_is_read(data: bytes) -> None:
    assert planar_code.decode(World, data).code == families.cycle(3).code


@pytest.mark.parametrize("between", [b"", HEAD, b"\n" + HEAD, b"\r\n" + HEAD])
@pytest.mark.parametrize("end", [b"", b"\n", b"\r\n", b"\n\n"])
def test_joined_files_are_read(between: bytes, end: bytes) -> None:
    data = TRIANGLE + between + TRIANGLE.removeprefix(HEAD) + end
    for graph in (0, 1):
        world = planar_code.decode(World, data, graph=graph)
        assert world.code == families.cycle(3).code
    assert "holds 2 graphs" in refusal_of(data)


def test_joined_files_may_differ_in_their_byte_order() -> None:
    big, little = (HEAD[:-2] + b" be<<\0", HEAD[:-2] + b" le<<\0")
    path = (2, 2, 0, 1, 0)
    high_first = big + b"".join(number.to_bytes(2, "big") for number in path)
    low_first = little + b"".join(number.to_bytes(2, "little") for number in path)
    data = high_first + low_first + high_first
    for graph in range(3):
        assert planar_code.decode(World, data, graph=graph).code == families.path(2).code


@pytest.mark.parametrize("size", [10, 13])
def test_the_end_of_a_line_may_be_the_size_of_a_graph(size: int) -> None:
    path = planar_code.encode(families.path(size))
    data = TRIANGLE + path.removeprefix(HEAD)
    assert planar_code.decode(World, data, graph=1).code == families.path(size).code


def test_maps_of_any_genus_are_read() -> None:
    rows = [(2, 4, 3, 7, 5, 6), (3, 5, 4, 1, 6, 7), (4, 6, 5, 2, 7, 1), (5, 7, 6, 3, 1, 2),
            (6, 1, 7, 4, 2, 3), (7, 2, 1, 5, 3, 4), (1, 3, 2, 6, 4, 5)]  # fmt: skip
    data = HEAD + bytes([7, *(number for row in rows for number in (*row, 0))])
    world = planar_code.decode(World, data)
    assert (len(world.vertices), len(world.edges), world.genus) == (7, 21, 1)
    assert planar_code.decode(World, K4_ON_A_TORUS).genus == 1


K4_ON_A_TORUS = HEAD + bytes([4, 2, 3, 4, 0, 1, 3, 4, 0, 1, 2, 4, 0, 1, 2, 3, 0])

# ---------------------------------------------------------------- what is refused


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (b"", "holds no graph: name a file"),
        (HEAD, "holds no graph"),
        (b">>graph6<<C~", "expected the head '>>planar_code<<' at byte 0, got '>>graph6<<C~'"),
        (TRIANGLE[:-1], "graph 0 ends within the neighbours of vertex 3 of 3"),
        (HEAD + b"\xff", "ends within the neighbours of vertex 1 of 255"),
        (HEAD + b"\0", "expected a number of vertices at byte 15"),
        (HEAD + b"\0\0\0", "expected a number of vertices at byte 15"),
        (HEAD + b"\0\xff\xff\0", "ends within the neighbours of vertex 1 of 65535"),
        (HEAD + b"\0\0\2\0\2", "ends within the neighbours of vertex 1 of 2"),
        (TRIANGLE + b"\1", "ends within"),
        (HEAD + bytes([2, 3, 0, 1, 0]), "vertex 1 names the neighbour 3, and .* 1 … 2"),
        (HEAD + bytes([1, 1, 1, 0]), "vertex 1 is its own neighbour: loops"),
        (HEAD + bytes([2, 2, 2, 0, 1, 1, 0]), "vertex 1 names its neighbour 2 twice"),
        (HEAD + bytes([2, 2, 0, 0]), "vertex 1 names 2 as a neighbour, but 2 does not name 1"),
        (HEAD + bytes([2, 0, 0]), "not connected"),
        (HEAD + bytes([4, 2, 0, 1, 0, 4, 0, 3, 0]), "not connected"),
        (TRIANGLE + b">>graph6<<", "expected the head '>>planar_code<<' at byte 25, got '>>graph6"),
        (TRIANGLE + b"\n\4", "ends within"),
    ],
)
def test_bytes_that_are_no_simple_planar_world_are_refused(data: bytes, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        planar_code.decode(World, data)
    refusal_of(data)


def test_a_graph_that_is_named_is_named_in_the_refusal() -> None:
    data = TRIANGLE + bytes([1, 1, 1, 0])
    assert refusal_of(data, graph=1).startswith("planar_code, graph 1: vertex 1 is its own")
    assert planar_code.decode(World, data, graph=0).code == families.cycle(3).code


@pytest.mark.parametrize(
    ("world", "sentence"),
    [
        (
            lambda: families.cycle(1),
            "holds simple worlds, and this one has loops or parallel edges",
        ),
        (lambda: families.cycle(2), "holds simple worlds"),
        (lambda: families.torus(3, 3), "holds planar worlds, and this one has genus 1"),
        (lambda: families.path(65536), "numbers vertices up to 65535, and the world has 65536"),
    ],
)
def test_a_world_that_does_not_fit_is_refused(world: Callable[[], World], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        planar_code.encode(world())


@given(data=st.binary(max_size=60), head=st.booleans())
def test_any_bytes_give_a_world_or_one_sentence(data: bytes, head: bool) -> None:
    world = world_or_sentence(lambda: planar_code.decode(World, HEAD * head + data))
    assert_comes_back(world)


@given(data=st.data())
def test_any_change_to_a_file_gives_a_world_or_one_sentence(data: st.DataObject) -> None:
    content = bytearray((DATA / "solids.pc").read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    cut = data.draw(st.integers(0, len(content)))
    graph = data.draw(st.none() | st.integers(0, 4))
    world = world_or_sentence(lambda: planar_code.decode(World, bytes(content[:cut]), graph=graph))
    assert_comes_back(world)
