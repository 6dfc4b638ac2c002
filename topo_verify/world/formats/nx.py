"""NetworkX: multigraphs with rotations, planar embeddings, graphs with positions.

**Multigraphs with rotations** hold every world whole (rotated.py), **planar embeddings** simple
planar worlds. **Graphs with positions**, such as street networks of OSMnx, are read as embedding.py
says.

In the last two the marker is the first dart of the first vertex, unless `marker=("a", "b")` names
its edge: it lies at a and points to b; in a multigraph a key may follow.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, cast

from topo_verify.errors import InputError, shown
from topo_verify.world.formats import drawn_graph, rotated
from topo_verify.world.formats.embedding import DrawnEnd
from topo_verify.world.formats.flaws import Flaws
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
    _require_graph(graph)
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
    _require_embedding(embedding)
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


def _require_embedding(embedding: object) -> None:
    import networkx as nx

    if not isinstance(embedding, nx.PlanarEmbedding):
        raise InputError(
            "the planar embedding: expected a networkx.PlanarEmbedding, got"
            f" {shown(repr(embedding), limit=60)}; networkx.check_planarity(graph)"
            " returns whether the graph is planar, and its embedding, or None if it is not; a graph"
            " with positions is read by from_positions"
        )


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
            2), GeoJSON, or an object of shapely; or `bends`, the points between their ends in a
            row; default: straight.
        positions: (x, y) of each node; default: the nodes' own attributes, `pos`, `x` and `y`,
            a point as `geometry`, or `lon` and `lat`.
        marker: (node, neighbour) or (node, neighbour, key).
    Raises:
        InputError: positions or geometry are malformed, two edges leave a node at one angle, the
            graph is empty or not connected, or the marker names no edge or several.
    """
    _require_graph(graph)
    given = cast("Any", graph)
    labels = list(given.edges(keys=True)) if given.is_multigraph() else list(given.edges())
    edges = (
        drawn_graph.GraphEdge(
            label[0], label[1], given.edges[label], directed=given.is_directed(), label=label
        )
        for label in labels
    )
    nodes = given.nodes
    if positions is not None:
        if not isinstance(cast("object", positions), Mapping):
            raise InputError(
                "the graph: expected positions as a mapping from nodes to (x, y), got"
                f" {shown(repr(positions), limit=60)}; dict(zip(graph, rows)) makes one of rows"
            )
        nodes = {node: {"pos": positions.get(node)} for node in given}
    return drawn_graph.as_world(
        World,
        nodes,
        edges,
        Flaws("the graph"),
        name=name,
        marker=None if marker is None else _marked(marker, labels),
    )


def _require_graph(graph: object) -> None:
    import networkx as nx

    if not isinstance(graph, nx.Graph):
        raise InputError(
            f"the graph: expected a graph of NetworkX, got"
            f" {shown(repr(graph), limit=60)}; World.load reads a file"
        )


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
