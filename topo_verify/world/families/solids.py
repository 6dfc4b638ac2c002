"""The five Platonic solids: planar worlds in which every dart looks like every other.

Wherever the marker points, the world is the same up to isomorphism; `marker=DART` only says which
of the darts it is. The tetrahedron is a wheel and the cube a prism; the octahedron and the
icosahedron are drawn with one corner in the middle and one outside, rings between them; the
dodecahedron is the dual of the icosahedron (its faces become vertices).

Source: Euclid, "Elements", book XIII.
"""

from __future__ import annotations

from topo_verify.errors import InputError
from topo_verify.world.families import _arguments as arguments
from topo_verify.world.families import shapes
from topo_verify.world.families._rotated_graph import as_world, from_neighbours
from topo_verify.world.rooted_map import Dart, World


def tetrahedron(*, marker: Dart | None = None) -> World:
    """4 vertices of degree 3, 6 edges, 4 triangles.

    Raises:
        InputError: it has no dart `marker`; the same for the other four.
    """
    return _named("tetrahedron", shapes.wheel(3), marker)


def cube(*, marker: Dart | None = None) -> World:
    """8 vertices of degree 3, 12 edges, 6 squares."""
    return _named("cube", shapes.prism(4), marker)


def octahedron(*, marker: Dart | None = None) -> World:
    """6 vertices of degree 4, 12 edges, 8 triangles."""
    ring = [[5, i % 4 + 1, 0, (i - 2) % 4 + 1] for i in range(1, 5)]
    # The node outside sees the ring from its other side, so in the reverse order.
    rows = [[1, 2, 3, 4], *ring, [4, 3, 2, 1]]
    return _named("octahedron", as_world("octahedron", from_neighbours(rows), 0), marker)


def dodecahedron(*, marker: Dart | None = None) -> World:
    """20 vertices of degree 3, 30 edges, 12 pentagons."""
    # Faces taken as rotations make the dual or its mirror image; a solid is its own mirror image.
    other = icosahedron()
    return _named("dodecahedron", World.from_rotations(other.faces, other.edges, 0), marker)


def icosahedron(*, marker: Dart | None = None) -> World:
    """12 vertices of degree 5, 30 edges, 20 triangles."""
    # Node 6 + i lies outside the inner ring, between node 1 + i and the next one.
    inner = [[6 + i, 1 + (i + 1) % 5, 0, 1 + (i - 1) % 5, 6 + (i - 1) % 5] for i in range(5)]
    outer = [[11, 6 + (i + 1) % 5, 1 + (i + 1) % 5, 1 + i, 6 + (i - 1) % 5] for i in range(5)]
    rows = [[1, 2, 3, 4, 5], *inner, *outer, [10, 9, 8, 7, 6]]
    return _named("icosahedron", as_world("icosahedron", from_neighbours(rows), 0), marker)


def _named(family: str, world: World, marker: Dart | None) -> World:
    marker = arguments.marker(family, marker)
    name = arguments.name(family, marker=marker)
    try:
        return World(
            world.alpha,
            world.sigma,
            0 if marker is None else marker,
            starts=world.starts,
            name=name,
        )
    except InputError as error:
        raise InputError(f"{name}: {error}") from error
