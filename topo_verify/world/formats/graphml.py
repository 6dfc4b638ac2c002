"""GraphML with positions, as OSMnx and NetworkX write it.

The reader takes from each node its data `x` and `y` (y upwards; degrees of longitude and latitude
order the exits just as metres do); from each edge its data `geometry`, a polyline in well-known
text, if it has one, and whether it is directed. It ignores the rest. embedding.py says how a
drawing becomes a world, which two directed edges are one street, and what is refused.

The vertices come in the order of the nodes in the file and keep their ids as names. A street
network as OSMnx saves it (`save_graphml`) is directed, with both directions of a street: each pair
becomes one edge. A network in several parts is refused; `osmnx.truncate.largest_component` keeps
one.

Source: U. Brandes and others, "GraphML Progress Report", Graph Drawing 2001; http://graphml.graphdrawing.org.
"""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from typing import TypeVar

from topo_verify.errors import InputError
from topo_verify.text import shown
from topo_verify.world.formats import embedding, files, markup
from topo_verify.world.formats.embedding import DrawnEdge, DrawnVertex
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)

_WANTED = {"node": ("x", "y"), "edge": ("geometry",)}


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
        stem: what to call the world.
    Raises:
        InputError: the bytes are not GraphML, a node has no position, or the drawing is refused.
    """
    reader = _Reader(name)
    markup.read(data, name=name, start=reader.start, end=reader.end)
    if not reader.is_graphml:
        raise InputError(f"{name}: expected GraphML, whose first element is <graphml>")
    places = list(reader.places.values())
    ways = reader.ways()
    return embedding.as_world(cls, places, ways, source=name, name=stem)


class _Reader:
    """Collects the keys, nodes and edges of a document while it is read.

    `element` is the node or edge that is open, with its attributes and the data read in it.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self.is_graphml = False
        self.directed: bool | None = None  # None until the graph begins
        self.keys: dict[str, str] = {}  # the names of the data by their keys
        self.defaults: dict[str, str] = {}  # likewise, their defaults
        self.places: dict[str, DrawnVertex] = {}
        self.edges: list[tuple[dict[str, str], dict[str, str]]] = []
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
            case ("graphml", "graph", "node" | "edge", "data"):
                self.data_key = attributes.get("key", "")
            case (*_, "graph" | "hyperedge"):
                raise InputError(f"{self.name} has a <{path[-1]}> within its graph: leave it out")
            case _:
                pass

    def end(self, path: tuple[str, ...], text: str) -> None:
        match path:
            case ("graphml", "key", "default"):
                self.defaults[self.data_key] = text
            case ("graphml", "graph", "node" | "edge", "data"):
                self._data(text)
            case ("graphml", "graph", "node"):
                self._node()
            case ("graphml", "graph", "edge"):
                self.edges.append((self.attributes, self._complete("edge")))
            case _:
                pass

    def _key(self, attributes: Mapping[str, str]) -> None:
        # The key of a <default> that may follow within this <key>; empty if the key is not wanted.
        self.data_key = ""
        for kind in ("node", "edge"):
            name = attributes.get("attr.name", "")
            if attributes.get("for", "all") in {kind, "all"} and name in _WANTED[kind]:
                self.data_key = attributes.get("id", "")
                self.keys[self.data_key] = name

    def _data(self, text: str) -> None:
        name = self.keys.get(self.data_key)
        if name is not None:
            if name in self.element:
                raise InputError(f"{self._what()} has '{name}' twice: leave one of the two out")
            self.element[name] = text

    def _complete(self, kind: str) -> dict[str, str]:
        """The data of the open element, with the defaults of its keys."""
        given = {
            self.keys[key]: text
            for key, text in self.defaults.items()
            if self.keys.get(key) in _WANTED[kind]
        }
        return {**given, **self.element}

    def _node(self) -> None:
        name, data = self.attributes.get("id"), self._complete("node")
        if name is None or name in self.places:
            why = "has no id" if name is None else "stands there twice"
            raise InputError(f"{self._what()} {why}: each node has an id of its own")
        missing = [axis for axis in ("x", "y") if axis not in data]
        if missing:
            raise InputError(
                f"{self._what()} has no '{missing[0]}': the rotation comes from positions, so each"
                " node has its x and y as data"
            )
        at = [embedding.number(data[axis], f"{self._what()}, {axis}") for axis in ("x", "y")]
        self.places[name] = DrawnVertex(name, (at[0], at[1]))

    def _name(self) -> str:
        """What the open node or edge is called in messages."""
        given = (self.attributes.get(key) for key in ("source", "target", "id"))
        return " ".join(text for text in given if text is not None)

    def _what(self) -> str:
        kind = "edge" if "source" in self.attributes else "node"
        return f"{self.name}: {kind} '{shown(self._name(), limit=60)}'"

    def ways(self) -> list[DrawnEdge]:
        """The edges, once all nodes are known."""
        number = {name: place for place, name in enumerate(self.places)}
        ways: list[DrawnEdge] = []
        for attributes, data in self.edges:
            # `_what` names the element that is at hand, and an edge may stand before its nodes.
            self.attributes = attributes
            ends = [number.get(attributes.get(key, "")) for key in ("source", "target")]
            start, end = ends
            if start is None or end is None:
                raise InputError(
                    f"{self._what()}: expected the ids of two nodes as source and target"
                )
            text = data.get("geometry", "").strip()
            course = embedding.line(text, f"{self._what()}, geometry") if text else ()
            own = attributes.get("directed")  # an edge may differ from its graph
            directed = bool(self.directed) if own is None else own == "true"
            ways.append(DrawnEdge(start, end, course, directed, self._name()))
        return ways
