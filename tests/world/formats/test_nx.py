"""NetworkX: planar embeddings there and back; graphs with positions, clockwise and exactly so."""

from __future__ import annotations

from math import atan2, cos, pi, sin
from types import SimpleNamespace
from typing import Any

import networkx as nx
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.world.formats.worlds import simple_planar, world_or_sentence
from topo_verify.errors import InputError
from topo_verify.world import World, families
from topo_verify.world.formats.nx import (
    from_networkx,
    from_planar_embedding,
    from_positions,
    to_planar_embedding,
)
from topo_verify.world.resolve import resolve_world

NX: Any = nx
"""NetworkX where its stubs leave types open."""

SQUARE = {"a": (0, 0), "b": (1, 0), "c": (1, 1), "d": (0, 1)}


def star(*tips: tuple[float, float], **attributes: Any) -> nx.Graph[Any]:
    """A node 'hub' at the origin, joined with a node at each tip."""
    graph: nx.Graph[Any] = nx.Graph()
    graph.add_node("hub", x=0, y=0)
    for number, (x, y) in enumerate(tips):
        graph.add_node(number, x=x, y=y)
        graph.add_edge("hub", number, **attributes)
    return graph


def around(world: World, vertex: int = 0) -> list[str]:
    """The names of the neighbours in the order of the exits."""
    darts = world.vertices[vertex]
    return [world.vertex_names[world.vertex_of[world.alpha[dart]]] for dart in darts]


# ---------------------------------------------------------------- planar embeddings


@pytest.mark.parametrize("edges", range(6))
def test_every_small_simple_planar_world_comes_back(edges: int) -> None:
    for world in simple_planar(edges):
        embedding = to_planar_embedding(world)
        embedding.check_structure()
        assert from_planar_embedding(embedding).code == world.code


def test_the_marker_comes_back_wherever_it_is() -> None:
    world = families.prism(3)
    for dart in range(18):
        marked = world.with_marker(dart)
        assert from_planar_embedding(to_planar_embedding(marked)).code == marked.code


def test_an_embedding_is_clockwise_here_and_there() -> None:
    embedding: nx.PlanarEmbedding[str] = nx.PlanarEmbedding()
    embedding.add_nodes_from(["hub", "n", "e", "s"])
    embedding.set_data({"hub": ["n", "e", "s"], "n": ["hub"], "e": ["hub"], "s": ["hub"]})
    world = from_planar_embedding(embedding, marker=("hub", "s"), name="star")
    assert around(world) == ["n", "e", "s"]
    assert (world.root, world.name) == (2, "star")
    assert list(to_planar_embedding(world).neighbors_cw_order(0)) == [3, 1, 2]


def test_networkxs_own_embeddings_are_read() -> None:
    planar, embedding = NX.check_planarity(NX.dodecahedral_graph())
    assert planar
    assert from_planar_embedding(embedding).code == families.dodecahedron().code


def test_what_is_no_simple_planar_world_is_not_embedded() -> None:
    with pytest.raises(InputError, match="a planar embedding holds planar worlds"):
        to_planar_embedding(families.torus(3, 3))
    with pytest.raises(InputError, match="a planar embedding holds simple worlds"):
        to_planar_embedding(families.cycle(2))


def test_an_embedding_that_is_broken_is_refused() -> None:
    half: Any = NX.PlanarEmbedding()
    half.add_half_edge_first(0, 1)  # NetworkX 3.2 has no add_half_edge
    two: nx.PlanarEmbedding[int] = nx.PlanarEmbedding()
    two.set_data({0: [1], 1: [0], 2: [3], 3: [2]})
    toroidal: nx.PlanarEmbedding[int] = nx.PlanarEmbedding()
    toroidal.set_data({0: [1, 2, 3], 1: [0, 2, 3], 2: [0, 1, 3], 3: [0, 1, 2]})
    given: list[tuple[Any, str]] = [
        (half, "the planar embedding is broken"),
        (None, "expected a networkx.PlanarEmbedding, got None; networkx.check_planarity"),
        (NX.path_graph(2), "expected a networkx.PlanarEmbedding, got <networkx"),
        (NX.check_planarity(NX.path_graph(2)), r"PlanarEmbedding, got \(True"),
        (toroidal, "the planar embedding is broken"),
        (two, "the planar embedding: the world is not connected"),
        (NX.PlanarEmbedding(), "'vertices' is empty"),
    ]
    for embedding, sentence in given:
        with pytest.raises(InputError, match=sentence):
            from_planar_embedding(embedding)
    with pytest.raises(InputError, match=r"no edge for marker=\(0, 9\)"):
        from_planar_embedding(to_planar_embedding(families.path(3)), marker=(0, 9))


