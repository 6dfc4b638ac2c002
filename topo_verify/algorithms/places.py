"""What a fold says of places: all that history.py asks of `PartialFold` is asked in this file.

A **place** is a node of the fold that stands for all that are one with it. It is a vertex of S, or
a ghost. The places of a layer are those that there would be if what the layer joins were true.

    letter       what it is
    S            the map so far; `entries` holds the first dart of each vertex, in their order
    NodeDart     a dart of a node; different ones may be the same dart, and `resolve` tells
"""

from __future__ import annotations

from collections.abc import Iterator

from topo_verify.algorithms.chart import Vertex
from topo_verify.algorithms.folding import NodeDart, PartialFold
from topo_verify.robot.percept import Door, Percept

PlaceNode = NodeDart
"""A node that stands for itself, named by its first dart."""


class Places:
    """The places of a fold or of a layer above it, and which of them are the vertices of S."""

    def __init__(self, percept: Percept) -> None:
        """Begin with v0, which is the first vertex of S."""
        self.fold = PartialFold()
        self.seen = self.fold.seen
        self.entries: list[NodeDart] = [self.fold.add(percept, known=True)]
        # A vertex of S stands for whatever is identified with it, so it keeps its name.
        self._vertices: dict[PlaceNode, Vertex] = {self.entries[0]: 0}

    def suppose(self, one: NodeDart, other: NodeDart) -> Places | str:
        """The places if these two darts were one edge, or the contradiction that folding meets."""
        made = Places.__new__(Places)
        made.fold, made.seen = self.fold.layer(), self.seen
        made.entries, made._vertices = self.entries, self._vertices  # noqa: SLF001  of this class
        return made.fold.join(one, other) or made

    def follow(self) -> bool:
        """Learn what was seen since `suppose`; False if that must be folded anew."""
        return self.fold.follow() == ""

    @property
    def merges(self) -> int:
        """How many darts of places were identified with others, but for what is supposed."""
        return self.seen.merges

    # ---------------------------------------------------------------- darts

    def resolve(self, dart: NodeDart) -> NodeDart:
        """The dart that stands for all that are the same dart."""
        return self.fold.resolve(dart)

    def across(self, dart: NodeDart) -> NodeDart | None:
        """The other end of a dart's edge; None if nothing was seen behind it."""
        end = self.fold.across(dart)
        return self.fold.resolve(end) if end else None

    def turn(self, dart: NodeDart, door: Door) -> NodeDart:
        """The dart that is so many doors clockwise from this one."""
        return self.fold.resolve(self.fold.turn(dart, door))

    def door(self, dart: NodeDart, exit_dart: NodeDart) -> Door:
        """How many doors clockwise one dart of a place is from another."""
        at, out = self.fold.resolve(dart), self.fold.resolve(exit_dart)
        return (out - at) % self.seen.looks[at][0]

    # ---------------------------------------------------------------- places

    def place(self, dart: NodeDart) -> PlaceNode:
        """The place of a dart."""
        return self.seen.node[self.fold.resolve(dart)]

    def darts(self, place: PlaceNode) -> tuple[NodeDart, ...]:
        """The darts of a place, clockwise."""
        return self.seen.clockwise(place)

    def looks(self, dart: NodeDart) -> tuple[int, bool]:
        """The degree of a dart's place, and whether the marker is there."""
        return self.seen.looks[dart]

    def vertex(self, dart: NodeDart) -> Vertex | None:
        """The vertex of S that a dart's place is, or None: it is a ghost."""
        return self._vertices.get(self.place(dart))

    def coincidences(self) -> Iterator[int]:
        """The degree of each place of the fold below that is one with another one here."""
        node, looks = self.seen.node, self.seen.looks
        return (looks[dart][0] for dart in self.fold.leader if node[dart] == dart)

    # ---------------------------------------------------------------- growing

    def add(self, exit_dart: NodeDart, percept: Percept) -> tuple[NodeDart, str]:
        """Add what is seen behind an open dart, and fold.

        Returns:
            The dart of arrival; and "", or the contradiction that folding meets.
        """
        entry = self.fold.add(percept)
        wrong = self.fold.join(exit_dart, entry)
        if percept.marker is not None and not wrong:
            wrong = self.fold.identify(self.fold.turn(entry, percept.marker), self.entries[0])
        return entry, wrong

    def know(self, entry: NodeDart) -> None:
        """Make a ghost the next vertex of S, and this dart its first one."""
        self.fold.know(entry)
        self._vertices[self.place(entry)] = len(self.entries)
        self.entries.append(entry)
