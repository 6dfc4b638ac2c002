"""Parses a finished SVG, independently of what drew it, and compares it with the world.

What this does not show: that a reader's eye tells two near edges apart.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import atan2, degrees, hypot, tau
from xml.etree import ElementTree as ET

import numpy as np

from topo_verify.pictures.drawing.arrays import Floats
from topo_verify.pictures.drawing.curves import crossings, distances, flatten
from topo_verify.world.rooted_map import Dart, World

TOLERANCE = 0.03
"""The distance of a point from its circle: coordinates have two decimals."""

SVG = "{http://www.w3.org/2000/svg}"


@dataclass(frozen=True)
class Picture:
    """The content of an SVG.

    Attributes:
        circles: x, y and radius of each vertex.
        curves: the parts of each edge, by its two darts.
        stubs: the beginnings of edges that leave a ball, by their dart.
        sides: of a cut surface, by letter.
        gaps: in the edges below bridges, each along the edge above.
    """

    circles: dict[int, tuple[float, float, float]]
    curves: dict[tuple[Dart, Dart], tuple[Floats, ...]]
    stubs: dict[Dart, Floats]
    sides: dict[str, list[Floats]]
    gaps: list[Floats]


def read(svg: str) -> Picture:
    """The content of the SVG; ValueError if it shows no world."""
    circles: dict[int, tuple[float, float, float]] = {}
    parts: dict[tuple[Dart, Dart], dict[int, Floats]] = {}
    stubs: dict[Dart, Floats] = {}
    sides: dict[str, list[Floats]] = {}
    gaps: list[Floats] = []
    for element in ET.fromstring(svg).iter():  # noqa: S314  our own picture
        get = element.attrib.get
        if element.tag == f"{SVG}circle" and (vertex := get("data-vertex")) is not None:
            if int(vertex) in circles:
                raise ValueError(f"vertex {vertex} is drawn twice")
            circles[int(vertex)] = (float(get("cx", "")), float(get("cy", "")), float(get("r", "")))
        elif (darts := get("data-darts")) is not None:
            a, b = map(int, darts.split())
            part = int(get("data-part", "0"))
            if part in parts.setdefault((a, b), {}):
                raise ValueError(f"part {part} of edge {darts} is drawn twice")
            parts[a, b][part] = flatten(get("d", ""))
        elif (stub := get("data-stub")) is not None:
            stubs[int(stub)] = flatten(get("d", ""))
        elif get("class") == "tv-halo":
            gaps.append(flatten(get("d", "")))
        elif (cell := get("data-cell")) is not None:
            corner, right, up = np.array([*map(float, cell.split())]).reshape(3, 2)
            corners = np.array([corner, corner + right, corner + right + up, corner + up])
            sides = _sides(corners, "abab")
        elif (outline := get("data-polygon")) is not None:
            corners = np.array([*map(float, outline.split())]).reshape(-1, 2)
            sides = _sides(corners, get("data-sides", ""))
    curves = {edge: tuple(pieces[k] for k in sorted(pieces)) for edge, pieces in parts.items()}
    return Picture(circles, curves, stubs, sides, gaps)


def _sides(corners: Floats, letters: str) -> dict[str, list[Floats]]:
    sides: dict[str, list[Floats]] = {}
    for letter, start, end in zip(letters, corners, np.roll(corners, -1, 0), strict=True):
        sides.setdefault(letter, []).append(np.array([start, end]))
    if any(len(pair) != 2 for pair in sides.values()):
        raise ValueError(f"expected each side of the cell twice, got {letters!r}")
    return sides


def untruths(picture: Picture, world: World) -> list[str]:
    """The differences between the picture and the world."""
    missing = sorted(set(range(len(world.vertices))) - picture.circles.keys())
    if missing and not picture.stubs:
        return [f"vertex {missing[0]} is not drawn"]
    for check in (_edges, _ends, _seams):
        if mistakes := [*check(picture, world)]:
            return mistakes
    mistakes = [*_orders(picture, world), *overlaps(picture), *_touches(picture, world)]
    flat = [part for parts in picture.curves.values() for part in parts]
    places = np.reshape([c.at for c in crossings([*flat, *picture.stubs.values()])], (-1, 2))
    apart = [np.full(len(places), np.inf), *(distances(places, gap) for gap in picture.gaps)]
    if len(places) and (picture.sides or not world.genus):
        mistakes.append(f"{len(places)} crossings are drawn, 0 are meant")
    elif plain := int((np.min(apart, axis=0) > TOLERANCE).sum()):
        mistakes.append(f"{plain} of {len(places)} crossings have no bridge")
    return mistakes


def _edges(picture: Picture, world: World) -> Iterator[str]:
    drawn = picture.circles.keys()
    whole = {
        (a, b)
        for a, b in world.edges
        if world.vertex_of[a] in drawn and world.vertex_of[b] in drawn
    }
    cut = {
        dart
        for dart, other in enumerate(world.alpha)
        if world.vertex_of[dart] in drawn and world.vertex_of[other] not in drawn
    }
    for edge in sorted(whole ^ picture.curves.keys()):
        yield f"edge {edge} is {'not drawn' if edge in whole else 'drawn, and not there'}"
    for dart in sorted(cut ^ picture.stubs.keys()):
        yield f"the stub of dart {dart} is {'not drawn' if dart in cut else 'drawn, and not due'}"


def leavings(picture: Picture) -> dict[Dart, Floats]:
    """The curve of every dart, from the circle of its vertex on."""
    lines = dict(picture.stubs)
    for (a, b), parts in picture.curves.items():
        lines[a], lines[b] = parts[0], parts[-1][::-1]
    return lines


def _ends(picture: Picture, world: World) -> Iterator[str]:
    for dart, curve in sorted(leavings(picture).items()):
        x, y, r = picture.circles[world.vertex_of[dart]]
        off = hypot(curve[0][0] - x, curve[0][1] - y) - r
        if abs(off) > TOLERANCE:
            yield f"dart {dart} begins {off:.2f} off the circle of vertex {world.vertex_of[dart]}"


def _seams(picture: Picture, _world: World) -> Iterator[str]:
    for edge, parts in sorted(picture.curves.items()):
        for before, after in pairwise(parts):
            if not picture.sides:
                yield f"edge {edge} is torn, and there is no cell that it could leave"
            elif not any(
                _is_glued(side, partner, before[-1], after[0])
                for pair in picture.sides.values()
                for side, partner in (pair, pair[::-1])
            ):
                yield f"edge {edge} does not come back where it left the cell"


def _is_glued(side: Floats, partner: Floats, out: Floats, back: Floats) -> bool:
    (start, end), (last, first) = side, partner
    share = float((out - start) @ (end - start) / ((end - start) ** 2).sum())
    off = (out - start - share * (end - start), back - first - share * (last - first))
    return -1e-3 < share < 1 + 1e-3 and float(np.hypot(*np.array(off).T).max()) < 3 * TOLERANCE


def gaps(picture: Picture, world: World) -> dict[int, list[float]]:
    """The clockwise angles between neighbouring darts at each drawn vertex of degree 2 or more.

    They sum up to 2 pi iff the order is that of the world.
    """
    starts = leavings(picture)
    angles: dict[int, list[float]] = {}
    for vertex, (x, y, _) in picture.circles.items():
        row = [atan2(starts[d][0][1] - y, starts[d][0][0] - x) for d in world.vertices[vertex]]
        if len(row) > 1:
            angles[vertex] = [(b - a) % tau for a, b in zip(row, row[1:] + row[:1], strict=True)]
    return angles


def _orders(picture: Picture, world: World) -> Iterator[str]:
    for vertex, row in sorted(gaps(picture, world).items()):
        if abs(sum(row) - tau) > 1e-6:
            yield f"the order of the darts at vertex {vertex} is not that of the world"
        elif min(row) * picture.circles[vertex][2] < TOLERANCE:
            yield f"two darts leave vertex {vertex} at the same point"


def smallest_angle(picture: Picture, world: World) -> float:
    """The smallest angle between two darts of a vertex, in degrees."""
    return degrees(min([tau, *(min(row) for row in gaps(picture, world).values())]))


def overlaps(picture: Picture) -> Iterator[str]:
    """The circles that overlap."""
    vertices = sorted(picture.circles)
    rows = np.array([picture.circles[vertex] for vertex in vertices])
    apart = np.hypot(*(rows[:, None, :2] - rows[None, :, :2]).transpose(2, 0, 1))
    near = apart < (rows[:, None, 2] + rows[None, :, 2])
    for i, j in np.argwhere(np.triu(near, 1)).tolist():
        yield f"vertices {vertices[i]} and {vertices[j]} overlap"


def _touches(picture: Picture, world: World) -> Iterator[str]:
    vertices = sorted(picture.circles)
    rows = np.array([picture.circles[vertex] for vertex in vertices])
    lines = [(edge, part) for edge, parts in picture.curves.items() for part in parts]
    lines += [((dart, dart), stub) for dart, stub in picture.stubs.items()]
    for edge, line in lines:
        own = {world.vertex_of[dart] for dart in edge}
        points = np.concatenate([line, (line[1:] + line[:-1]) / 2])
        into = distances(rows[:, :2], line) < rows[:, 2]
        for k in np.flatnonzero(into).tolist():
            if vertices[k] not in own:
                yield f"edge {edge} runs through vertex {vertices[k]}"
            elif np.hypot(*(points - rows[k][:2]).T).min() < rows[k][2] - 2 * TOLERANCE:
                yield f"edge {edge} comes back into its own vertex {vertices[k]}"
