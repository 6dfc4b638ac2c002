"""Springs for drawings with straight edges: evenly spread, and no edge ever crosses another.

A vertex moves at most a third of the way to any edge that is not its own, and so do the ends of
that edge: what was plane stays plane, and every cyclic order stays (P. Simonetto, D. Archambault,
D. Auber and R. Bourqui, "ImPrEd: An Improved Force-Directed Algorithm that Prevents Nodes from
Crossing Edges", EuroVis 2011).
"""

from __future__ import annotations

import numpy as np

from topo_verify.world.drawing.arrays import Flags, Floats, Ints

ROOM = 1.0
"""The distance between a vertex and a foreign edge below which they push each other away."""

GRAVITY = 0.02
"""A pull to the middle, which folds what would get long."""

STIFF = 0.15
"""How far a vertex moves for a force of 1."""


def relaxed(centres: Floats, ends: Ints, *, steps: int) -> Floats:
    """The vertices after so many steps.

    Args:
        centres: of a drawing in which straight edges show every order.
        ends: the two vertices of each edge, an (m, 2) array.
    """
    lengths = np.hypot(*(centres[ends[:, 1]] - centres[ends[:, 0]]).T)
    places = centres / float(np.median(lengths))
    own = np.zeros((len(places), len(ends)), bool)
    own[ends[:, 0], np.arange(len(ends))] = own[ends[:, 1], np.arange(len(ends))] = True
    for k in range(steps):
        force, near = _forces(places, ends, own)
        move = STIFF * force
        reach = np.hypot(*move.T)
        # Slower and slower, so that it comes to rest.
        most = np.minimum(0.5 * (1 - k / steps) + 0.01, near / 3)
        places = places + move * (np.minimum(reach, most) / np.maximum(reach, 1e-12))[:, None]
    return places


def _forces(places: Floats, ends: Ints, own: Flags) -> tuple[Floats, Floats]:
    """The force on each vertex, and the distance to what its moves must not reach."""
    x, y = places.T
    tail, head = ends.T
    force = np.zeros_like(places)
    # Vertices push each other away, on short ways mostly: far clusters shall not spread the whole.
    dx, dy = x[:, None] - x, y[:, None] - y
    square = dx * dx + dy * dy
    np.fill_diagonal(square, np.inf)
    weight = 1 / (square * square)
    force[:, 0], force[:, 1] = (dx * weight).sum(1), (dy * weight).sum(1)
    ex, ey = x[head] - x[tail], y[head] - y[tail]
    length = np.hypot(ex, ey)
    force -= GRAVITY * (places - places.mean(0))
    pull = (1 - 1 / np.maximum(length, 1e-9)) * np.stack([ex, ey])
    # Vertices and foreign edges.
    ox, oy = x[:, None] - x[tail], y[:, None] - y[tail]
    t = np.clip((ox * ex + oy * ey) / np.maximum(length * length, 1e-24), 0, 1)
    gx, gy = ox - t * ex, oy - t * ey
    distance = np.hypot(gx, gy)
    distance[own] = np.inf
    push = np.maximum(ROOM - distance, 0) / np.maximum(distance, 1e-9)
    push *= push
    px, py = gx * push, gy * push
    force[:, 0] += px.sum(1)
    force[:, 1] += py.sum(1)
    on_head = np.stack([(px * t).sum(0), (py * t).sum(0)])
    on_tail = np.stack([px.sum(0), py.sum(0)]) - on_head
    np.add.at(force, tail, (pull - on_tail).T)
    np.add.at(force, head, (-pull - on_head).T)
    near, beside = distance.min(1), distance.min(0)
    np.minimum.at(near, tail, beside)
    np.minimum.at(near, head, beside)
    return force, near
