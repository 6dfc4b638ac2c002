"""The map S that a mapper draws while it explores.

The darts of a new vertex are numbered clockwise from the dart of entry (v0: from the marked dart,
0). A vertex is an interval of darts, and turning is addition modulo its degree.

    letter   what it is                                              e.g.
    e, h     darts of S: the edge being validated, a hypothesis       7
    vk, vu   vertices: where e leaves, where it arrives (unknown)     2
    U        the unexplored darts: their other end is not known yet   {3, 7, 8}

S only grows, so every statement it makes stays true.

Source: docs/semantics.md, section 3; "S" and "U" of the paper's listings 1-3.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from topo_verify.robot.events import MapDart
from topo_verify.robot.percept import Door, Percept

Vertex = int


class Survey(NamedTuple):
    """The result of a mapper: its map, and its cost in edge traversals."""

    vertices: tuple[tuple[MapDart, ...], ...]
    edges: tuple[tuple[MapDart, MapDart], ...]
    marker: MapDart | None
    cost: int


class Tree(NamedTuple):
    """Each vertex's distance from the root (-1: not reached) and its dart towards the root."""

    depth: list[int]
    parent: list[MapDart | None]


class Chart:
    """S, from one vertex to the whole world. It grows by `add_vertex` and `join`.

    Attributes:
        vertex: of each dart.
        alpha: the other end of each dart; None while it is unexplored.
        percepts: with each dart as the reference dart.
        first, degree: of each vertex.
        unexplored: U, ascending.
    """

    def __init__(self, percept: Percept) -> None:
        self.first: list[MapDart] = []
        self.degree: list[int] = []
        self.vertex: list[Vertex] = []
        self.alpha: list[MapDart | None] = []
        self.percepts: list[Percept] = []
        self.unexplored: dict[MapDart, None] = {}
        self.add_vertex(percept)

    def add_vertex(self, percept: Percept) -> MapDart:
        """Add a vertex, given its percept at its first dart. Returns that dart."""
        first = len(self.alpha)
        self.vertex += [len(self.first)] * percept.degree
        self.first.append(first)
        self.degree.append(percept.degree)
        self.alpha += [None] * percept.degree
        if percept.marker is None:
            self.percepts += [percept] * percept.degree
        else:
            turned = ((percept.marker - door) % percept.degree for door in range(percept.degree))
            self.percepts += [Percept(percept.degree, marker) for marker in turned]
        self.unexplored |= dict.fromkeys(range(first, first + percept.degree))
        return first

    def join(self, e: MapDart, other: MapDart) -> None:
        """Make two darts the ends of one edge."""
        self.alpha[e], self.alpha[other] = other, e
        self.unexplored.pop(e, None)
        self.unexplored.pop(other, None)

    def turn(self, dart: MapDart, door: Door) -> MapDart:
        """sigma^door(dart): the dart behind a door for a robot with this reference dart."""
        v = self.vertex[dart]
        first = self.first[v]
        return first + (dart - first + door) % self.degree[v]

    def door(self, dart: MapDart, exit_dart: MapDart) -> Door:
        """The door through which a robot with reference dart `dart` leaves by `exit_dart`."""
        return (exit_dart - dart) % self.degree[self.vertex[dart]]

    def across(self, dart: MapDart) -> MapDart:
        """The other end of an explored dart."""
        other = self.alpha[dart]
        assert other is not None, f"dart {dart} is unexplored"
        return other

    def darts(self, v: Vertex) -> range:
        """The darts of a vertex, clockwise from its first."""
        return range(self.first[v], self.first[v] + self.degree[v])

    def outward(self, root: Vertex) -> Iterator[tuple[Vertex, int, MapDart | None]]:
        """Breadth-first search on S, darts ascending: vertex, distance, dart towards the root."""
        reached = {root}
        queue: list[tuple[Vertex, int, MapDart | None]] = [(root, 0, None)]
        for v, distance, back in queue:
            yield v, distance, back
            for dart in self.darts(v):
                other = self.alpha[dart]
                if other is not None and (there := self.vertex[other]) not in reached:
                    reached.add(there)
                    queue.append((there, distance + 1, other))

    def tree(self, root: Vertex, *, until: Vertex | None = None) -> Tree:
        """The breadth-first tree from a root: complete, or until `until` is reached."""
        depth = [-1] * len(self.first)
        parent: list[MapDart | None] = [None] * len(self.first)
        depth[root], queue = 0, [root]
        for v in queue:
            if v == until:
                break
            for dart in self.darts(v):
                other = self.alpha[dart]
                if other is not None and depth[there := self.vertex[other]] < 0:
                    depth[there], parent[there] = depth[v] + 1, other
                    queue.append(there)
        return Tree(depth, parent)

    def survey(self, cost: int) -> Survey:
        """The map as a mapper delivers it."""
        rotations = tuple([tuple(self.darts(v)) for v in range(len(self.first))])
        edges = tuple([(d, o) for d, o in enumerate(self.alpha) if o is not None and d < o])
        return Survey(rotations, edges, 0 if self.alpha else None, cost)
