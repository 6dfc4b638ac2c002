"""Graphs whose exits are in clockwise order, and their worlds."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from random import Random
from typing import NamedTuple

from topo_verify.errors import InputError
from topo_verify.world.rooted_map import Dart, World


class EdgeEnd(NamedTuple):
    """One end of an edge, as seen from its node."""

    to: int
    edge: tuple[int, int]
    side: int


Graph = dict[int, list[EdgeEnd]]
"""The exits of each node in clockwise order; nodes ascending."""


def from_neighbours(rows: Iterable[Sequence[int]]) -> Graph:
    """The simple graph with these neighbours of each node, clockwise."""
    return {
        node: [EdgeEnd(to, (min(node, to), max(node, to)), int(node > to)) for to in row]
        for node, row in enumerate(rows)
    }


def with_holes(name: str, graph: Graph, holes: float, random: Random) -> Graph:
    """The largest component without `round(holes·nodes)` random nodes."""
    removed = set(random.sample(range(len(graph)), round(holes * len(graph))))
    if len(removed) == len(graph):
        raise InputError(f"{name}: no node is left: ask for fewer holes")
    return largest_component(
        {
            node: [end for end in exits if end.to not in removed]
            for node, exits in graph.items()
            if node not in removed
        }
    )


def largest_component(graph: Graph) -> Graph:
    """The largest component; of several, that with the lowest node."""
    largest: list[int] = []
    known: set[int] = set()
    for node in graph:
        if node not in known:
            known.add(node)
            component = [node]
            for reached in component:
                # the order does not matter
                fresh = {end.to for end in graph[reached]} - known
                known |= fresh
                component += fresh
            largest = max(largest, component, key=len)
    return {node: graph[node] for node in sorted(largest)}


def as_world(
    name: str,
    graph: Graph,
    marker: Dart | None,
    random: Random | None = None,
    positions: tuple[tuple[float, float], ...] = (),
) -> World:
    """The world of a connected graph: darts numbered node by node, clockwise."""
    number = {
        (end.edge, end.side): dart
        for dart, end in enumerate(end for ends in graph.values() for end in ends)
    }
    rotations = [[number[end.edge, end.side] for end in ends] for ends in graph.values()]
    pairs = [(dart, number[edge, 1]) for (edge, side), dart in number.items() if side == 0]
    if marker is None and number and random:
        # vertices are equally likely, darts are not
        marker = random.choice(random.choice(rotations))
    try:
        return World.from_rotations(rotations, pairs, marker, name=name, positions=positions)
    except InputError as error:
        raise InputError(f"{name}: {error}") from error
