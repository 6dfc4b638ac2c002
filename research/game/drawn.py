"""A world that the robot may be in, and lower bounds on the remaining cost there."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

from research.game.folds import ABSENT, FoldCode, Sight, distances, vertices
from topo_verify.world.enumeration.rank_order import Table
from topo_verify.world.least_cost import BreadthFirstTree


class Pendant(NamedTuple):
    """An edge of a pendant tree.

    Attributes:
        edge: its bit.
        above: the vertex above it.
        attached: the depth of the vertex where the tree is attached.
    """

    edge: int
    above: int
    attached: int


class Rest(NamedTuple):
    """What a fold leaves to be done in a world.

    Attributes:
        uncrossed: the end vertices of edges never crossed, two for each edge.
        trips: the lengths of the shortest missing closed trips, ascending.
        ended, back: moves on uncrossed pendant edges, for a walk that ends anywhere; that begins
            at v0.
        far: for each dart of the fold, its distance from v0 there.
    """

    uncrossed: tuple[int, ...]
    unvisited: int
    trips: tuple[int, ...]
    ended: int
    back: int
    far: tuple[int, ...]


class DrawnWorld:
    """A world by its canonical code, and what folds leave to be done in it."""

    def __init__(self, table: Table) -> None:
        self.table = table
        self.degrees, self.alpha = table
        self._first, self.vertex = vertices(self.degrees)
        self._placed = dict[FoldCode, tuple[int, ...]]()
        self._rest = dict[FoldCode, Rest]()

    def turned(self, dart: int, by: int) -> int:
        """The dart `by` doors clockwise of a dart."""
        v = self.vertex[dart]
        return self._first[v] + (dart - self._first[v] + by) % self.degrees[v]

    def sight(self, dart: int) -> Sight:
        """The percept with this reference dart."""
        v = self.vertex[dart]
        return self.degrees[v], ABSENT if v else -dart % self.degrees[0]

    def placed(self, code: FoldCode) -> tuple[int, ...]:
        """For each dart of the fold its dart here, which is unique."""
        if code not in self._placed:
            degrees, alpha = code
            first, _ = vertices(degrees)
            darts = list[int]()
            for v, degree in enumerate(degrees):
                entry = self.alpha[darts[alpha[first[v]]]] if v else 0
                darts += [self.turned(entry, by) for by in range(degree)]
            self._placed[code] = tuple(darts)
        return self._placed[code]

    # ------------------------------------------------------------ lower bounds

    def proof_bound(self, code: FoldCode, at: int) -> int:
        """Least moves to close the fold here, even with the map in hand.

        Every edge must be crossed. Let I be the space (modulo 2) of the closed trips made so
        far. A missing trip adds at most one dimension; those of a lightest basis modulo I are
        the shortest. The first may have `far` of its length behind it; or count the way home and
        all but the longest. Pendant edges belong to no trip.
        """
        rest = self._rest_of(code)
        here = self.vertex[self.placed(code)[at]]
        bound = len(rest.uncrossed) // 2
        if rest.trips:
            under_way = sum(rest.trips) - rest.far[at]
            home = self._distances[here][0] + sum(rest.trips[:-1])
            bound = max(bound, rest.back + max(under_way, home))
        elif rest.uncrossed:
            near = min(self._distances[here][v] for v in rest.uncrossed)
            bound = near + max(bound, rest.ended)
        return max(bound, 1)

    def visit_bound(self, code: FoldCode, _at: int) -> int:
        """Least moves to visit every vertex and cross all edges but one, needed where n is known.

        Another loop could hang on an unvisited vertex; two uncrossed edges could exchange ends.
        """
        rest = self._rest_of(code)
        return max(1, rest.unvisited, len(rest.uncrossed) // 2 - 1)

    def crossing_bound(self, code: FoldCode, _at: int) -> int:
        """Least moves to cross every edge, needed where the world is known to be planar.

        On an open dart a leaf or a path of two may hang.
        """
        return max(1, len(self._rest_of(code).uncrossed) // 2)

    def _rest_of(self, code: FoldCode) -> Rest:
        if code not in self._rest:
            self._rest[code] = self._left_to_do(code)
        return self._rest[code]

    def _left_to_do(self, code: FoldCode) -> Rest:
        degrees, alpha = code
        first, vertex = vertices(degrees)
        darts, crossed_edges = self.placed(code), 0
        way = [0] * len(degrees)  # from v0 to each vertex, modulo 2
        basis = list[int]()  # a basis of the closed trips
        for dart, end in enumerate(alpha):
            if dart < end:
                edge = self._edges[darts[dart]]
                crossed_edges |= edge
                if first[vertex[end]] == end and end:
                    way[vertex[end]] = way[vertex[dart]] ^ edge
                else:
                    _extended(basis, way[vertex[dart]] ^ way[vertex[end]] ^ edge)
        missing = tuple(length for length, loop in self._loops if _extended(basis, loop))
        uncrossed = tuple(
            v for v, edge in zip(self.vertex, self._edges, strict=True) if not edge & crossed_edges
        )
        unvisited = len(self.degrees) - len({self.vertex[dart] for dart in darts})
        far_of = distances(code, 0)
        far = tuple(far_of[v] for v in vertex)
        return Rest(uncrossed, unvisited, missing, *self._pendant_moves(crossed_edges), far)

    def _pendant_moves(self, crossed_edges: int) -> tuple[int, int]:
        """`ended` and `back` of `Rest`."""
        below = dict[int, int]()
        moves = deepest = saved = 0
        for v, (edge, above, attached) in self._pendants.items():
            is_new = not edge & crossed_edges
            moves += 2 * is_new
            below[v] = below.get(above, 0) + is_new
            deepest = max(deepest, below[v])
            saved = max(saved, below[v] - attached)
        return moves - deepest, moves - saved

    @cached_property
    def _tree(self) -> BreadthFirstTree:
        return BreadthFirstTree(self.table)

    @cached_property
    def _edges(self) -> tuple[int, ...]:
        """The bit of each dart's edge."""
        return tuple(1 << min(dart, end) for dart, end in enumerate(self.alpha))

    @cached_property
    def _loops(self) -> list[tuple[int, int]]:
        """Loops of the breadth-first tree, shortest first: length, and edges modulo 2."""
        loops = list[tuple[int, int]]()
        for chord in self._tree.chords:
            edges = 0
            for dart in self._tree.loop(chord):
                edges ^= self._edges[dart]
            loops.append((self._tree.weight(chord), edges))
        return sorted(loops)

    @cached_property
    def _pendants(self) -> dict[int, Pendant]:
        """By the vertex below them, from the top down."""
        tree, pendants = self._tree, dict[int, Pendant]()
        core = {0}
        for chord in tree.chords:
            for end in (chord, self.alpha[chord]):
                core.update([*tree.climb(tree.vertex[end], core)])
        for v in range(1, len(self.degrees)):
            if v not in core:
                above = tree.parent[v]
                attached = pendants[above].attached if above in pendants else tree.depth[above]
                pendants[v] = Pendant(self._edges[tree.first[v]], above, attached)
        return pendants

    @cached_property
    def _distances(self) -> list[list[int]]:
        return [distances(self.table, v) for v in range(len(self.degrees))]


def _extended(basis: list[int], vector: int) -> bool:
    """Add a vector modulo 2 to the basis; return whether it was independent."""
    for member in basis:
        vector = min(vector, vector ^ member)
    if vector:
        basis.append(vector)
        basis.sort(reverse=True)
    return vector != 0
