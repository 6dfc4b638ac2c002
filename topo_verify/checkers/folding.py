"""The fold of a history: what percepts and doors alone prove, with no world at hand.

**Folding** (Stallings). One node a visit, its dart 0 the reference dart of that visit. The move by
door k joins the earlier node's dart k with the later node's dart 0. (A move through a door that was
crossed before leads to a known place: it must look as it did, and no node is added. So a long
patrol takes no more memory than the places it saw.) Every visit that saw the marker is v0, turned
by the marker's direction. A dart has one partner: where it would get two, these are
one dart, so their vertices are one vertex, turned by an offset; and so on until nothing changes
(union-find with offsets, nearly linear). Each step identifies only what is one dart in every world
that shows this history; so the result maps into all of them, dart by dart.

- No dart left open: the fold is a covering in which v0 has one copy, hence it IS the world.
- A dart left open: a leaf hung on every open dart, or a path of two, makes two different worlds
  with this same history. Nothing is proved; these are its **witness worlds**.
- A **contradiction** (two degrees at one place, the marker seen at one and not at the other, a
  vertex turned against itself, a dart its own partner, a door that is not there) says that no world
  shows this history; and under an assumption, that it is false in every world that does. The first
  one refutes; `contradictions` folds on past it and lists every kind that is met.

What this does not show: that the percepts are true (claim 1 does), or anything for a mapper that
may assume more than "some connected embedded graph", as that it is planar.

Source: docs/semantics.md, section 11; J. R. Stallings, "Topology of finite graphs", Invent. Math.
71 (1983).
"""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from contextlib import contextmanager
from itertools import combinations

from topo_verify.robot.percept import Door, Percept
from topo_verify.world.rooted_map import World

Place = tuple[int, int]
"""A dart of the fold: a node and one of its doors. Different places may be one dart."""


class Contradiction(Exception):
    """No world shows this history (under the assumption made)."""


