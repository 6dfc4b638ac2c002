"""Where things lie in a picture of a run, and when.

Spans are of moments: the first, and the one after the last. Points are in the layout's space.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from topo_verify.checkers.darts import KnownDart, WorldDart
from topo_verify.pictures.detours import SupposedWalk, tested_guesses
from topo_verify.pictures.drawing import Layout, curves
from topo_verify.pictures.drawing.svg import leaving
from topo_verify.pictures.scenes import Moment, Playback
from topo_verify.robot import events as ev
from topo_verify.world.formats.junctions import Point
from topo_verify.world.rooted_map import Dart

Span = tuple[int, int]

LEAP = 0.0002
"""The share of the whole time that a jump takes: keyframes differ by at least 0.01 %."""

PACE = 0.8
"""The share of a move's time in which the robot goes; the rest it stands."""


class Face(NamedTuple):
    """A badge from moment `first` to before `last`: class and words."""

    first: int
    last: int
    kind: str
    words: str


class Badge(NamedTuple):
    """The badge of a hypothesis beside its dart."""

    at: Point
    faces: tuple[Face, ...]


Way = tuple[tuple[Point, ...], ...]
"""The points of a way; a new part begins where a cell of a torus is re-entered."""


class Leg(NamedTuple):
    """The path of an object during one moment; a single point if it stands."""

    moment: int
    way: Way


@dataclass(frozen=True)
class Ghost:
    """Where the robot would be during these moments, if a hypothesis were right."""

    span: Span
    steps: tuple[Leg, ...]


def timed(
    steps: Sequence[Leg], begins: Sequence[float]
) -> Iterator[tuple[float, tuple[Point, ...]]]:
    """The times at which points are reached, each with the points of its part so far."""
    for step in steps:
        at, pause = begins[step.moment], begins[step.moment + 1]
        pace = PACE * (pause - at) / (sum(map(length, step.way)) or 1.0)
        for number, part in enumerate(step.way):
            # A jump takes a moment: keyframes of one time would be one.
            at += LEAP * begins[-1] if number else 0.0
            yield at, part[:1]
            for end in range(2, len(part) + 1):
                at += pace * math.dist(part[end - 2], part[end - 1])
                yield at, part[:end]


def length(points: Sequence[Point]) -> float:
    """The length of a polyline."""
    return sum(math.dist(a, b) for a, b in itertools.pairwise(points))


