"""The places of a fold: history.py reaches `PartialFold` only through this file.

A **place** is a node that stands for all nodes identified with it: a vertex of S or a ghost.
"""

from __future__ import annotations

from collections.abc import Iterator

from topo_verify.algorithms.beyond.folding import NodeDart, PartialFold
from topo_verify.algorithms.chart import Vertex
from topo_verify.robot.percept import Door, Percept

PlaceNode = NodeDart
"""A node that leads its class, named by its first dart."""


class Places:
    """The places of a fold or a layer; `entries`: the first dart of each vertex of S."""

    def __init__(self, percept: Percept) -> None:
        self.fold = PartialFold()
        self.seen = self.fold.seen
        self.entries: list[NodeDart] = [self.fold.add(percept, known=True)]
        # its node never changes: a vertex of S leads its class
        self._vertices: dict[PlaceNode, Vertex] = {self.entries[0]: 0}

    def suppose(self, e: NodeDart, h: NodeDart) -> Places | str:
        """The places if these two darts were one edge, or the contradiction."""
        places = Places.__new__(Places)
        places.fold, places.seen = self.fold.layer(), self.seen
        places.entries, places._vertices = self.entries, self._vertices  # noqa: SLF001  of this class
        return places.fold.join(e, h) or places

    def follow(self) -> bool:
        """Fold in the percepts since `suppose`; False if the supposition must be folded anew."""
        return self.fold.follow() == ""

    @property
    def changes(self) -> int:
        """A number that grows when places are identified or become vertices of S."""
        return len(self.seen.changed)

    # ---------------------------------------------------------------- darts

    def resolve(self, dart: NodeDart) -> NodeDart:
        """The dart that leads all darts that are the same."""
        return self.fold.resolve(dart)

    def across(self, dart: NodeDart) -> NodeDart | None:
        """The other end of a dart's edge; None if the dart was never crossed."""
        beyond = self.beyond(dart)
        return beyond and beyond[0]

    def beyond(self, dart: NodeDart) -> tuple[NodeDart, Vertex | None] | None:
        """The other end of a dart's edge and its vertex of S, if it is one; None if unknown."""
        fold, seen = self.fold, self.seen  # look-ups written out, since it runs by the million
        leader, leader_seen = fold.leader, seen.leader
        while up := leader_seen[dart] or leader.get(dart):
            dart = up
        end = fold.behind.get(dart) or seen.behind[dart]
        if not end:
            return None
        while up := leader_seen[end] or leader.get(end):
            end = up
        return end, self._vertices.get(seen.node[end])

    def turn(self, dart: NodeDart, door: Door) -> NodeDart:
        """The dart `door` doors clockwise from this one."""
        return self.fold.resolve(self.fold.turn(dart, door))

    def door(self, dart: NodeDart, exit_dart: NodeDart) -> Door:
        """The number of doors from `dart` clockwise to `exit_dart`."""
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
        """The signature of a dart's place."""
        return self.seen.looks[dart]

    def vertex(self, dart: NodeDart) -> Vertex | None:
        """The vertex of S at a dart's place; None if it is a ghost."""
        return self._vertices.get(self.seen.node[self.fold.resolve(dart)])

    def coincidences(self) -> Iterator[int]:
        """The degree of each place of the fold below that this layer identifies with another."""
        node, looks = self.seen.node, self.seen.looks
        return (looks[dart][0] for dart in self.fold.leader if node[dart] == dart)

    # ---------------------------------------------------------------- growing

    def add(self, exit_dart: NodeDart, percept: Percept) -> tuple[NodeDart, str]:
        """Add the percept behind an open dart. Returns its end; "" or a contradiction."""
        entry = self.fold.add(percept)
        contradiction = self.fold.join(exit_dart, entry)
        if percept.marker is not None and not contradiction:
            marked = self.fold.turn(entry, percept.marker)
            contradiction = self.fold.identify(marked, self.entries[0])
        return entry, contradiction

    def know(self, entry: NodeDart) -> None:
        """Make a ghost the next vertex of S, with this dart as its first."""
        self.fold.know(entry)
        self._vertices[self.place(entry)] = len(self.entries)
        self.entries.append(entry)
