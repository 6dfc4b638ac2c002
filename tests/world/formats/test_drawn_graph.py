"""Graphs with attributes: which ones draw, and that none of them is overlooked."""

from __future__ import annotations

import json
from types import SimpleNamespace
from typing import Any

import networkx as nx
import numpy as np
import pytest

from topo_verify.errors import InputError
from topo_verify.world import World
from topo_verify.world.formats import graphml, node_link
from topo_verify.world.formats.drawn_graph import is_drawn
from topo_verify.world.formats.nx import from_positions

K4 = "m6/19699"
"""Without a crossing; with its last edge straight it has genus 1."""

BENDS = "150 -20 150 150 -20 150 "


def k4(**last: Any) -> nx.Graph[str]:
    """The complete graph on a square, its last diagonal with these attributes."""
    graph: nx.Graph[str] = nx.Graph()
    for node, (x, y) in {"a": (0, 0), "b": (100, 0), "c": (100, 100), "d": (0, 100)}.items():
        graph.add_node(node, x=x, y=y)
    graph.add_edges_from([("a", "b"), ("b", "c"), ("c", "d"), ("d", "a"), ("a", "c")])
    graph.add_edge("b", "d", **last)
    return graph


@pytest.mark.parametrize(
    "bends",
    [
        BENDS,
        "150,-20 150,150 -20,150",
        [150, -20, 150, 150, -20, 150],
        np.array([150, -20, 150, 150, -20, 150]),
        [[150, -20], [150, 150], [-20, 150]],
        [{"x": 150, "y": -20}, {"x": 150, "y": 150}, {"x": -20, "y": 150}],
        np.array([[150, -20], [150, 150], [-20, 150]]),
    ],
)
def test_bends_are_the_points_between_the_ends(bends: Any) -> None:
    assert from_positions(k4()).genus == 1
    assert from_positions(k4(bends=bends)).id == K4


@pytest.mark.parametrize("bends", ["", " ", None, []])
def test_an_edge_without_bends_is_straight(bends: Any) -> None:
    assert from_positions(k4(bends=bends)) == from_positions(k4())


@pytest.mark.parametrize("bends", ["150 -20 150", "150 x", "1 nan", 7, [1, 2, 3], [[1]], {"x": 1}])
def test_bends_that_are_no_points_are_refused(bends: Any) -> None:
    with pytest.raises(InputError, match=r"edge \('b', 'd'\), bends"):
        from_positions(k4(bends=bends))


def test_an_edge_has_a_geometry_or_bends() -> None:
    with pytest.raises(InputError, match=r"edge \('b', 'd'\) has 'geometry' and 'bends'"):
        from_positions(k4(bends=BENDS, geometry="LINESTRING (100 0, 0 100)"))


def test_a_ring_is_no_edge_between_two_vertices() -> None:
    with pytest.raises(InputError, match=r"edge \('b', 'd'\), geometry is a ring"):
        from_positions(k4(geometry="LINESTRING (100 0, 150 0, 150 50, 100 0)"))


