"""The order of the edges at a vertex with an extent: a junction whose roads begin around its point.

A straight **spoke** from the vertex to a point of each edge, its **exit**, replaces what the edge
does before. If no spoke meets the rest of another edge, the spokes add no crossing to the drawing,
and their clockwise order is that of the edges. The exits that are tried, in this order, are

1. the last crossings outwards of a circle of 3, 2, 1.5 and 1.01 times the largest offset; an edge
   that stays in the circle has its exit at half of its length, a loop where it begins;
2. the points where the edges begin; edges that begin at one point have the order around it.

Why so? Of 750 random planar drawings 12 are refused, mostly for a loop around the vertex, and the
others are read as they were drawn. Rules that sort by one bearing misread 36 to 160 of them
(research/junctions.py).

The genus is at most the number of crossings of two different edges in the drawing with spokes.

Source: docs/formats.md, "Drawings".
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import atan2, dist, hypot, pi, sqrt
from typing import NamedTuple

Point = tuple[float, float]

_NEAR = 0.1
"""The largest offset, as a share of its edge's first segment, at a vertex without an extent."""

_CLOSE = 0.01
"""An offset that is rounding, as a share of the first segment; a distance between beginnings that
is, as a share of the largest offset."""

_LEAST = 1e-100
"""Offsets below this are none: their squares would vanish."""

_CIRCLES = (3.0, 2.0, 1.5, 1.01)

_TURN = 2 * pi

_EQUAL = 1e-9
"""Radians: floating point does not tell such directions apart."""


class Leaving(NamedTuple):
    """An end of an edge at the vertex."""

    edge: int
    course: Sequence[Point]  # from this end on


class _Exit(NamedTuple):
    """A point of a course, before its point number `place`."""

    at: Point
    place: int


class NoOrder(Exception):
    """Two edges between which there is no order, by their places among the leaving ends."""

    def __init__(self, first: int, second: int) -> None:
        self.pair = (first, second)


def snapped(at: Point, courses: Sequence[Sequence[Point]]) -> list[Sequence[Point]]:
    """The courses; those that begin at the vertex, or together, but for rounding begin there.

    All begin at the vertex if it has no extent.
    """
    offsets = [dist(at, course[0]) for course in courses]
    if not _has_extent(at, courses, offsets):
        return [_begun(at, course) for course in courses]
    close = _CLOSE * max(offsets)
    cells = {(0, 0): at}
    moved: list[Sequence[Point]] = []
    for course in courses:
        x, y = (round((a - b) / close) for a, b in zip(course[0], at, strict=True))
        around = (cells.get((x + dx, y + dy)) for dx in (0, -1, 1) for dy in (0, -1, 1))
        points = (p for p in around if p and dist(p, course[0]) <= close)
        point = next(points, course[0])
        cells.setdefault((x, y), point)
        moved.append(_begun(point, course))
    return moved


def _has_extent(at: Point, courses: Sequence[Sequence[Point]], offsets: Sequence[float]) -> bool:
    """Whether the edges begin around the vertex, or are not apart if they begin there."""
    if max(offsets, default=0.0) <= _LEAST:
        return False
    share = max(
        offset / max(dist(course[0], course[1]), offset)
        for course, offset in zip(courses, offsets, strict=True)
    )
    if share <= _CLOSE:
        return False
    row = sorted(bearing(at, course[1]) for course in courses)
    turns = [(b - a) % _TURN for a, b in pairwise([*row, row[0]])]
    return share > _NEAR or any(turn < _EQUAL for turn in turns if len(row) > 1)


def _begun(point: Point, course: Sequence[Point]) -> Sequence[Point]:
    if course[0] == point or all(other == point for other in course[1:]):
        return course
    return (point, *course[1:])


def bearing(a: Point, b: Point) -> float:
    """The direction from a to b in radians, clockwise from the north."""
    return atan2(b[0] - a[0], b[1] - a[1]) % _TURN


class Spoke(NamedTuple):
    """An end of an edge by its place, its exit, and the place of the next point of its course."""

    end: int
    exit: Point
    after: int


def clockwise(at: Point, ends: Sequence[Leaving]) -> list[Spoke]:
    """The spokes of a vertex with an extent, clockwise; raises `NoOrder` if they have no order."""
    largest = max(dist(at, end.course[0]) for end in ends)
    junction = _Junction(at, ends)
    no_order: NoOrder | None = None
    for circle in (*_CIRCLES, 0.0):
        try:
            return junction.order(circle * largest)
        except NoOrder as met:
            no_order = no_order or met
    assert no_order
    raise no_order


