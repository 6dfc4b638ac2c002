"""Graphs whose exits are in clockwise order, and the worlds that they make."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from random import Random
from typing import NamedTuple

from topo_verify.errors import InputError
from topo_verify.world.rooted_map import Dart, World


class EdgeEnd(NamedTuple):
    """One end of an edge, as seen from its node."""

    to: int  # the node at the other end
    edge: tuple[int, int]
    side: int  # 0 or 1: which end of the edge; a loop has both at one node


Graph = dict[int, list[EdgeEnd]]
"""The exits of each node in clockwise order; nodes ascending."""


def from_neighbours(rows: Iterable[Sequence[int]]) -> Graph:
    """The simple graph whose nodes have these neighbours, in clockwise order."""
    return {
        node: [EdgeEnd(to, (min(node, to), max(node, to)), int(node > to)) for to in row]
        for node, row in enumerate(rows)
    }


def with_holes(name: str, graph: Graph, holes: float, random: Random) -> Graph:
    """The largest component that is left when `round(holes·nodes)` nodes are taken out."""
    removed = set(random.sample(range(len(graph)), round(holes * len(graph))))
    if len(removed) == len(graph):
        raise InputError(f"{name}: no node is left among so many holes: take out fewer")
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
    seen: set[int] = set()
    for node in graph:
        if node not in seen:
            seen.add(node)
            component = [node]
            for reached in component:  # grows as it goes: a queue
                # The order of this set does not show, because the component is sorted at the end.
                fresh = {end.to for end in graph[reached]} - seen
                seen |= fresh
                component += fresh
            # Of two that are as large, `max` keeps the earlier, which has the lower node.
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
    # The side is needed for loops, both ends of which are at one node.
    number = {
        (end.edge, end.side): dart
        for dart, end in enumerate(end for ends in graph.values() for end in ends)
    }
    rotations = [[number[end.edge, end.side] for end in ends] for ends in graph.values()]
    pairs = [(dart, number[edge, 1]) for (edge, side), dart in number.items() if side == 0]
    if marker is None and number and random:
        # Not a choice among all darts: every vertex is to be as likely as any other.
        marker = random.choice(random.choice(rotations))
    try:
        return World.from_rotations(rotations, pairs, marker, name=name, positions=positions)
    except InputError as error:
        raise InputError(f"{name}: {error}") from error