DRAWN: list[tuple[str, Any]] = [
    ("bendpoints", "150 -20 150 150"),
    ("bend-points", [150, -20, 150, 150]),
    ("controlPoints", [[1, 2], [3, 4]]),
    ("coords", [1, 2, 3, 4]),
    ("d", "M 0 0 L 1 2"),
    ("path", "m0,0c1,2,3,4,5,6"),
    ("points", [{"x": 1, "y": 2}, {"x": 3, "y": 4}]),
    ("points", "0,0 1,2"),
    ("pos", "e,27,18 27,72 27,64"),
    ("shape", "0,0 40,-10 90,0"),
    ("polyline", "_p~iF~ps|U_ulLnnqC"),
    ("wkt", "LINESTRING (0 0, 1 2)"),
    ("wkb", "0102000000"),
    ("the_geom", b"\1\2\0\0\0"),
    ("geom", SimpleNamespace()),
    ("graphics", {"Line": {"point": [{"x": 1, "y": 2}]}}),
    ("sections", [{"startPoint": {"x": 1, "y": 2}}] * 2),
    # by their value, whatever their name
    ("road", "LINESTRING (0 0, 1 2)"),
    ("road", "SRID=4326;MULTILINESTRING ((0 0, 1 2))"),
    ("road", "0,0 40,-10 90,0"),
    ("road", "0 0, 40 -10, 90 0"),
    ("road", "[[0, 0], [1, 2]]"),
    ("road", "[(0.5, 0), (1, 2)]"),
    ("road", '[{"x": 0, "y": 0}]'),
    ("road", '{"type": "LineString", "coordinates": [[0, 0], [1, 2]]}'),
    ("road", "M 0 0 L 1 2"),
    ("road", "0102000000020000000000000000000000000000000000000000000000"),
    ("road", [(0, 0), (1, 2)]),
    ("road", [(0.5, 0.4)]),
    ("road", [{"x": 0.5, "y": 0.4}]),
    ("bendPoints", [{"y": 0.4, "x": 0.5, "label": "a"}]),
    ("road", np.array([[0.5, 0.4]])),
    ("road", np.array([[0, 0], [1, 2]])),
    ("road", {"type": "LineString", "coordinates": [[0, 0], [1, 2]]}),
    ("road", SimpleNamespace(coords=[(0, 0), (1, 2)])),
    ("road", SimpleNamespace(__geo_interface__={})),
    ("road", b"\1\2\0\0\0"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "value"), DRAWN)
def test_points_in_another_attribute_are_refused_by_its_name(name: str, value: Any) -> None:
    with pytest.raises(InputError, match=rf"edge \('b', 'd'\) has points in '{name}'"):
        from_positions(k4(**{name: value}))


NO_POINTS: list[tuple[str, Any]] = [
    ("osmid", [25, 26]), ("osmid", "[25, 26]"), ("lanes", ["3", "2"]), ("lanes", "['3', '2']"),
    ("d", 12.5), ("d", "12.5"), ("path", "via Roma 12"), ("line", "U1"), ("line", "12"),
    ("shape", "solid"), ("track", "grade2"), ("curve", True), ("points", 5), ("route", ""),
    ("ref", "A 1;A 2"), ("name", "12, 13"), ("opening_hours", "Mo-Fr 08:00-18:00"), ("key", 0),
    ("width", "3.5"), ("color", "#010203"), ("speed", np.float64(50)), ("tags", {"a": 1}),
    ("ids", {1, 2}), ("nothing", None), ("hash", "01" + "f" * 62), ("viz", {"shape": "dotted"}),
    ("weights", "1 2 3 4"), ("label", "M1"), ("oneway", "False"), ("length", "57.1"),
    ("stats", [{"lanes": 2, "speed": 50}]), ("tags", [{}]), ("parts", [[1]]), ("parts", []),
]  # fmt: skip


@pytest.mark.parametrize(("name", "value"), NO_POINTS)
def test_other_attributes_draw_nothing(name: str, value: Any) -> None:
    assert not is_drawn(name, value)


# ---------------------------------------------------------------- nodes

PLACES: list[dict[str, Any]] = [
    {"x": 1, "y": 2},
    {"x": "1", "y": "2e0", "z": 9, "lon": 24, "lat": 60},
    {"pos": (1, 2)},
    {"pos": "1,2"},
    {"geometry": "POINT (1 2)"},
    {"geometry": "POINT Z (1 2 3)", "x": None, "y": ""},
    {"geometry": {"type": "Point", "coordinates": [1, 2]}, "x": 1, "y": 2},
    {"geometry": SimpleNamespace(__geo_interface__={"type": "Point", "coordinates": (1, 2)})},
    {"pos": "NOUN", "x": 1, "y": 2},
    {"pos": [1, 2], "x": 1, "y": 2.0000001},
    {"lon": 1, "lat": 2},
    {"lng": 1, "lat": 2},
    {"longitude": "1", "latitude": "2"},
]


