"""Sketches of any world as a plane map with bridges.

**A drawing on a grid** is a first injective map of the mesh into the plane, without triangles too
small for floating-point numbers (M. Chrobak and T. Payne, "A linear-time algorithm for drawing a
planar graph on a grid", 1995). Rejected: a circle packing, whose circles shrink exponentially where
loops lie within loops.

**Polishing** brings triangles towards wished shapes. The energy of a triangle is the symmetric
Dirichlet energy of the linear map J from its wished shape, |J|² + |J⁻¹|², infinite where it would
flip. Bends along edges of the world cost their squares. Newton's method uses the Hessian of every
triangle, made positive by its eigenvalues in closed form (B. Smith, F. de Goes and T. Kim,
"Analytic Eigensystems for Isotropic Distortion Energies", ACM TOG 2019). Far triangles get a nearer
wish first (L. Liu et al., "Progressive Parameterizations", ACM TOG 2018).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import sqrt
from typing import Any

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from topo_verify.pictures.drawing.arrays import Floats, Ints, solve
from topo_verify.pictures.drawing.layout import Kind, Sketch
from topo_verify.pictures.drawing.plane_map import (
    RING,
    Mesh,
    PlaneMap,
    best_plane_map,
    over,
    points_of,
)
from topo_verify.world.rooted_map import World

BEND = 0.4
"""The cost of a bend, beside that of a triangle's shape."""

STEPS = 60

ATTEMPTS, LARGE_ATTEMPTS = 6, 2
"""Attempts for worlds with at most 100 edges, and with more."""


