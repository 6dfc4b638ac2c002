"""Trees with straight edges; a long path is wound up to a spiral."""

from __future__ import annotations

from math import cos, pi, sin, sqrt, tau

import numpy as np

from topo_verify.world.drawing.arrays import Floats
from topo_verify.world.drawing.fit import Sketch
from topo_verify.world.drawing.springs import relaxed
from topo_verify.world.rooted_map import Dart, World

LONG = 16
"""The vertices of a path beyond which it is wound up."""

PITCH = 1.7
"""The distance between two turns of a spiral, in edges."""


def tree(world: World) -> Sketch | None:
    """The sketch of a tree; None of any other world."""
    if len(world.edges) != len(world.vertices) - 1 or not world.edges:
        return None
    ends = np.array([(world.vertex_of[a], world.vertex_of[b]) for a, b in world.edges])
    wound = max(world.degrees) <= 2 and len(world.vertices) > LONG
    centres = _spiral(world) if wound else _fan(world)
    if not wound and max(world.degrees) < len(world.edges):  # a star is fine as it is
        centres = relaxed(centres, ends, steps=_steps(world))
    chains = tuple(centres[pair] for pair in ends)
    return Sketch("planar", centres, chains, bridges=0, turn=not wound)


def _steps(world: World) -> int:
    return max(60, min(300, 30_000 // len(world.vertices)))


def _fan(world: World) -> Floats:
    """Each edge points to the middle of its wedge; the wedges share the circle by their leaves.

    (J. Felsenstein's equal-angle algorithm: no edges cross, whatever their lengths.)
    """
    leaves = _leaves(world)
    places: dict[int, complex] = {}
    root = max(range(len(world.vertices)), key=lambda v: len(world.vertices[v]))
    total = sum(leaves[dart] for dart in world.vertices[root])
    # The vertex, the dart by which it was entered, the wedge that it has.
    todo: list[tuple[int, Dart | None, float, float]] = [(root, None, 0.0, tau)]
    places[root] = 0j
    while todo:
        vertex, entry, angle, _ = todo.pop()
        rotation = world.vertices[vertex]
        first = 0 if entry is None else world.place_of[entry] + 1
        row = rotation[first:] + rotation[:first]
        for dart in row if entry is None else row[:-1]:
            wide = tau * leaves[dart] / total
            # Clockwise with y upwards: angles fall.
            middle = angle - wide / 2
            out = world.alpha[dart]
            length = 1 + 0.2 * sqrt(leaves[dart])
            end = world.vertex_of[out]
            places[end] = places[vertex] + length * complex(cos(middle), sin(middle))
            todo.append((end, out, angle, wide))
            angle -= wide
    return np.array([(places[v].real, places[v].imag) for v in range(len(world.vertices))])


def _leaves(world: World) -> dict[Dart, int]:
    """The number of leaves beyond each dart."""
    found: dict[Dart, int] = {}
    todo = list(range(len(world.alpha)))
    while todo:
        dart = todo[-1]
        out = world.alpha[dart]
        onward = [d for d in world.vertices[world.vertex_of[out]] if d != out]
        missing = [d for d in onward if d not in found]
        if missing:
            todo += missing
            continue
        found[dart] = max(1, sum(found[d] for d in onward))
        todo.pop()
    return found


def _spiral(world: World) -> Floats:
    """Points at distances of about 1 along an Archimedean spiral, the marker's side outside."""
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
