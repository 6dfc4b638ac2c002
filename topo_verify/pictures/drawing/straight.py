"""Drawings with straight edges: trees, and the positions of the world's file.

**Springs** spread a drawing evenly. No edge ever crosses another, since a vertex moves at most a
third of the way to any foreign edge, and so do that edge's ends (P. Simonetto, D. Archambault, D.
Auber and R. Bourqui, "ImPrEd: An Improved Force-Directed Algorithm that Prevents Nodes from
Crossing Edges", EuroVis 2011).
"""

from __future__ import annotations

from math import cos, pi, sin, sqrt, tau

import numpy as np

from topo_verify.pictures.drawing.arrays import Flags, Floats, Ints
from topo_verify.pictures.drawing.layout import Sketch, fitted
from topo_verify.world.rooted_map import Dart, World

LONG = 16
"""Longer paths are wound up to a spiral."""

PITCH = 1.7
"""The distance between two turns of a spiral, in edges."""


def tree(world: World) -> Sketch | None:
    """The sketch of a tree; None of any other world."""
    if len(world.edges) != len(world.vertices) - 1 or not world.edges:
        return None
    ends = ends_of(world)
    wound = max(world.degrees) <= 2 and len(world.vertices) > LONG
    centres = _spiral(world) if wound else _fan(world)
    if not wound and max(world.degrees) < len(world.edges):
        centres = relaxed(centres, ends, steps=max(60, min(300, 30_000 // len(centres))))
    chains = tuple(centres[pair] for pair in ends)
    return Sketch("planar", centres, chains, bridges=0, turn=not wound)


def _fan(world: World) -> Floats:
    """Each edge points to the middle of its wedge; leaves share the circle (J. Felsenstein)."""
    leaves = _leaves(world)
    places: dict[int, complex] = {}
    root = max(range(len(world.vertices)), key=lambda v: len(world.vertices[v]))
    total = sum(leaves[dart] for dart in world.vertices[root])
    # vertex, dart of entry, wedge
    todo: list[tuple[int, Dart | None, float, float]] = [(root, None, 0.0, tau)]
    places[root] = 0j
    while todo:
        vertex, entry, angle, _ = todo.pop()
        rotation = world.vertices[vertex]
        first = 0 if entry is None else world.place_of[entry] + 1
        row = rotation[first:] + rotation[:first]
        for dart in row if entry is None else row[:-1]:
            wide = tau * leaves[dart] / total
            middle = angle - wide / 2
            out = world.alpha[dart]
            length = 1 + 0.2 * sqrt(leaves[dart])
            end = world.vertex_of[out]
            places[end] = places[vertex] + length * complex(cos(middle), sin(middle))
            todo.append((end, out, angle, wide))
            angle -= wide
    return np.array([(places[v].real, places[v].imag) for v in range(len(world.vertices))])


def _leaves(world: World) -> dict[Dart, int]:
    leaves: dict[Dart, int] = {}
    todo = list(range(len(world.alpha)))
    while todo:
        dart = todo[-1]
        out = world.alpha[dart]
        onward = [d for d in world.vertices[world.vertex_of[out]] if d != out]
        missing = [d for d in onward if d not in leaves]
        if missing:
            todo += missing
            continue
        leaves[dart] = max(1, sum(leaves[d] for d in onward))
        todo.pop()
    return leaves


def _spiral(world: World) -> Floats:
    """Points along an Archimedean spiral, the marker's side outside."""
    start = next(v for v, degree in enumerate(world.degrees) if degree == 1)
    order, dart = [start], world.vertices[start][0]
    while True:
        out = world.alpha[dart]
        order.append(world.vertex_of[out])
        if world.sigma[out] == out:
            break
        dart = world.sigma[out]
    if order.index(world.marker_vertex) < len(order) / 2:
        order.reverse()
    turn = 1.6 * pi
    places: dict[int, tuple[float, float]] = {}
    for vertex in order:
        radius = PITCH * turn / tau
        places[vertex] = (radius * cos(turn), radius * sin(turn))
        turn += 1 / radius
    return np.array([places[v] for v in range(len(order))])


ROOM = 1.0
"""A vertex and a foreign edge repel each other at a smaller distance."""

GRAVITY = 0.02

STIFF = 0.15
"""The move for a force of 1."""


def relaxed(centres: Floats, ends: Ints, *, steps: int) -> Floats:
    """The vertices after this number of steps.

    Args:
        centres: of a drawing in which straight edges show every order.
        ends: an (m, 2) array.
    """
    lengths = np.hypot(*(centres[ends[:, 1]] - centres[ends[:, 0]]).T)
    places = centres / float(np.median(lengths))
    own = np.zeros((len(places), len(ends)), bool)
    own[ends[:, 0], np.arange(len(ends))] = own[ends[:, 1], np.arange(len(ends))] = True
    for k in range(steps):
        force, near = _forces(places, ends, own)
        move = STIFF * force
        reach = np.hypot(*move.T)
        most = np.minimum(0.5 * (1 - k / steps) + 0.01, near / 3)
        places = places + move * (np.minimum(reach, most) / np.maximum(reach, 1e-12))[:, None]
    return places


def _forces(places: Floats, ends: Ints, own: Flags) -> tuple[Floats, Floats]:
    """The force on each vertex, and the distance that its moves must not cover."""
    x, y = places.T
    tail, head = ends.T
    force = np.zeros_like(places)
    # at short range, or far clusters would spread the whole
    dx, dy = x[:, None] - x, y[:, None] - y
    square = dx * dx + dy * dy
    np.fill_diagonal(square, np.inf)
    weight = 1 / (square * square)
    force[:, 0], force[:, 1] = (dx * weight).sum(1), (dy * weight).sum(1)
    ex, ey = x[head] - x[tail], y[head] - y[tail]
    length = np.hypot(ex, ey)
    force -= GRAVITY * (places - places.mean(0))
    pull = (1 - 1 / np.maximum(length, 1e-9)) * np.stack([ex, ey])
    # vertices and foreign edges
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


CROWDED = 0.12
"""A picture is crowded with more than sqrt(n) / CROWDED radii along its mean side."""


def given(world: World) -> Sketch | None:
    """The positions with straight edges; None without positions, or if edges coincide."""
    distinct = len(set(world.positions)) == len(world.vertices)
    if not world.positions or not distinct or not world.is_simple:
        return None
    centres = np.array(world.positions, float)
    return Sketch("positions", centres, tuple(centres[ends_of(world)]), turn=False)


def is_crowded(sketch: Sketch) -> bool:
    """Whether the circles are small, compared with an even drawing."""
    layout = fitted(sketch, 0.0)
    share = layout.radius / sqrt(layout.width * layout.height)
    return share * sqrt(len(sketch.centres)) < CROWDED


def spread(world: World, sketch: Sketch) -> Sketch | None:
    """The positions spread evenly; None if edges cross."""
    if world.genus or fitted(sketch, 0.0).bridges:
        return None
    ends = ends_of(world)
    centres = relaxed(sketch.centres, ends, steps=100)
    return Sketch("planar", centres, tuple(centres[ends]), bridges=0, turn=False)


def ends_of(world: World) -> Ints:
    """The two vertices of each edge."""
    return np.array([(world.vertex_of[a], world.vertex_of[b]) for a, b in world.edges], int)
