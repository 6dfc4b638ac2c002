"""NetworkX: multigraphs with rotations, planar embeddings, graphs with positions.

**Multigraphs with rotations** hold every world whole (rotated.py), **planar embeddings** simple
planar worlds. **Graphs with positions**, such as street networks of OSMnx, are read as embedding.py
says.

In the last two the marker is the first dart of the first vertex, unless `marker=("a", "b")` names
its edge: it lies at a and points to b; in a multigraph a key may follow.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, cast

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import embedding, rotated
from topo_verify.world.formats.embedding import DrawnEdge, DrawnEnd, DrawnVertex, Point
from topo_verify.world.formats.planar_code import require_simple_and_planar
from topo_verify.world.formats.rotated import RotatedEdge, RotatedVertex
from topo_verify.world.rooted_map import World

if TYPE_CHECKING:
    import networkx as nx

MarkerEnds = tuple[Any, ...]
"""A node, the node that the marker points to, and perhaps the edge's key."""


def to_networkx(world: World) -> nx.MultiGraph[int]:
    """The world as a graph with `marker`, `rotation` of each node and `darts` of each edge."""
    import networkx as nx

    graph: nx.MultiGraph[int] = nx.MultiGraph()
    graph.graph.update(rotated.attributes(world))
    for vertex in range(len(world.vertices)):
        graph.add_node(vertex, **rotated.node_attributes(world, vertex))
    for number, (a, b) in enumerate(world.edges):
        graph.add_edge(world.vertex_of[a], world.vertex_of[b], key=number, darts=[a, b])
    return graph


def from_networkx(graph: nx.Graph[Any]) -> World:
    """The world of a graph with the attributes of `to_networkx`; nodes and keys may be renamed.

    Raises:
        InputError: attributes are missing or make no world.
    """
    given = cast("Any", graph)
    if "format" in given.graph:
        rotated.require_version(
            given.graph["format"], given.graph.get("version"), source="the graph"
        )
    nodes: dict[Any, int] = {node: number for number, node in enumerate(given)}
    vertices = [_rotated(given.nodes[node], node) for node in nodes]
    edges: list[RotatedEdge] = []
    for start, end, attributes in given.edges(data=True):
        if "darts" not in attributes:
            subject = f"the graph: edge {shown(repr((start, end)), limit=60)}"
            raise InputError(f"{subject} has no 'darts': give it the two darts of its ends")
        edges.append(RotatedEdge(nodes[start], nodes[end], attributes["darts"]))
    return rotated.as_world(
        World,
        vertices,
        edges,
        given.graph.get("marker"),
        source="the graph",
        about=rotated.texts_of(given.graph),
    )


def _rotated(attributes: Mapping[str, Any], node: Any) -> RotatedVertex:
    subject = f"the graph: node {shown(repr(node), limit=60)}"
    if "rotation" not in attributes:
        raise InputError(
            f"{subject} has no 'rotation', its darts in clockwise order: give it one, or read the"
            " graph with from_positions or from_planar_embedding"
        )
    name = attributes.get("name")
    at = rotated.point(attributes.get("x"), attributes.get("y"), subject)
    return RotatedVertex(str(node), attributes["rotation"], None if name is None else str(name), at)


def from_planar_embedding(
    embedding: nx.PlanarEmbedding[Any], *, marker: MarkerEnds | None = None, name: str = ""
) -> World:
    """The world with the embedding's rotations.

    Args:
        marker: (node, neighbour).
    Raises:
        InputError: the embedding is broken, empty or not connected, or has no such edge.
    """
    import networkx as nx

    source = "the planar embedding"
    given = cast("Any", embedding)
    try:
        given.check_structure()
        rows = {node: list(given.neighbors_cw_order(node)) for node in given}
    except (nx.NetworkXException, KeyError, TypeError) as error:
        raise InputError(f"{source} is broken: {shown(str(error))}") from error
    ends = [(node, other) for node, row in rows.items() for other in row]
    dart: dict[MarkerEnds, int] = {end: number for number, end in enumerate(ends)}
    if marker is not None and marker not in dart:
        raise InputError(f"{source} has no edge for marker={shown(repr(marker))}")
    try:
        return World.from_rotations(
            [[dart[node, other] for other in row] for node, row in rows.items()],
            [(number, dart[b, a]) for number, (a, b) in enumerate(ends) if number < dart[b, a]],
            dart[marker] if marker is not None else 0 if dart else None,
            name=name,
            vertex_names=tuple(map(str, rows)),
        )
    except InputError as error:
        raise InputError(f"{source}: {error}") from error


