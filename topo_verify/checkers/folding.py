"""The fold of a history: what percepts and doors alone prove, with no world at hand.

**Folding** (Stallings). Each visit is a node whose dart 0 is the reference dart of that visit. The
move by door k joins the earlier node's dart k with the later node's dart 0. Every visit that saw
the marker is v0, turned by the marker's direction. If a dart would get two partners, these are one
dart, so their vertices are one vertex, turned by an offset; and so on until nothing changes
(union-find with offsets, nearly linear). Each step identifies only what is one dart in every world
that shows this history.

- No open dart: the fold is a covering in which v0 has one copy, hence it IS the world.
- An open dart: a leaf hung on every open dart, or a path of two, makes two **witness worlds** with
  this history. Nothing is proved.
- A **contradiction** (two degrees at one place, the marker seen at one and not at the other, a
  vertex turned against itself, a dart its own partner, a door that is not there): no world shows
  this history, or an assumption is false in every world that does.

What this does not show: that the percepts are true (claim 1 does), or anything for a mapper that
may assume more, as that the world is planar.

Source: docs/semantics.md, section 11; J. R. Stallings, "Topology of finite graphs", Invent. Math.
    71 (1983).
"""

from __future__ import annotations

from array import array
from collections.abc import Iterator, Sequence
from itertools import combinations, starmap

from topo_verify.robot.percept import Door, Percept
from topo_verify.world.rooted_map import Code, World

Place = tuple[int, int]
"""A dart of the fold: a node and one of its doors. Different places may be one dart."""

Pair = tuple[Place, Place]

UNLIKE = "two degrees, or the marker and its absence, at one place"
TURNED = "a vertex would be itself, turned"
OWN_END = "a dart would be its own other end"
TWO_OF_S = "two vertices of S would be one"

NARROW = 64
"""A node with more doors keeps their other ends in a table, not in an array."""


class Ends:
    """The other end of each dart of each node; None where the dart is open.

    A narrow node takes eight bytes a door; a wide one takes memory only for crossed doors.
    """

    def __init__(self) -> None:
        self._first = array("q")  # the first dart of each narrow node in `_narrow`
        self._narrow = array("q")  # node << 32 | dart; or -1
        self._wide: dict[int, dict[int, Place]] = {}

    def add(self, degree: int) -> None:
        """Add a node, all its darts open."""
        if degree > NARROW:
            self._wide[len(self._first)] = {}
        self._first.append(len(self._narrow))
        self._narrow.extend([-1] * (degree if degree <= NARROW else 0))

    def get(self, node: int, dart: int) -> Place | None:
        """The other end of a dart, or None."""
        if node in self._wide:
            return self._wide[node].get(dart)
        end = self._narrow[self._first[node] + dart]
        return None if end < 0 else (end >> 32, end & 0xFFFFFFFF)

    def put(self, node: int, dart: int, end: Place) -> None:
        """Set the other end of a dart."""
        if node in self._wide:
            self._wide[node][dart] = end
        else:
            self._narrow[self._first[node] + dart] = end[0] << 32 | end[1]

    def of(self, node: int, degree: int) -> list[tuple[int, Place]]:
        """The darts of a node that are not open, each with its other end."""
        darts = self._wide.get(node, range(degree))
        return [(dart, end) for dart in darts if (end := self.get(node, dart)) is not None]


Looks = dict[tuple[int, bool], Place]
"""What may be behind a dart: one place for each signature."""

Met = tuple[str, Sequence[Place]]


class Contradiction(Exception):
    """No world shows this history (under the assumption made)."""


