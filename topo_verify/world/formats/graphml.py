"""GraphML: worlds with their rotation, and drawings as OSMnx and NetworkX write them.

A graph whose data `format` is `topo-verify/graph` carries its rotation (rotated.py). Any other
graph is a **drawing** (embedding.py): nodes with `x` and `y`, edges perhaps with a `geometry`.

Source: docs/formats.md; U. Brandes and others, "GraphML Progress Report", Graph Drawing 2001.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from io import BytesIO
from typing import Any, NamedTuple, TypeVar, cast

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import embedding, markup, rotated
from topo_verify.world.formats.embedding import DrawnEdge, DrawnVertex, Point
from topo_verify.world.formats.rotated import RotatedEdge, RotatedVertex
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)

_WANTED = {
    "graph": ("format", "version", "marker", "name", "source", "licence"),
    "node": ("x", "y", "rotation", "name"),
    "edge": ("geometry", "darts"),
}


def decode(cls: type[W], data: bytes, *, name: str = "GraphML", stem: str = "") -> W:
    """The world in the bytes."""
    reader = _Reader(name)
    markup.read(data, name=name, start=reader.start, end=reader.end)
    if not reader.is_graphml:
        raise InputError(
            f"{name}: expected GraphML, whose first element is <graphml>: name a file of that kind"
        )
    if "format" in reader.about:
        return _rotated(cls, reader, stem)
    places = [
        DrawnVertex(key, _at(node, reader.what("node", key))) for key, node in reader.nodes.items()
    ]
    ways = [
        DrawnEdge(start, end, edge.course, edge.directed, edge.name)
        for edge, start, end in reader.joined()
    ]
    return embedding.as_world(cls, places, ways, source=name, name=stem)


def _at(node: Mapping[str, str], subject: str) -> Point:
    missing = [axis for axis in ("x", "y") if axis not in node]
    if missing:
        raise InputError(
            f"{subject} has no '{missing[0]}': the rotation comes from positions, so each"
            " node has its x and y as data"
        )
    x, y = (embedding.number(node[axis], f"{subject}, {axis}") for axis in ("x", "y"))
    return x, y


def _rotated(cls: type[W], reader: _Reader, stem: str) -> W:
    name, graph = reader.name, reader.about
    rotated.require_version(graph["format"], graph.get("version"), source=name)
    vertices: list[RotatedVertex] = []
    for key, node in reader.nodes.items():
        subject = reader.what("node", key)
        if "rotation" not in node:
            raise InputError(f"{subject} has no 'rotation': give it its darts in clockwise order")
        darts = rotated.darts_in(node["rotation"], f"{subject}, rotation")
        at = rotated.point(node.get("x"), node.get("y"), subject)
        vertices.append(RotatedVertex(key, darts, node.get("name"), at))
    edges: list[RotatedEdge] = []
    for edge, start, end in reader.joined():
        subject = reader.what("edge", edge.name)
        if edge.darts is None:
            raise InputError(f"{subject} has no 'darts': give it the two darts of its ends")
        edges.append(RotatedEdge(start, end, rotated.darts_in(edge.darts, f"{subject}, darts")))
    marker = rotated.darts_in(graph.get("marker", ""), f"{name}: the marker")
    if len(marker) > 1:
        raise InputError(f"{name}: the marker has {len(marker)} darts: give it one")
    return rotated.as_world(
        cls,
        vertices,
        edges,
        marker[0] if marker else None,
        source=name,
        about={"name": stem, **rotated.texts_of(graph)},
    )


class _Edge(NamedTuple):
    """An edge as read; `source` and `target` are ids of nodes that may follow."""

    source: str | None
    target: str | None
    id: str | None
    directed: bool
    course: tuple[Point, ...] = ()
    darts: str | None = None

    @property
    def name(self) -> str:
        return " ".join(text for text in self[:3] if text is not None)


class _Reader:
    """Collects nodes and edges; `element` is the data of the open graph, node or edge."""

    def __init__(self, name: str) -> None:
        self.name = name
        self.is_graphml = False
        self.directed: bool | None = None
        self.keys: dict[tuple[str, str], str] = {}
        self.defaults: dict[str, dict[str, str]] = {kind: {} for kind in _WANTED}
        self.about: dict[str, str] = {}
        self.nodes: dict[str, dict[str, str]] = {}
        self.edges: list[_Edge] = []
        self.points = 0
        self.attributes: dict[str, str] = {}
        self.element: dict[str, str] = {}
        self.data_key = ""

    def start(self, path: tuple[str, ...], attributes: dict[str, str]) -> None:
        match path:
            case ("graphml",):
                self.is_graphml = True
            case ("graphml", "key"):
                self._key(attributes)
            case ("graphml", "graph"):
                if self.directed is not None:
                    raise InputError(f"{self.name} holds several graphs: give each a file")
                self.directed = attributes.get("edgedefault") == "directed"
            case ("graphml", "graph", "node" | "edge"):
                self.attributes, self.element = attributes, {}
            case ("graphml", "graph", "data") | ("graphml", "graph", "node" | "edge", "data"):
                self.data_key = attributes.get("key", "")
            case (*_, "graph" | "hyperedge"):
                raise InputError(f"{self.name} has a <{path[-1]}> within its graph: leave it out")
            case _:
                pass

    def end(self, path: tuple[str, ...], text: str) -> None:
        match path:
            case ("graphml", "key", "default"):
                for kind in _WANTED:
                    if (name := self.keys.get((kind, self.data_key))) is not None:
                        self.defaults[kind][name] = text
            case ("graphml", "graph", "data"):
                self._data("graph", self.about, text)
            case ("graphml", "graph", "node" | "edge" as kind, "data"):
                self._data(kind, self.element, text)
            case ("graphml", "graph", "node"):
                self._node()
            case ("graphml", "graph", "edge"):
                self._edge()
            case _:
                pass

    def _key(self, attributes: Mapping[str, str]) -> None:
        self.data_key = attributes.get("id", "")
        for kind, wanted in _WANTED.items():
            name = attributes.get("attr.name", "")
            if attributes.get("for", "all") in {kind, "all"} and name in wanted:
                self.keys[kind, self.data_key] = name

    def _data(self, kind: str, element: dict[str, str], text: str) -> None:
        name = self.keys.get((kind, self.data_key))
        if name is not None:
            if name in element:
                subject = f"{self.name}: the graph" if kind == "graph" else self._open(kind)
                raise InputError(f"{subject} has '{name}' twice: leave one of the two out")
            element[name] = text

    def _node(self) -> None:
        name = self.attributes.get("id")
        if name is None or name in self.nodes:
            why = "has no id" if name is None else "stands there twice"
            raise InputError(f"{self._open('node')} {why}: each node needs a distinct id")
        self.nodes[name] = {**self.defaults["node"], **self.element}
        self._require_size(len(self.edges))

    def _edge(self) -> None:
        given, data = self.attributes, {**self.defaults["edge"], **self.element}
        text = data.get("geometry", "").strip()
        self.points += text.count(",")
        self._require_size(len(self.edges) + 1)
        own = given.get("directed")
        self.edges.append(
            _Edge(
                given.get("source"),
                given.get("target"),
                given.get("id"),
                bool(self.directed) if own is None else own == "true",
                embedding.line(text, f"{self._open('edge')}, geometry") if text else (),
                data.get("darts"),
            )
        )

    def _require_size(self, edges: int) -> None:
        embedding.require_size(self.name, vertices=len(self.nodes), edges=edges, points=self.points)

    def _open(self, kind: str) -> str:
        given = (self.attributes.get(key) for key in ("source", "target", "id"))
        return self.what(kind, " ".join(text for text in given if text is not None))

    def what(self, kind: str, name: str) -> str:
        """The name of a node or an edge in messages."""
        return f"{self.name}: {kind} '{shown(name, limit=60)}'"

    def joined(self) -> Iterator[tuple[_Edge, int, int]]:
        number = {name: place for place, name in enumerate(self.nodes)}
        for edge in self.edges:
            start, end = (number.get(key or "") for key in edge[:2])
            if start is None or end is None:
                raise InputError(
                    f"{self.what('edge', edge.name)}: expected the ids of two nodes as source and"
                    " target"
                )
            yield edge, start, end


_UNFIT = re.compile("[^\t\n\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""What XML cannot hold; readers change the carriage return."""


def encode(world: World) -> str:
    """GraphML with the world's rotation; refuses characters that XML cannot hold."""
    import networkx as nx

    from topo_verify.world.formats.nx import to_networkx

    for text in (world.name, world.source, world.licence, *world.vertex_names):
        if match := _UNFIT.search(text):
            raise InputError(
                f"GraphML cannot hold the character {match[0]!a} in {shown(repr(text), limit=60)}:"
                " rename it, or write world JSON or nx-json"
            )
    graph: Any = to_networkx(world)
    for _, attributes in graph.nodes(data=True):
        attributes["rotation"] = " ".join(map(str, attributes["rotation"]))
    for *_, attributes in graph.edges(data=True):
        attributes["darts"] = " ".join(map(str, attributes["darts"]))
    file = BytesIO()
    # `write_graphml` depends on lxml
    cast("Any", nx).write_graphml_xml(graph, file)
    return file.getvalue().decode().removesuffix("\n")