def to_planar_embedding(world: World) -> nx.PlanarEmbedding[int]:
    """The embedding whose nodes are the numbers of the vertices, the marker's first.

    Raises:
        InputError: the world is not simple and planar.
    """
    import networkx as nx

    require_simple_and_planar(world, "a planar embedding")
    first = world.marker_vertex
    order = [first, *(v for v in range(len(world.vertices)) if v != first)]
    rotations = list(world.vertices)
    if world.root is not None:
        turn = world.place_of[world.root]
        rotations[first] = rotations[first][turn:] + rotations[first][:turn]
    embedding: nx.PlanarEmbedding[int] = nx.PlanarEmbedding()
    embedding.add_nodes_from(order)
    embedding.set_data(
        {v: [world.vertex_of[world.alpha[dart]] for dart in rotations[v]] for v in order}
    )
    return embedding


def from_positions(
    graph: nx.Graph[Any],
    positions: Mapping[Any, Sequence[float]] | None = None,
    *,
    marker: MarkerEnds | None = None,
    name: str = "",
) -> World:
    """The world of a drawn graph, directed or not, multigraph or not.

    Args:
        graph: its edges may have a `geometry`: a list of (x, y), a text such as LINESTRING (0 0, 1
            2), or an object with `coords`; default: straight.
        positions: (x, y) of each node; default: the nodes' own attributes, `x` and `y` or `pos`.
        marker: (node, neighbour) or (node, neighbour, key).
    Raises:
        InputError: positions or geometry are malformed, two edges leave a node at one angle, the
            graph is empty or not connected, or the marker names no edge or several.
    """
    given = cast("Any", graph)
    nodes: dict[Any, int] = {node: number for number, node in enumerate(given)}
    places = [DrawnVertex(str(node), _at(given.nodes[node], node, positions)) for node in nodes]
    labels = list(given.edges(keys=True)) if given.is_multigraph() else list(given.edges())
    ways = [
        DrawnEdge(
            *(nodes[label[0]], nodes[label[1]]),
            course=_geometry(given, label),
            directed=given.is_directed(),
            name=repr(label),
        )
        for label in labels
    ]
    end = None if marker is None else _marked(marker, labels)
    return embedding.as_world(World, places, ways, source="the graph", name=name, marker=end)


def _at(attributes: Mapping[str, Any], node: Any, positions: Mapping[Any, Any] | None) -> Point:
    subject = f"the graph: the position of node {shown(repr(node), limit=60)}"
    position: Any = attributes.get("pos") if positions is None else positions.get(node)
    if position is None and positions is None and "x" in attributes and "y" in attributes:
        position = attributes["x"], attributes["y"]
    if position is None:
        raise InputError(
            f"{subject} is missing: the rotation comes from positions; give each node x and y,"
            " or pos, or hand a mapping to `positions`"
        )
    (point,) = embedding.points([_row(position, subject)], subject)
    return point


def _geometry(graph: Any, label: tuple[Any, ...]) -> Sequence[Point]:
    subject = f"the graph: the geometry of edge {shown(repr(label), limit=60)}"
    value = graph.edges[label].get("geometry")
    if value is None:
        return ()
    if isinstance(value, str):
        return embedding.line(value, subject)
    rows = _row(getattr(value, "coords", value), subject)
    return embedding.points([_row(row, subject) for row in rows], subject)


def _row(value: Any, subject: str) -> list[Any]:
    if isinstance(value, str | bytes | Mapping) or not isinstance(value, Iterable):
        text = shown(repr(cast("Any", value)), limit=60)
        raise InputError(f"{subject} is {text}, expected x and y in a row, or such rows")
    return list(cast("Any", value))


def _marked(marker: MarkerEnds, labels: Sequence[tuple[Any, ...]]) -> DrawnEnd:
    """The end of an edge that the marker names; of a loop, its start.

    Of two directions, the marker's own comes first.
    """
    near, key = marker[:2], marker[2:]
    for side, ends in ((0, near), (1, near[::-1])):
        fits = [n for n, label in enumerate(labels) if label[:2] == ends and key in ((), label[2:])]
        if len(fits) == 1:
            return DrawnEnd(fits[0], side)
        if fits:
            raise InputError(
                f"the graph has {len(fits)} edges for marker={shown(repr(marker))}: name its"
                " key, too, as in (node, neighbour, key)"
            )
    raise InputError(
        f"the graph has no edge for marker={shown(repr(marker))}: name one by its two ends"
        " and, in a multigraph, its key"
    )
