"""Makes a world of a string of bytes, one byte an edge.

    letter         meaning                                                             e.g.
    edge k         darts 2k and 2k+1; alpha(d) is d ^ 1                                 4, 5
    corner d       the place between dart d and the next one clockwise, sigma(d)        5
    newest corner  that of the highest dart                                            2k-1

A byte is two bits of kind (leaf, split or cross: shapes.py) and six bits of place, counted from the
newest edge back; above 32 edges a second string adds multiples of 64. A leaf grows at that corner.
A closing leads from the newest corner to the place's corner among those that it may reach; if none,
from the next newest. If a kind is impossible, or would make the bounds so, the next kind is used.

Places are relative, so that a world stays similar when Hypothesis removes a byte. Zeros make a
star, ones a path. Hypothesis tries zeros first; in a star no hypothesis is posed, so it shrinks
further. Rejected: paths at zero, for planted faults shrank to paths of twice the edges.

Every map within the bounds is reached: let the vertices of a spanning tree grow as leaves, each
then closing its edges to itself and to earlier vertices, clockwise from the edge by which it grew,
a loop at its second end. Each closing leads from the newest corner. Cost: O(m) a byte.
"""

from __future__ import annotations

from collections.abc import Iterator
from copy import copy
from dataclasses import dataclass
from itertools import cycle
from random import Random
from typing import Literal

from topo_verify.strategies.shapes import MANY, Shape
from topo_verify.world.rooted_map import Dart

EdgeKind = Literal["leaf", "split", "cross"]
EdgeKinds = tuple[EdgeKind, EdgeKind, EdgeKind, EdgeKind]
"""The kinds that the two highest bits of a byte request, simplest first."""

BALANCED: EdgeKinds = ("leaf", "leaf", "split", "cross")
CROWDED: EdgeKinds = ("leaf", "split", "split", "cross")

PLACES = 64

ONE_STRING = PLACES // 2
"""The most edges with places of one byte."""

_INSTEAD: dict[EdgeKind, tuple[EdgeKind, EdgeKind, EdgeKind]] = {
    "leaf": ("leaf", "split", "cross"),
    "split": ("split", "cross", "leaf"),
    "cross": ("cross", "split", "leaf"),
}

_TRIALS = 32
"""Attempts at bytes that lead into a dead end."""


@dataclass(frozen=True, slots=True)
class Grown:
    """A map: dart 0 leaves the first vertex, and alpha(d) is d ^ 1.

    Attributes:
        vertex: of each dart, in the order of growth.
        closings: the edges outside the tree.
    """

    sigma: tuple[Dart, ...]
    vertex: tuple[int, ...]
    closings: tuple[int, ...]

    @property
    def alpha(self) -> tuple[Dart, ...]:
        """The other dart of each dart's edge."""
        return tuple(dart ^ 1 for dart in range(len(self.sigma)))


def grow(shape: Shape, kinds: EdgeKinds, steps: bytes, further: bytes = b"\0") -> Grown | None:
    """The map of len(steps) edges that these bytes stand for.

    None if they and all replacements end in a dead end, which takes tight bounds on degrees, loops
    or parallel edges.
    """
    shape = shape.at(len(steps))
    shuffle = Random(steps)
    # trial 1: the same bytes, handles first; then new bytes
    for trial in range(_TRIALS):
        sapling = _Sapling(shape, len(steps), genus_first=trial > 0)
        grown = sapling.grow(kinds, steps, further)
        if grown is not None:
            return grown
        if trial:
            steps = shuffle.randbytes(len(steps))
    return None


