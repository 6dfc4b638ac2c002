"""Makes a world of a drawing: places (vertices with coordinates) and ways (edges with polylines).

The rotation at a place is the clockwise order, from the north on, of the directions in which its
ways leave. Where they begin at its point, their first segments are compared exactly, in fractions
where floating point does not decide; else junctions.py finds the order. A directed way with the
course (polyline) of an earlier one backwards is merged with it.

Source: docs/formats.md, "Drawings".
"""

from __future__ import annotations

import logging
from collections import Counter
from collections.abc import Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from functools import cache, cmp_to_key
from itertools import pairwise
from math import dist, inf, sqrt
from typing import NamedTuple, TypeVar

from topo_verify.errors import InputError, plural, shown
from topo_verify.world.formats import junctions
from topo_verify.world.formats.flaws import MOST, Flaws
from topo_verify.world.formats.junctions import Leaving, Point
from topo_verify.world.rooted_map import World

W = TypeVar("W", bound=World)

REMARKS = logging.getLogger("topo_verify.world.formats")
"""The logger of remarks about a file; commands print them as notes on stderr."""

MOST_EDGES = 500_000

MOST_POINTS = 1_000_000


class DrawnVertex(NamedTuple):
    """A vertex of the drawing."""

    name: str
    at: Point
    incoming: Sequence[str] = ()  # clockwise: names of edges that lead here, where the file says it


class DrawnEdge(NamedTuple):
    """An edge of the drawing, between vertices by their numbers."""

    start: int
    end: int
    course: Sequence[Point] = ()  # from start to end; empty: straight
    directed: bool = False
    name: str = ""  # for messages
    street: str = ""  # the same for both directions, where the file says it


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
    largest_part: bool = False,
) -> W:
    """The world of the drawing; by default the marker is the first dart of the first place.

    Args:
        flaws: what the reader found; refused together with what is found here.
        largest_part: keep only the largest part, and remark what is left out.
    Raises:
        InputError: equal directions, a way of one point, a place without a way, several parts.
    """
    if not places and not flaws:
        raise InputError(f"{flaws.source} has no vertex: a world has one at least")
    if largest_part and not flaws:
        places, ways = _largest_part(places, ways, flaws.source)
    drawn: list[DrawnEdge] = []
    courses: list[tuple[Point, ...]] = []
    for way in ways:
        with flaws:
            courses.append(_course(way, places))
            drawn.append(way)
    _require_near(places, drawn, courses, flaws)
    kept, same = _merged(drawn, courses)
    rotations: list[list[DrawnEnd]] = []
    for place, ends in zip(places, _exits(places, drawn, kept), strict=True):
        with flaws:
            rotations.append(_clockwise(place, ends, courses, drawn))
    _require_connected(places, ways, flaws)
    flaws.refuse()
    dart = {end: n for n, end in enumerate(end for row in rotations for end in row)}
    if marker and marker.way in same:
        marker = DrawnEnd(same[marker.way], 1 - marker.side)
    world = cls.from_rotations(
        [[dart[end] for end in row] for row in rotations],
        [(dart[DrawnEnd(way, 0)], dart[DrawnEnd(way, 1)]) for way in kept],
        dart[marker] if marker else 0 if dart else None,
        name=name,
        vertex_names=tuple(place.name for place in places),
        positions=tuple(place.at for place in places),
    )
    # a file that is refused gets one sentence
    _say_merged(drawn, kept, same, flaws.source)
    _say_stated_orders(places, drawn, rotations, same, flaws.source)
    return world


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


def _require_near(
    places: Sequence[DrawnVertex],
    ways: Sequence[DrawnEdge],
    courses: Sequence[Sequence[Point]],
    flaws: Flaws,
) -> None:
    """Add polylines that have nothing to do with their vertices to the flaws."""
    allowed: list[float] = []
    offsets: list[list[float]] = []
    extents = [0.0] * len(places)
    for way, course in zip(ways, courses, strict=True):
        start, end = places[way.start].at, places[way.end].at
        is_loop = way.start == way.end
        length = sum(dist(a, b) for a, b in pairwise(course)) if is_loop else dist(start, end)
        allowed.append(length / 2)
        offsets.append([dist(course[0], start), dist(course[-1], end)])
        for vertex, offset in zip((way.start, way.end), offsets[-1], strict=True):
            if offset <= length / 2:
                extents[vertex] = max(extents[vertex], offset)
    for way, most, row in zip(ways, allowed, offsets, strict=True):
        for vertex, offset in zip((way.start, way.end), row, strict=True):
            if offset <= most + extents[vertex]:
                continue
            extent = f" and {extents[vertex]:.6g} for its extent" if extents[vertex] else ""
            with flaws:
                raise InputError(
                    f"edge '{shown(way.name, limit=60)}' has an end {offset:.6g} away from its"
                    f" vertex '{shown(places[vertex].name)}', expected {most:.6g} at most{extent}:"
                    " give vertices and polylines in the same coordinates"
                )


