"""Surfaces cut open, without crossings: what leaves on one side comes back on its partner.

**A regular map of the torus** is a flat periodic cell. Each dart gets a whole translation with sum
zero around every face, and each vertex lies in the middle of its neighbours (S. Gortler, C. Gotsman
and D. Thurston, "Discrete one-forms on meshes", CAGD 23 (2006)).

**A world with one face**, of genus g > 0, is a polygon with 4g sides and a spanning tree in its
middle. The 2g other edges leave it as spokes in the order of its contour, and come back through the
side with the same letter. Each vertex lies in the middle of its neighbours (W. Tutte, "How to draw
a graph", 1963); a dead end hangs on an undrawn boundary point.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise, product
from math import cos, pi, sin

import numpy as np

from topo_verify.pictures.drawing import curves
from topo_verify.pictures.drawing.arrays import Floats, Ints, solve
from topo_verify.pictures.drawing.layout import MARGIN, RADIUS, CutSurface, Layout, clear_radius
from topo_verify.world.formats.junctions import Point
from topo_verify.world.rooted_map import Dart, World


@dataclass(frozen=True)
class _Torus:
    """The drawing in the plane.

    Attributes:
        places: of the vertices, as fractions of the sides.
        steps: from each dart's vertex to its other end, likewise.
        sides: of the cell, as rows.
    """

    places: Floats
    steps: Floats
    sides: Floats
    vertex_of: Ints


def torus_cell(world: World) -> Layout | None:
    """The layout of a regular map of the torus, or None."""
    if world.genus != 1 or len(set(world.degrees)) > 1 or len(set(map(len, world.faces))) > 1:
        return None
    torus = _flat(world)
    lengths = np.hypot(*(torus.steps @ torus.sides).T)
    # the marker needs more of its edge before a seam than a number does
    spans = lengths * np.where(np.arange(len(lengths)) == world.root, 0.35, 0.7)
    torus = _shifted(torus, spans)
    square = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    low, high = (square @ torus.sides).min(0), (square @ torus.sides).max(0)
    radius = min(0.17 * float(lengths.min()), 0.8 * _to_border(torus, spans))
    scale = RADIUS / radius
    margin = MARGIN * RADIUS

    def on_page(points: Floats) -> Floats:
        x, y = (points @ torus.sides).T
        return np.stack([(x - low[0]) * scale + margin, (high[1] - y) * scale + margin], 1)

    size = (high - low) * scale + 2 * margin
    return Layout(
        kind="cell",
        width=round(float(size[0]), 2),
        height=round(float(size[1]), 2),
        radius=RADIUS,
        centres=_points(on_page(torus.places)),
        paths=tuple(
            tuple(
                curves.straight(_points(on_page(part)))
                for part in _parts(
                    torus.places[world.vertex_of[a]], torus.steps[a], radius / float(lengths[a])
                )
            )
            for a, _ in world.edges
        ),
        cell=CutSurface(_points(on_page(square)), "abab"),
    )


def _points(points: Floats) -> tuple[Point, ...]:
    return tuple((x, y) for x, y in points.round(2).tolist())


def _translations(world: World) -> dict[Dart, list[int]]:
    """A whole, not trivial translation of each dart, with sum zero around every face.

    Two edges lie neither in a tree of vertices nor in one of faces. Each closes a cycle of faces;
    translations count how often it crosses a dart.
    """
    face_of = {dart: k for k, face in enumerate(world.faces) for dart in face}
    tree = _tree(world, 0)
    entered: dict[int, Dart] = {}
    reached, queue = {0}, deque([0])
    while queue:
        for dart in world.faces[queue.popleft()]:
            face = face_of[world.alpha[dart]]
            if dart not in tree and face not in reached:
                reached.add(face)
                entered[face] = dart
                queue.append(face)

    def home(face: int) -> list[Dart]:
        way: list[Dart] = []
        while face in entered:
            way.append(entered[face])
            face = face_of[entered[face]]
        return way

    used = tree | {d for dart in entered.values() for d in (dart, world.alpha[dart])}
    translations = {dart: [0, 0] for dart in range(len(world.alpha))}
    for k, (a, b) in enumerate(edge for edge in world.edges if edge[0] not in used):
        back = [world.alpha[dart] for dart in home(face_of[b])]
        for dart in (a, *back, *home(face_of[a])):
            translations[dart][k] += 1
            translations[world.alpha[dart]][k] -= 1
    return translations


def _tree(world: World, root: int) -> set[Dart]:
    reached, queue, tree = {root}, deque([root]), set[Dart]()
    while queue:
        for dart in world.vertices[queue.popleft()]:
            end = world.vertex_of[world.alpha[dart]]
            if end not in reached:
                reached.add(end)
                queue.append(end)
                tree |= {dart, world.alpha[dart]}
    return tree


def _flat(world: World) -> _Torus:
    translation = _translations(world)
    moves = np.array([translation[dart] for dart in range(len(world.alpha))], float)
    tails = np.array(world.vertex_of)
    heads = tails[np.array(world.alpha)]
    size = len(world.vertices)
    right = np.zeros((size, 2))
    np.add.at(right, tails, moves)
    places = np.zeros((size, 2))
    if size > 1:
        kept = (tails > 0) & (heads > 0)
        inner = np.arange(size - 1)
        places[1:] = solve(
            np.concatenate([inner, tails[kept] - 1]),
            np.concatenate([inner, heads[kept] - 1]),
            np.concatenate([np.array(world.degrees[1:], float), -np.ones(int(kept.sum()))]),
            right[1:],
        )
    steps = places[heads] + moves - places[tails]
    # make steps alike in all directions
    spread = steps.T @ steps
    a = np.sqrt(spread[0, 0])
    b = spread[0, 1] / a
    c = np.sqrt(spread[1, 1] - b * b)
    sides = np.array([[1 / a, -b / (a * c)], [0.0, 1 / c]])
    drawn = steps @ sides
    after = drawn[np.array(world.sigma)]
    if (drawn[:, 0] * after[:, 1] - drawn[:, 1] * after[:, 0]).sum() > 0:
        sides = sides * np.array([1, -1])  # sigma turns clockwise, negative with y upwards
    lattice = _reduced(sides)
    change = sides @ np.linalg.inv(lattice)
    x, y = lattice[0] / np.hypot(*lattice[0])
    level = lattice @ np.array([[x, -y], [y, x]])
    return _Torus(places @ change, steps @ change, level, tails)


def _reduced(sides: Floats) -> Floats:
    """A basis of the same lattice of short vectors, the longer one first."""
    a, b = sides[0], sides[1]
    while True:
        if a @ a > b @ b + 1e-9:
            a, b = b, a
        times = round(float(a @ b / (a @ a)))
        if not times:
            break
        b = b - times * a
    # the angle from the first to the second is 90° or more
    if b[0] * a[1] - b[1] * a[0] < 0:
        a = -a
    return np.array([b, a])


def _shifted(torus: _Torus, spans: Floats) -> _Torus:
    """The cell whose seams keep farthest from vertices and from the beginnings of darts."""
    candidates: list[list[float]] = []
    for k in (0, 1):
        row: list[float] = sorted(set((torus.places[:, k] % 1).round(6).tolist()))
        gaps = [*pairwise([*row, row[0] + 1])]
        candidates.append([])
        for share in (0.5, 0.36, 0.64, 0.2, 0.8):
            seams = [low + (high - low) * share for low, high in gaps]
            candidates[k] += sorted(seams, key=partial(_room, torus, spans, k), reverse=True)[:2]
    moved = [replace(torus, places=(torus.places - at) % 1) for at in product(*candidates)]
    return max(moved, key=lambda it: round(min(_to_border(it, spans), 2 * _to_corner(it)), 6))


def _to_border(torus: _Torus, spans: Floats) -> float:
    return min(_room(torus, spans, k, 0.0) for k in (0, 1))


def _room(torus: _Torus, spans: Floats, k: int, seam: float) -> float:
    """The least distance of a vertex from this seam across side k, or share of a cut span."""
    places = (torus.places[:, k] - seam) % 1
    height = abs(float(np.linalg.det(torus.sides))) / float(np.hypot(*torus.sides[1 - k]))
    step, start = torus.steps[:, k], places[torus.vertex_of]
    shares = np.where(step > 0, 1 - start, start) / np.maximum(np.abs(step), 1e-9)
    cut = np.where(shares < 1, shares * spans, np.inf)
    return float(min(np.minimum(places, 1 - places).min() * height, cut.min()))


def _to_corner(torus: _Torus) -> float:
    starts = torus.places[torus.vertex_of]
    near = np.round(starts)[:, None] + np.array([*product(range(-2, 3), repeat=2)])
    offset = (near - starts[:, None]) @ torus.sides
    step = (torus.steps @ torus.sides)[:, None]
    t = np.clip((offset * step).sum(2) / (step**2).sum(2), 0, 1)
    return float(np.hypot(*np.moveaxis(offset - t[:, :, None] * step, 2, 0)).min())


def _parts(place: Floats, step: Floats, trim: float) -> list[Floats]:
    """The pieces of an edge within the cell, in fractions of the sides."""
    times = {trim, 1 - trim}
    for start, length in zip(place.tolist(), step.tolist(), strict=True):
        low, high = sorted((start, start + length))
        borders = range(int(np.floor(low)) + 1, int(np.ceil(high)))
        times |= {t for border in borders if trim < (t := (border - start) / length) < 1 - trim}
    pieces: list[Floats] = []
    for begin, end in pairwise(sorted(times)):
        home = np.floor(place + (begin + end) / 2 * step)
        pieces.append(np.array([place + begin * step - home, place + end * step - home]))
    return pieces


LETTERS = "abcdefghijklmnopqrstuvwxyz"

SMALL = 0.04
"""In a polygon with smaller circles, bridges are easier to read."""


def polygon(world: World) -> Layout | None:
    """The layout of a small world with one face and a genus, or None."""
    if not 0 < 2 * world.genus <= len(LETTERS) or len(world.faces) > 1:
        return None
    tree = _tree(world, max(range(len(world.vertices)), key=lambda v: len(world.vertices[v])))
    stops = [*_contour(world, tree)]
    spokes = [dart for dart in stops if dart not in tree]
    angle = _angles(stops, tree)
    rim = {dart: np.array([cos(a), sin(a)]) for dart, a in angle.items()}
    centres = _held(world, tree, rim)
    tails = [centres[world.vertex_of[dart]] for dart in range(len(world.alpha))]
    chains = [
        np.array([tails[dart], tails[world.alpha[dart]] if dart in tree else rim[dart]])
        for dart in range(len(world.alpha))
    ]
    radius = clear_radius(centres, chains, 0.0)
    if radius < SMALL:
        return None
    scale, half = RADIUS / radius, pi / len(spokes)
    corners = np.array([[cos(angle[d] - half), sin(angle[d] - half)] for d in spokes]) / cos(half)
    low, high = corners.min(0), corners.max(0)
    margin = (MARGIN + 1) * RADIUS

    def on_page(points: Floats) -> tuple[Point, ...]:
        return _points((points - low) * scale + margin)

    def part(dart: Dart) -> tuple[Point, ...]:
        start, end = chains[dart]
        trim = (end - start) * radius / float(np.hypot(*(end - start)))
        return on_page(np.array([start + trim, end - trim if dart in tree else end]))

    width, height = ((high - low) * scale + 2 * margin).round(2).tolist()
    names: dict[Dart, str] = {}
    for dart in spokes:
        names[dart] = names.get(world.alpha[dart]) or LETTERS[len({*names.values()})]
    return Layout(
        kind="cell",
        width=width,
        height=height,
        radius=RADIUS,
        centres=on_page(centres),
        paths=tuple(
            tuple(map(curves.straight, [part(a)] if a in tree else [part(a), part(b)[::-1]]))
            for a, b in world.edges
        ),
        cell=CutSurface(on_page(corners), "".join(names[dart] for dart in spokes)),
    )


def _contour(world: World, tree: set[Dart]) -> Iterator[Dart]:
    """Clockwise around the tree, from the marker: dead ends and the darts of other edges."""
    start = dart = world.root or 0
    while True:
        if dart not in tree or world.sigma[dart] == dart:
            yield dart
        dart = world.sigma[world.alpha[dart] if dart in tree else dart]
        if dart == start:
            return


def _angles(stops: Iterable[Dart], tree: set[Dart]) -> dict[Dart, float]:
    """The angles of the stops: spokes evenly, the first one up; dead ends between."""
    groups: list[list[Dart]] = [[]]
    for dart in stops:
        groups += [] if dart in tree else [[]]
        groups[-1].append(dart)
    groups[-1] += groups.pop(0)
    step = 2 * pi / len(groups)
    return {
        dart: step * (k + place / len(group)) - pi / 2
        for k, group in enumerate(groups)
        for place, dart in enumerate(group)
    }


def _held(world: World, tree: set[Dart], rim: Mapping[Dart, Floats]) -> Floats:
    size = len(world.vertices)
    matrix, right = np.zeros((size, size)), np.zeros((size, 2))
    for dart, vertex in enumerate(world.vertex_of):
        ends = [world.vertex_of[world.alpha[dart]]] if dart in tree else []
        matrix[vertex, vertex] += len(ends) + (dart in rim)
        matrix[vertex, ends] -= 1
        right[vertex] += rim.get(dart, np.zeros(2))
    return np.asarray(np.linalg.solve(matrix, right), np.float64)