class _Junction:
    def __init__(self, at: Point, ends: Sequence[Leaving]) -> None:
        self.at = at
        self.ends = ends
        self.courses = [end.course for end in ends]
        self.twin: dict[int, int] = {}  # the two ends of each loop
        first: dict[int, int] = {}
        for place, end in enumerate(ends):
            other = first.setdefault(end.edge, place)
            if other != place:
                self.twin |= {other: place, place: other}

    def order(self, radius: float) -> list[Spoke]:
        """The order by the exits of this circle; raises `NoOrder`."""
        exits = [self._exit(place, radius) for place in range(len(self.ends))]
        rests = [self._rest(place, exits) for place in range(len(self.ends))]
        rows = sorted((*self._direction(rest), place) for place, rest in enumerate(rests))
        self._require_apart(rows, exits)
        self._require_free(rows, exits, rests)
        return [Spoke(place, *exits[place]) for *_, place in rows]

    def _exit(self, place: int, radius: float) -> _Exit:
        """Where an end leaves the circle; with a radius of 0, where it begins."""
        course = self.courses[place]
        crossing = _last_crossing(self.at, course, radius) if radius else None
        if crossing is None:
            begins = place in self.twin or not radius
            crossing = _Exit(course[0], 1) if begins else _half_way(course)
        return crossing

    def _rest(self, place: int, exits: Sequence[_Exit]) -> list[Point]:
        """What an edge does after its exit; of a loop, up to its other exit."""
        course, leaving = self.courses[place], exits[place]
        if place not in self.twin:
            return [leaving.at, *course[leaving.place :]]
        other = exits[self.twin[place]]
        return [leaving.at, *course[leaving.place : len(course) - other.place], other.at]

    def _direction(self, rest: Sequence[Point]) -> tuple[float, float]:
        """The bearing of the exit, and how far the edge turns there from the way back."""
        leaving = rest[0]
        ahead = next((point for point in rest if point != leaving), self.at)
        if leaving == self.at:
            return bearing(self.at, ahead), 0.0
        turn = (bearing(leaving, ahead) - bearing(leaving, self.at)) % _TURN
        return bearing(self.at, leaving), turn

    def _require_apart(
        self, rows: Sequence[tuple[float, float, int]], exits: Sequence[_Exit]
    ) -> None:
        """No two spokes in one direction, unless they end at one point, as streets may begin."""
        for (angle, turn, first), (other, next_turn, second) in pairwise([*rows, rows[0]]):
            if first == second or _EQUAL < (other - angle) % _TURN < _TURN - _EQUAL:
                continue
            at = exits[first].at
            has_order = at == exits[second].at != self.at and all(
                _EQUAL < t < _TURN - _EQUAL for t in (turn, next_turn, (next_turn - turn) % _TURN)
            )
            if not has_order:
                raise NoOrder(first, second)

    def _require_free(
        self,
        rows: Sequence[tuple[float, float, int]],
        exits: Sequence[_Exit],
        rests: Sequence[Sequence[Point]],
    ) -> None:
        """No spoke meets the rest of another edge, or its own, if that is a loop."""
        farthest = max(dist(self.at, leaving.at) for leaving in exits)
        bearings = [angle for angle, *_ in rows]
        for place, rest in enumerate(rests):
            tips = {rest[0], rest[-1]}
            for a, b in pairwise(rest):
                if a == b or self.at in (a, b) or projected(self.at, a, b)[1] > farthest:
                    continue
                for _, _, other in _between(
                    rows, bearings, bearing(self.at, a), bearing(self.at, b)
                ):
                    tip = exits[other].at
                    if other == place or (tip in tips and tip in (a, b)):
                        continue
                    if tip != self.at and _meet(self.at, tip, a, b):
                        raise NoOrder(other, place)


def _between(
    rows: Sequence[tuple[float, float, int]], bearings: Sequence[float], a: float, b: float
) -> Iterator[tuple[float, float, int]]:
    """The rows with bearings in the smaller angle between a and b."""
    if (b - a) % _TURN > pi:
        a, b = b, a
    first = bisect_left(bearings, a - _EQUAL)
    span = (b - a) % _TURN + 2 * _EQUAL
    for step in range(len(rows)):
        row = rows[(first + step) % len(rows)]
        if (row[0] - a + _EQUAL) % _TURN > span:
            return
        yield row


def _meet(p: Point, q: Point, a: Point, b: Point) -> bool:
    """Whether the segment from a to b touches that from p to q; a and b lie on either side."""
    return _side(p, q, a) * _side(p, q, b) <= 0 and _side(a, b, p) * _side(a, b, q) <= 0


def _side(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def projected(p: Point, a: Point, b: Point) -> tuple[float, float]:
    """How far along the segment from a to b its point nearest to p lies, and how far from p."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    square = dx * dx + dy * dy
    along = (p[0] - a[0]) * dx + (p[1] - a[1]) * dy
    share = min(max(along / square, 0.0), 1.0) if square else 0.0
    return share * sqrt(square), hypot(a[0] + share * dx - p[0], a[1] + share * dy - p[1])


def _last_crossing(at: Point, course: Sequence[Point], radius: float) -> _Exit | None:
    """Where the course leaves the circle for good."""
    after = dist(at, course[-1])
    for place in range(len(course) - 1, 0, -1):
        before = dist(at, course[place - 1])
        if before <= radius < after:
            (a, b), (c, d) = course[place - 1], course[place]
            x, y, dx, dy = a - at[0], b - at[1], c - a, d - b
            length, along = dx * dx + dy * dy, x * dx + y * dy
            root = along * along - length * (before - radius) * (before + radius)
            share = (sqrt(max(root, 0.0)) - along) / length
            return _Exit((a + share * dx, b + share * dy), place)
        after = before
    return None


def _half_way(course: Sequence[Point]) -> _Exit:
    lengths = [dist(a, b) for a, b in pairwise(course)]
    left = sum(lengths) / 2
    place = 0
    while left > lengths[place]:
        left -= lengths[place]
        place += 1
    (a, b), (c, d) = course[place], course[place + 1]
    share = left / lengths[place]
    return _Exit((a + (c - a) * share, b + (d - b) * share), place + 1)
