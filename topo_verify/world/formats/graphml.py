"""GraphML: worlds with their rotation, and drawings as OSMnx and NetworkX write them.

A graph whose data `format` is `topo-verify/graph` carries its rotation (rotated.py). Any other
graph is a **drawing** (drawn_graph.py): nodes with `x` and `y`, edges perhaps with a `geometry`.

Why not `networkx.read_graphml`? It expands entities, and builds the whole tree before it can refuse
anything. It keeps the last of two nodes, data or edges with one id, adds a node where an edge ends
at an unknown one, ignores nested graphs, and cannot read an undirected edge in a directed graph.
Each of these would be another world in silence.

Source: docs/formats.md; U. Brandes and others, "GraphML Progress Report", Graph Drawing 2001.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from io import BytesIO
from typing import Any, NamedTuple, TypeVar, cast

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import drawn_graph, embedding, markup, rotated
from topo_verify.world.formats.flaws import Flaws
from topo_verify.world.formats.rotated import RotatedEdge, RotatedVertex
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)

_WANTED = {
    "graph": {"format", "version", "marker", "name", "source", "licence"},
    "node": {"rotation", "name", *drawn_graph.PLACES, *drawn_graph.NOT_READ},
    "edge": {"darts"},
}
"""The data that is kept; of an edge whatever holds points, too."""


def decode(
    cls: type[W],
    data: bytes,
    *,
    name: str = "GraphML",
    stem: str = "",
    largest_part: bool = False,
) -> W:
    """The world in the bytes; `largest_part` as for `embedding.as_world`."""
    reader = _Reader(name)
    markup.read(data, name=name, start=reader.start, end=reader.end)
    if not reader.is_graphml:
        raise InputError(
            f"{name}: expected GraphML, whose first element is <graphml>: name a file of that kind"
        )
    if "format" in reader.about:
        reader.flaws.refuse()
        return _rotated(cls, reader, stem)
    rotated.require_no_rotation(reader.nodes.values(), source=name)
    edges = (
        drawn_graph.GraphEdge(edge.source, edge.target, edge.data, edge.directed, edge.name)
        for edge in reader.edges
    )
    return drawn_graph.as_world(
        cls,
        reader.nodes,
        edges,
        reader.flaws,
        name=stem,
        largest_part=largest_part,
    )


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
        if "darts" not in edge.data:
            raise InputError(f"{subject} has no 'darts': give it the two darts of its ends")
        darts = rotated.darts_in(edge.data["darts"], f"{subject}, darts")
        edges.append(RotatedEdge(start, end, darts))
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
    data: Mapping[str, str]

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
        self.flaws = Flaws(name)
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
            case ("graphml", "graph", "node" | "edge", "data", *_, inner):
                self._inner(inner, attributes)
            case _:
                pass

    def end(self, path: tuple[str, ...], text: str) -> None:
        match path:
            case ("graphml", "key", "default"):
                for kind in _WANTED:
                    if (name := self.keys.get((kind, self.data_key))) is not None and (
                        self._is_wanted(kind, name, text)
                    ):
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
        for kind in _WANTED:
            if attributes.get("for", "all") in {kind, "all"}:
                self.keys[kind, self.data_key] = attributes.get("attr.name", "")

    def _is_wanted(self, kind: str, name: str, text: str) -> bool:
        return name in _WANTED[kind] or (kind == "edge" and drawn_graph.is_drawn(name, text))

    def _data(self, kind: str, element: dict[str, str], text: str) -> None:
        name = self.keys.get((kind, self.data_key)) or f"data {self.data_key}"
        if not self._is_wanted(kind, name, text):
            return
        with self.flaws:
            if name in element:
                subject = f"{self.name}: the graph" if kind == "graph" else self._open(kind)
                raise InputError(f"{subject} has '{name}' twice: leave one of the two out")
            element[name] = text

    def _inner(self, inner: str, attributes: Mapping[str, str]) -> None:
        """An element within the data, as yEd writes them; the place of a label draws nothing."""
        has_place = {"x", "y"} <= {key.lower() for key in attributes} or "Location" in attributes
        is_shifted = any(attributes.get(key, "").strip("-0.") for key in ("sx", "sy", "tx", "ty"))
        if is_shifted or (has_place and not inner.endswith("Label")):
            self.element[drawn_graph.ELEMENT.format(inner)] = "x y"

    def _node(self) -> None:
        with self.flaws:
            name = self.attributes.get("id")
            if name is None or name in self.nodes:
                why = "has no id" if name is None else "stands there twice"
                raise InputError(f"{self._open('node')} {why}: each node needs a distinct id")
            self.nodes[name] = {**self.defaults["node"], **self.element}
        self._require_size(len(self.edges))

    def _edge(self) -> None:
        given, data = self.attributes, {**self.defaults["edge"], **self.element}
        for name in given.keys() - {"id", "source", "target", "directed"}:
            if drawn_graph.is_drawn(name, given[name]):
                data[drawn_graph.ELEMENT.format(f"edge {name}")] = given[name]
        self.points += data.get("geometry", "").count(",") + len(data.get("bends", "").split()) // 2
        self._require_size(len(self.edges) + 1)
        own = given.get("directed")
        self.edges.append(
            _Edge(
                given.get("source"),
                given.get("target"),
                given.get("id"),
                bool(self.directed) if own is None else own == "true",
                data,
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
