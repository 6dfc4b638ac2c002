"""Random graphs with random rotations and without positions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations, product
from random import Random

from topo_verify.errors import InputError
from topo_verify.world.families import _arguments as arguments
from topo_verify.world.families import _rotated_graph as graphs
from topo_verify.world.rooted_map import Dart, World


def regular(
    nodes: int, degree: int, *, holes: float = 0.0, seed: int = 0, marker: Dart | None = None
) -> World:
    """A random simple graph in which every node has the same degree; then holes, then rotations.

    Args:
        nodes: more than degree; nodes·degree is even.
        holes, seed, marker: as for `lattice`.
    Source: A. Steger and N. C. Wormald, "Generating random regular graphs quickly", Combin. Probab.
        Comput. 8 (1999): pair free ends at random, keep the pairs that fit. Nearly uniform.
    """
    family = "regular"
    degree = arguments.integer(family, "degree", degree, 1)
    nodes = arguments.integer(family, "nodes", nodes, degree + 1)
    holes = arguments.share(family, "holes", holes, whole=False)
    name, marker, random = arguments.settled(
        family, nodes, degree, darts=nodes * degree, marker=marker, seed=seed, holes=holes
    )
    if nodes * degree % 2:
        raise InputError(
            f"regular: {nodes} nodes of degree {degree} have an odd number of darts, and an edge is"
            " two: make one of the two numbers even"
        )
    # The order of the draws is a promise: edges, holes, rotations, marker.
    graph = _graph(nodes, _regular_edges(nodes, degree, random))
    return _rotated(name, graphs.with_holes(name, graph, holes, random), marker, random)


def dense(nodes: int, probability: float, *, seed: int = 0, marker: Dart | None = None) -> World:
    """A random graph, each pair of nodes joined with this probability; then rotations."""
    family = "dense"
    nodes = arguments.integer(family, "nodes", nodes, 1)
    probability = arguments.share(family, "probability", probability, whole=True)
    name, marker, random = arguments.settled(
        family, nodes, probability, darts=nodes * (nodes - 1), marker=marker, seed=seed
    )
    edges = [pair for pair in combinations(range(nodes), 2) if random.random() < probability]
    return _rotated(name, _graph(nodes, edges), marker, random)


def complete(nodes: int, *, seed: int = 0, marker: Dart | None = None) -> World:
    """Every two nodes joined; random rotations."""
    nodes = arguments.integer("complete", "nodes", nodes, 1)
    name, marker, random = arguments.settled(
        "complete", nodes, darts=nodes * (nodes - 1), marker=marker, seed=seed
    )
    return _rotated(name, _graph(nodes, combinations(range(nodes), 2)), marker, random)


def complete_bipartite(
    left: int, right: int, *, seed: int = 0, marker: Dart | None = None
) -> World:
    """Each of `left` nodes joined with each of `right` others; random rotations."""
    family = "complete_bipartite"
    left = arguments.integer(family, "left", left, 1)
    right = arguments.integer(family, "right", right, 1)
    name, marker, random = arguments.settled(
        family, left, right, darts=2 * left * right, marker=marker, seed=seed
    )
    edges = product(range(left), range(left, left + right))
    return _rotated(name, _graph(left + right, edges), marker, random)


def _regular_edges(nodes: int, degree: int, random: Random) -> Iterable[tuple[int, int]]:
    if 2 * degree >= nodes:  # few pairs fit in a nearly full graph
        missing = set(_regular_edges(nodes, nodes - 1 - degree, random))
        return [pair for pair in combinations(range(nodes), 2) if pair not in missing]
    while True:
        edges: dict[tuple[int, int], None] = {}
        ends = [node for node in range(nodes) for _ in range(degree)]
        while ends:
            random.shuffle(ends)
            unpaired: list[int] = []
            for a, b in zip(ends[::2], ends[1::2], strict=True):
                pair = (min(a, b), max(a, b))
                if a == b or pair in edges:
                    unpaired += pair
                else:
                    edges[pair] = None
            # `_some_fit` is slow
            if len(unpaired) == len(ends) and not _some_fit(unpaired, edges):
                break  # start again, as the paper does
            ends = unpaired
        if not ends:
            return edges


def _some_fit(ends: Sequence[int], edges: Mapping[tuple[int, int], None]) -> bool:
    return any(pair not in edges for pair in combinations(sorted(set(ends)), 2))


def _graph(nodes: int, edges: Iterable[tuple[int, int]]) -> graphs.Graph:
    graph: graphs.Graph = {node: [] for node in range(nodes)}
    for a, b in edges:
        graph[a].append(graphs.EdgeEnd(b, (a, b), 0))
        graph[b].append(graphs.EdgeEnd(a, (a, b), 1))
    return graph


def _rotated(name: str, graph: graphs.Graph, marker: Dart | None, random: Random) -> World:
    graph = graphs.largest_component(graph)
    for exits in graph.values():
        random.shuffle(exits)
    return graphs.as_world(name, graph, marker, random)
