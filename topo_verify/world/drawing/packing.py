"""A circle packing of a triangulated disc: a first injective map of the mesh into the plane.

Every point becomes a circle that touches the circles of its neighbours. The radii follow from the
angles (2 pi around inner points, those of a regular polygon on the rim) by Newton's method on their
logarithms, a convex problem (C. Collins and K. Stephenson, "A circle packing algorithm", 2003; Y.
Colin de Verdière, "Un principe variationnel pour les empilements de cercles", 1991).
"""

from __future__ import annotations

import heapq
from math import pi, sqrt

import numpy as np

from topo_verify.world.drawing.arrays import Floats
from topo_verify.world.drawing.mesh import Mesh
from topo_verify.world.drawing.sparse import solve


def packed(mesh: Mesh) -> Floats | None:
    """The centres of the circles; None if rounding errors have spoilt a triangle."""
    try:
        places = _laid(mesh, _radii(mesh))
    except ZeroDivisionError:  # two circles of no size
        return None
    corners = places[mesh.triangles]
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    sound = np.isfinite(places).all() and bool(
        (area > 1e-7 * np.hypot(*u.T) * np.hypot(*v.T)).all()
    )
    return places if sound else None


def _radii(mesh: Mesh) -> Floats:
    a, b, c = mesh.triangles.T
    size = mesh.size
    goal = np.full(size, 2 * pi)
    goal[mesh.rim] = pi - 2 * pi / len(mesh.rim)
    rows, columns = np.concatenate([a, b, b, c, c, a]), np.concatenate([b, a, c, b, a, c])
    # One radius is free: that of the first point stays.
    kept = (rows > 0) & (columns > 0)
    diagonal = np.arange(1, size)

    def angles(log_radii: Floats) -> tuple[Floats, Floats]:
        """The angle sums less the goal, and half the heights over which angles change."""
        ra, rb, rc = (np.exp(log_radii)[corner] for corner in (a, b, c))
        h = np.sqrt(ra * rb * rc / (ra + rb + rc))
        total = np.zeros(size)
        for corner, r in ((a, ra), (b, rb), (c, rc)):
            total += np.bincount(corner, 2 * np.arctan2(h, r), size)
        weights = [h / (ra + rb), h / (rb + rc), h / (rc + ra)]
        return goal - total, np.concatenate([w for w in weights for _ in (0, 1)])

    log_radii = np.zeros(size)
    residual, weights = angles(log_radii)
    for _ in range(60):
        if np.abs(residual).max() < 1e-9:
            break
        sums = np.asarray(np.bincount(rows, weights, size), np.float64)
        change = np.zeros(size)
        change[1:] = solve(
            np.concatenate([rows[kept] - 1, diagonal - 1]),
            np.concatenate([columns[kept] - 1, diagonal - 1]),
            np.concatenate([-weights[kept], sums[1:]]),
            -residual[1:],
        )
        step = min(1.0, 2 / float(np.abs(change).max()))
        trial, trial_weights = angles(log_radii + step * change)
        while not (trial**2).sum() < (residual**2).sum() and step > 1e-6:
            step /= 2
            trial, trial_weights = angles(log_radii + step * change)
        if step <= 1e-6:
            break
        log_radii, residual, weights = log_radii + step * change, trial, trial_weights
    radii: Floats = np.exp(log_radii - log_radii.max())
    return radii


def _laid(mesh: Mesh, radii: Floats) -> Floats:
    """The centres, from the largest circles to the smallest, which keeps errors small."""
    r = radii.tolist()
    apex: dict[tuple[int, int], int] = {}
    for x, y, z in mesh.triangles.tolist():
        apex[x, y], apex[y, z], apex[z, x] = z, x, y
    first = max(range(mesh.size), key=lambda p: r[p])
    second = max((q for p, q in apex if p == first), key=lambda q: r[q])
    at: dict[int, complex] = {first: 0j, second: complex(r[first] + r[second])}
    heap: list[tuple[float, int, int]] = []

    def push(x: int, y: int) -> None:
        if (x, y) in apex:
            heapq.heappush(heap, (-min(r[x], r[y]), x, y))

    push(first, second)
    push(second, first)
    done: set[tuple[int, int]] = set()
    while heap:
        _, x, y = heapq.heappop(heap)
        z = apex[x, y]
        if (x, y) in done:
            continue
        done |= {(x, y), (y, z), (z, x)}
        if z not in at:
            near, far, third = r[x] + r[y], r[x] + r[z], r[y] + r[z]
            cosine = (near * near + far * far - third * third) / (2 * near * far)
            cosine = max(-1.0, min(1.0, cosine))
            along = (at[y] - at[x]) / abs(at[y] - at[x])
            at[z] = at[x] + far * along * complex(cosine, sqrt(1 - cosine * cosine))
        push(z, y)
        push(x, z)
    return np.array([(at[p].real, at[p].imag) for p in range(mesh.size)])