def _merged(
    ways: Sequence[DrawnEdge], courses: Sequence[tuple[Point, ...]]
) -> tuple[list[int], dict[int, int]]:
    """The ways that stay, and by each other way the one that it repeats."""

    @cache
    def precision(n: int) -> tuple[float, float]:
        return _rounding(courses[n]), _bend(courses[n])

    def have_one_name(n: int, back: int) -> bool:
        return bool(ways[n].street) and ways[n].street == ways[back].street

    def have_one_course(n: int, back: int) -> bool:
        course, other = courses[n], courses[back][::-1]
        if course == other:
            return True
        most = sqrt(2) * min(precision(n)[0], precision(back)[0])
        return _lies_along(course, other, most) and _lies_along(other, course, most)

    def are_straight(n: int, back: int) -> bool:
        (rounding, bend), (other, other_bend) = precision(n), precision(back)
        return ways[n].start != ways[n].end and max(bend, other_bend) <= min(rounding, other)

    kept: list[int] = []
    same: dict[int, int] = {}
    waiting: dict[tuple[int, int], list[int]] = {}
    for number, way in enumerate(ways):
        opposite = waiting.get((way.end, way.start), []) if way.directed else []
        partners = (
            n
            for are_one in (have_one_name, have_one_course, are_straight)
            for n in opposite
            if are_one(n, number)
        )
        partner = next(partners, None)
        if partner is not None:
            same[number] = partner
            opposite.remove(partner)
            continue
        kept.append(number)
        if way.directed:
            waiting.setdefault((way.start, way.end), []).append(number)
    return kept, same


def _bend(course: Sequence[Point]) -> float:
    """How far the course goes away from the line between its ends."""
    (a, b), (c, d) = course[0], course[-1]
    doubled = (abs((x - a) * (d - b) - (y - b) * (c - a)) for x, y in course[1:-1])
    length = dist(course[0], course[-1])
    return max(doubled, default=0.0) / length if length else inf


def _rounding(course: Sequence[Point]) -> float:
    """How far two roundings of a coordinate differ: a unit of the last digit, with its error.

    At most a hundredth of the street's length, since whole numbers need not be rounded.
    """
    numbers = [number for point in course for number in point]
    unit = min(10.0 ** int(Decimal(repr(n)).normalize().as_tuple().exponent) for n in numbers)
    length = sum(dist(a, b) for a, b in pairwise(course))
    return min(1.01 * unit + 1e-12 * max(map(abs, numbers)), length / 100)


def _lies_along(points: Sequence[Point], course: Sequence[Point], most: float) -> bool:
    """Whether the points lie on the course in their order, at a distance of at most `most`."""
    segments = pairwise(course)
    segment = next(segments)
    passed = 0.0
    for point in points:
        along, away = junctions.projected(point, *segment)
        while away > most or along < passed - most:
            following = next(segments, None)
            if following is None:
                return False
            segment, passed = following, 0.0
            along, away = junctions.projected(point, *segment)
        passed = along
    return True


def _say_merged(
    ways: Sequence[DrawnEdge], kept: Sequence[int], same: dict[int, int], source: str
) -> None:
    there = Counter((ways[n].start, ways[n].end) for n in kept if ways[n].directed)
    back = Counter((ways[n].end, ways[n].start) for n in kept if ways[n].directed)
    double = sum(min(there[pair], back[pair]) for pair in there if pair[0] < pair[1])
    if same or double:
        merged = f"{source}: merged {plural(len(same), 'two-way street')} into one edge each"
        apart = f", kept {double} double, whose two directions have different courses"
        REMARKS.info(merged + apart * (double > 0))


