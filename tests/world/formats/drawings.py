"""Random planar drawings of known worlds, with junctions that have an extent.

A drawing begins as a plane triangulation with edges left out, some bent, some doubled, some loops;
its rotations are known. Then its edges begin

- at the `point` of their vertex;
- on the `rim` of a circle around it;
- on a rim that was `twisted`: homeomorphisms of the plane turn what lies around some points;
- on such a rim, around a vertex that lies anywhere `within` it;
- at the nodes of a `cluster` that was joined into the vertex, as SUMO does: a tree of nodes around
  any point, each with some consecutive edges.

None of this changes a rotation, so a reader has to find it again. Drawings that cross are dropped.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from math import cos, dist, pi, sin
from random import Random
from typing import Any, cast

import shapely  # type: ignore[import-untyped]

from topo_verify.world import World
from topo_verify.world.formats.junctions import Point, bearing

KINDS = ("point", "rim", "twisted", "within", "cluster")

End = tuple[int, int]
"""An edge's number, and 0 for its start, 1 for its end."""


@dataclass(frozen=True)
class Road:
    """An edge of a drawing."""

    start: int
    end: int
    course: Sequence[Point]


@dataclass(frozen=True)
class Drawing:
    """A drawn world; the marker points along its first edge."""

    at: Sequence[Point]
    roads: Sequence[Road]
    rotations: Sequence[Sequence[End]]  # clockwise

    @property
    def world(self) -> World:
        """The world that is drawn."""
        ends = [end for row in self.rotations for end in row]
        dart = {end: number for number, end in enumerate(ends)}
        return World.from_rotations(
            [[dart[end] for end in row] for row in self.rotations],
            [(dart[road, 0], dart[road, 1]) for road in range(len(self.roads))],
            dart[0, 0],
        )

    def moved(self, move: Callable[[Point], Point]) -> Drawing:
        """The drawing with its points moved."""
        roads = [replace(road, course=[*map(move, road.course)]) for road in self.roads]
        return replace(self, at=[*map(move, self.at)], roads=roads)

    def turned(self, angle: float) -> Drawing:
        """The drawing turned clockwise."""
        c, s = cos(angle), sin(angle)
        return self.moved(lambda p: (p[0] * c + p[1] * s, p[1] * c - p[0] * s))

    def mirrored(self) -> Drawing:
        """The mirror image."""
        rotations = [row[::-1] for row in self.rotations]
        return replace(self.moved(lambda p: (-p[0], p[1])), rotations=rotations)

    def shaken(self, random: Random, most: float) -> Drawing:
        """The drawing whose edges begin and end up to so far from where they did."""

        def near(p: Point) -> Point:
            return p[0] + random.uniform(-most, most), p[1] + random.uniform(-most, most)

        roads = [
            replace(r, course=[near(r.course[0]), *r.course[1:-1], near(r.course[-1])])
            for r in self.roads
        ]
        return replace(self, roads=roads)


def rounded(drawn: Drawing, digits: int) -> Drawing:
    """The drawing with so many decimals."""
    return drawn.moved(lambda p: (round(p[0], digits), round(p[1], digits)))


def crossings(courses: Sequence[Sequence[Point]]) -> int:
    """How often two of the courses cross or touch elsewhere than at common ends."""
    lines: list[Any] = [shapely.LineString(course) for course in courses]
    pairs = cast("Any", shapely.STRtree(lines)).query(lines, predicate="intersects")
    number = 0
    for one, other in zip(*pairs.tolist(), strict=True):
        if one < other:
            ends: set[Point] = {courses[n][e] for n in (one, other) for e in (0, -1)}
            common: Any = lines[one].intersection(lines[other])
            parts = getattr(common, "geoms", [common])
            number += sum(part.geom_type != "Point" or part.coords[0] not in ends for part in parts)
    return number


def drawing(kind: str, random: Random) -> Drawing:
    """A drawing of this kind without a crossing, about 400 wide; junctions of 1 to 15."""
    while True:
        plane = _with_loops(_plane(random, rows=3, columns=4), random)
        radius = random.uniform(1, 15)
        match kind:
            case "point":
                drawn = plane
            case "rim":
                drawn, _ = _trimmed(plane, radius, random)
            case "twisted":
                drawn = _twisted(*_trimmed(plane, radius, random), random)
            case "within":
                drawn, extents = _trimmed(plane, radius, random)
                drawn = _twisted(drawn, extents, random)
                moved = [_near(p, r / 2, random) for p, r in zip(drawn.at, extents, strict=True)]
                drawn = replace(drawn, at=moved)
            case _:
                drawn = _clustered(plane, radius, random)
        if not crossings([road.course for road in drawn.roads]):
            return drawn


