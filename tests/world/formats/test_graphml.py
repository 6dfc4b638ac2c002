"""GraphML: what OSMnx and NetworkX write, and what is refused."""

from __future__ import annotations

import re
from io import BytesIO
from typing import Any

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.world.formats.worlds import sentence_of, world_or_sentence
from topo_verify.world import World, families
from topo_verify.world.formats import embedding, graphml
from topo_verify.world.formats.nx import from_positions

NX: Any = nx
"""NetworkX where its stubs leave types open."""

# As `osmnx.save_graphml` writes a simplified network: directed, both ways of a street.
OSMNX = b"""<?xml version='1.0' encoding='utf-8'?>
<graphml xmlns="http://graphml.graphdrawing.org/xmlns" \
xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" \
xsi:schemaLocation="http://graphml.graphdrawing.org/xmlns http://graphml.graphdrawing.org/xmlns/1.0">
<key id="d9" for="edge" attr.name="geometry" attr.type="string"/>
<key id="d8" for="edge" attr.name="oneway" attr.type="string"/>
<key id="d5" for="node" attr.name="x" attr.type="string"/>
<key id="d4" for="node" attr.name="y" attr.type="string"/>
<key id="d0" for="graph" attr.name="crs" attr.type="string"/>
<graph edgedefault="directed"><data key="d0">epsg:4326</data>
<node id="11"><data key="d4">40.0</data><data key="d5">-73.0</data></node>
<node id="12"><data key="d4">40.0</data><data key="d5">-72.9</data></node>
<node id="13"><data key="d4">40.1</data><data key="d5">-73.0</data></node>
<edge source="11" target="12" id="0"><data key="d8">False</data>
  <data key="d9">LINESTRING (-73.0 40.0, -72.95 39.9, -72.9 40.0)</data></edge>
<edge source="12" target="11" id="0"><data key="d8">False</data>
  <data key="d9">LINESTRING (-72.9 40.0, -72.95 39.9, -73.0 40.0)</data></edge>
<edge source="11" target="12" id="1"><data key="d8">True</data></edge>
<edge source="11" target="13" id="0"/>
<edge source="13" target="11" id="0"/>
</graph></graphml>"""


def refusal_of(data: bytes) -> str:
    """The one sentence that refuses it."""
    return sentence_of(lambda: graphml.decode(World, data), "GraphML")


def test_a_network_of_osmnx_is_read_each_street_once() -> None:
    world = graphml.decode(World, OSMNX, stem="town")
    assert world.name == "town"
    assert world.vertex_names == ("11", "12", "13")
    assert world.positions[1] == (-72.9, 40.0)
    assert world.degrees == (3, 2, 1)
    names = [world.vertex_names[world.vertex_of[world.alpha[d]]] for d in world.vertices[0]]
    assert names == ["13", "12", "12"]  # north, east along the straight, south-east
    assert world.root == 0
    assert world.is_planar


@pytest.mark.parametrize("kind", [nx.Graph, nx.DiGraph, nx.MultiGraph, nx.MultiDiGraph])
def test_what_networkx_writes_is_read_as_networkx_reads_it(kind: Any) -> None:
    lattice = families.lattice(4, 5, holes=0.2, seed=2)
    graph: Any = kind()
    for vertex, (x, y) in enumerate(lattice.positions):
        graph.add_node(str(vertex), x=x, y=y)
    for a, b in lattice.edges:
        ends = str(lattice.vertex_of[a]), str(lattice.vertex_of[b])
        graph.add_edge(*ends)
        if graph.is_directed():
            graph.add_edge(*ends[::-1])
    file = BytesIO()
    NX.write_graphml(graph, file)
    world = graphml.decode(World, file.getvalue())
    assert world == from_positions(graph)
    assert lattice.code in {world.with_marker(d).code for d in range(2 * len(world.edges))}


def test_a_port_of_an_edge_is_no_part_of_the_drawing() -> None:
    data = OSMNX.replace(b'target="13"', b'target="13" sourceport="North"', 1)
    assert graphml.decode(World, data) == graphml.decode(World, OSMNX)


def test_an_edge_of_a_rotation_leads_to_a_node() -> None:
    text = graphml.encode(World.from_id("m1/0"))
    data = re.sub(r'target="[^"]*"', 'target="nowhere"', text, count=1).encode()
    assert "expected the ids of two nodes as source and target" in refusal_of(data)


def test_an_edge_says_itself_whether_it_is_directed() -> None:
    """Two undirected ones with one course are two edges, and those have no order."""
    start, rest = OSMNX.split(b'<edge source="12" target="11" id="0">')
    data = start + b'<edge source="12" target="11" id="0" directed="false">' + rest
    assert "at vertex '11' two edges leave at the same angle, '11 12 0' toward" in refusal_of(data)


