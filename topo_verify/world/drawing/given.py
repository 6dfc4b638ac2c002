"""The positions of the world's file as a sketch with straight edges, as they are or spread out."""

from __future__ import annotations

from math import sqrt

import numpy as np

from topo_verify.world.drawing.arrays import Ints
from topo_verify.world.drawing.fit import Sketch, fitted
from topo_verify.world.drawing.springs import relaxed
from topo_verify.world.rooted_map import World

CROWDED = 0.12
"""The picture is crowded if its mean side has more than sqrt(n) / CROWDED radii."""


def given(world: World) -> Sketch | None:
    """The sketch with straight edges between the world's positions.

    None if there are no positions, or edges would lie on each other.
    """
    distinct = len(set(world.positions)) == len(world.vertices)
    if not world.positions or not distinct or not world.is_simple:
        return None
    centres = np.array(world.positions, float)
    return Sketch("positions", centres, tuple(centres[_ends(world)]), turn=False)


def is_crowded(sketch: Sketch) -> bool:
    """Would the circles of the vertices be small, beside those of an even drawing?"""
    layout = fitted(sketch, 0.0)
    share = layout.radius / sqrt(layout.width * layout.height)
    return share * sqrt(len(sketch.centres)) < CROWDED


def spread(world: World, sketch: Sketch) -> Sketch | None:
    """The positions spread evenly; None where edges cross, which springs would not respect."""
    if world.genus or fitted(sketch, 0.0).bridges:
        return None
    ends = _ends(world)
    centres = relaxed(sketch.centres, ends, steps=100)
    return Sketch("planar", centres, tuple(centres[ends]), bridges=0, turn=False)


def _ends(world: World) -> Ints:
    """The two vertices of each edge."""
    return np.array([(world.vertex_of[a], world.vertex_of[b]) for a, b in world.edges], int)