# ---------------------------------------------------------------- positions


def test_exits_are_clockwise_from_the_north_with_y_upwards() -> None:
    world = from_positions(star((-1, 0), (0, -1), (1, 0), (0, 1)))
    assert around(world) == ["3", "2", "1", "0"]
    assert world.root == 0
    assert world.positions[1] == (-1, 0)


@given(
    turns=st.lists(st.integers(0, 719), min_size=1, max_size=20, unique=True),
    x=st.sampled_from([0.0, 1e6, -0.1]),
)
def test_any_star_is_read_in_the_order_of_its_bearings(turns: list[int], x: float) -> None:
    tips = {n: (x + sin(t * pi / 360), cos(t * pi / 360)) for n, t in enumerate(turns)}
    graph: nx.Graph[Any] = nx.Graph(("hub", n) for n in tips)
    world = from_positions(graph, {"hub": (x, 0.0), **tips})
    assert around(world) == [str(turns.index(t)) for t in sorted(turns)]


@pytest.mark.parametrize(
    "name", ["nyc", "family:lattice(4,5,holes=0.2,seed=3)", "family:king(4,5,holes=0.2,seed=3)"]
)
def test_a_world_follows_from_its_positions(name: str) -> None:
    world = resolve_world(name)
    graph: nx.Graph[int] = nx.Graph()
    graph.add_nodes_from(range(len(world.vertices)))
    graph.add_edges_from((world.vertex_of[a], world.vertex_of[b]) for a, b in world.edges)
    drawn = from_positions(graph, dict(enumerate(world.positions)))
    assert world.code in {drawn.with_marker(d).code for d in range(2 * len(world.edges))}


def test_positions_may_be_attributes_of_either_kind_and_numbers_may_be_texts() -> None:
    graph: nx.Graph[Any] = nx.Graph([("a", "b")])
    for attributes in ({"x": "0", "y": "1e0"}, {"pos": (0.0, 1.0)}):
        NX.set_node_attributes(graph, {"a": attributes, "b": {"x": 1, "y": 1, "pos": [1, 1]}})
        assert from_positions(graph).positions == ((0.0, 1.0), (1.0, 1.0))
        graph.nodes["a"].clear()


def test_one_node_is_a_world_and_none_is_not() -> None:
    graph: nx.Graph[Any] = nx.Graph()
    with pytest.raises(InputError, match="the graph has no vertex"):
        from_positions(graph)
    graph.add_node("a", x=0, y=0)
    assert from_positions(graph).id == "m0/0"


# ---------------------------------------------------------------- geometry


@pytest.mark.parametrize(
    "course",
    [
        [(0, 0), (0, 1), (5, 1), (1, 0)],
        [(1, 0), (5, 1), (0, 1), (0, 0)],  # from the other end
        [(0, 0), (0, 0), (0, 1), (5, 1), (1, 0)],  # stands still at first
        "LINESTRING (0 0, 0 1, 5 1, 1 0)",
        "linestring Z(0 0 7,0 1 7,5 1 7,1 0 7)",
        SimpleNamespace(coords=[(0, 0), (0, 1), (5, 1), (1, 0)]),
    ],
)
def test_an_edge_leaves_along_the_first_segment_of_its_geometry(course: object) -> None:
    graph = star((1, 0), (1, 0.5))
    assert around(from_positions(graph)) == ["1", "0"]
    graph.edges["hub", 0]["geometry"] = course
    assert around(from_positions(graph)) == ["0", "1"]


