"""Chooses how a world is drawn, and tries again until the picture is true."""

from __future__ import annotations

from collections.abc import Iterator

from topo_verify.errors import InternalError
from topo_verify.world.drawing import read_back
from topo_verify.world.drawing.ball import LIMIT, ball, put_back
from topo_verify.world.drawing.fit import Sketch, fitted
from topo_verify.world.drawing.given import given, is_crowded, spread
from topo_verify.world.drawing.layout import Layout
from topo_verify.world.drawing.planar import planar
from topo_verify.world.drawing.svg import to_svg
from topo_verify.world.drawing.torus_cell import cell
from topo_verify.world.drawing.trees import tree
from topo_verify.world.rooted_map import Dart, World

ROUNDINGS = (0.5, 0.35, 0.2, 0.1, 0.0)
"""How round the corners of edges are, the roundest first."""

ROOMY = 0.025
"""The radius, as a share of the picture's longer side, with which anybody is content."""

CRAMPED = 0.0003
"""The same, at which vertices have no room; `fit` makes no radius smaller than 0.0002."""

READABLE = 250
"""The vertices of a random map beyond which only a ball is shown."""

SIMPLE_READABLE = 600
"""The same for plane maps without loops and parallel edges."""


def lay_out(world: World, *, centre: Dart | None = None) -> Layout:
    """A layout of the world whose picture was read back and found true.

    Args:
        centre: the dart around which a ball is shown if the world is too large to be shown whole;
            default: the marker's.
    """
    flat = cell(world)
    if flat is not None and not untrue(world, flat, 0):
        return flat
    for sketch in _sketches(world):
        layout = _true(world, sketch)
        if layout is not None:
            return layout
    if world.root is None:
        raise InternalError(f"no true picture of {world!r} was found")
    return _ball(world, world.root if centre is None else centre)


def _sketches(world: World) -> Iterator[Sketch]:
    positions = given(world)
    if positions is not None and is_crowded(positions):
        if _true(world, positions) and (even := spread(world, positions)):
            yield even
    elif positions is not None:
        yield positions
    branches = tree(world)
    if branches is not None:
        yield branches
    plain = world.genus == 0 and world.is_simple
    if len(world.vertices) <= (SIMPLE_READABLE if plain else READABLE):
        yield from planar(world)
    if positions is not None:
        yield positions


def _ball(world: World, centre: Dart) -> Layout:
    """A true layout of the largest ball that has one."""
    limit = LIMIT
    while limit > 8:
        around = ball(world, centre, limit=limit)
        for sketch in planar(around.part):
            layout = _true(around.part, sketch)
            if layout is not None:
                whole = put_back(around, layout)
                if not untrue(world, whole, None):
                    return whole
        limit //= 2
    raise InternalError(f"no true picture of {world!r} was found")


def _true(world: World, sketch: Sketch) -> Layout | None:
    """The layout of the sketch, with corners as round as they may be; None if none is true."""
    straight = fitted(sketch, 0.0)
    if _share(straight) < CRAMPED and untrue(world, straight, sketch.bridges):
        return None  # vertices coincide, and rounder corners give them no more room
    best: Layout | None = None
    for rounding in ROUNDINGS:
        layout = fitted(sketch, rounding)
        # A corner that is cut may come near a vertex: then all circles get small.
        if best is not None and _share(layout) < 1.3 * _share(best):
            break
        if not untrue(world, layout, sketch.bridges):
            best = layout
            if _share(layout) > ROOMY:
                break
    return best


def _share(layout: Layout) -> float:
    """The radius of a vertex as a share of the picture's longer side."""
    return layout.radius / max(layout.width, layout.height)


def untrue(world: World, layout: Layout, bridges: int | None) -> list[str]:
    """What the finished picture of the layout shows and is not so.

    Args:
        bridges: the crossings that are meant; None: as many as there happen to be.
    """
    return read_back.untruths(read_back.read(to_svg(world, layout)), world, bridges=bridges)
