"""Lattices: nodes on a grid, joined with their neighbours."""

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.world.families import _arguments as arguments
from topo_verify.world.families._rotated_graph import EdgeEnd, Graph, as_world, with_holes
from topo_verify.world.rooted_map import Dart, World

_NORTH, _NORTH_EAST, _EAST, _SOUTH_EAST = (-1, 0), (-1, 1), (0, 1), (1, 1)
"""(Rows down, columns right)."""

_KING = (_NORTH, _NORTH_EAST, _EAST, _SOUTH_EAST)


def lattice(
    rows: int, columns: int, *, holes: float = 0.0, seed: int = 0, marker: Dart | None = None
) -> World:
    """A grid, each node joined with its four neighbours. Planar.

    Args:
        rows, columns: 1 or more; one row is a path.
        holes: the share of removed nodes, 0 <= holes < 1.
        seed: 0 or more.
        marker: a dart; default: drawn.
    """
    return _drawn("lattice", (_NORTH, _EAST), (rows, columns), holes, seed, marker)


def king(
    rows: int, columns: int, *, holes: float = 0.0, seed: int = 0, marker: Dart | None = None
) -> World:
    """A grid, each node joined with its eight neighbours. Arguments as for `lattice`.

    Diagonals cross: a map of high genus.
    """
    return _drawn("king", _KING, (rows, columns), holes, seed, marker)


def king_torus(
    rows: int, columns: int, *, holes: float = 0.0, seed: int = 0, marker: Dart | None = None
) -> World:
    """A `king` with joined opposite borders: degrees 8; simple from 3 by 3 on."""
    return _drawn("king_torus", _KING, (rows, columns), holes, seed, marker, wrapped=True)


def torus(rows: int, columns: int, *, marker: Dart | None = None) -> World:
    """A grid with joined opposite borders. Genus 1, degrees 4.

    Args:
        rows, columns: 1 or more; 1 makes loops, 2 parallel edges.
        marker: a dart; default: 0.
    """
    return _wrapped("torus", (_NORTH, _EAST), (rows, columns), marker)


def triangular_torus(rows: int, columns: int, *, marker: Dart | None = None) -> World:
    """A torus with one diagonal in each square. Genus 1, degrees 6; simple from 3 by 3 on."""
    return _wrapped("triangular_torus", (_NORTH, _NORTH_EAST, _EAST), (rows, columns), marker)


def hexagonal_torus(rows: int, columns: int, *, marker: Dart | None = None) -> World:
    """A honeycomb with joined opposite borders, two nodes a cell. Genus 1, degrees 3.

    Simple from 2 by 2 on; the dual of the triangular torus.
    """
    rows, columns, darts = arguments.size("hexagonal_torus", (rows, columns), darts_each=6)
    name, marker, _ = arguments.settled(
        "hexagonal_torus", rows, columns, darts=darts, marker=marker
    )
    graph: Graph = {}
    for cell in range(rows * columns):
        row, column = divmod(cell, columns)
        for side in (0, 1):
            step = (-1, 1)[side]
            others = (
                cell,
                (row + step) % rows * columns + column,
                row * columns + (column + step) % columns,
            )
            graph[2 * cell + side] = [
                EdgeEnd(2 * other + 1 - side, ((cell, other)[side], way), side)
                for way, other in enumerate(others)
            ]
    return as_world(name, graph, marker or 0)


def _wrapped(
    family: str,
    steps: Sequence[tuple[int, int]],
    size: tuple[int, int],
    marker: Dart | None,
) -> World:
    rows, columns, darts = arguments.size(family, size, darts_each=2 * len(steps))
    name, marker, _ = arguments.settled(family, rows, columns, darts=darts, marker=marker)
    return as_world(name, _grid(rows, columns, steps, wrapped=True), marker or 0)


def _drawn(
    family: str,
    steps: Sequence[tuple[int, int]],
    size: tuple[int, int],
    holes: float,
    seed: int,
    marker: Dart | None,
    *,
    wrapped: bool = False,
) -> World:
    rows, columns, darts = arguments.size(family, size, darts_each=2 * len(steps))
    holes = arguments.share(family, "holes", holes, whole=False)
    name, marker, random = arguments.settled(
        family, rows, columns, darts=darts, marker=marker, seed=seed, holes=holes
    )
    graph = with_holes(name, _grid(rows, columns, steps, wrapped=wrapped), holes, random)
    if wrapped:
        return as_world(name, graph, marker, random)
    positions = tuple((float(node % columns), float(rows - 1 - node // columns)) for node in graph)
    return as_world(name, graph, marker, random, positions)


def _grid(rows: int, columns: int, steps: Sequence[tuple[int, int]], *, wrapped: bool) -> Graph:
    """The grid; `steps` are half of the directions, clockwise."""
    graph: Graph = {}
    for node in range(rows * columns):
        exits = graph[node] = []
        # clockwise: along the steps, then against them
        for side in (0, 1):
            for way, (down, right) in enumerate(steps):
                row = node // columns + (down, -down)[side]
                column = node % columns + (right, -right)[side]
                if wrapped or (0 <= row < rows and 0 <= column < columns):
                    to = row % rows * columns + column % columns
                    exits.append(EdgeEnd(to, ((node, to)[side], way), side))
    return graph
