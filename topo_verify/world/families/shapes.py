"""Small well-known graphs and the Platonic solids, drawn in the plane without crossings: genus 0.

Nodes on a circle are numbered clockwise. The simplest world of each: `path(1)` (a node alone),
`cycle(1)` (a loop), `star(1)` (an edge), `wheel(3)` (the tetrahedron), `prism(3)`. **Solids** look
the same from every dart.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace

from topo_verify.errors import InputError
from topo_verify.world.families import _arguments as arguments
from topo_verify.world.families._rotated_graph import EdgeEnd, Graph, as_world, from_neighbours
from topo_verify.world.rooted_map import Dart, World


def path(nodes: int, *, marker: Dart | None = None) -> World:
    """Nodes in a row, each joined with the next.

    Args:
        nodes: 1 or more.
        marker: a dart; default: 0, at the first node.
    """

    def rows(n: int) -> Iterable[list[int]]:
        return ([to for to in (i + 1, i - 1) if 0 <= to < n] for i in range(n))

    return _made("path", "nodes", (nodes, 1, 2), marker, lambda n: from_neighbours(rows(n)))


def cycle(nodes: int, *, marker: Dart | None = None) -> World:
    """Nodes on a circle: one has a loop, two are joined twice."""

    def graph(n: int) -> Graph:
        return {
            i: [EdgeEnd((i + 1) % n, (i, 0), 0), EdgeEnd((i - 1) % n, ((i - 1) % n, 0), 1)]
            for i in range(n)
        }

    return _made("cycle", "nodes", (nodes, 1, 2), marker, graph)


def star(leaves: int, *, marker: Dart | None = None) -> World:
    """One node joined with `leaves` others (1 or more)."""

    def rows(n: int) -> Iterable[list[int]]:
        return [list(range(1, n + 1)), *([0] for _ in range(n))]

    return _made("star", "leaves", (leaves, 1, 2), marker, lambda n: from_neighbours(rows(n)))


def wheel(rim: int, *, marker: Dart | None = None) -> World:
    """A cycle of `rim` nodes (3 or more), each joined with a hub."""

    def rows(n: int) -> Iterable[list[int]]:
        return [
            list(range(1, n + 1)),
            *([(i + 1) % n + 1, 0, (i - 1) % n + 1] for i in range(n)),
        ]

    return _made("wheel", "rim", (rim, 3, 4), marker, lambda n: from_neighbours(rows(n)))


def prism(sides: int, *, marker: Dart | None = None) -> World:
    """Two nested cycles of `sides` nodes (3 or more), joined one to one."""

    def rows(n: int) -> Iterable[list[int]]:
        return [
            *([(i + 1) % n, n + i, (i - 1) % n] for i in range(n)),
            *([i, n + (i + 1) % n, n + (i - 1) % n] for i in range(n)),
        ]

    return _made("prism", "sides", (sides, 3, 6), marker, lambda n: from_neighbours(rows(n)))


def _made(
    family: str,
    parameter: str,
    number: tuple[int, int, int],
    marker: Dart | None,
    graph: Callable[[int], Graph],
) -> World:
    """`number`: the argument's value, its least value, and darts per unit."""
    value, least, darts_each = number
    value = arguments.integer(family, parameter, value, least)
    name, marker, _ = arguments.settled(family, value, darts=darts_each * value, marker=marker)
    # path(1) has no dart
    exits = graph(value)
    return as_world(name, exits, 0 if marker is None and exits[0] else marker)


def tetrahedron(*, marker: Dart | None = None) -> World:
    """4 vertices of degree 3, 6 edges, 4 triangles."""
    return _named("tetrahedron", wheel(3), marker)


def cube(*, marker: Dart | None = None) -> World:
    """8 vertices of degree 3, 12 edges, 6 squares."""
    return _named("cube", prism(4), marker)


def octahedron(*, marker: Dart | None = None) -> World:
    """6 vertices of degree 4, 12 edges, 8 triangles."""
    ring = [[5, i % 4 + 1, 0, (i - 2) % 4 + 1] for i in range(1, 5)]
    rows = [[1, 2, 3, 4], *ring, [4, 3, 2, 1]]
    return _named("octahedron", as_world("octahedron", from_neighbours(rows), 0), marker)


def dodecahedron(*, marker: Dart | None = None) -> World:
    """20 vertices of degree 3, 30 edges, 12 pentagons."""
    # the dual
    other = icosahedron()
    return _named("dodecahedron", World.from_rotations(other.faces, other.edges, 0), marker)


def icosahedron(*, marker: Dart | None = None) -> World:
    """12 vertices of degree 5, 30 edges, 20 triangles."""
    # node 6 + i lies outside, between 1 + i and the next
    inner = [[6 + i, 1 + (i + 1) % 5, 0, 1 + (i - 1) % 5, 6 + (i - 1) % 5] for i in range(5)]
    outer = [[11, 6 + (i + 1) % 5, 1 + (i + 1) % 5, 1 + i, 6 + (i - 1) % 5] for i in range(5)]
    rows = [[1, 2, 3, 4, 5], *inner, *outer, [10, 9, 8, 7, 6]]
    return _named("icosahedron", as_world("icosahedron", from_neighbours(rows), 0), marker)


def _named(family: str, world: World, marker: Dart | None) -> World:
    name, marker, _ = arguments.settled(family, darts=0, marker=marker)
    try:
        return replace(world, root=marker or 0, name=name)
    except InputError as error:
        raise InputError(f"{name}: {error}") from error
