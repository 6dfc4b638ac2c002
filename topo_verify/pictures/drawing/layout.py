"""Layout: where the vertices, edges and bridges of a drawn world lie, y downwards.

A sketch, places in a plane, is scaled, trimmed at the circles and given bridges.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from topo_verify.pictures.drawing import curves
from topo_verify.pictures.drawing.arrays import Floats
from topo_verify.pictures.drawing.curves import crossings
from topo_verify.world.formats.junctions import Point
from topo_verify.world.rooted_map import Dart

Kind = Literal["positions", "planar", "bridges", "cell", "ball", "known"]


@dataclass(frozen=True)
class Bridge:
    """One edge passes over another, or over itself; indices into `world.edges`."""

    over: int
    under: int
    path: str


class CutSurface(NamedTuple):
    """A polygon whose sides are glued in pairs.

    Attributes:
        corners: in order around it.
        sides: a letter for each side; sides with equal letters are glued, end to start.
    """

    corners: tuple[Point, ...]
    sides: str


@dataclass(frozen=True)
class Layout:
    """Where everything in a picture of a world lies.

    Attributes:
        kind: `planar` has no crossings, `bridges` has some, `cell` is a cut surface; of `known`
            the hidden vertices are not known.
        centres: of the vertices; of a hidden one, where the way to it leaves the ball.
        paths: path data of each edge, from the circle at its lesser dart; several parts if it
            leaves a cell, none if hidden.
        stubs: the beginnings of edges whose other vertex is hidden: dart and path data.
        hidden: the vertices outside of the ball.
    """

    kind: Kind
    width: float
    height: float
    radius: float
    centres: tuple[Point, ...]
    paths: tuple[tuple[str, ...], ...]
    bridges: tuple[Bridge, ...] = ()
    stubs: tuple[tuple[Dart, str], ...] = ()
    hidden: frozenset[int] = frozenset()
    cell: CutSurface | None = None


RADIUS = 11.0
"""Of a vertex's circle, unless the picture would get too large."""

LONGEST_SIDE = 2400.0

MANY = 250

MARGIN = 2.4
"""In radii of a vertex."""


@dataclass(frozen=True)
class Sketch:
    """Where vertices and edges lie in a plane, y upwards.

    Attributes:
        centres: of the vertices, an (n, 2) array.
        chains: the control points of each edge, from centre to centre, the lesser dart first.
        bridges: the number of crossings; None: any.
        turn: whether it may be turned.
    """

    kind: Kind
    centres: Floats
    chains: tuple[Floats, ...]
    bridges: int | None = None
    turn: bool = True


def fitted(sketch: Sketch, rounding: float) -> Layout:
    """The layout of the sketch, with the largest clear circles."""
    centres, chains = _upright(sketch)
    radius = clear_radius(centres, chains, rounding)
    corner, size = _box(centres, chains)
    longest = LONGEST_SIDE * max(1.0, len(chains) / MANY)
    scale = min(RADIUS / radius, longest / max(float(size.max()), radius))
    radius *= scale
    margin = MARGIN * radius
    centres = (centres - corner) * scale + margin
    chains = [(chain - corner) * scale + margin for chain in chains]
    width, height = (size * scale + 2 * margin).tolist()
    paths = [path(chain, radius, rounding) for chain in chains]
    return Layout(
        kind=sketch.kind,
        width=round(width, 2),
        height=round(height, 2),
        radius=round(radius, 2),
        centres=tuple((round(x, 2), round(y, 2)) for x, y in centres.tolist()),
        paths=tuple((data,) for data in paths),
        bridges=find_bridges(paths, radius),
    )


def path(chain: Floats, radius: float, rounding: float) -> str:
    """Path data of an edge, from circle to circle."""
    points = chain.copy()
    points[0] += radius * _towards(chain[1] - chain[0])
    points[-1] += radius * _towards(chain[-2] - chain[-1])
    return curves.smooth([(x, y) for x, y in points.tolist()], rounding)


def find_bridges(paths: Sequence[str], radius: float) -> tuple[Bridge, ...]:
    """Bridges where the paths cross; the later edge passes over."""
    flat = [curves.flatten(data) for data in paths]
    places = crossings(flat)
    half = 0.9 * radius
    along: dict[int, list[float]] = {}
    for crossing in places:
        along.setdefault(crossing.first, []).append(crossing.along_first)
        along.setdefault(crossing.second, []).append(crossing.along_second)
    bridges: list[Bridge] = []
    for crossing in places:
        over = max(crossing.first, crossing.second)
        under = min(crossing.first, crossing.second)
        along_over = crossing.along_first if crossing.first == over else crossing.along_second
        near = [abs(along_over - other) for other in along[over] if other != along_over]
        reach = min([half, *(0.45 * gap for gap in near)])
        bridges.append(Bridge(over, under, curves.piece(flat[over], along_over, max(reach, 0.02))))
    return tuple(bridges)


def _towards(step: Floats) -> Floats:
    unit: Floats = step / max(float(np.hypot(*step)), 1e-12)
    return unit


def _upright(sketch: Sketch) -> tuple[Floats, list[Floats]]:
    turn = np.array([[1.0, 0.0], [0.0, -1.0]])
    if sketch.turn and len(sketch.centres) > 1:
        points = np.concatenate([sketch.centres, *sketch.chains])
        points = points - points.mean(0)
        spread = points.T @ points
        # libraries differ on the sign of the main axis
        angle = 0.5 * np.arctan2(2 * spread[0, 1], spread[0, 0] - spread[1, 1])
        c, s = np.cos(angle), np.sin(angle)
        turn = np.array([[c, s], [-s, c]]).T @ turn
    return sketch.centres @ turn, [chain @ turn for chain in sketch.chains]


def _box(centres: Floats, chains: Sequence[Floats]) -> tuple[Floats, Floats]:
    points = np.concatenate([centres, *chains])
    return points.min(0), points.max(0) - points.min(0)


def clear_radius(centres: Floats, chains: Sequence[Floats], rounding: float) -> float:
    """The vertex radius: a fraction of the usual edge, and clear of all else."""
    usual = [curves.length(chain) for chain in chains]
    limits = [0.18 * float(np.median(usual)) if usual else 1.0]
    if len(centres) > 1:
        apart = np.hypot(*(centres[:, None] - centres[None]).transpose(2, 0, 1))
        limits.append(0.31 * float((apart + np.diag([np.inf] * len(centres))).min()))
    for chain in chains:
        ends = (chain[1] - chain[0], chain[-2] - chain[-1])
        share = 0.7 if len(chain) > 2 else 0.3
        limits += [share * float(np.hypot(*leg)) for leg in ends]
        if np.abs(chain[0] - chain[-1]).max() == 0:
            limits.append(0.13 * curves.length(chain))
        # enlarged: path data has two decimals
        scale = 1e4 / max(float(np.abs(chain).max()), 1e-12)
        data = curves.smooth([(x, y) for x, y in (chain * scale).tolist()], rounding)
        apart = curves.distances(centres, curves.flatten(data) / scale)
        own = (np.abs(centres - chain[0]).max(1) == 0) | (np.abs(centres - chain[-1]).max(1) == 0)
        if not own.all():
            limits.append(0.62 * float(apart[~own].min()))
    # coinciding vertices make the picture untrue
    return max(min(limits), 2e-4 * float(_box(centres, chains)[1].max()), 1e-9)