@pytest.mark.parametrize("place", PLACES)
def test_a_node_lies_where_its_attributes_say(place: dict[str, Any]) -> None:
    graph: nx.Graph[str] = nx.Graph()
    graph.add_node("a", **place)
    assert from_positions(graph).positions == ((1, 2),)


@pytest.mark.parametrize(
    ("place", "sentence"),
    [
        ({}, "node 'a' has no 'x'"),
        ({"x": 1}, "node 'a' has no 'y'"),
        ({"x": 1, "lat": 2}, "node 'a' has no 'y'"),
        ({"geometry": ""}, "node 'a' has no 'x'"),
        ({"geometry": "LINESTRING (0 0, 1 1)"}, "node 'a', geometry is a LINESTRING"),
        ({"geometry": "POINT EMPTY"}, "node 'a', geometry has 0 points"),
        ({"x": 385000, "y": 6672000, "geometry": "POINT (25 60)"}, "node 'a' lies at .* and at"),
        ({"pos": (1, 2), "x": 2, "y": 1}, "node 'a' lies at .* and at"),
        ({"pos": "NOUN"}, "node 'a' has no 'x'"),
        ({"viz": {"position": {"x": 1, "y": 2}}}, "no 'x'.*; its 'viz' is not read"),
        ({"graphics": {"x": 1, "y": 2}}, "no 'x'.*; its 'graphics' is not read"),
        ({"pos": "1;2"}, "node 'a', pos has a point of 1"),
        ({"pos": {"x": 1}}, "node 'a', pos is"),
    ],
)
def test_a_node_whose_place_is_not_read_is_refused(place: dict[str, Any], sentence: str) -> None:
    graph: nx.Graph[str] = nx.Graph()
    graph.add_node("a", **place)
    with pytest.raises(InputError, match=sentence):
        from_positions(graph)


# ---------------------------------------------------------------- files

# As OGDF writes it.
OGDF = """<?xml version="1.0"?><graphml xmlns="http://graphml.graphdrawing.org/xmlns"
  xmlns:y="http://www.yworks.com/xml/graphml">
  <key for="node" attr.name="x" attr.type="double" id="x"/>
  <key for="node" attr.name="y" attr.type="double" id="y"/>
  <key for="edge" attr.name="bends" attr.type="string" id="bends"/>
  <key for="edge" yfiles.type="edgegraphics" id="d9"/>
  <graph id="G" edgedefault="undirected">
    <node id="0"><data key="x">0</data><data key="y">0</data></node>
    <node id="1"><data key="x">100</data><data key="y">0</data></node>
    <node id="2"><data key="x">100</data><data key="y">100</data></node>
    <node id="3"><data key="x">0</data><data key="y">100</data></node>
    <edge source="0" target="1"/><edge source="1" target="2"/><edge source="2" target="3"/>
    <edge source="3" target="0"/><edge source="0" target="2"/>
    <edge id="5" source="1" target="3">DATA</edge>
  </graph></graphml>"""


def ogdf(data: str) -> World:
    """The world with this inside of its last edge."""
    return graphml.decode(World, OGDF.replace("DATA", data).encode())


def test_the_bends_of_ogdf_are_read() -> None:
    assert ogdf("").genus == 1
    assert ogdf(f'<data key="bends">{BENDS}</data>').id == K4


@pytest.mark.parametrize(
    ("data", "name"),
    [
        ('<data key="d9"><y:Path sx="0"><y:Point x="150" y="9"/></y:Path></data>', "<Point>"),
        ('<data key="d9"><y:Path sx="0.0" sy="-7.5" tx="0.0" ty="0"/></data>', "<Path>"),
        ('<data key="d9"><x:List xmlns:x="x"><y:Bend Location="150,-20"/></x:List></data>',
         "<Bend>"),
        ('<data key="points">150,-20 150,150</data>', "data points"),
        ('<data key="d9">150,-20 150,150</data>', "data d9"),
    ],
)  # fmt: skip
def test_points_that_a_program_writes_in_its_own_way_are_refused(data: str, name: str) -> None:
    with pytest.raises(InputError, match=f"edge '1 3 5' has points in '{name}'"):
        ogdf(data)


