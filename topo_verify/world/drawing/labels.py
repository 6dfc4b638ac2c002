"""Where the number of a dart stands: on its own edge, near its vertex, and on nothing else.

A number must be seen to belong to its edge. So it goes out along the edge until no other number, no
circle and no other dart of the same vertex is near; where there is no such place, it takes the one
that is farthest from all of these.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from topo_verify.world.drawing import curves
from topo_verify.world.drawing.arrays import Floats
from topo_verify.world.drawing.layout import Layout
from topo_verify.world.formats.embedding import Point
from topo_verify.world.rooted_map import Dart, World

FIRST, STEP, MOST = 0.75, 0.3, 24
"""In radii: the first place along an edge, and the step to the next; so many are tried at most."""

CLEAR = 0.55
"""In radii: so far a number of one digit stays from the lines of other darts."""

DIGIT = 0.2
"""In radii: half the width of a digit."""


def leaving(world: World, layout: Layout) -> dict[Dart, Floats]:
    """The points of the edge of each dart that is drawn, from the dart on; its first part."""
    lines: dict[Dart, Floats] = {}
    for (a, b), parts in zip(world.edges, layout.paths, strict=True):
        if parts:
            lines[a], lines[b] = curves.flatten(parts[0]), curves.flatten(parts[-1])[::-1]
    return lines | {dart: curves.flatten(data) for dart, data in layout.stubs}


def places(world: World, layout: Layout, words: Mapping[Dart, str]) -> dict[Dart, Point]:
    """Where the words of each dart that is drawn stand, vertex by vertex, clockwise."""
    lines, radius = leaving(world, layout), layout.radius
    circles = [c for vertex, c in enumerate(layout.centres) if vertex not in layout.hidden]
    # What a number stays away from: points, and how far from each, across and down.
    taken = [(x, y, 1.3 * radius, 1.3 * radius) for x, y in circles]
    found: dict[Dart, Point] = {}
    for vertex, rotation in enumerate(world.vertices):
        if vertex in layout.hidden:
            continue
        near = {dart: _sampled(lines[dart], radius) for dart in rotation if dart in lines}
        for dart in near:
            others = [near[other] for other in near if other != dart]
            across = len(words[dart]) * DIGIT * radius
            found[dart] = _best(
                [*_along(lines[dart], radius, marked=dart == world.root)],
                np.concatenate(others) if others else np.empty((0, 2)),
                np.array(taken) + np.array([0, 0, across, 0]),
                CLEAR * radius,
            )
            taken.append((*found[dart], across + 0.15 * radius, 0.8 * radius))
    return found


def _sampled(line: Floats, radius: float) -> Floats:
    """Points along the part of a line on which numbers may stand, close together."""
    length = min(curves.length(line), (FIRST + STEP * MOST + 2) * radius)
    return np.array([curves.place(line, d) for d in np.arange(0.0, length, 0.25 * radius)])


def _along(line: Floats, radius: float, *, marked: bool) -> Iterator[Point]:
    """The places to try, the nearest first; beside the arrow on the marked dart."""
    most = 0.35 * curves.length(line)  # the other end has a number, too
    for k in range(MOST):
        away = (FIRST + STEP * k) * radius
        if k and away > most:
            return
        place = curves.place(line, min(away, most))
        if marked:
            ahead = curves.place(line, min(away, most) + 0.2 * radius) - place
            place = place + 0.8 * radius * np.array([ahead[1], -ahead[0]]) / np.hypot(*ahead)
        yield float(place[0]), float(place[1])


def _best(tries: list[Point], lines: Floats, taken: Floats, clear: float) -> Point:
    """The first place that is clear of all; else one on no other number, and off the lines."""
    rooms: list[tuple[float, float]] = []
    for place in tries:
        apart = (np.abs(taken[:, :2] - place) / taken[:, 2:]).max(axis=1).min()
        off = np.hypot(*(lines - place).T).min() / clear if len(lines) else 1.0
        rooms.append((min(float(apart), 1.0), min(float(off), 1.0)))
    return tries[max(range(len(tries)), key=lambda k: (rooms[k], -k))]