def test_keys_have_defaults_and_may_be_for_all() -> None:
    data = b"""<graphml><key id="a" for="all" attr.name="x"><default>1</default></key>
    <key id="b" attr.name="y"/><key id="c" for="port" attr.name="x"><default>9</default></key>
    <desc>two nodes</desc><graph><node id="p"><data key="b">0</data></node>
    <node id="q"><data key="b"> 2 </data></node><edge source="p" target="q"/></graph></graphml>"""
    assert graphml.decode(World, data).positions == ((1, 0), (1, 2))


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        (b"<graphml", b"<!DOCTYPE graphml><graphml", "has a document type"),
        (b"</graphml>", b"", "is not valid XML"),
        (b'for="node" attr.name="x"', b'for="node" attr.name="lon"', "node '11' has no 'x'"),
        (b'<data key="d4">40.1</data>', b"", "node '13' has no 'y': the rotation comes from"),
        (b"40.1", b"north", "node '13', y is 'north', expected a number"),
        (b"40.1", b"nan", "node '13', y is 'nan', expected a number"),
        (b"40.1", b"1e999", "node '13', y is '1e999', expected a number"),
        (b'"d4">40.1', b'"d5">40.1', "node '13' has 'x' twice"),
        (b'node id="12"', b'node id="11"', "node '11' stands there twice"),
        (b'node id="12"', b"node", "node '' has no id"),
        (b'target="12" id="1"', b'target="99" id="1"', "edge '11 99 1': expected the ids"),
        (b'target="12" id="1"', b'id="1"', "edge '11 1': expected the ids of two nodes"),
        (b"LINESTRING (-73.0 40.0", b"LINESTRING (-73.0", "edge '11 12 0', geometry has a point"),
        (b"LINESTRING (-73.0 40.0", b"POINT (", "edge '11 12 0', geometry is a POINT"),
        (b"</graph>", b"</graph><graph/>", "holds several graphs"),
        (b"</node>", b"<graph/></node>", "has a <graph> within its graph"),
        (b"<node", b"<hyperedge/><node", "has a <hyperedge> within its graph"),
        (b'source="11" target="13"', b'source="12" target="13"', ""),
        (b"</graph>", b"<node id='9'><data key='d4'>0</data><data key='d5'>0</data></node></graph>",
         "vertex '9' has no edge"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_named_with_its_place(old: bytes, new: bytes, sentence: str) -> None:
    data = OSMNX.replace(old, new, 1)
    assert data != OSMNX
    if sentence:
        assert sentence in refusal_of(data)
    else:
        assert len(graphml.decode(World, data).edges) == 4  # one way there, another way back


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (b"", "is not valid XML"),
        (b"<svg/>", "expected GraphML, whose first element is <graphml>"),
        (b"<graphml/>", "has no vertex"),
        (b"<graphml><graph/></graphml>", "has no vertex"),
    ],
)
def test_what_is_no_graph_is_refused(data: bytes, sentence: str) -> None:
    assert sentence in refusal_of(data)


@pytest.mark.parametrize(("vertices", "edges"), [(4, 5), (7, 4)])
def test_a_file_is_refused_as_soon_as_it_has_too_much(
    vertices: int, edges: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before its end, which is not XML."""
    monkeypatch.setattr(embedding, "MOST_EDGES", 4)
    text = "<graphml><graph>" + "".join(f'<node id="{v}"/>' for v in range(vertices))
    text += '<edge source="0" target="0"/>' * edges + "<broken"
    sentence = refusal_of(text.encode())
    assert "expected at most 4 edges, their vertices, and 1,000,000 points in" in sentence
    assert "is not valid XML" in refusal_of(b"<graphml><graph><broken")


def test_a_polyline_of_too_many_points_is_refused_before_it_is_read(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(embedding, "MOST_POINTS", 4)
    assert len(graphml.decode(World, OSMNX).edges) == 3
    data = OSMNX.replace(b"-72.95 39.9,", b"-72.95 39.9, x, y, z,")
    assert "4 points in all polylines, and it has more" in refusal_of(data)


@given(data=st.data())
def test_any_change_to_a_file_gives_a_world_or_one_sentence(data: st.DataObject) -> None:
    parts = OSMNX.split(b"<")
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(1, len(parts) - 1))
        change = data.draw(st.sampled_from(["drop", "twice", "swap", "bytes"]))
        if change == "drop":
            del parts[at]
        elif change == "twice":
            parts.insert(at, parts[at])
        elif change == "swap":
            parts[at], parts[-1] = parts[-1], parts[at]
        else:
            parts[at] = parts[at][: data.draw(st.integers(0, 20))] + data.draw(
                st.binary(max_size=4)
            )
    world_or_sentence(lambda: graphml.decode(World, b"<".join(parts)))
