"""Layout: where the vertices, edges and bridges of a drawn world lie.

Coordinates are those of the picture: y grows downwards, so clockwise on the screen is clockwise in
the world.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from topo_verify.world.formats.embedding import Point
from topo_verify.world.rooted_map import Dart

Kind = Literal["positions", "planar", "bridges", "cell", "ball"]


@dataclass(frozen=True)
class Bridge:
    """One edge passes over another (or over itself).

    Attributes:
        over, under: the edges, as indices into `world.edges`.
        path: the piece of the upper edge's curve that lies over the lower one, as path data.
    """

    over: int
    under: int
    path: str


@dataclass(frozen=True)
class Layout:
    """Where everything in a picture of a world lies.

    Attributes:
        kind: `positions` of the file, `planar` without crossings, planar with `bridges`, a flat
            periodic `cell` of a torus, or a `ball` around a vertex.
        width, height: the size of the picture; its top left corner is (0, 0).
        radius: of the circle of each vertex.
        centres: of the circles, in the order of `world.vertices`. A hidden vertex has the place
            where the way to it leaves the ball.
        paths: the curve of each edge, in the order of `world.edges`, as SVG path data. Usually one
            part; more where the edge leaves a cell on one side and comes back on the other; none
            if the edge is not shown. The first part begins where the lesser dart leaves the circle
            of its vertex; the last part ends where the other dart does.
        bridges: what passes over what.
        stubs: in a ball, the beginnings of edges whose other vertex is hidden: dart and path data.
        hidden: in a ball, the vertices that are not shown.
        cell: the corner and the two sides of a periodic cell.
    """

    kind: Kind
    width: float
    height: float
    radius: float
    centres: tuple[Point, ...]
    paths: tuple[tuple[str, ...], ...]
    bridges: tuple[Bridge, ...] = ()
    stubs: tuple[tuple[Dart, str], ...] = ()
    hidden: frozenset[int] = frozenset()
    cell: tuple[Point, Point, Point] | None = None