def test_parallel_edges_and_loops_are_told_apart_by_their_geometry() -> None:
    graph: nx.MultiGraph[str] = nx.MultiGraph()
    graph.add_node("a", pos=(0, 0))
    graph.add_node("b", pos=(4, 0))
    graph.add_edge("a", "b", key="straight")
    graph.add_edge("a", "b", key="north", geometry=[(0, 0), (2, 2), (4, 0)])
    graph.add_edge("a", "a", key="loop", geometry=[(0, 0), (-1, 1), (-1, -1), (0, 0)])
    world = from_positions(graph)
    assert (world.degrees, world.genus) == ((4, 2), 0)
    assert around(world) == ["b", "b", "a", "a"]
    marked = from_positions(graph, marker=("a", "b", "straight"))
    assert marked.root == world.vertices[0][1]
    assert from_positions(graph, marker=("a", "a")).root == world.vertices[0][3]
    assert from_positions(graph, marker=("b", "a", "north")).root in world.vertices[1]
    with pytest.raises(InputError, match=r"2 edges for marker=\('a', 'b'\): name its key"):
        from_positions(graph, marker=("a", "b"))


@pytest.mark.parametrize("marker", [("a", "z"), ("a",), (), ("a", "b", 7)])
def test_a_marker_that_names_no_edge_is_refused(marker: tuple[Any, ...]) -> None:
    graph: nx.Graph[str] = NX.cycle_graph(list("abcd"))
    assert from_positions(graph, SQUARE, marker=("b", "a")).marker_vertex == 1
    with pytest.raises(InputError, match="the graph has no edge for marker="):
        from_positions(graph, SQUARE, marker=marker)


# ---------------------------------------------------------------- ties


@pytest.mark.parametrize(
    "tips",
    [
        [(1, 0), (2, 0)],
        [(0, 1), (0, 3)],
        [(-1, -3), (-2, -6)],
        [(0.1, 0.2), (0.3, 0.6000000000000001), (0.2, 0.4)],
        [(1e-300, 2e-300), (1, 2)],
        [(-1, 0.0), (-2, -0.0)],
    ],
)
def test_equal_angles_are_an_error_that_names_the_vertex(tips: list[tuple[float, float]]) -> None:
    with pytest.raises(
        InputError, match=r"at vertex 'hub' two edges leave at the same angle, .*toward"
    ):
        from_positions(star(*tips))


def test_angles_that_differ_in_the_last_bit_have_an_order() -> None:
    """Seen from the hub the second tip is higher, by less than any float angle shows."""
    low, high = (1e9, 1e9 - 1), (1e9 + 1, 1e9)
    assert atan2(low[1], low[0]) == atan2(high[1], high[0])
    assert around(from_positions(star(low, high))) == ["1", "0"]
    assert around(from_positions(star(high, low))) == ["0", "1"]


# ---------------------------------------------------------------- directed graphs


def test_a_street_in_both_directions_is_one_edge() -> None:
    graph: nx.MultiDiGraph[str] = nx.MultiDiGraph()
    for node, position in SQUARE.items():
        graph.add_node(node, pos=position)
    graph.add_edge("a", "b", geometry="LINESTRING (0 0, 0.5 -1, 1 0)")
    graph.add_edge("b", "a", geometry="LINESTRING (1 0, 0.5 -1, 0 0)")
    graph.add_edge("b", "c")
    graph.add_edge("c", "b")
    graph.add_edge("c", "d")  # one way
    world = from_positions(graph)
    assert world.degrees == (1, 2, 2, 1)
    assert from_positions(graph, marker=("b", "a", 0)).marker_vertex == 1


def test_a_loop_in_both_directions_is_one_edge_and_twice_in_one_direction_is_refused() -> None:
    loop = [(0, 0), (1, 0), (1, 1), (0, 0)]
    for again, is_read in ((loop[::-1], True), (loop, False)):
        graph: nx.MultiDiGraph[str] = nx.MultiDiGraph()
        graph.add_node("a", pos=(0, 0))
        graph.add_edge("a", "a", geometry=loop)
        graph.add_edge("a", "a", geometry=again)
        if is_read:
            assert from_positions(graph).degrees == (2,)
        else:
            with pytest.raises(InputError, match="two edges leave at the same angle"):
                from_positions(graph)


def test_carriageways_with_courses_of_their_own_are_two_edges() -> None:
    graph: nx.MultiDiGraph[str] = nx.MultiDiGraph()
    graph.add_node("a", pos=(0, 0))
    graph.add_node("b", pos=(1, 0))
    graph.add_edge("a", "b", geometry="LINESTRING (0 0, 0.5 -1, 1 0)")
    graph.add_edge("b", "a", geometry="LINESTRING (1 0, 0.5 1, 0 0)")
    assert from_positions(graph).degrees == (2, 2)
    graph.add_edge("a", "b", geometry="LINESTRING (0 0, 0.5 -1, 1 0)")
    with pytest.raises(InputError, match="at vertex 'a' two edges leave at the same angle"):
        from_positions(graph)


