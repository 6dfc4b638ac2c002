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
        self.entries: list[NodeDart] = [(self.fold.add(percept, known=True), 0)]
        self.below: Places | None = None
        self._vertices: dict[PlaceNode, Vertex] = {self.entries[0]: 0}
        self._merges = 0

    def suppose(self, one: NodeDart, other: NodeDart) -> Places | str:
        """The places if these two darts were one edge, or the contradiction that folding meets."""
        made = Places.__new__(Places)
        made.fold, made.entries, made.below = self.fold.layer(), self.entries, self
        made._vertices, made._merges = {}, 0  # noqa: SLF001  of this class
        return made.fold.join(one, other) or made

    def follow(self) -> bool:
        """Learn what was seen since `suppose`; False if that must be folded anew."""
        return self.fold.follow()

    @property
    def merges(self) -> int:
        """How many times nodes were identified here."""
        return len(self.fold.leader)

    # ---------------------------------------------------------------- darts

    def resolve(self, dart: NodeDart) -> NodeDart:
        """The dart that stands for all that are the same dart."""
        return self.fold.resolve(dart)

    def across(self, dart: NodeDart) -> NodeDart | None:
        """The other end of a dart's edge; None if nothing was seen behind it."""
        end = self.fold.across(dart)
        return None if end is None else self.fold.resolve(end)

    def turn(self, dart: NodeDart, door: Door) -> NodeDart:
        """The dart that is so many doors clockwise from this one."""
        return self.fold.resolve((dart[0], dart[1] + door))

    def door(self, dart: NodeDart, exit_dart: NodeDart) -> Door:
        """How many doors clockwise one dart of a place is from another."""
        (place, at), (_, out) = self.fold.resolve(dart), self.fold.resolve(exit_dart)
        return (out - at) % self.fold.signatures[place][0]

    # ---------------------------------------------------------------- places

    def place(self, dart: NodeDart) -> PlaceNode:
        """The place of a dart."""
        return self.fold.resolve(dart)[0], 0

    def darts(self, place: PlaceNode) -> list[NodeDart]:
        """The darts of a place, clockwise."""
        return [(place[0], door) for door in range(self.fold.signatures[place[0]][0])]

    def looks(self, dart: NodeDart) -> tuple[int, bool]:
        """The degree of a dart's place, and whether the marker is there."""
        return self.fold.signatures[dart[0]]

    def vertex(self, dart: NodeDart) -> Vertex | None:
        """The vertex of S that a dart's place is, or None: it is a ghost."""
        if self._merges != len(self.fold.leader):
            self._look_up()
        place = self.place(dart)
        v = self._vertices.get(place)
        return v if v is not None or self.below is None else self.below.vertex(place)

    def _look_up(self) -> None:
        """Find the vertices of S anew: any node may stand for one, once it is one with it."""
        self._merges = len(self.fold.leader)
        if self.below is None:
            self._vertices = {self.place(entry): v for v, entry in enumerate(self.entries)}
            return
        for node in self.fold.leader:
            v = self.below.vertex((node, 0))
            if v is not None:
                self._vertices[self.place((node, 0))] = v

    def coincidences(self) -> Iterator[int]:
        """The degree of each place of the fold below that is one with another one here."""
        return (self.fold.signatures[node][0] for node in self.fold.leader)

    # ---------------------------------------------------------------- growing

    def add(self, exit_dart: NodeDart, percept: Percept) -> NodeDart:
        """Add what is seen behind an open dart, and fold. Returns the dart of arrival."""
        entry = (self.fold.add(percept), 0)
        self.fold.join(exit_dart, entry)
        if percept.marker is not None:
            self.fold.identify((entry[0], percept.marker), self.entries[0])
        return entry

    def know(self, entry: NodeDart) -> None:
        """Make a ghost the next vertex of S, and this dart its first one."""
        place = self.place(entry)
        self.fold.known.add(place[0])
        self._vertices[place] = len(self.entries)
        self.entries.append(entry)
