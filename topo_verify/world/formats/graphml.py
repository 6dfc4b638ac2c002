"""GraphML: worlds with their rotation, and drawings as OSMnx and NetworkX write them.

A graph whose data `format` is `topo-verify/graph` carries its rotation in data of the names that
rotated.py lists, darts as `0 5 3`. `encode` writes such graphs; they hold every world whole, except
texts with characters that XML cannot hold.

Any other graph is a **drawing**. The reader takes from each node its data `x` and `y` (y upwards;
degrees of longitude and latitude order the exits just as metres do); from each edge its data
`geometry`, a polyline in well-known text, if it has one, and whether it is directed. It ignores the
rest. embedding.py says how a drawing becomes a world, which two directed edges are one street, and
what is refused. The vertices come in the order of the nodes in the file and keep their ids as
names. A street network as OSMnx saves it (`save_graphml`) is directed, with both directions of a
street: each pair becomes one edge. A network in several parts is refused;
`osmnx.truncate.largest_component` keeps one.

Source: U. Brandes and others, "GraphML Progress Report", Graph Drawing 2001; http://graphml.graphdrawing.org.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from io import BytesIO
from os import PathLike
from typing import Any, NamedTuple, TypeVar, cast

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import embedding, files, markup, rotated
from topo_verify.world.formats.embedding import DrawnEdge, DrawnVertex, Point
from topo_verify.world.formats.rotated import RotatedEdge, RotatedVertex
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)

_WANTED = {
    "graph": ("format", "version", "marker", "name", "source", "licence"),
    "node": ("x", "y", "rotation", "name"),
    "edge": ("geometry", "darts"),
}
"""The names of the data that are read, of each kind of element."""


def load(cls: type[W], path: str | PathLike[str]) -> W:
    """The world in the file.

    Raises:
        InputError: as `decode`, or the file cannot be read.
    """
    return decode(cls, files.read(path), name=shown(path), stem=files.stem(path))


def decode(cls: type[W], data: bytes, *, name: str = "GraphML", stem: str = "") -> W:
    """The world in the bytes.

    Args:
        name: what to call the input in messages.
        stem: what to call the world, if the graph has no name for it.
    Raises:
        InputError: the bytes are not GraphML; a node has neither position nor rotation; the drawing
            or the rotation is refused.
    """
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


def _at(node: Mapping[str, str], what: str) -> Point:
    """The position of a node of a drawing."""
    missing = [axis for axis in ("x", "y") if axis not in node]
    if missing:
        raise InputError(
            f"{what} has no '{missing[0]}': the rotation comes from positions, so each"
            " node has its x and y as data"
        )
    x, y = (embedding.number(node[axis], f"{what}, {axis}") for axis in ("x", "y"))
    return x, y


def _rotated(cls: type[W], reader: _Reader, stem: str) -> W:
    """The world of a graph that carries its rotation."""
    name, graph = reader.name, reader.about
    rotated.require_version(graph["format"], graph.get("version"), source=name)
    vertices: list[RotatedVertex] = []
    for key, node in reader.nodes.items():
        what = reader.what("node", key)
        if "rotation" not in node:
            raise InputError(f"{what} has no 'rotation': give it its darts in clockwise order")
        darts = rotated.darts_in(node["rotation"], f"{what}, rotation")
        at = rotated.point(node.get("x"), node.get("y"), what)
        vertices.append(RotatedVertex(key, darts, node.get("name"), at))
    edges: list[RotatedEdge] = []
    for edge, start, end in reader.joined():
        what = reader.what("edge", edge.name)
        if edge.darts is None:
            raise InputError(f"{what} has no 'darts': give it the two darts of its ends")
        edges.append(RotatedEdge(start, end, rotated.darts_in(edge.darts, f"{what}, darts")))
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
    """An edge as it is read; `source` and `target` are ids of nodes that may follow."""

    source: str | None
    target: str | None
    id: str | None
    directed: bool
    course: tuple[Point, ...] = ()
    darts: str | None = None

    @property
    def name(self) -> str:
        """What the edge is called in messages."""
        return " ".join(text for text in self[:3] if text is not None)


class _Reader:
    """Collects the keys, nodes and edges of a document while it is read.

    `element` is the data of the graph, node or edge that is open, `attributes` the attributes of
    the node or edge.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self.is_graphml = False
        self.directed: bool | None = None  # None until the graph begins
        self.keys: dict[tuple[str, str], str] = {}  # the names of the data by kind and key
        self.defaults: dict[str, dict[str, str]] = {kind: {} for kind in _WANTED}
        self.about: dict[str, str] = {}  # the data of the graph
        self.nodes: dict[str, dict[str, str]] = {}
        self.edges: list[_Edge] = []
        self.points = 0  # in all geometries
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
        # The key of a <default> that may follow within this <key>.
        self.data_key = attributes.get("id", "")
        for kind, wanted in _WANTED.items():
            name = attributes.get("attr.name", "")
            if attributes.get("for", "all") in {kind, "all"} and name in wanted:
                self.keys[kind, self.data_key] = name

    def _data(self, kind: str, element: dict[str, str], text: str) -> None:
        name = self.keys.get((kind, self.data_key))
        if name is not None:
            if name in element:
                what = f"{self.name}: the graph" if kind == "graph" else self._open(kind)
                raise InputError(f"{what} has '{name}' twice: leave one of the two out")
            element[name] = text

    def _node(self) -> None:
        name = self.attributes.get("id")
        if name is None or name in self.nodes:
            why = "has no id" if name is None else "stands there twice"
            raise InputError(f"{self._open('node')} {why}: each node has an id of its own")
        self.nodes[name] = {**self.defaults["node"], **self.element}
        self._require_size(len(self.edges))

    def _edge(self) -> None:
        given, data = self.attributes, {**self.defaults["edge"], **self.element}
        text = data.get("geometry", "").strip()
        self.points += text.count(",")
        self._require_size(len(self.edges) + 1)
        own = given.get("directed")  # an edge may differ from its graph
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
        """What the open node or edge is called in messages."""
        given = (self.attributes.get(key) for key in ("source", "target", "id"))
        return self.what(kind, " ".join(text for text in given if text is not None))

    def what(self, kind: str, name: str) -> str:
        """What a node or an edge is called in messages."""
        return f"{self.name}: {kind} '{shown(name, limit=60)}'"

    def joined(self) -> Iterator[tuple[_Edge, int, int]]:
        """Each edge with the numbers of its nodes, once all are known."""
        number = {name: place for place, name in enumerate(self.nodes)}
        for edge in self.edges:
            start, end = (number.get(key or "") for key in edge[:2])
            if start is None or end is None:
                raise InputError(
                    f"{self.what('edge', edge.name)}: expected the ids of two nodes as source and"
                    " target"
                )
            yield edge, start, end


# ---------------------------------------------------------------- writing


_UNFIT = re.compile("[^\t\n\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""What no XML can hold; and the carriage return, which every reader makes a new line."""


def encode(world: World) -> str:
    """GraphML with the world's rotation: the same world gives the same text.

    Raises:
        InputError: a name, the source or the licence holds a character that XML cannot hold.
    """
    import networkx as nx

    from topo_verify.world.formats.nx import to_networkx

    for text in (world.name, world.source, world.licence, *world.vertex_names):
        if found := _UNFIT.search(text):
            raise InputError(
                f"GraphML cannot hold the character {found[0]!a} in {shown(repr(text), limit=60)}:"
                " rename it, or write world JSON or nx-json"
            )
    graph: Any = to_networkx(world)
    for _, attributes in graph.nodes(data=True):
        attributes["rotation"] = " ".join(map(str, attributes["rotation"]))
    for *_, attributes in graph.edges(data=True):
        attributes["darts"] = " ".join(map(str, attributes["darts"]))
    file = BytesIO()
    # Not `write_graphml`, which writes other bytes where lxml is installed.
    cast("Any", nx).write_graphml_xml(graph, file)
    return file.getvalue().decode().removesuffix("\n")