class _Sapling:
    def __init__(self, shape: Shape, edges: int, *, genus_first: bool = False) -> None:
        self._shape = shape
        self._genus_first = genus_first
        self._edges = edges
        self._sigma: list[Dart] = []
        self._vertex: list[int] = []
        self._face: list[int] = []
        self._closings: list[int] = []
        self._room = [shape.first_room]
        self._total_room = shape.first_room
        self._joins: dict[tuple[int, int], int] = {}
        self._counts_joins = shape.max_parallel < MANY or shape.max_loops < MANY
        self._bounded = shape.max_degree < MANY or shape.leaf
        self._genus = 0
        self._faces = 1
        # a cross leaves a label unused
        self._labels = 1

    def grow(self, kinds: EdgeKinds, steps: bytes, further: bytes) -> Grown | None:
        for step, more in zip(steps, cycle(further), strict=False):
            place = step % PLACES + PLACES * more
            kind = kinds[step // PLACES]
            # after a dead end handles come first
            if self._genus_first and self._genus < self._shape.min_genus and kind != "leaf":
                kind = "split" if self._faces == 1 else "cross"
            if not any(self._add(kind, place) for kind in _INSTEAD[kind]):
                return None
        return Grown(tuple(self._sigma), tuple(self._vertex), tuple(self._closings))

    def _add(self, kind: EdgeKind, place: int) -> bool:
        """Add an edge of this kind if the map can be finished then."""
        # what the edge adds: vertices, faces, genus, room
        if kind == "leaf":
            possible = self._can_finish(1, 0, 0, self._shape.max_degree - 2)
        elif kind == "split":
            possible = self._can_finish(0, 1, 0, -2)
        else:
            possible = self._faces > 1 and self._can_finish(0, -1, 1, -2)
        if not possible:
            return False
        # taken back if no cross can follow, which a missing handle needs
        careful = self._genus_first and kind == "split" and self._genus < self._shape.min_genus
        for near, far in self._moves(kind, place):
            before = (
                {name: copy(value) for name, value in vars(self).items() if name != "_shape"}
                if careful
                else None
            )
            if kind == "leaf":
                self._leaf(near)
            else:
                self._join(near, far, across=kind == "cross")
            if before is None or any(True for _ in self._moves("cross", 0)):
                return True
            vars(self).update(before)
        return False

    def _can_finish(self, vertices: int, faces: int, genus: int, room: int) -> bool:
        return self._shape.can_finish(
            edges=self._edges,
            to_come=self._edges - len(self._sigma) // 2 - 1,
            vertices=len(self._room) + vertices,
            faces=self._faces + faces,
            genus=self._genus + genus,
            room=self._total_room + room,
        )

    def _moves(self, kind: EdgeKind, place: int) -> Iterator[tuple[Dart, Dart]]:
        """The pairs of corners that an edge of this kind may join, from this place on."""
        darts = len(self._sigma)
        if not darts:  # -1: the lone vertex has no corner
            if kind == "leaf" or self._may_join(0, 0):
                yield -1, -1
        elif kind != "leaf":
            for near in range(darts - 1, -1, -1):
                for far in _from_place(self._far_ends(near, across=kind == "cross"), place):
                    yield near, far
        elif self._bounded:
            corners = (d ^ 1 for d in range(darts - 1, -1, -1))
            free = [d for d in corners if self._room[self._vertex[d]] > 0]
            for near in _from_place(free, place):
                yield near, near
        else:
            # `^` binds last
            near = darts - 1 - nth(place, darts) ^ 1
            yield near, near

    def _far_ends(self, near: Dart, *, across: bool) -> list[Dart]:
        # corner d lies on the face of dart d ^ 1
        face, vertex, here = self._face, self._vertex, self._face[near ^ 1]
        corners = range(len(face) - 1, -1, -1)
        if across:
            ends = [d for d in corners if face[d ^ 1] != here]
        else:
            ends = [d for d in corners if face[d ^ 1] == here]
        if not (self._bounded or self._counts_joins):
            return ends
        u = vertex[near]
        fit = [self._may_join(u, v) for v in range(len(self._room))]
        return [d for d in ends if fit[vertex[d]]]

    def _may_join(self, u: int, v: int) -> bool:
        if u == v:
            return self._room[u] > 1 and self._joins.get((u, u), 0) < self._shape.max_loops
        return (
            self._room[u] > 0
            and self._room[v] > 0
            and self._joins.get((min(u, v), max(u, v)), 0) < self._shape.max_parallel
        )

    def _insert(self, corner: Dart, dart: Dart) -> None:
        self._sigma.append(self._sigma[corner])
        self._sigma[corner] = dart

    def _leaf(self, corner: Dart) -> None:
        darts, new = len(self._sigma), len(self._room)
        if corner < 0:
            vertex, face = 0, 0
            self._sigma.append(0)
        else:
            vertex, face = self._vertex[corner], self._face[corner ^ 1]
            self._insert(corner, darts)
        self._sigma.append(darts + 1)
        self._vertex += [vertex, new]
        self._face += [face, face]
        self._room[vertex] -= 1
        self._room.append(self._shape.max_degree - 1)
        self._total_room += self._shape.max_degree - 2
        self._count_join(vertex, new)

    def _join(self, near: Dart, far: Dart, *, across: bool) -> None:
        a = len(self._sigma)
        b = a + 1
        if near < 0:
            u, v, face = 0, 0, 0
            self._sigma += [b, a]
        else:
            u, v, face = self._vertex[far], self._vertex[near], self._face[near ^ 1]
            # in one corner the second goes behind the first
            self._insert(far, a)
            self._insert(a if near == far else near, b)
        self._vertex += [u, v]
        self._face += [face, face]
        self._faces += -1 if across else 1
        self._genus += across
        if not across:
            face = self._labels
            self._labels += 1
        self._label(b, face)
        self._closings.append(a // 2)
        self._room[u] -= 1
        self._room[v] -= 1
        self._total_room -= 2
        self._count_join(u, v)

    def _label(self, dart: Dart, face: int) -> None:
        first = dart
        while True:
            self._face[dart] = face
            dart = self._sigma[dart ^ 1]
            if dart == first:
                break

    def _count_join(self, u: int, v: int) -> None:
        if self._counts_joins:
            ends = (min(u, v), max(u, v))
            self._joins[ends] = self._joins.get(ends, 0) + 1


def _from_place(corners: list[Dart], place: int) -> list[Dart]:
    if not corners:
        return []
    start = nth(place, len(corners))
    return corners[start:] + corners[:start]


def nth(place: int, corners: int) -> int:
    """The index below `corners` that the place means: the low bits that fit.

    It stays the same while later corners disappear, as in shrinking.
    """
    bits = (corners - 1).bit_length()
    number = place & ((1 << bits) - 1)
    # without its top bit it is below 2^(bits-1) < corners
    return number if number < corners else number - (1 << bits >> 1)