def _plane(random: Random, *, rows: int, columns: int) -> Drawing:
    """Part of a triangulation, connected."""
    at = [
        (100 * (c + r % 2 / 2 + random.uniform(-0.2, 0.2)), 87 * (r + random.uniform(-0.2, 0.2)))
        for r in range(rows)
        for c in range(columns)
    ]
    pairs = [
        (r * columns + c, (r + down) * columns + c + aside)
        for r in range(rows)
        for c in range(columns)
        for down, aside in ((0, 1), (1, 0), (1, 1 if r % 2 else -1))
        if r + down < rows and 0 <= c + aside < columns
    ]
    random.shuffle(pairs)
    part = list(range(len(at)))
    share = random.choice([0.3, 0.7, 1])
    roads: list[Road] = []
    for a, b in pairs:
        joins = part[a] != part[b]
        part = [part[a] if p == part[b] else p for p in part]
        if joins or random.random() < share:
            bend = random.choice([0, 0, random.uniform(-0.12, 0.12)])
            roads.append(Road(a, b, _bent(at[a], at[b], bend, random)))
            if random.random() < 0.1:  # a parallel one
                bend = random.choice([-1, 1]) * random.uniform(0.13, 0.2)
                roads.append(Road(a, b, _bent(at[a], at[b], bend, random)))
    return Drawing(at, roads, _rotations(at, roads))


def _bent(a: Point, b: Point, bend: float, random: Random) -> list[Point]:
    x, y = b[0] - a[0], b[1] - a[1]
    places = sorted(random.uniform(0.3, 0.7) for _ in range(random.randint(1, 3))) if bend else []
    return [a, *((a[0] + x * t - y * bend, a[1] + y * t + x * bend) for t in places), b]


def _rotations(at: Sequence[Point], roads: Sequence[Road]) -> list[list[End]]:
    """The clockwise ends of roads that begin at the points."""
    rows: list[list[tuple[float, End]]] = [[] for _ in at]
    for number, road in enumerate(roads):
        for side, vertex in enumerate((road.start, road.end)):
            rows[vertex].append((bearing(*_first_segment(road, side)), (number, side)))
    return [[end for _, end in sorted(row)] for row in rows]


def _first_segment(road: Road, side: int) -> tuple[Point, Point]:
    first, second, *_ = road.course[:: -1 if side else 1]
    return first, second


def _with_loops(plane: Drawing, random: Random) -> Drawing:
    """Loops of any size in the widest gap of some vertices."""
    roads = list(plane.roads)
    for at, row in zip(plane.at, plane.rotations, strict=True):
        if random.random() < 0.15:
            angles = [bearing(*_first_segment(plane.roads[n], side)) for n, side in row]
            after = [*angles[1:], angles[0] + 2 * pi]
            gap, angle = max((b - a, a) for a, b in zip(angles, after, strict=True))
            wide, size, vertex = min(gap, pi) / 5, random.uniform(2, 30), plane.at.index(at)
            tips = [
                (
                    at[0] + size * far * sin(angle + gap / 2 + t),
                    at[1] + size * far * cos(angle + gap / 2 + t),
                )
                for t, far in ((-wide, 1.0), (0.0, 1.2), (wide, 1.0))
            ]
            roads.append(Road(vertex, vertex, [at, *tips, at]))
    return Drawing(plane.at, roads, _rotations(plane.at, roads))


def _near(p: Point, most: float, random: Random) -> Point:
    return p[0] + random.uniform(-most, most), p[1] + random.uniform(-most, most)


