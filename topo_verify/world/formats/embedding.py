"""Makes a world of a drawing: places (vertices with coordinates) and ways (edges with polylines).

The rotation at a place is the clockwise order, from the north on, of the directions in which its
ways leave. Directions are compared exactly, in fractions where floating point does not decide. A
directed way whose course (polyline) is that of an earlier one backwards is merged with it.

Source: docs/formats.md, "Drawings".
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from contextlib import suppress
from fractions import Fraction
from functools import cmp_to_key
from itertools import pairwise
from math import dist
from typing import Any, NamedTuple, TypeVar

from topo_verify.errors import InputError, shown
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)

Point = tuple[float, float]

FARTHEST = 1e12
"""The largest coordinate: products must not overflow."""


MOST_EDGES = 500_000

MOST_POINTS = 1_000_000


class DrawnVertex(NamedTuple):
    """A vertex of the drawing."""

    name: str
    at: Point


class DrawnEdge(NamedTuple):
    """An edge of the drawing, between vertices by their numbers."""

    start: int
    end: int
    course: Sequence[Point] = ()  # from start to end; empty: straight
    directed: bool = False
    name: str = ""  # for messages


class DrawnEnd(NamedTuple):
    """One end of an edge; side 0 is its start."""

    way: int
    side: int


def as_world(
    cls: type[W],
    places: Sequence[DrawnVertex],
    ways: Sequence[DrawnEdge],
    *,
    source: str,
    name: str = "",
    marker: DrawnEnd | None = None,
) -> W:
    """The world of the drawing; by default the marker is the first dart of the first place.

    Raises:
        InputError: equal directions, a way of one point, a place without a way, several parts.
    """
    if not places:
        raise InputError(f"{source} has no vertex: a world has one at least")
    try:
        courses = [_course(way, places) for way in ways]
        kept, same = _merged(ways, courses)
        exits = _exits(places, ways, courses, kept)
        rotations = [_clockwise(place, row, ways) for place, row in zip(places, exits, strict=True)]
        _require_connected(places, [ways[number] for number in kept])
        dart = {end: n for n, end in enumerate(end for row in rotations for end in row)}
        if marker and marker.way in same:
            marker = DrawnEnd(same[marker.way], 1 - marker.side)
        return cls.from_rotations(
            [[dart[end] for end in row] for row in rotations],
            [(dart[DrawnEnd(way, 0)], dart[DrawnEnd(way, 1)]) for way in kept],
            dart[marker] if marker else 0 if dart else None,
            name=name,
            vertex_names=tuple(place.name for place in places),
            positions=tuple(place.at for place in places),
        )
    except InputError as error:
        raise InputError(f"{source}: {error}") from error


def _course(way: DrawnEdge, places: Sequence[DrawnVertex]) -> tuple[Point, ...]:
    start, end = places[way.start], places[way.end]
    points = list(way.course) or [start.at, end.at]
    course = (points[0], *(b for a, b in pairwise(points) if a != b))
    if len(course) < 2:
        subject = "a loop that is" if way.start == way.end else "an edge that is"
        raise InputError(
            f"at vertex '{shown(start.name)}' begins {subject} a single point, so it leaves in"
            " no direction: give it a geometry with two different points, or leave it out"
        )
    as_is = dist(course[0], start.at) + dist(course[-1], end.at)
    turned = dist(course[-1], start.at) + dist(course[0], end.at)
    return course[::-1] if turned < as_is else course


def _merged(
    ways: Sequence[DrawnEdge], courses: Sequence[tuple[Point, ...]]
) -> tuple[list[int], dict[int, int]]:
    """The ways that stay, and by each other way the one that it repeats."""
    kept: list[int] = []
    same: dict[int, int] = {}
    waiting: dict[tuple[int, int, tuple[Point, ...]], list[int]] = {}
    for number, (way, course) in enumerate(zip(ways, courses, strict=True)):
        partners = waiting.get((way.end, way.start, course[::-1])) if way.directed else None
        if partners:
            same[number] = partners.pop(0)
            continue
        kept.append(number)
        if way.directed:
            waiting.setdefault((way.start, way.end, course), []).append(number)
    return kept, same


class _LeavingEnd(NamedTuple):
    """An end of a way, and the two points of its direction."""

    end: DrawnEnd
    origin: Point
    toward: Point

    @property
    def direction(self) -> Point:
        return self.toward[0] - self.origin[0], self.toward[1] - self.origin[1]

    @property
    def westward(self) -> bool:
        x, y = self.direction
        return x < 0 or (x == 0 and y < 0)

    @property
    def exact(self) -> tuple[Fraction, Fraction]:
        (a, b), (c, d) = self.origin, self.toward
        return Fraction(c) - Fraction(a), Fraction(d) - Fraction(b)


def _exits(
    places: Sequence[DrawnVertex],
    ways: Sequence[DrawnEdge],
    courses: Sequence[tuple[Point, ...]],
    kept: Sequence[int],
) -> list[list[_LeavingEnd]]:
    exits: list[list[_LeavingEnd]] = [[] for _ in places]
    for number in kept:
        way, course = ways[number], courses[number]
        exits[way.start].append(_LeavingEnd(DrawnEnd(number, 0), course[0], course[1]))
        exits[way.end].append(_LeavingEnd(DrawnEnd(number, 1), course[-1], course[-2]))
    for place, row in zip(places, exits, strict=True):
        if not row and len(places) > 1:
            raise InputError(
                f"vertex '{shown(place.name)}' has no edge, so the world is not connected:"
                " leave the vertex out"
            )
    return exits


def _require_connected(places: Sequence[DrawnVertex], ways: Sequence[DrawnEdge]) -> None:
    beside: list[list[int]] = [[] for _ in places]
    for way in ways:
        beside[way.start].append(way.end)
        beside[way.end].append(way.start)
    reached = {0: None}
    queue = [0]
    for at in queue:
        fresh = dict.fromkeys(other for other in beside[at] if other not in reached)
        reached |= fresh
        queue += fresh
    for number, place in enumerate(places):
        if number not in reached:
            raise InputError(
                f"the world is not connected: no way leads from vertex"
                f" '{shown(places[0].name)}' to vertex '{shown(place.name)}'; keep one"
                f" of the parts ({len(queue)} of {len(places)} vertices are in the first)"
            )


def _clockwise(
    place: DrawnVertex, exits: Sequence[_LeavingEnd], ways: Sequence[DrawnEdge]
) -> list[DrawnEnd]:
    row = sorted(exits, key=cmp_to_key(_compared))
    for first, second in pairwise(row):
        if _compared(first, second) == 0:
            names = [shown(ways[leaving.end.way].name, limit=60) for leaving in (first, second)]
            raise InputError(
                f"at vertex '{shown(place.name)}' two edges leave at the same angle,"
                f" '{names[0]}' toward {first.toward} and '{names[1]}' toward {second.toward}, so"
                " neither comes first: move a point of one of them, or leave one out"
            )
    return [first.end for first in row]


def _compared(first: _LeavingEnd, second: _LeavingEnd) -> int:
    """Negative if `first` comes first clockwise from the north, 0 for the same direction."""
    if first.westward != second.westward:
        return 1 if first.westward else -1
    # less than half a turn lies between them, so a·d > b·c iff `second` comes first
    (a, b), (c, d) = first.direction, second.direction
    ahead, back = a * d, b * c
    if abs(ahead - back) > 1e-12 * (abs(ahead) + abs(back)):
        return 1 if ahead > back else -1
    (p, q), (r, s) = first.exact, second.exact
    turn = p * s - q * r
    return (turn > 0) - (turn < 0)


def require_size(name: str, *, vertices: int, edges: int, points: int) -> None:
    """Refuse a file as soon as it exceeds the promised memory."""
    if vertices > MOST_EDGES + 1 or edges > MOST_EDGES or points > MOST_POINTS:
        raise InputError(
            f"{name}: expected at most {MOST_EDGES:,} edges, their vertices, and"
            f" {MOST_POINTS:,} points in all polylines, and it has more: give a part of it, or"
            " simplify the polylines"
        )


def number(value: Any, subject: str, most: float = FARTHEST) -> float:
    """The value as a coordinate, at most `most` either way."""
    with suppress(TypeError, ValueError, OverflowError):
        coordinate = float(value)
        if abs(coordinate) <= most:
            return coordinate + 0.0  # not -0.0
    # long integers cannot be printed
    got = "an integer" if isinstance(value, int) else repr(value)
    raise InputError(
        f"{subject} is {shown(got, limit=60)}, expected a number of at most {most:.0e} in size"
    )


def line(text: str, subject: str) -> tuple[Point, ...]:
    """The points of well-known text, `LINESTRING (0 0, 1 2)`, without heights."""
    match = re.fullmatch(r"\s*LINESTRING\s*(?:Z\s*)?\(([^()]*)\)\s*", text, re.IGNORECASE)
    if not match:
        raise InputError(
            f"{subject} is '{shown(text, limit=60)}', expected a line as LINESTRING (0 0, 1 2)"
        )
    # a list of texts would take ten times the memory
    return points((part.split() for part in _parts(match[1])), subject)


def _parts(text: str) -> Iterator[str]:
    begin = 0
    while (comma := text.find(",", begin)) >= 0:
        yield text[begin:comma]
        begin = comma + 1
    yield text[begin:]


def points(rows: Iterable[Sequence[object]], subject: str) -> tuple[Point, ...]:
    """The points of a polyline, without heights."""
    return tuple(_point(row, subject) for row in rows)


def _point(row: Sequence[object], subject: str) -> Point:
    if len(row) not in {2, 3}:
        raise InputError(
            f"{subject} has a point of {len(row)} coordinates, expected x and y: give it both"
        )
    return number(row[0], subject), number(row[1], subject)
