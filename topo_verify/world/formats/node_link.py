"""Node-link JSON: a world as NetworkX writes a graph to JSON, `nx-json` on the command line.

    {"directed": false, "multigraph": true,
     "graph": {"format": "topo-verify/graph", "version": 1, "marker": 0},
     "nodes": [{"rotation": [0], "id": 0}, {"rotation": [1], "id": 1}],
     "edges": [{"darts": [0, 1], "source": 0, "target": 1, "key": 0}]}

`links`, the former name of `edges`, is read as well. Other fields are ignored; repeated ones are
refused.
"""

from __future__ import annotations

from typing import Annotated, Any, TypeVar

import msgspec
from msgspec import UNSET, Meta, UnsetType

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import rotated, world_json
from topo_verify.world.formats.rotated import RotatedEdge, RotatedVertex
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)

_SAFE = 2**53
_FileDart = Annotated[int, Meta(ge=-_SAFE, le=_SAFE)]
_Id = int | str


class _Graph(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    format: str
    version: int
    marker: _FileDart | None = None
    name: str = ""
    source: str = ""
    licence: str = ""


class _Node(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    rotation: tuple[_FileDart, ...]
    name: str | None = None
    x: float | None = None
    y: float | None = None
    id: _Id


class _Edge(msgspec.Struct, frozen=True, kw_only=True):
    darts: tuple[_FileDart, _FileDart]
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
    graph: dict[str, Any]


def decode(cls: type[W], text: str | bytes, *, name: str = "node-link JSON", stem: str = "") -> W:
    """The world in the text."""
    data = _parse(text, name)
    number = {node.id: place for place, node in enumerate(data.nodes)}
    if len(number) < len(data.nodes):
        raise InputError(f"{name}: two nodes have one id: give each a distinct id")
    vertices = [
        RotatedVertex(
            str(node.id),
            node.rotation,
            node.name,
            rotated.point(node.x, node.y, f"{name}: node '{shown(str(node.id), limit=60)}'"),
        )
        for node in data.nodes
    ]
    edges = data.edges or data.links or ()
    for place, edge in enumerate(edges):
        for end in (edge.source, edge.target):
            if end not in number:
                raise InputError(
                    f"{name}: edge {place} has the end {shown(repr(end), limit=60)}, expected the"
                    " id of a node"
                )
    return rotated.as_world(
        cls,
        vertices,
        [RotatedEdge(number[edge.source], number[edge.target], edge.darts) for edge in edges],
        data.graph.marker,
        source=name,
        about={
            "name": data.graph.name or stem,
            "source": data.graph.source,
            "licence": data.graph.licence,
        },
    )


def _parse(text: str | bytes, name: str) -> _NodeLink:
    text = world_json.utf8_text(text, name)
    try:
        header = msgspec.json.decode(text, type=_Header).graph
        rotated.require_version(header.get("format"), header.get("version"), source=name)
        data = msgspec.json.decode(text, type=_NodeLink)
        world_json.require_single_keys(text, name)
    except msgspec.ValidationError as error:
        raise InputError(
            f"{name}: {shown(str(error))}; a world has a 'graph' with its 'marker', 'nodes' with"
            " 'id' and 'rotation', 'edges' with 'source', 'target' and 'darts'"
        ) from error
    except msgspec.DecodeError as error:
        raise InputError(
            f"{name} is not valid JSON: {error}; node-link JSON is one object"
        ) from error
    except RecursionError as error:
        raise InputError(
            f"{name}: expected a graph, got lists that are nested too deeply: leave them out"
        ) from error
    return data


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