class Tracks:
    """The visible parts of a run in a layout of its world."""

    def __init__(self, playback: Playback, layout: Layout) -> None:
        self.playback, self.layout = playback, layout
        self.world, self.moments = playback.world, playback.moments
        self.edge_of = {dart: k for k, edge in enumerate(self.world.edges) for dart in edge}

    def centre(self, dart: Dart) -> Point:
        """The centre of the vertex of a dart."""
        return self.layout.centres[self.world.vertex_of[dart]]

    def way(self, dart: Dart) -> Way:
        """From the vertex of a dart along its edge to the other vertex; corners only."""
        a, b = self.world.edges[self.edge_of[dart]]
        data = self.layout.paths[self.edge_of[dart]]
        parts = [[(float(x), float(y)) for x, y in curves.flatten(piece)] for piece in data] or [[]]
        parts[0].insert(0, self.centre(a))
        parts[-1].append(self.centre(b))
        way = tuple(tuple(corners(part)) for part in parts)
        return way if dart == a else reverse(way)

    # ------------------------------------------------------------ what S knows

    def known_from(self) -> tuple[list[int], list[int]]:
        """The moments from which on S has (or the robot knows) each vertex and each edge."""
        end = len(self.moments)
        vertices, edges = [end] * len(self.world.vertices), [end] * len(self.world.edges)
        vertices[self.world.vertex_of[self.world.root] if self.world.root is not None else 0] = 0
        chart = self.playback.map
        if any(isinstance(moment.event, ev.Augment) for moment in self.moments):
            for known, dart in chart.phi.items():
                vertices[self.world.vertex_of[dart]] = chart.born[known]
                edges[self.edge_of[dart]] = min(chart.joined[known], end)
            return vertices, edges
        for moment in reversed(self.moments):
            if moment.left_by is not None and moment.position is not None:
                vertices[self.world.vertex_of[moment.position]] = moment.number
                edges[self.edge_of[moment.position]] = moment.number
        vertices[self.world.vertex_of[self.world.root or 0] if self.edge_of else 0] = 0
        return vertices, edges

    def asked(self) -> dict[int, list[Span]]:
        """By edge, when it is e: from its crossing to the decision."""
        spans: dict[int, list[Span]] = {}
        for moment in self.moments:
            edge = self._asked_at(moment)
            if edge is None:
                continue
            known = spans.setdefault(edge, [])
            if known and known[-1][1] == moment.number:
                known[-1] = (known[-1][0], moment.number + 1)
            else:
                known.append((moment.number, moment.number + 1))
        return spans

    def _asked_at(self, moment: Moment) -> int | None:
        if isinstance(moment.event, ev.Move) and moment.event.purpose == "cross":
            return None if moment.left_by is None else self.edge_of[moment.left_by]
        dart = None if moment.edge is None else self._image(moment.edge, moment.number)
        return None if dart is None else self.edge_of[dart]

    def _image(self, dart: int, when: int) -> WorldDart | None:
        chart = self.playback.map
        known = KnownDart(dart)
        return (
            chart.phi[known] if 0 <= known < len(chart.born) and chart.born[known] < when else None
        )

    # ------------------------------------------------------------ hypotheses

    def badges(self) -> Iterator[Badge]:
        """The hypotheses of every pose: numbered until they are rejected or the pose is over."""
        for moment in self.moments:
            if isinstance(moment.event, ev.Pose):
                for number, dart in enumerate(moment.event.hypotheses, 1):
                    image = self._image(dart, moment.number)
                    if image is not None and self.layout.paths[self.edge_of[image]]:
                        faces = tuple(self._faces(moment.number, number, dart))
                        yield Badge(self._beside(image), faces)

    def _faces(self, posed: int, number: int, dart: int) -> Iterator[Face]:
        for moment in self.moments[posed + 1 :]:
            event, when = moment.event, moment.number
            if isinstance(event, ev.Reject) and event.hypothesis == dart:
                yield Face(posed, when, "guess", str(number))
                yield Face(when, when + 1, "bad", "×")
                return
            if isinstance(event, ev.Confirm) and event.hypothesis == dart:
                yield Face(posed, when, "guess", str(number))
                yield Face(when, min(when + 2, len(self.moments)), "ok", "✓")
                return
            if isinstance(event, ev.Pose | ev.Augment):
                yield Face(posed, when, "guess", str(number))
                return
        yield Face(posed, len(self.moments), "guess", str(number))

    def _beside(self, dart: Dart) -> Point:
        along = leaving(self.world, self.layout)[dart]
        away = min(1.3 * self.layout.radius, 0.26 * curves.length(along))
        x, y = curves.place(along, away).tolist()
        return x, y

    def clashes(self) -> dict[tuple[Point, bool], list[Span]]:
        """The rings at a rejection: where the evidence was seen; True: where it is expected."""
        rings: dict[tuple[Point, bool], list[Span]] = {}
        for moment in self.moments:
            mismatch = moment.mismatch
            if mismatch is None or mismatch.evidence.contradiction is not None:
                continue
            at = {(self.centre(mismatch.trail[-1]), False)}
            if mismatch.leaves is None:
                at.add((self.centre(self.playback.map.phi[mismatch.traced[-1]]), True))
            for ring in sorted(at):
                rings.setdefault(ring, []).append((moment.number, moment.number + 1))
        return rings

    # ------------------------------------------------------------ who walks

    def robot(self) -> tuple[Leg, ...]:
        """The steps of the robot: it stands at the start, and goes at every move."""
        start = self.moments[0].position
        steps = [Leg(0, ((self.layout.centres[0] if start is None else self.centre(start),),))]
        steps += [
            Leg(moment.number, self.way(moment.left_by))
            for moment in self.moments
            if moment.left_by is not None
        ]
        return tuple(steps)

    def first_turn(self) -> float:
        """Where the marker points to, in degrees clockwise from the right."""
        root = self.world.root
        points = () if root is None else self.way(root)[0][:2]
        if len(points) < 2:
            return 0.0
        (x, y), (to_x, to_y) = points
        return math.degrees(math.atan2(to_y - y, to_x - x))

    def ghosts(self) -> Iterator[Ghost]:
        """Where the robot would be on S, while it tests a hypothesis by motion."""
        walk, tested = SupposedWalk(self.playback), tested_guesses(self.moments)
        steps = list[Leg]()
        for moment in self.moments:
            event, number = moment.event, moment.number
            goal, decides = tested.get(number), False
            if isinstance(event, ev.Reject | ev.Confirm) and event.rule == "motion":
                goal, decides = event.hypothesis, True
            at = walk.place(moment, goal)
            if at is not None:
                way = reverse(self.way(self.playback.map.phi[at]))
                if not steps:
                    steps.append(Leg(number, ((way[-1][-1] if decides else way[0][0],),)))
                steps += [] if decides else [Leg(number, way)]
            if decides and steps:
                yield Ghost((steps[0].moment, number + 1), tuple(steps))
            if decides or isinstance(event, ev.Pose | ev.Augment):
                steps = []


def reverse(way: Way) -> Way:
    """The same track backwards."""
    return tuple(part[::-1] for part in way[::-1])


def corners(points: Sequence[Point]) -> Iterator[Point]:
    """The points without those on the straight line between their neighbours."""
    kept: list[Point] = []
    for point in points:
        while len(kept) > 1 and _is_between(kept[-2], kept[-1], point):
            kept.pop()
        if not kept or math.dist(kept[-1], point) > 0.01:
            kept.append(point)
    yield from kept


def _is_between(a: Point, b: Point, c: Point) -> bool:
    bend = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    return abs(bend) < 0.02 * math.dist(a, c) and math.dist(a, c) > math.dist(a, b)