class Fold:
    """The fold of a history. Grows by `move`; `contradictions` looks ahead.

    Attributes:
        at: where the robot stands: a node, and its reference dart there.
    """

    def __init__(self, percept: Percept) -> None:
        self._seen: list[Percept] = []
        # dart d of a node is dart d + offset of its parent
        self._parent, self._offset, self._size = array("i"), array("i"), array("i")
        self._ends = Ends()
        self.at: Place = (self._visit(percept), 0)

    def _visit(self, percept: Percept) -> int:
        node = len(self._seen)
        self._seen.append(percept)
        self._parent.append(node)
        self._offset.append(0)
        self._size.append(1)
        self._ends.add(percept.degree)
        return node

    def move(self, door: Door, percept: Percept) -> None:
        """Let the robot leave by a door and sense this behind it. Raises Contradiction."""
        (here, dart), marker, back = self.at, percept.marker, percept.degree
        if door not in range(doors := self._seen[here].degree):
            raise Contradiction(f"degree {doors} has no door {door}: doors are 0 to {doors - 1}")
        if not 0 <= (marker or 0) < back:
            raise Contradiction(f"no place behind a door shows {percept}")
        exit_place = self.find((here, dart + door))
        known = (end := self._ends.get(*exit_place)) and self.find(end)
        # the marker is at v0, whose dart 0 is marked
        at_v0 = None if marker is None else self.find((0, -marker))
        self.at = at_v0 or known or (self._visit(percept), 0)
        self._require_alike(self._seen[self.at[0]], percept)  # as the node that stands for it
        if self.at != known:
            self.join(exit_place, self.at)

    def find(self, place: Place) -> Place:
        """The place that stands for all places that are the same dart."""
        node, dart = place
        while (parent := self._parent[node]) != node:
            node, dart = parent, dart + self._offset[node]
        return node, dart % self._seen[node].degree

    def partner(self, place: Place) -> Place | None:
        """The other end of a dart's edge; None if the dart is open."""
        end = self._ends.get(*self.find(place))
        return None if end is None else self.find(end)

    def join(self, one: Place, other: Place) -> None:
        """Make the two the ends of one edge, and fold. Raises Contradiction."""
        self._draw([(one, other), (other, one)])

    def identify(self, one: Place, other: Place) -> None:
        """Make the two one dart, and fold. Raises Contradiction."""
        self._draw(self._merged(self.find(one), self.find(other)))

    def _draw(self, edges: list[Pair]) -> None:
        """Put these ends of edges; two ends of one dart are one dart."""
        while edges:
            one, other = map(self.find, edges.pop())
            if one == other:
                raise Contradiction(OWN_END)
            if known := self._ends.get(*one):
                edges += self._merged(self.find(known), other)
            else:
                self._ends.put(*one, other)

    def _merged(self, one: Place, other: Place) -> list[Pair]:
        """Make two nodes one. Returns the edges of one of them, to be drawn again."""
        (a, i), (b, j) = one, other
        if a == b:
            if i != j:
                raise Contradiction(TURNED)
            return []
        if self._size[a] > self._size[b]:  # so paths stay logarithmic
            (a, i), (b, j) = other, one
        self._require_alike(self._seen[a], self._seen[b])
        self._parent[a], self._offset[a] = b, j - i
        self._size[b] += self._size[a]
        return [((a, dart), end) for dart, end in self._ends.of(a, self.degree(a))]

    def _require_alike(self, one: Percept, other: Percept) -> None:
        if not one.is_like(other):
            raise Contradiction(f"{UNLIKE}: {other} and {one}")

    def _behind(self, place: Place, drawn: dict[Place, Looks]) -> Looks:
        """The other ends of a dart: those drawn so far, or that of the fold."""
        if place not in drawn:
            end = self._ends.get(*place)
            drawn[place] = {} if end is None else {self._seen[end[0]].signature: self.find(end)}
        return drawn[place]

    def contradictions(self, one: Place, other: Place, apart: Sequence[Place]) -> Iterator[Met]:
        """What follows if the two are ends of one edge and `apart` are different vertices.

        The order of steps does not matter. The fold does not change.
        """
        same: dict[Place, Place] = {}
        ends: dict[Place, Looks] = {}
        one, other = self.find(one), self.find(other)
        waiting = [(one, other, True), (other, one, True)]  # ends of one edge; False: one dart

        def find(place: Place) -> Place:
            while place in same:
                place = same[place]
            return place

        while waiting:
            one, other, are_ends = waiting.pop()
            (a, i), (b, j) = one, other = find(one), find(other)
            if are_ends:
                behind = self._behind(one, ends)
                waiting.append((other, behind.setdefault(self._seen[b].signature, other), False))
                if one == other:
                    yield OWN_END, [one]
                if len(behind) > 1:
                    yield UNLIKE, [*behind.values()]
            elif one != other:
                if a == b:
                    yield TURNED, [one, other]
                for door in range(n := self._seen[a].degree):
                    one, other = find((a, (i + door) % n)), find((b, (j + door) % n))
                    if one != other:
                        same[one] = other
                        waiting += [(other, end, True) for end in self._behind(one, ends).values()]
        if len({find(self.find(place))[0] for place in apart}) < len(apart):
            yield TWO_OF_S, apart

    def alike(self) -> Iterator[Pair]:
        """The pairs of places that may be one dart: each two vertices once in every turn."""
        for one, other in combinations(self.roots(), 2):
            if self._seen[one].is_like(self._seen[other]):
                yield from (((one, 0), (other, door)) for door in range(self.degree(one)))

    def are_apart(self, one: Place, other: Place) -> bool:
        """Whether two places cannot be one dart at a glance: two turns of a vertex, or unlike."""
        (a, i), (b, j) = self.find(one), self.find(other)
        return i != j if a == b else not self._seen[a].is_like(self._seen[b])

    def degree(self, node: int) -> int:
        """The degree of a node."""
        return self._seen[node].degree

    def open_darts(self) -> int:
        """The number of darts that were crossed in neither direction."""
        return sum([self.degree(v) - len(self._ends.of(v, self.degree(v))) for v in self.roots()])

    def roots(self) -> list[int]:
        """One node for each place of the fold."""
        return [node for node, parent in enumerate(self._parent) if node == parent]

    def table(self, pendant_length: int = 1) -> Code:
        """The degrees, vertex by vertex from v0 on, and the other end of each dart.

        A path of this many vertices hangs on every open dart; if none does, its other end is -1.
        Without an open dart, this is the code of the only world that shows the history.
        """
        if not self.degree(0):
            return (0,), ()
        number, degrees, entries = dict[Place, int](), list[int](), [self.find((0, 0))]
        ends: list[Place | None] = []
        for node, first in entries:  # grows
            if (node, first) not in number:
                degree = self.degree(node)
                places = [(node, (first + door) % degree) for door in range(degree)]
                number |= zip(places, range(len(number), len(number) + degree), strict=True)
                degrees.append(degree)
                ends += [end and self.find(end) for end in starmap(self._ends.get, places)]
                entries += filter(None, ends[-degree:])
        alpha = [-1 if end is None else number[end] for end in ends]
        for end in [dart for dart, other in enumerate(alpha) if other < 0]:
            for degree in [*[2] * (pendant_length - 1), 1][:pendant_length]:
                alpha[end] = len(alpha)
                alpha += [end, -1][:degree]
                degrees.append(degree)
                end = len(alpha) - 1  # noqa: PLW2901  where the path goes on
        return tuple(degrees), tuple(alpha)

    def world(self, pendant_length: int = 1) -> World:
        """The world of `table`."""
        return World.from_code(self.table(pendant_length))
