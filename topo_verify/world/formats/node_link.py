"""Node-link JSON: a world as NetworkX writes a graph to JSON, `nx-json` on the command line.

    {"directed": false, "multigraph": true,
     "graph": {"format": "topo-verify/graph", "version": 1, "marker": 0},
     "nodes": [{"rotation": [0], "id": 0}, {"rotation": [1], "id": 1}],
     "edges": [{"darts": [0, 1], "source": 0, "target": 1, "key": 0}]}

`links`, the former name of `edges`, is read as well. Other fields are ignored; repeated ones are
refused. A graph without `format` is a **drawing** (drawn_graph.py). An id is any value but an
object; a list is a tuple of NetworkX.

Why not `networkx.node_link_graph`? It keeps the last of two nodes or edges with one id or key, adds
a node where an edge ends at an unknown one, numbers nodes without id, and takes no nested lists as
ids. Each of these would be another world in silence.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar, cast

import msgspec
from msgspec import UNSET, UnsetType

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import drawn_graph, rotated, world_json
from topo_verify.world.formats.drawn_graph import GraphEdge
from topo_verify.world.formats.flaws import Flaws
from topo_verify.world.formats.rotated import RotatedEdge, RotatedVertex
from topo_verify.world.rooted_map import World
from topo_verify.world.validation import Number

W = TypeVar("W", bound=World)

_Id = Any


class _Graph(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    format: str
    version: int
    marker: Number | None = None
    name: str = ""
    source: str = ""
    licence: str = ""


class _Node(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    rotation: tuple[Number, ...]
    name: str | None = None
    x: float | None = None
    y: float | None = None
    id: _Id


class _Edge(msgspec.Struct, frozen=True, kw_only=True):
    darts: tuple[Number, Number]
    source: _Id
    target: _Id


class _KeyedEdge(_Edge, frozen=True, kw_only=True):
    key: int


class _NodeLink(msgspec.Struct, frozen=True, kw_only=True):
    directed: bool = False
    multigraph: bool = True
    graph: _Graph
    nodes: tuple[_Node, ...]
    edges: tuple[_Edge, ...] | UnsetType = UNSET
    links: tuple[_Edge, ...] | UnsetType = UNSET


class _Header(msgspec.Struct):
    graph: dict[str, Any] = {}


class _Drawing(msgspec.Struct, frozen=True, kw_only=True):
    directed: bool = False
    nodes: tuple[dict[str, Any], ...]
    edges: tuple[dict[str, Any], ...] | UnsetType = UNSET
    links: tuple[dict[str, Any], ...] | UnsetType = UNSET


def decode(
    cls: type[W],
    text: str | bytes,
    *,
    name: str = "node-link JSON",
    stem: str = "",
    largest_part: bool = False,
) -> W:
    """The world in the text; `largest_part` as for `embedding.as_world`."""
    text = world_json.utf8_text(text, name)
    try:
        graph = msgspec.json.decode(text, type=_Header).graph
        if "format" in graph:
            rotated.require_version(graph["format"], graph.get("version"), source=name)
            data = msgspec.json.decode(text, type=_NodeLink)
            world_json.require_single_keys(text, name)
            return _rotated(cls, data, name, stem)
        drawing = msgspec.json.decode(text, type=_Drawing)
        world_json.require_single_keys(text, name)
        return _drawn(cls, drawing, name, stem, largest_part=largest_part)
    except msgspec.ValidationError as error:
        raise InputError(
            f"{name}: {shown(str(error))}; a world has a 'graph' with its 'marker', 'nodes' with"
            " 'id' and 'rotation', 'edges' with 'source', 'target' and 'darts'; a drawing 'nodes'"
            " with 'id', 'x' and 'y', and 'edges' with 'source' and 'target'"
        ) from error
    except msgspec.DecodeError as error:
        raise InputError(
            f"{name} is not valid JSON: {error}; node-link JSON is one object"
        ) from error
    except RecursionError as error:
        raise InputError(
            f"{name}: expected a graph, got lists that are nested too deeply: leave them out"
        ) from error


def _drawn(cls: type[W], data: _Drawing, name: str, stem: str, *, largest_part: bool) -> W:
    flaws = Flaws(name)
    rotated.require_no_rotation(data.nodes, source=name)
    nodes: dict[Any, dict[str, Any]] = {}
    for place, node in enumerate(data.nodes):
        with flaws:
            key = _key(node, "id", f"{name}: node {place}")
            if key in nodes:
                raise InputError(
                    f"{name}: node {shown(repr(key), limit=60)} stands there twice: each node needs"
                    " a distinct id"
                )
            nodes[key] = node
    edges: list[GraphEdge] = []
    for place, edge in enumerate(_edges(data, name)):
        with flaws:
            subject = f"{name}: edge {place}"
            start, end = (_key(edge, side, subject) for side in ("source", "target"))
            label = (start, end, *([edge["key"]] if "key" in edge else []))
            edges.append(GraphEdge(start, end, edge, data.directed, label))
    return drawn_graph.as_world(cls, nodes, edges, flaws, name=stem, largest_part=largest_part)


def _edges(data: _Drawing | _NodeLink, name: str) -> tuple[Any, ...]:
    given = [rows for rows in (data.edges, data.links) if not isinstance(rows, UnsetType)]
    if len(given) != 1:
        raise InputError(
            f"{name}: expected its edges as 'edges', or 'links', got"
            f" {'both' if given else 'neither'}: give one of the two"
        )
    return given[0]


def _key(fields: Mapping[str, Any], field: str, subject: str) -> Any:
    if field not in fields:
        raise InputError(f"{subject} has no {field!r}: give it the id of a node")
    return _hashable(fields[field], f"{subject}, {field}")


def _hashable(value: Any, subject: str) -> Any:
    """The id, a list of it as a tuple."""
    if isinstance(value, list):
        return tuple(_hashable(part, subject) for part in cast("Any", value))
    if isinstance(value, dict):
        raise InputError(
            f"{subject} is an object, expected an id: a number, a text, true, false, null, or a"
            " list of these"
        )
    return value


def _rotated(cls: type[W], data: _NodeLink, name: str, stem: str) -> W:
    number: dict[Any, int] = {}
    vertices: list[RotatedVertex] = []
    for place, node in enumerate(data.nodes):
        key = _hashable(node.id, f"{name}: node {place}, id")
        number.setdefault(key, place)
        subject = f"{name}: node '{shown(str(key), limit=60)}'"
        at = rotated.point(node.x, node.y, subject)
        vertices.append(RotatedVertex(str(key), node.rotation, node.name, at))
    if len(number) < len(data.nodes):
        raise InputError(f"{name}: two nodes have one id: give each a distinct id")
    edges: list[RotatedEdge] = []
    for place, edge in enumerate(_edges(data, name)):
        ends = [_hashable(end, f"{name}: edge {place}") for end in (edge.source, edge.target)]
        for end in ends:
            if end not in number:
                raise InputError(
                    f"{name}: edge {place} has the end {shown(repr(end), limit=60)}, expected the"
                    " id of a node"
                )
        edges.append(RotatedEdge(number[ends[0]], number[ends[1]], edge.darts))
    return rotated.as_world(
        cls,
        vertices,
        edges,
        data.graph.marker,
        source=name,
        about={
            "name": data.graph.name or stem,
            "source": data.graph.source,
            "licence": data.graph.licence,
        },
    )


def encode(world: World) -> str:
    """Node-link JSON on one line."""
    data = _NodeLink(
        graph=_Graph(**rotated.attributes(world)),
        nodes=tuple(
            _Node(**rotated.node_attributes(world, vertex), id=vertex)
            for vertex in range(len(world.vertices))
        ),
        edges=tuple(
            _KeyedEdge(
                darts=(a, b), source=world.vertex_of[a], target=world.vertex_of[b], key=number
            )
            for number, (a, b) in enumerate(world.edges)
        ),
    )
    return world_json.encoded(data)
