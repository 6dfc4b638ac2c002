"""The least cost LB of a proof: a lower bound for every right mapper, and a walk that attains it.

A mapper has proved its map only if its closed trips from v0 generate the fundamental group; else
the fold of its history has an open dart. The cheapest such trips are the loops that a breadth-first
tree closes with the other edges. Each edge of a **pendant tree**, off all tree paths from v0 to
such an edge, is walked there and back, but the last trip need not come back. LB does not bind
mappers that may assume planarity, n or m.

    core        the vertices that the walk passes anyway
    branch      a vertex outside the core whose tree edge must be walked, or one on the way there

Source: docs/semantics.md, section 11, with the formula and its proof.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Sequence
from functools import lru_cache
from itertools import accumulate, chain
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from topo_verify.world.enumeration.rank_order import Table


class BreadthFirstTree:
    """The breadth-first tree of a world from v0, in the numbering of its canonical code, `table`.

    The first dart of a vertex leads to its parent; parents stand before their children.

    Attributes:
        vertex: the vertex of each dart.
        first: the first dart of each vertex.
        parent: the parent of each vertex; v0 is its own.
        depth: the distance of each vertex from v0.
        chords: the lesser dart of each edge outside the tree, ascending.
    """

    def __init__(self, table: Table) -> None:
        self.table = table
        degrees, alpha = table
        self.vertex = [v for v, degree in enumerate(degrees) for _ in range(degree)]
        self.first = [*accumulate(degrees[:-1], initial=0)]
        self.parent, self.depth = [0], [0]
        for dart in self.first[1:]:
            self.parent.append(self.vertex[alpha[dart]])
            self.depth.append(self.depth[self.parent[-1]] + 1)
        entries = set(self.first[1:])  # first darts end tree edges
        self.chords = [d for d, other in enumerate(alpha) if d < other and other not in entries]

    def weight(self, chord: int) -> int:
        """The length of the chord's loop."""
        return self.depth[self.vertex[chord]] + 1 + self.depth[self.vertex[self.table[1][chord]]]

    def climb(self, vertex: int, goals: Container[int] = (0,)) -> Iterator[int]:
        """The vertices from this one up to the first goal, excluded."""
        while vertex not in goals:
            yield vertex
            vertex = self.parent[vertex]

    def home(self, vertex: int) -> list[int]:
        """The darts of the tree path from the vertex to v0."""
        return [self.first[v] for v in self.climb(vertex)]

    def down(self, vertex: int) -> list[int]:
        """The darts of the tree path from v0 to the vertex."""
        return [self.table[1][dart] for dart in reversed(self.home(vertex))]

    def loop(self, chord: int) -> list[int]:
        """The darts from v0 down the tree, over the chord, and home."""
        end = self.vertex[self.table[1][chord]]
        return [*self.down(self.vertex[chord]), chord, *self.home(end)]

    def doors(self, darts: Iterable[int], reference: int = 0) -> tuple[int, ...]:
        """The doors of a walk, each counted from the dart of arrival."""
        degrees, alpha = self.table
        doors: list[int] = []
        for dart in darts:
            doors.append((dart - reference) % degrees[self.vertex[dart]])
            reference = alpha[dart]
        return tuple(doors)


@lru_cache(maxsize=4)
def least_cost(table: Table) -> int:
    """LB of the world with this canonical code. O(m)."""
    tree = BreadthFirstTree(table)
    core = {0}
    for chord in tree.chords:
        for dart in (chord, table[1][chord]):
            v = tree.vertex[dart]
            while v not in core:
                core.add(v)
                v = tree.parent[v]
    pendant = [v for v in range(len(tree.first)) if v not in core]
    _, saved = _last(tree, core, pendant)
    return sum(map(tree.weight, tree.chords)) + 2 * len(pendant) - saved


def proof_tour(table: Table) -> tuple[int, ...]:
    """The doors of a cheapest walk that proves the world with this canonical code. O(cost)."""
    tree = BreadthFirstTree(table)
    trips = [tree.loop(chord) for chord in tree.chords]
    return tree.doors(covering_walk(tree, trips, range(len(tree.first))))


def covering_walk(
    tree: BreadthFirstTree, trips: Sequence[Sequence[int]], needed: Iterable[int]
) -> list[int]:
    """The darts of a walk that makes these trips and walks the tree edges above these vertices.

    All trips but the first begin at v0, and all end there. Tree edges off the trips are walked
    there and back, the last branch only there.
    """
    core = {0, *(tree.vertex[dart] for trip in trips for dart in trip)}
    reached = {*core}
    for goal in needed:
        reached.update([*tree.climb(goal, reached)])
    branches = sorted(reached - core)
    last, _ = _last(tree, core, branches)
    onward = {*tree.climb(last, core)}
    children: dict[int, list[int]] = {}
    for v in branches:
        if v not in onward:
            children.setdefault(tree.parent[v], []).append(v)
    start = tree.vertex[trips[0][0]] if trips and trips[0] else 0
    walk = _there_and_back(tree, children, start)
    for dart in [*chain(*trips), *tree.down(last)]:
        walk.append(dart)
        walk += _there_and_back(tree, children, tree.vertex[tree.table[1][dart]])
    return walk


def _last(tree: BreadthFirstTree, core: set[int], branches: Iterable[int]) -> tuple[int, int]:
    """The branch at which a walk ends best, or v0, and the moves saved."""
    attached: dict[int, int] = {}  # the depth of the core vertex above
    best, saved = 0, 0
    for v in branches:
        above = tree.parent[v]
        attached[v] = tree.depth[above] if above in core else attached[above]
        if tree.depth[v] - 2 * attached[v] > saved:
            best, saved = v, tree.depth[v] - 2 * attached[v]
    return best, saved


def _there_and_back(
    tree: BreadthFirstTree, children: dict[int, list[int]], vertex: int
) -> list[int]:
    walk: list[int] = []
    todo = [(child, False) for child in reversed(children.pop(vertex, ()))]
    while todo:
        child, is_done = todo.pop()
        up = tree.first[child]
        walk.append(up if is_done else tree.table[1][up])
        if not is_done:
            todo.append((child, True))
            todo += [(below, False) for below in reversed(children.pop(child, ()))]
    return walk