def planar(world: World) -> Iterator[Sketch]:
    """Sketches of the world, the most promising first."""
    if not world.edges:
        yield Sketch("planar", np.zeros((1, 2)), ())
        return
    tried = set[tuple[int, int]]()
    for attempt in range(ATTEMPTS if len(world.edges) <= 100 else LARGE_ATTEMPTS):
        plane = best_plane_map(world, seed=attempt // 2)
        if plane is None:
            return
        outers = outer_faces(plane)
        outer = outers[min(attempt % 2 if attempt < 4 else attempt - 2, len(outers) - 1)]
        if (attempt // 2, outer) in tried:
            continue
        tried.add((attempt // 2, outer))
        points = 2 if len(plane.other) < 600 else 1
        mesh = over(plane, outer, points=points)
        places = polished(mesh, gridded(mesh), bend=BEND, steps=STEPS)
        chains = [
            places[points_of(plane, mesh.between, number)] for number in range(len(world.edges))
        ]
        kind: Kind = "bridges" if plane.crossings else "planar"
        yield Sketch(kind, places[: plane.vertices], tuple(chains), bridges=plane.crossings)


def outer_faces(plane: PlaneMap) -> list[int]:
    """A half-edge of each face, the best outer face first."""
    faces = plane.faces()

    def worth(face: list[int]) -> tuple[int, int]:
        edges = {plane.edge[half] for half in face}
        dummies = sum(plane.node[half] >= plane.vertices for half in face)
        return len(edges) - 2 * dummies, len(face)

    by_size = sorted(faces, key=worth, reverse=True)
    middle = min(by_size[:40], key=lambda face: (_depth(plane, face), -len(face)))
    rest = [face for face in by_size if face is not by_size[0] and face is not middle]
    best = [by_size[0]] if middle is by_size[0] else [by_size[0], middle]
    return [face[0] for face in (*best, *rest)]


def _depth(plane: PlaneMap, face: list[int]) -> tuple[int, float]:
    """The rings of faces around this one, and the mean distance of a node."""
    visited, ring = {plane.face[face[0]]}, [face]
    nodes: set[int] = set()
    depth = total = 0
    at: dict[int, list[int]] = {}
    for half, node in enumerate(plane.node):
        at.setdefault(node, []).append(half)
    while ring:
        fresh = {plane.node[half] for around in ring for half in around} - nodes
        nodes |= fresh
        total += depth * len(fresh)
        depth += 1
        ring = list[list[int]]()
        for node in sorted(fresh):
            for half in at[node]:
                if plane.face[half] not in visited:
                    visited.add(plane.face[half])
                    ring.append(plane.cycle(half))
    return depth, total / len(nodes)


def gridded(mesh: Mesh) -> Floats:
    """The points of the mesh on a grid whose frame is equilateral."""
    before: dict[int, dict[int, int]] = {}  # [point][neighbour]: the next one clockwise
    for x, y, z in [*mesh.triangles.tolist(), mesh.frame[::-1].tolist()]:
        for point, next_point, other in ((x, y, z), (y, z, x), (z, x, y)):
            before.setdefault(point, {})[other] = next_point
    corners: list[int] = mesh.frame.tolist()
    # the outer face, for NetworkX
    first = {corners[0]: corners[1]}
    embedding: nx.PlanarEmbedding[int] = nx.PlanarEmbedding()
    embedding.set_data(
        {
            point: [*_cycle(before[point], first.get(point, next(iter(before[point]))))]
            for point in dict.fromkeys([*corners, *range(mesh.size)])
        }
    )
    grid: Any = nx.combinatorial_embedding_to_pos(embedding)
    places = np.array([grid[point] for point in range(mesh.size)], float)
    a, b, c = places[mesh.frame]
    upright = np.array([[1, 0], [0.5, sqrt(3) / 2]])
    return np.asarray((places - a) @ np.linalg.inv(np.array([b - a, c - a])) @ upright, np.float64)


def _cycle(after: Mapping[int, int], start: int) -> Iterator[int]:
    at = start
    while True:
        yield at
        at = after[at]
        if at == start:
            return


NEAR = 60.0
"""A triangle with more energy gets a nearer wish; the least energy is 4."""

ENOUGH = 3e-4
"""The polish ends when a step gains a smaller share of the energy."""


@dataclass(frozen=True)
class _Energy:
    """The energy of one mesh and its derivatives.

    Attributes:
        inverse: of each triangle's wished shape, edges from the first corner as columns.
        free: the coordinates that may move, in the order x0 y0 x1 y1 …
    """

    triangles: Ints
    weights: Floats
    inverse: Floats
    lines: Ints
    bend: float
    size: int
    free: NDArray[np.bool_]

    def jacobians(self, places: Floats, inverse: Floats) -> Floats:
        a, b, c = (places[self.triangles[:, k]] for k in range(3))
        jacobians: Floats = np.stack([b - a, c - a], 2) @ inverse
        return jacobians

    def bends(self, places: Floats) -> Floats:
        a, b, c = (places[self.lines[:, k]] for k in range(3))
        bends: Floats = a - 2 * b + c
        return bends

    def value(self, places: Floats, inverse: Floats) -> float:
        j = self.jacobians(places, inverse)
        det = j[:, 0, 0] * j[:, 1, 1] - j[:, 0, 1] * j[:, 1, 0]
        if not det.min() > 0:
            return float("inf")
        shape = (self.weights * (j**2).sum((1, 2)) * (1 + 1 / det**2)).sum()
        return float(shape + self.bend * (self.bends(places) ** 2).sum())

    def step(self, places: Floats, *, near: bool) -> tuple[Floats, Floats, Floats, float]:
        """The step, the gradient, the wishes that they serve, and the worst triangle's energy.

        Args:
            near: bring wishes nearer, and take bolder steps.
        """
        u, s, v = np.linalg.svd(self.jacobians(places, self.inverse))
        worst = float((s**2 + s**-2).sum(1).max())
        exponent = _nearer(s) if near else np.ones(len(s))
        # J becomes U S^t V: the wish is stretched by V' S^(t-1) V
        stretch = s ** (exponent - 1)[:, None]
        inverse = self.inverse @ (v.transpose(0, 2, 1) * stretch[:, None, :]) @ v
        s = s ** exponent[:, None]
        slope = 2 * s - 2 * s**-3
        force = (u * (self.weights[:, None] * slope)[:, None, :]) @ v @ inverse.transpose(0, 2, 1)
        gradient = np.zeros((self.size, 2))
        for k in (0, 1):
            np.add.at(gradient, self.triangles[:, k + 1], force[:, :, k])
            np.add.at(gradient, self.triangles[:, 0], -force[:, :, k])
        bends = 2 * self.bend * self.bends(places)
        for k, share in enumerate((1, -2, 1)):
            np.add.at(gradient, self.lines[:, k], share * bends)
        rows, columns, values = self._hessian(u, s, v, inverse, bold=near)
        kept = self.free[rows] & self.free[columns]
        number = np.cumsum(self.free) - 1
        flat = gradient.ravel()
        move = np.zeros(2 * self.size)
        move[self.free] = solve(
            number[rows[kept]], number[columns[kept]], values[kept], -flat[self.free]
        )
        return move.reshape(-1, 2), np.where(self.free, flat, 0).reshape(-1, 2), inverse, worst

    def _hessian(
        self, u: Floats, s: Floats, v: Floats, inverse: Floats, *, bold: bool
    ) -> tuple[Ints, Ints, Floats]:
        """Rows, columns and values of the Hessian, each triangle's part made positive.

        Args:
            bold: for stretches below 1 the secant of the slope to 1 replaces its derivative, so
                Newton's step multiplies a small stretch by 4/3 at most.
        """
        a, b = s[:, 0], s[:, 1]
        cube = (a * b) ** 3
        eigenvalues = np.stack(
            [
                _stiffness(a, bold=bold),
                _stiffness(b, bold=bold),
                2 - 2 * (a * a - a * b + b * b) / cube,
                2 + 2 * (a * a + a * b + b * b) / cube,
            ],
            1,
        )
        eigenvalues = np.maximum(eigenvalues, 1e-6) * self.weights[:, None]
        u0, u1, v0, v1 = u[:, :, 0], u[:, :, 1], v[:, 0, :], v[:, 1, :]

        def outer(x: Floats, y: Floats) -> Floats:
            product: Floats = x[:, :, None] * y[:, None, :]
            return product

        twist, flip = outer(u1, v0) - outer(u0, v1), outer(u1, v0) + outer(u0, v1)
        modes = np.stack([outer(u0, v0), outer(u1, v1), twist / np.sqrt(2), flip / np.sqrt(2)], 1)
        grow = np.concatenate([-inverse.sum(1, keepdims=True), inverse], 1)
        # (triangle, mode, coordinate, corner) -> (triangle, mode, 6)
        parts = modes @ grow.transpose(0, 2, 1)[:, None]
        parts = parts.transpose(0, 1, 3, 2).reshape(len(a), 4, 6)
        blocks = parts.transpose(0, 2, 1) @ (parts * eigenvalues[:, :, None])
        index = (2 * self.triangles[:, :, None] + np.array([0, 1])).reshape(-1, 6)
        rows = np.repeat(index, 6, 1).ravel()
        columns = np.tile(index, (1, 6)).ravel()
        share = np.array([1, -2, 1])
        pairs = 2 * self.bend * np.outer(share, share).ravel()
        line_rows, line_columns = np.repeat(self.lines, 3, 1).ravel(), np.tile(self.lines, (1, 3))
        bent = np.tile(pairs, len(self.lines))
        more = [(2 * line_rows + k, 2 * line_columns.ravel() + k, bent) for k in (0, 1)]
        return (
            np.concatenate([rows, *(m[0] for m in more)]),
            np.concatenate([columns, *(m[1] for m in more)]),
            np.concatenate([blocks.ravel(), *(m[2] for m in more)]),
        )


def _stiffness(s: Floats, *, bold: bool) -> Floats:
    newton: Floats = 2 + 6 * s**-4
    if not bold:
        return newton
    secant: Floats = np.where(s < 1, 2 * (1 + s) * (1 + s * s) * s**-3, newton)
    return secant


def _nearer(s: Floats) -> Floats:
    """The exponents t, at most 1, for which the energies of s^t are at most `NEAR`."""

    def energy(t: Floats) -> Floats:
        power = s ** (2 * t)[:, None]
        total: Floats = (power + 1 / power).sum(1)
        return total

    whole = np.ones(len(s))
    far = energy(whole) > NEAR
    low, high = np.zeros(len(s)), whole.copy()
    for _ in range(18):
        middle = (low + high) / 2
        fits = energy(middle) <= NEAR
        low, high = np.where(fits, middle, low), np.where(fits, high, middle)
    return np.where(far, low, whole)


def polished(mesh: Mesh, places: Floats, *, bend: float, steps: int) -> Floats:
    """The mesh's points after at most `steps` steps; injective if `places` are."""
    free = np.ones(2 * mesh.size, bool)
    free[2 * mesh.frame] = free[2 * mesh.frame + 1] = False
    energy = _Energy(mesh.triangles, mesh.weights, _wishes(mesh), mesh.lines, bend, mesh.size, free)
    places = _scaled(mesh, places)
    near, worsts = True, list[float]()
    for _ in range(steps):
        move, gradient, inverse, worst = energy.step(places, near=near)
        now = energy.value(places, inverse)
        slope = float((gradient * move).sum())
        step = min(1.0, 0.9 * _first_flip(mesh.triangles, places, move))
        then = energy.value(places + step * move, inverse)
        while then > now + 1e-4 * step * slope and step > 1e-10:
            step *= 0.5
            then = energy.value(places + step * move, inverse)
        if then < now:
            places = places + step * move
        if near:
            # wishes may change for ever
            worsts.append(worst)
            near = worst > NEAR and not worst > 0.5 * min([np.inf, *worsts[-4:-3]])
        elif now - then < ENOUGH * now:
            break
    return places


def _wishes(mesh: Mesh) -> Floats:
    ra, rb, rc = (mesh.radii[mesh.triangles[:, k]] for k in range(3))
    ab, ac, bc = ra + rb, ra + rc, rb + rc
    shape = np.zeros((len(ab), 2, 2))
    shape[:, 0, 0] = ab
    shape[:, 0, 1] = x = (ab**2 + ac**2 - bc**2) / (2 * ab)
    shape[:, 1, 1] = np.sqrt(np.maximum(ac**2 - x**2, 1e-12))
    return np.asarray(np.linalg.inv(shape), np.float64)


def _scaled(mesh: Mesh, places: Floats) -> Floats:
    areas = 0.5 / np.linalg.det(_wishes(mesh))
    room = float(areas[mesh.weights >= RING].sum())
    centre = places[mesh.frame].mean(0)
    reach = float(np.hypot(*(places[mesh.frame] - centre).T).max())
    scaled: Floats = (places - centre) * (4.0 * np.sqrt(room / np.pi) / reach)
    return scaled


def _first_flip(triangles: Ints, places: Floats, move: Floats) -> float:
    a, da = places[triangles[:, 0]], move[triangles[:, 0]]
    u, v = places[triangles[:, 1]] - a, places[triangles[:, 2]] - a
    du, dv = move[triangles[:, 1]] - da, move[triangles[:, 2]] - da

    def cross(p: Floats, q: Floats) -> Floats:
        product: Floats = p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]
        return product

    quadratic, linear, constant = cross(du, dv), cross(u, dv) + cross(du, v), cross(u, v)
    square = linear**2 - 4 * quadratic * constant
    root = np.sqrt(np.maximum(square, 0))
    with np.errstate(divide="ignore", invalid="ignore"):
        times = np.stack([2 * constant / (-linear + root), 2 * constant / (-linear - root)])
    times = np.where((times > 0) & (square >= 0), times, np.inf)
    return float(np.nanmin(times, initial=np.inf))