# ---------------------------------------------------------------- what is refused


@pytest.mark.parametrize(
    ("position", "sentence"),
    [
        (None, "node 'b' has no 'x'"),
        ("1;2", "node 'b', pos has a point of 1 coordinates"),
        (7, "is 7, expected x and y"),
        ((1,), "has a point of 1 coordinates"),
        ((1, 2, 3, 4), "has a point of 4 coordinates"),
        ((float("nan"), 0), "is nan, expected a number of at most 1e\\+12 in size"),
        ((float("inf"), 0), "is inf, expected"),
        ((10**5000, 0), "is an integer, expected"),
        ((1e13, 0), "is 10000000000000.0, expected"),
        ((None, 0), "is None, expected"),
        ((1j, 0), "is 1j, expected"),
    ],
)
def test_a_position_that_is_none_is_refused(position: Any, sentence: str) -> None:
    graph: nx.Graph[str] = nx.Graph([("a", "b")])
    with pytest.raises(InputError, match=sentence):
        from_positions(graph, {"a": (0, 0), "b": position})


def test_a_node_without_position_is_refused() -> None:
    graph: nx.Graph[str] = nx.Graph([("a", "b")])
    graph.nodes["a"]["x"] = 0
    with pytest.raises(InputError, match="node 'a' has no 'y'"):
        from_positions(graph)


@pytest.mark.parametrize(
    ("geometry", "sentence"),
    [
        ("POINT (0 0)", "is a POINT, expected a line"),
        ("LINESTRING EMPTY", "expected a line"),
        ("LINESTRING (0 0, 1)", "has a point of 1 coordinates"),
        ("LINESTRING (0 0, 1 x)", "is 'x', expected a number"),
        ("LINESTRING (0 0, 0 0)", "at vertex 'hub' begins an edge that is a single point"),
        ("LINESTRING (" + "0 0," * 9999 + "0 y)", "is 'y', expected a number"),
        ([(0, 0)], "an edge that is a single point"),
        ([0, 0], "is 0, expected x and y in a row"),
        (7, "is 7, expected x and y in a row"),
        ({0: 0}, "expected x and y in a row"),
    ],
)
def test_a_geometry_that_is_none_is_refused(geometry: object, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence) as refusal:
        from_positions(star((1, 0), geometry=geometry))
    assert str(refusal.value).isprintable()


@pytest.mark.parametrize("graph", [None, {}, [("a", "b")], "town.graphml"])
@pytest.mark.parametrize("read", [from_positions, from_networkx])
def test_what_is_no_graph_is_refused(read: Any, graph: Any) -> None:
    with pytest.raises(InputError, match="expected a graph of NetworkX, got"):
        read(graph)


@pytest.mark.parametrize("positions", [[(0, 0), (1, 0)], np.zeros((2, 2)), 5, "0,0"])
def test_positions_that_are_no_mapping_are_refused(positions: Any) -> None:
    with pytest.raises(InputError, match="expected positions as a mapping"):
        from_positions(NX.path_graph(2), positions)


def test_a_drawing_that_is_no_world_is_refused() -> None:
    graph = star((1, 0))
    graph.add_node("alone", x=9, y=9)
    with pytest.raises(InputError, match="vertex 'alone' has no edge, so the world is not conn"):
        from_positions(graph)
    graph.add_node("other", x=9, y=8)
    graph.add_edge("alone", "other")
    with pytest.raises(InputError, match="no way leads from vertex 'hub' to vertex 'alone'"):
        from_positions(graph)
    loop: nx.Graph[Any] = nx.Graph([("a", "a")])
    with pytest.raises(InputError, match="at vertex 'a' begins a loop that is a single point"):
        from_positions(loop, {"a": (0, 0)})


@given(
    geometry=st.text("LINESTRING(), 0.1-e\n", max_size=30)
    | st.lists(st.tuples(st.floats(), st.floats())),
    tip=st.tuples(st.floats(), st.floats()),
)
def test_any_geometry_gives_a_world_or_one_sentence(geometry: Any, tip: Any) -> None:
    world = world_or_sentence(lambda: from_positions(star(tip, (1, 0), geometry=geometry)))
    assert world is None or len(world.edges) == 2