def _trimmed(plane: Drawing, radius: float, random: Random) -> tuple[Drawing, list[float]]:
    """What lies outside of circles around some vertices, and their radii; short loops stay."""
    extents = [radius * random.choice([0, random.uniform(0.5, 1)]) for _ in plane.at]
    roads: list[Road] = []
    for road in plane.roads:
        line: Any = shapely.LineString(road.course)
        for vertex in {road.start, road.end}:
            circle = shapely.Point(plane.at[vertex]).buffer(extents[vertex], quad_segs=64)
            rest: Any = line.difference(circle) if extents[vertex] else line
            line = line if rest.is_empty or rest.geom_type != "LineString" else rest
        roads.append(replace(road, course=[(x, y) for x, y in line.coords]))
    return replace(plane, roads=roads), extents


def _twisted(plane: Drawing, extents: Sequence[float], random: Random) -> Drawing:
    for _ in range(random.randint(2, 12)):
        vertex = random.randrange(len(plane.at))
        centre = _near(plane.at[vertex], 1.5 * extents[vertex], random)
        reach = random.uniform(1.5, 4) * max(extents[vertex], 3)
        most = random.uniform(-pi / 2, pi / 2)

        def twist(p: Point, o: Point = centre, reach: float = reach, most: float = most) -> Point:
            angle = most * max(0.0, 1 - (dist(p, o) / reach) ** 2) ** 2
            c, s, x, y = cos(angle), sin(angle), p[0] - o[0], p[1] - o[1]
            return (o[0] + x * c + y * s, o[1] + y * c - x * s) if angle else p

        roads = [replace(road, course=_fine(road.course, centre, reach)) for road in plane.roads]
        plane = replace(plane, roads=roads).moved(twist)
    return plane


def _fine(course: Sequence[Point], centre: Point, reach: float) -> list[Point]:
    """The course in short steps near the centre."""
    points = [course[0]]
    for a, b in pairwise(course):
        line = shapely.LineString([a, b])
        steps = 1
        if line.distance(shapely.Point(centre)) < reach:
            steps = int(12 * line.length / reach) + 1
        points += [
            (a[0] + (b[0] - a[0]) * n / steps, a[1] + (b[1] - a[1]) * n / steps)
            for n in range(1, steps)
        ]
        points.append(b)
    return points


def _clustered(plane: Drawing, radius: float, random: Random) -> Drawing:
    for vertex in range(len(plane.at)):
        for _ in range(30):
            drawn = _split(plane, vertex, radius * random.uniform(0.5, 1), random)
            if drawn is not None:
                plane = drawn
                break
    return plane


def _split(plane: Drawing, vertex: int, radius: float, random: Random) -> Drawing | None:
    """The vertex as a star of nodes; None if they or their edges cross, or change the order."""
    middle, row = plane.at[vertex], plane.rotations[vertex]
    cuts = sorted(random.sample(range(len(row)), random.randint(1, min(len(row), 4))))
    turns = [*row, *row]
    groups = [turns[a:b] for a, b in pairwise([*cuts, cuts[0] + len(row)])]
    centre = _near(middle, radius / 1.5, random)
    nodes = [_near(middle, radius / 1.5, random) for _ in groups]
    for n, group in enumerate(groups):
        if random.random() < 0.5:  # on its own side
            number, side = group[len(group) // 2]
            _, toward = _first_segment(plane.roads[number], side)
            share = radius / dist(middle, toward)
            nodes[n] = (
                middle[0] + (toward[0] - middle[0]) * share,
                middle[1] + (toward[1] - middle[1]) * share,
            )
    roads = list(plane.roads)
    for node, group in zip(nodes, groups, strict=True):
        for number, side in group:
            course = [*roads[number].course]
            course[-1 if side else 0] = node
            roads[number] = replace(roads[number], course=course)
    own = sorted({number for number, _ in row})
    spokes = [(centre, node) for node in nodes]
    if crossings([*(roads[number].course for number in own), *spokes]):
        return None
    found: list[End] = []
    for _, node, group in sorted(
        (bearing(centre, node), node, group) for node, group in zip(nodes, groups, strict=True)
    ):
        back = bearing(node, centre)
        angles = [
            (bearing(*_first_segment(roads[number], side)) - back) % (2 * pi)
            for number, side in group
        ]
        found += [end for _, end in sorted(zip(angles, group, strict=True))]
    shift = found.index(row[0])
    if [*found[shift:], *found[:shift]] != list(row):
        return None
    at = [*plane.at]
    at[vertex] = random.choice([centre, _near(middle, radius / 1.5, random)])
    return replace(plane, at=at, roads=roads)