def _say_stated_orders(
    places: Sequence[DrawnVertex],
    ways: Sequence[DrawnEdge],
    rotations: Sequence[Sequence[DrawnEnd]],
    same: Mapping[int, int],
    source: str,
) -> None:
    """Remark at which vertices the file states another order than the drawing."""
    end_of = {
        way.name: DrawnEnd(same[number], 0) if number in same else DrawnEnd(number, 1)
        for number, way in enumerate(ways)
    }
    others: list[str] = []
    for place, rotation in zip(places, rotations, strict=True):
        number = {end: n for n, end in enumerate(rotation)}
        ends = dict.fromkeys(end_of[name] for name in place.incoming if name in end_of)
        row = [number[end] for end in ends if end in number]
        if sum(a > b for a, b in pairwise([*row, *row[:1]])) > 1:  # it ascends but for one fall
            others.append(f"'{shown(place.name, limit=60)}'")
    if others:
        REMARKS.warning(
            f"{source}: at {plural(len(others), 'vertex', 'vertices')} the file states another"
            f" clockwise order than that of the drawing, which is read: {', '.join(others[:3])}"
            + ", …"
            * (len(others) > 3)
        )


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
    places: Sequence[DrawnVertex], ways: Sequence[DrawnEdge], kept: Sequence[int]
) -> list[list[DrawnEnd]]:
    exits: list[list[DrawnEnd]] = [[] for _ in places]
    for number in kept:
        exits[ways[number].start].append(DrawnEnd(number, 0))
        exits[ways[number].end].append(DrawnEnd(number, 1))
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
    places: Sequence[DrawnVertex], ways: Sequence[DrawnEdge], source: str
) -> tuple[Sequence[DrawnVertex], Sequence[DrawnEdge]]:
    """The part with the most vertices, the first of several; what is left out is remarked."""
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
    REMARKS.info(
        f"{source}: the largest part is kept, {len(largest):,} of {len(places):,} vertices and"
        f" {len(kept):,} of {len(ways):,} edges; left out:"
        f" {plural(len(others), 'part')} with {listed}"
    )
    return [places[old] for old in number], kept


def _clockwise(
    place: DrawnVertex,
    ends: Sequence[DrawnEnd],
    courses: Sequence[Sequence[Point]],
    ways: Sequence[DrawnEdge],
) -> list[DrawnEnd]:
    outwards = [courses[way][:: -1 if side else 1] for way, side in ends]
    leaving = [
        Leaving(way, course)
        for (way, _), course in zip(ends, junctions.snapped(place.at, outwards), strict=True)
    ]
    if any(course[0] != place.at for _, course in leaving):
        return _around_extent(place, ends, leaving, ways)
    row = sorted(
        (
            _LeavingEnd(end, course[0], course[1])
            for end, (_, course) in zip(ends, leaving, strict=True)
        ),
        key=cmp_to_key(_compared),
    )
    for first, second in pairwise(row):
        if _compared(first, second) == 0:
            names = [shown(ways[leaving.end.way].name, limit=60) for leaving in (first, second)]
            raise InputError(
                f"at vertex '{shown(place.name)}' two edges leave at the same angle,"
                f" '{names[0]}' toward {first.toward} and '{names[1]}' toward {second.toward}, so"
                " neither comes first: move a point of one of them, or leave one out"
            )
    return [first.end for first in row]


def _around_extent(
    place: DrawnVertex,
    ends: Sequence[DrawnEnd],
    leaving: Sequence[Leaving],
    ways: Sequence[DrawnEdge],
) -> list[DrawnEnd]:
    try:
        return [ends[spoke.end] for spoke in junctions.clockwise(place.at, leaving)]
    except junctions.NoOrder as met:
        first, second = (shown(ways[ends[n].way].name, limit=60) for n in met.pair)
        farthest = max(dist(place.at, course[0]) for _, course in leaving)
        raise InputError(
            f"at vertex '{shown(place.name)}' edges begin up to {farthest:.6g} from its point, and"
            f" their order is not clear, since '{first}' and '{second}' meet on every way from"
            " the point to where they leave: let one of them begin at the point, or leave it out"
        ) from met


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