class Fold:
    """The fold of a history. Grows by `move`; `assuming` looks ahead and returns.

    Attributes:
        at: where the robot stands: a node, and its reference dart there.
    """

    def __init__(self, percept: Percept) -> None:
        self._seen: list[Percept] = []
        self._parent: list[int] = []
        self._offset: list[int] = []  # dart d of a node is dart d + offset of its parent
        self._size: list[int] = []
        self._partner: list[dict[int, Place]] = []
        self._undo: list[tuple[int, int | None]] = []
        self._met: set[str] | None = None  # the contradictions so far, while they are listed
        self.at: Place = (self._visit(percept), 0)

    def _visit(self, percept: Percept) -> int:
        node = len(self._seen)
        self._seen.append(percept)
        self._parent.append(node)
        self._offset.append(0)
        self._size.append(1)
        self._partner.append({})
        return node

    def move(self, door: Door, percept: Percept) -> None:
        """Let the robot leave by a door and see this behind it. Raises Contradiction."""
        (here, dart), marker = self.at, percept.marker
        if not 0 <= door < self._seen[here].degree or percept.degree < 1:
            raise Contradiction(f"door {door} of {self._seen[here].degree} cannot be crossed")
        if marker is not None and not 0 <= marker < percept.degree:
            raise Contradiction(f"the marker cannot point at door {marker} of {percept.degree}")
        known = self.partner((here, dart + door))
        if known is not None:
            self._require_alike(self._seen[known[0]], percept)
        self.at = there, entry = known or (self._visit(percept), 0)
        if marker is not None:
            self._identify((there, entry + marker), (0, 0))
        if known is None:
            self.join((here, dart + door), (there, 0))

    def find(self, place: Place) -> Place:
        """The one place that stands for all that are the same dart."""
        node, dart = place
        while self._parent[node] != node:
            dart += self._offset[node]
            node = self._parent[node]
        return node, dart % self._seen[node].degree

    def partner(self, place: Place) -> Place | None:
        """The other end of a dart's edge, or None: the dart is open."""
        node, dart = self.find(place)
        end = self._partner[node].get(dart)
        return None if end is None else self.find(end)

    def join(self, one: Place, other: Place) -> None:
        """Make the two the ends of one edge, and draw what follows. Raises Contradiction."""
        for place, end in ((one, other), (other, one)):
            node, dart = self.find(place)
            if (node, dart) == self.find(end):
                self._meet("a dart would be its own other end")
            elif dart in self._partner[node]:
                self._identify(self._partner[node][dart], end)
            else:
                self._set(node, dart, end)

    def _meet(self, contradiction: str) -> None:
        if self._met is None:
            raise Contradiction(contradiction)
        self._met.add(contradiction.partition(":")[0])

    def _require_alike(self, one: Percept, other: Percept) -> bool:
        """Whether two percepts may be of one place; if not, that is a contradiction."""
        if one.signature != other.signature:
            clash = "two degrees, or the marker and its absence, at one place"
            self._meet(f"{clash}: {other} and {one}")
            return False
        return True

    def _identify(self, one: Place, other: Place) -> None:
        """Make the two one dart, and draw what follows. Raises Contradiction."""
        pairs = [(one, other)]
        while pairs:
            (a, i), (b, j) = map(self.find, pairs.pop())
            if a == b:
                if i != j:
                    self._meet("a vertex would be itself, turned")
                continue
            if self._size[a] > self._size[b]:
                (a, i), (b, j) = (b, j), (a, i)
            lost, kept = self._seen[a], self._seen[b]
            if not self._require_alike(lost, kept):
                continue
            # Paths are never shortened: to undo a union is to cut one link, and unions by size keep
            # the paths logarithmic.
            self._parent[a], self._offset[a] = b, j - i
            self._size[b] += self._size[a]
            self._undo.append((a, None))
            for dart, end in self._partner[a].items():
                moved = (dart + j - i) % kept.degree
                if self.find(end) == (b, moved):
                    self._meet("a dart would be its own other end")
                elif moved in self._partner[b]:
                    pairs.append((self._partner[b][moved], end))
                else:
                    self._set(b, moved, end)

    def _set(self, node: int, dart: int, end: Place) -> None:
        self._partner[node][dart] = end
        self._undo.append((node, dart))

    @contextmanager
    def assuming(self, one: Place, other: Place, *, same: bool = False) -> Generator[None]:
        """Inside the block the two are ends of one edge; after it the fold is as before.

        Args:
            same: they are one dart, instead.
        Raises Contradiction at the head of the block, if there is one; nothing remains of it.
        """
        mark = len(self._undo)
        try:
            (self._identify if same else self.join)(one, other)
            yield
        finally:
            while len(self._undo) > mark:
                node, dart = self._undo.pop()
                if dart is not None:
                    del self._partner[node][dart]
                else:
                    self._size[self._parent[node]] -= self._size[node]
                    self._parent[node], self._offset[node] = node, 0

    def contradictions(self, one: Place, other: Place, apart: Sequence[Place] = ()) -> set[str]:
        """The contradictions if the two are ends of one edge, and no two of `apart` one vertex."""
        self._met = met = set[str]()
        with self.assuming(one, other):
            self._met = None
            if len({self.find(place)[0] for place in apart}) < len(apart):
                met.add("two vertices of S would be one")
        return met

    def alike(self) -> Iterator[tuple[Place, Place]]:
        """The pairs of places that may be one dart: each two vertices once in every turn."""
        for one, other in combinations(self.roots(), 2):
            if self._seen[one].signature == self._seen[other].signature:
                yield from (((one, 0), (other, door)) for door in range(self.degree(one)))

    def degree(self, node: int) -> int:
        """The degree of a node."""
        return self._seen[node].degree

    def open_darts(self) -> int:
        """How many darts were never crossed, neither way."""
        return self.darts() - sum(len(self._partner[node]) for node in self.roots())

    def darts(self) -> int:
        """How many darts there are."""
        return sum(self._seen[node].degree for node in self.roots())

    def roots(self) -> list[int]:
        """One node for each place of the fold."""
        return [node for node, parent in enumerate(self._parent) if node == parent]

    def world(self, pendant_length: int = 1) -> World:
        """The fold as a world, with a path of so many vertices hung on every open dart."""
        first, count = dict[int, int](), 0  # of each node, the number of its dart 0
        for node in self.roots():
            first[node], count = count, count + self.degree(node)
        vertices = [tuple(range(dart, dart + self.degree(node))) for node, dart in first.items()]
        edges: list[tuple[int, int]] = []
        for node, start in first.items():
            for dart in range(self.degree(node)):
                here, end = start + dart, self.partner((node, dart))
                if end is not None:
                    there = first[end[0]] + end[1]
                    if here < there:  # an edge is met at both its ends
                        edges.append((here, there))
                    continue
                edges.append((here, count))
                for _ in range(pendant_length - 1):
                    vertices.append((count, count + 1))
                    edges.append((count + 1, count + 2))
                    count += 2
                vertices.append((count,))
                count += 1
        if not count:
            return World.from_rotations(vertices, edges, None)
        node, dart = self.find((0, 0))  # the robot starts at v0, its reference dart the marked one
        return World.from_rotations(vertices, edges, first[node] + dart)
