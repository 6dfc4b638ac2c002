"""A triangulated disc over a plane map: what is drawn lies on its edges.

Every half-edge pair gets points between its ends, every face a centre, and a face that touches
itself a collar within its walk. So the mesh has no loops and no parallel edges, whatever the map
has. The outer face becomes rings of triangles around the rest.

Each point has a wished radius. The wished length of an edge of the mesh is the sum of two radii,
which makes the wished triangles: where many edges meet, they are longer.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from math import pi, sin

import numpy as np

from topo_verify.world.drawing.arrays import Floats, Ints
from topo_verify.world.drawing.plane_map import PlaneMap

COLLAR, RING, OUTER = 0.6, 0.25, 0.04
"""The weights of the triangles of collars and of the two rings around everything."""

AROUND = 3.0
"""How much more a triangle weighs that has a vertex of the world for a corner."""


@dataclass(frozen=True)
class Mesh:
    """A triangulated disc, with the points and edges of the plane map on it.

    Attributes:
        size: the number of points; those of the plane map's nodes come first.
        triangles: three points each, counter-clockwise with y upwards.
        weights: how much the shape of each triangle matters.
        radii: the wished radius of each point.
        rim: the points on the boundary, counter-clockwise.
        between: the points between the ends of each half-edge, from its node on.
        lines: three points in a row each, along the edges of the world.
    """

    size: int
    triangles: Ints
    weights: Floats
    radii: Floats
    rim: Ints
    between: dict[int, tuple[int, ...]]
    lines: Ints


class _Builder:
    def __init__(self, plane: PlaneMap, points: int) -> None:
        self.size, self.vertices = plane.nodes, plane.vertices
        self.triangles: list[tuple[int, int, int]] = []
        self.weights: list[float] = []
        self.between: dict[int, tuple[int, ...]] = {}
        for half, other in enumerate(plane.other):
            if half < other:
                loop = plane.node[half] == plane.node[other]
                made = self.new(max(points, 2) if loop else points)
                self.between[half], self.between[other] = made, made[::-1]

    def new(self, number: int) -> tuple[int, ...]:
        """The numbers of new points, added at the end."""
        self.size += number
        return tuple(range(self.size - number, self.size))

    def triangle(self, a: int, b: int, c: int, weight: float) -> None:
        """A triangle that is counter-clockwise."""
        self.triangles.append((a, b, c))
        self.weights.append(weight * (AROUND if min(a, b, c) < self.vertices else 1))

    def strip(self, walk: tuple[int, ...], weight: float) -> tuple[int, ...]:
        """Triangles between a walk and a new cycle on its left."""
        inner = self.new(len(walk))
        for j, (a, d) in enumerate(zip(walk, inner, strict=True)):
            b, c = walk[(j + 1) % len(walk)], inner[(j + 1) % len(walk)]
            self.triangle(a, b, d, weight)
            self.triangle(b, c, d, weight)
        return inner


def over(plane: PlaneMap, outer: int, *, points: int) -> Mesh:
    """The mesh over the plane map.

    Args:
        outer: a half-edge of the face that becomes the outer one.
        points: how many points lie between the two ends of a half-edge pair (loops: 2 at least).
    """
    builder = _Builder(plane, points)
    rim: tuple[int, ...] = ()
    for face in plane.faces():
        walk = tuple(p for half in face for p in (plane.node[half], *builder.between[half]))
        if outer in face:
            rim = builder.strip(builder.strip(walk, RING), OUTER)
            continue
        weight = 1.0
        if len(set(walk)) < len(walk):
            walk, weight = builder.strip(walk, COLLAR), COLLAR
        (centre,) = builder.new(1)
        for j, a in enumerate(walk):
            builder.triangle(a, walk[(j + 1) % len(walk)], centre, weight)
    triangles = np.array(builder.triangles)
    return Mesh(
        size=builder.size,
        triangles=triangles,
        radii=_radii(plane, builder),
        weights=np.array(builder.weights),
        # The walk of the outer face has the disc on its right.
        rim=np.array(rim[::-1]),
        between=builder.between,
        lines=_lines(plane, builder),
    )


def _radii(plane: PlaneMap, builder: _Builder) -> Floats:
    """The radius of a point is about that around which one circle for each neighbour fits."""
    degree = Counter(p for triangle in builder.triangles for p in triangle)
    drawn = {p for made in builder.between.values() for p in made}
    radii = np.full(builder.size, 0.5)
    for point, number in degree.items():
        fit = 0.5 / sin(pi / max(number, 3)) - 0.5
        if point in drawn:
            radii[point] = 0.4
        elif point < plane.vertices:
            radii[point] = max(0.8, fit**0.6)
        elif point >= plane.nodes:
            radii[point] = max(0.3, fit) ** 0.8
    return radii


def _lines(plane: PlaneMap, builder: _Builder) -> Ints:
    rows: list[tuple[int, int, int]] = []
    for number in range(len(plane.world.edges)):
        chain = points_of(plane, builder.between, number)
        rows += zip(chain, chain[1:], chain[2:], strict=False)
    return np.array(rows, int).reshape(-1, 3)


def points_of(plane: PlaneMap, between: dict[int, tuple[int, ...]], number: int) -> list[int]:
    """The points of the mesh along an edge of the world, from its lesser dart's vertex on."""
    chain = plane.chain(number)
    found = [plane.node[chain[0]]]
    for half in chain:
        found += [*between[half], plane.node[plane.other[half]]]
    return found