def test_points_among_the_attributes_of_an_element_are_refused() -> None:
    with pytest.raises(InputError, match="edge '1 3 5' has points in '<edge d>'"):
        graphml.decode(World, OGDF.replace('id="5"', 'id="5" d="M 0 0 L 1 2"').encode())


def test_the_style_and_the_labels_of_yed_draw_nothing() -> None:
    plain = ogdf("")
    styled = ogdf(
        '<data key="d9"><y:PolyLineEdge><y:Path sx="0.0" sy="0" tx="-0.0" ty="0.0"/>'
        '<y:LineStyle color="#000000"/><y:EdgeLabel x="10" y="5">a</y:EdgeLabel></y:PolyLineEdge>'
        "</data>"
    )
    assert styled == plain


def test_a_node_of_yed_has_its_place_in_an_element_that_is_named() -> None:
    node = '<data key="x">0</data><data key="y">0</data>'
    place = '<data key="g"><y:ShapeNode><y:Geometry x="0" y="0"/></y:ShapeNode></data>'
    with pytest.raises(InputError, match=r"node '0' has no 'x'.*; its '<Geometry>' is not read"):
        graphml.decode(World, OGDF.replace(node, place, 1).encode())


def as_json(graph: Any) -> str:
    """The graph as NetworkX writes it; the name of the list of edges differs by version."""
    return json.dumps(nx.node_link_data(graph))


def test_node_link_json_without_a_rotation_is_a_drawing() -> None:
    world = node_link.decode(World, as_json(k4(bends=BENDS)), stem="k4")
    assert (world.id, world.name, world.vertex_names) == (K4, "k4", ("a", "b", "c", "d"))
    assert world == from_positions(k4(bends=BENDS))


@pytest.mark.parametrize(
    "head", ['"graph":{},', '"graph":{"name":"t"},', "", '"multigraph":false,']
)
@pytest.mark.parametrize("edges", ["edges", "links"])
def test_a_drawing_in_node_link_json_needs_no_more_than_its_nodes_and_edges(
    head: str, edges: str
) -> None:
    text = (
        f'{{{head}"nodes":[{{"id":"a","x":0,"y":0}},{{"id":"b","lon":1,"lat":0}}],'
        f'"{edges}":[{{"source":"a","target":"b"}}]}}'
    )
    assert node_link.decode(World, text).id == "m1/0"


@pytest.mark.parametrize(
    "edges", ['"links":[],"edges":[]', '"adjacency":[[{"id":0}]]', '"edge":[]']
)
def test_a_drawing_in_node_link_json_has_its_edges_in_one_place(edges: str) -> None:
    with pytest.raises(InputError, match="expected its edges as 'edges', or 'links', got "):
        node_link.decode(World, f'{{"nodes":[{{"id":0,"x":0,"y":0}}],{edges}}}')


def test_directed_edges_of_node_link_json_are_merged() -> None:
    graph: nx.MultiDiGraph[tuple[int, int]] = nx.MultiDiGraph()
    graph.add_node((0, 0), pos=(0, 0))
    graph.add_node((0, 1), pos=(1, 0))
    graph.add_edges_from([((0, 0), (0, 1)), ((0, 1), (0, 0))])
    world = node_link.decode(World, as_json(graph))
    assert (world.id, world.vertex_names) == ("m1/0", ("(0, 0)", "(0, 1)"))


ROTATED = """<graphml><key id="r" attr.name="rotation"/><graph>
<node id="a"><data key="r">0</data></node></graph></graphml>"""
"""Without a `format`."""


def test_a_rotation_in_a_drawing_is_not_overlooked() -> None:
    text = '{"nodes":[{"id":0,"x":0,"y":0,"rotation":[]}],"edges":[]}'
    sentence = "its nodes have a 'rotation', and the graph has no 'format'"
    with pytest.raises(InputError, match=sentence):
        node_link.decode(World, text)
    with pytest.raises(InputError, match=sentence):
        graphml.decode(World, ROTATED.encode())
