"""Lattices: rectangles of a grid without some nodes, like the paper's street networks.

A node is removed unless the rest would fall apart; then single edges if too many remain. Lattices
are planar, simple, and carry their positions.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Literal, get_args

from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from topo_verify.strategies.draws import (
    AT_MOST,
    Sizes,
    at_most,
    canonical,
    draw_dart,
    marked_darts,
    scaled,
    shown_as_called,
)
from topo_verify.strategies.shapes import WIDEST, edge_bounds, require_marker
from topo_verify.world.rooted_map import Dart, World

LatticeMarker = Literal["any", "hub"]

Node = tuple[int, int]
"""Row and column."""

Grid = dict[Node, list[Node]]
"""The neighbours of each node, clockwise."""

_HOLES = 4
"""Edges per hole, at least."""


@shown_as_called
def lattices(
    *, min_edges: int = 1, max_edges: int = WIDEST, marker: LatticeMarker = "any"
) -> SearchStrategy[World]:
    """Rectangles of a grid with holes. Shrinks to few edges, then to whole rectangles.

    Args:
        marker: "any" exit, or "hub": at a vertex of the greatest degree.
    """
    least, most = edge_bounds("lattices", min_edges, max_edges)
    require_marker("lattices", marker, get_args(LatticeMarker))
    return _lattices(least, most, marker)


@st.composite
def _lattices(draw: st.DrawFn, least: int, most: int, marker: LatticeMarker) -> World:
    bound = max(least, at_most(most, draw(st.sampled_from(AT_MOST))))
    columns, rows = _sizes(least, bound).draw(draw)
    # shrinks to no holes
    turn, *holes = draw(st.binary(min_size=1, max_size=1 + most // _HOLES))
    grid = _rectangle(rows, columns)
    for hole in holes:
        _take_out(grid, divmod(scaled(rows * columns, hole), columns), least)
    if _edges(grid) > bound:
        _thin(grid, bound, turn)
    return _world(grid, lambda vertex: draw_dart(draw, marked_darts(vertex, marker), 2 * most))


@lru_cache(maxsize=256)
def _sizes(least: int, bound: int) -> Sizes:
    """The rectangles with at least `least` edges and about `bound` at most.

    A quarter and one column more leave room for holes.
    """
    rows = {
        c: [r for r in range(1, c + 1) if least <= 2 * r * c - r - c <= bound * 5 // 4 + 2 * r]
        for c in range(1, bound * 5 // 4 + 4)
    }
    sizes = Sizes.of(rows)
    assert sizes is not None, "one row of `least` edges fits"
    return sizes


def _rectangle(rows: int, columns: int) -> Grid:
    return {
        (y, x): [
            (y + down, x + right)
            for down, right in ((-1, 0), (0, 1), (1, 0), (0, -1))
            if 0 <= y + down < rows and 0 <= x + right < columns
        ]
        for y in range(rows)
        for x in range(columns)
    }


def _edges(grid: Grid) -> int:
    return sum(map(len, grid.values())) // 2


def _take_out(grid: Grid, node: Node, least: int) -> None:
    exits = grid.get(node, [])
    if exits and _edges(grid) - len(exits) >= least and _are_joined(grid, exits, without=node):
        del grid[node]
        for other in exits:
            grid[other].remove(node)


def _are_joined(grid: Grid, nodes: list[Node], *, without: Node) -> bool:
    reached = {nodes[0], without}
    queue = [nodes[0]]
    for node in queue:
        fresh = [other for other in grid[node] if other not in reached]
        reached.update(fresh)
        queue += fresh
    return reached.issuperset(nodes)


def _thin(grid: Grid, bound: int, turn: int) -> None:
    streets = [(u, v) for u, exits in grid.items() for v in exits if u < v]
    spare = len(streets) - bound
    turn = scaled(len(streets), turn)
    streets = streets[turn:] + streets[:turn]
    # an edge is a bridge in its turn iff later edges do not join its ends
    part = {node: {node} for node in grid}
    removable: list[tuple[Node, Node]] = []
    for u, v in reversed(streets):
        if part[u] is part[v]:
            removable.append((u, v))
        else:
            part[u] |= part[v]
            part |= dict.fromkeys(part[v], part[u])
    for u, v in removable[::-1][: max(0, spare)]:
        grid[u].remove(v)
        grid[v].remove(u)
        spare -= 1
    for _ in range(spare):  # a tree by now: take out its last dead end
        _take_out(grid, next(u for u in reversed(grid) if len(grid[u]) == 1), 0)


def _world(grid: Grid, draw_root: Callable[[list[int]], Dart]) -> World:
    number = {
        street: dart
        for dart, street in enumerate((u, v) for u, exits in grid.items() for v in exits)
    }
    sigma: list[Dart] = []
    for exits in grid.values():
        first = len(sigma)
        sigma += [*range(first + 1, first + len(exits)), first] if exits else []
    order = {node: v for v, node in enumerate(grid)}
    root = draw_root([order[u] for u, _ in number]) if number else None
    alpha = tuple(number[v, u] for u, v in number)
    positions = tuple((float(x), float(-y)) for y, x in grid)
    return canonical(World(alpha, tuple(sigma), root, positions=positions))
