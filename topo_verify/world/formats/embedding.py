"""Makes a world of a drawing: places (vertices with coordinates) and ways (edges with polylines).

The rotation at a place is the clockwise order, from the north on, of the directions in which its
ways leave. Directions are compared exactly, in fractions where floating point does not decide. A
directed way whose course (polyline) is that of an earlier one backwards is merged with it.

Source: docs/formats.md, "Drawings".
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from functools import cmp_to_key
from itertools import pairwise
from math import dist
from typing import NamedTuple, TypeVar

from topo_verify.errors import InputError, plural, shown
from topo_verify.world.formats.flaws import MOST, Flaws
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)

Point = tuple[float, float]

Note = Callable[[str], None]
"""A function that is called with a sentence about what was read."""

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
    flaws: Flaws,
    *,
    name: str = "",
    marker: DrawnEnd | None = None,
    largest_part: Note | None = None,
) -> W:
    """The world of the drawing; by default the marker is the first dart of the first place.

    Args:
        flaws: what the reader found; refused together with what is found here.
        largest_part: keep only the largest part, and tell this function what is left out.
    Raises:
        InputError: equal directions, a way of one point, a place without a way, several parts.
    """
    if not places and not flaws:
        raise InputError(f"{flaws.source} has no vertex: a world has one at least")
    if largest_part is not None and not flaws:
        places, ways = _largest_part(places, ways, flaws.source, largest_part)
    drawn: list[DrawnEdge] = []
    courses: list[tuple[Point, ...]] = []
    for way in ways:
        with flaws:
            courses.append(_course(way, places))
            drawn.append(way)
    kept, same = _merged(drawn, courses)
    rotations: list[list[DrawnEnd]] = []
    for place, row in zip(places, _exits(places, drawn, courses, kept), strict=True):
        with flaws:
            rotations.append(_clockwise(place, row, drawn))
    _require_connected(places, ways, flaws)
    flaws.refuse()
    dart = {end: n for n, end in enumerate(end for row in rotations for end in row)}
    if marker and marker.way in same:
        marker = DrawnEnd(same[marker.way], 1 - marker.side)
    try:
        return cls.from_rotations(
            [[dart[end] for end in row] for row in rotations],
            [(dart[DrawnEnd(way, 0)], dart[DrawnEnd(way, 1)]) for way in kept],
            dart[marker] if marker else 0 if dart else None,
            name=name,
            vertex_names=tuple(place.name for place in places),
            positions=tuple(place.at for place in places),
        )
    except InputError as error:
        raise InputError(f"{flaws.source}: {error}") from error


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
    return exits


def _parts(places: Sequence[DrawnVertex], ways: Sequence[DrawnEdge]) -> list[list[int]]:
    """The vertices of each connected part, the part with the most vertices first."""
    beside: list[list[int]] = [[] for _ in places]
    for way in ways:
        beside[way.start].append(way.end)
        beside[way.end].append(way.start)
    parts: list[list[int]] = []
    reached: set[int] = set()
    for first in range(len(places)):
        if first not in reached:
            reached.add(first)
            part = [first]
            for at in part:
                fresh = [*dict.fromkeys(other for other in beside[at] if other not in reached)]
                reached.update(fresh)
                part += fresh
            parts.append(part)
    return sorted(parts, key=len, reverse=True)


def _require_connected(
    places: Sequence[DrawnVertex], ways: Sequence[DrawnEdge], flaws: Flaws
) -> None:
    """Add vertices without an edge to the flaws, and, if there are no others, that of parts."""
    parts = _parts(places, ways)
    mend = "leave it out, or keep the largest part (`world convert FILE --largest-part`)"
    for part in parts[1:]:
        if len(part) == 1 and part[0] not in flaws.touched:
            with flaws:
                raise InputError(
                    f"vertex '{shown(places[part[0]].name)}' has no edge, so the world is not"
                    f" connected: {mend}"
                )
    if len(parts) > 1 and not flaws:
        first, other = (shown(places[part[0]].name) for part in parts[:2])
        with flaws:
            raise InputError(
                f"the world is not connected: no way leads from vertex '{first}' to vertex"
                f" '{other}' ({len(parts[0])} of {len(places)} vertices are in the largest of"
                f" {len(parts)} parts): {mend}"
            )


def _largest_part(
    places: Sequence[DrawnVertex], ways: Sequence[DrawnEdge], source: str, tell: Note
) -> tuple[Sequence[DrawnVertex], Sequence[DrawnEdge]]:
    """The part with the most vertices, the first of several; what is left out is told."""
    largest, *others = _parts(places, ways)
    if not others:
        return places, ways
    number = {old: new for new, old in enumerate(sorted(largest))}
    kept = [
        way._replace(start=number[way.start], end=number[way.end])
        for way in ways
        if way.start in number
    ]
    names = [f"'{shown(places[vertex].name, limit=60)}'" for part in others for vertex in part]
    listed = ", ".join([*names[:MOST], *["…"][: len(names) > MOST]])
    tell(
        f"{source}: the largest part is kept, {len(largest):,} of {len(places):,} vertices and"
        f" {len(kept):,} of {len(ways):,} edges; left out:"
        f" {plural(len(others), 'part')} with {listed}"
    )
    return [places[old] for old in number], kept


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
