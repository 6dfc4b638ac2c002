"""Graphs that carry a rotation: NetworkX, GraphML and node-link JSON, there and back."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from inspect import signature
from typing import Any

import networkx as nx
import pytest

from tests.world.formats.worlds import HOSTILE, every_kind, is_same, named
from topo_verify.errors import InputError
from topo_verify.world import World
from topo_verify.world.formats import graphml, node_link, rotated
from topo_verify.world.formats.nx import from_networkx, to_networkx

NX: Any = nx
"""NetworkX where its stubs leave types open."""

WAYS: dict[str, Callable[[World], World]] = {
    "networkx": lambda world: from_networkx(to_networkx(world)),
    "graphml": lambda world: graphml.decode(World, graphml.encode(world).encode()),
    "nx-json": lambda world: node_link.decode(World, node_link.encode(world)),
}


@pytest.mark.parametrize("way", WAYS)
def test_every_world_comes_back_with_all_that_it_carries(way: str) -> None:
    for world in every_kind():
        assert is_same(WAYS[way](world), world), world.to_json()


@pytest.mark.parametrize("encode", [graphml.encode, node_link.encode])
def test_the_same_world_gives_the_same_text_on_lines_that_do_not_end_in_an_empty_one(
    encode: Callable[[World], str],
) -> None:
    for world in (named(), World.from_id("m4/41")):
        text = encode(world)
        assert text == encode(World.from_json(world.to_json()))
        assert not text.endswith("\n")


# ---------------------------------------------------------------- beside NetworkX's own


def edges_called(name: str) -> dict[str, str]:
    """The argument by which NetworkX names the list of edges: `link` before 3.4."""
    given = signature(NX.node_link_graph).parameters
    return {"edges" if "edges" in given else "link": name}


def test_networkx_reads_our_json_and_we_read_its_own() -> None:
    for world in every_kind():
        graph = NX.node_link_graph(json.loads(node_link.encode(world)), **edges_called("edges"))
        assert is_same(from_networkx(graph), world)
        assert NX.utils.graphs_equal(graph, to_networkx(world))
        for name in ("edges", "links"):  # the second is what networkx < 3.6 writes
            text = json.dumps(NX.node_link_data(to_networkx(world), **edges_called(name)))
            assert is_same(node_link.decode(World, text), world)


def test_networkx_reads_our_graphml_with_each_rotation_as_a_text() -> None:
    world = named()
    graph = NX.parse_graphml(graphml.encode(world), node_type=int, force_multigraph=True)
    assert graph.graph["marker"] == 3
    rotations = [tuple(map(int, graph.nodes[v]["rotation"].split())) for v in range(len(HOSTILE))]
    assert tuple(rotations) == world.vertices
    darts = {tuple(map(int, data["darts"].split())) for *_, data in graph.edges(data=True)}
    assert darts == set(world.edges)


def test_a_networkx_graph_may_have_its_nodes_renamed_and_its_edges_turned() -> None:
    world = World.from_id("m4/41")
    graph = NX.relabel_nodes(to_networkx(world), {0: "zero", 1: (1, 1), 2: 2.5})
    graph.nodes["zero"]["colour"] = "red"
    assert from_networkx(graph) == world
    for *_, data in graph.edges(data=True):
        data["darts"] = data["darts"][::-1]
    assert from_networkx(graph) == world


def test_a_simple_world_may_be_a_plain_graph_without_format() -> None:
    graph: nx.Graph[str] = nx.Graph(marker=7)
    graph.add_node("a", rotation=(7,))
    graph.add_node("b", rotation=[9])
    graph.add_edge("a", "b", darts={7, 9})
    assert from_networkx(graph).id == "m1/0"


# ---------------------------------------------------------------- what is refused


def edge() -> dict[str, Any]:
    """The world of one edge, as node-link data."""
    return json.loads(node_link.encode(World.from_id("m1/0")))  # type: ignore[no-any-return]


def as_graphml(data: dict[str, Any]) -> str:
    """The same graph as GraphML, with whatever attributes it has got."""
    kinds: dict[str, dict[str, Any]] = {"graph": data["graph"], "node": {}, "edge": {}}
    for kind in ("node", "edge"):
        kinds[kind] = {key: 0 for row in data[f"{kind}s"] for key in row}
    keys = [(kind, name) for kind, names in kinds.items() for name in names]

    def item(kind: str, row: dict[str, Any]) -> str:
        texts = ((name, value) for name, value in row.items() if value is not None)
        return "".join(
            # A list of darts, [0, 5], becomes the text 0 5.
            f'<data key="{keys.index((kind, name))}">{re.sub("[][,]", "", str(value))}</data>'
            for name, value in texts
        )

    nodes = (f'<node id="{row.get("id")}">{item("node", row)}</node>' for row in data["nodes"])
    edges = (
        f'<edge source="{row["source"]}" target="{row["target"]}">{item("edge", row)}</edge>'
        for row in data["edges"]
    )
    declared = (
        f'<key id="{number}" for="{kind}" attr.name="{name}"/>'
        for number, (kind, name) in enumerate(keys)
    )
    return (
        f"<graphml>{''.join(declared)}<graph>{item('graph', data['graph'])}{''.join(nodes)}"
        f"{''.join(edges)}</graph></graphml>"
    )


WRONG: list[tuple[str, Any, Any, str]] = [
    # where, and what stands there, in place of what
    ("nodes", 1, {"id": 1}, "rotation"),
    ("nodes", 1, {"id": 1, "rotation": []}, r"vertices\[1\] has no dart"),
    ("nodes", 1, {"id": 1, "rotation": [0]}, "dart 0 stands at two places"),
    ("nodes", 1, {"id": 1, "rotation": [2]}, "names dart 1, which no vertex has"),
    ("nodes", 1, {"id": 1, "rotation": [1], "x": 1.0}, "node '?1'? has one of x and y: give it"),
    ("nodes", 1, {"id": 1, "rotation": [1], "x": 1.0, "y": 2.0}, "1 of 2 nodes have x and y"),
    ("nodes", 1, {"id": 1, "rotation": [1], "name": "b"}, "1 of 2 nodes have name: give it to eac"),
    ("edges", 0, {"source": 0, "target": 1}, "darts"),
    ("edges", 0, {"source": 0, "target": 1, "darts": [0, 0]}, "dart 0 stands in edges"),
    (
        "edges", 0, {"source": 0, "target": 0, "darts": [0, 1]},
        "darts 0 and 1 joins the nodes '0' and '0', but by their 'rotation' .* at '0' and '1'",
    ),
    ("graph", "marker", 5, "the marker points at dart 5, which no vertex has"),
    ("graph", "marker", None, "marker None with 2 darts"),
    ("graph", "format", "topo-verify/world", "the graph's 'format' 'topo-verify/graph', g"),
    ("graph", "version", 2, "'version' 1 of topo-verify/graph, got '2': if it is newer, update"),
]  # fmt: skip


READERS: dict[str, Callable[[dict[str, Any]], World]] = {
    "networkx": lambda data: from_networkx(NX.node_link_graph(data, **edges_called("edges"))),
    "graphml": lambda data: graphml.decode(World, as_graphml(data).encode()),
    "nx-json": lambda data: node_link.decode(World, json.dumps(data)),
}


@pytest.mark.parametrize(("where", "place", "value", "sentence"), WRONG)
@pytest.mark.parametrize("way", READERS)
def test_what_is_no_world_is_refused_with_its_place(
    where: str, place: Any, value: Any, sentence: str, way: str
) -> None:
    data = edge()
    data[where][place] = value
    with pytest.raises(InputError, match=sentence) as refusal:
        READERS[way](data)
    assert str(refusal.value).isprintable()


@pytest.mark.parametrize("way", READERS)
def test_what_these_tests_make_wrong_is_read_if_nothing_is_wrong(way: str) -> None:
    assert READERS[way](edge()) == World.from_id("m1/0")


@pytest.mark.parametrize("text", ["0 x", "0,1", "1.5", "٣", "1" * 19, "--1"])
def test_darts_in_a_text_are_integers_with_spaces_between_them(text: str) -> None:
    with pytest.raises(InputError, match=r"here has '.*', expected darts as in '0 5 3'"):
        rotated.darts_in(text, "here")
    assert rotated.darts_in(" 0\n5  -3 ", "here") == [0, 5, -3]


@pytest.mark.parametrize("value", ["north", float("nan"), float("inf"), None, [1]])
def test_a_coordinate_is_a_finite_number(value: object) -> None:
    graph: Any = to_networkx(named())
    graph.nodes[2]["y"] = value
    with pytest.raises(InputError, match=r"node 2(, y is .*, expected a number| has one of x and)"):
        from_networkx(graph)


def test_a_graphml_marker_is_one_dart() -> None:
    data = as_graphml({**edge(), "graph": {**edge()["graph"], "marker": [0, 1]}})
    with pytest.raises(InputError, match="the marker has 2 darts: give it one"):
        graphml.decode(World, data.encode())


@pytest.mark.parametrize("character", ["\x00", "\x1b", "\r", "\ufffe", "\ud800"])
def test_what_xml_cannot_hold_is_said(character: str) -> None:
    world = named((*HOSTILE[:-1], f"a{character}b"))
    with pytest.raises(InputError, match="GraphML cannot hold the character") as refusal:
        graphml.encode(world)
    assert str(refusal.value).isprintable()
    if character != "\ud800":
        assert is_same(node_link.decode(World, node_link.encode(world)), world)


def test_half_a_character_is_refused_in_node_link_json() -> None:
    with pytest.raises(InputError, match="expected Unicode in the world's name"):
        node_link.encode(named((*HOSTILE[:-1], "\ud800")))
