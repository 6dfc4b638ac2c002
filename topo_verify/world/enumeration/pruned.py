"""Lists the worlds of a class in rank order; pruning, not filtering, keeps the others out.

Worlds grow as in `rank_order`. A **pruner** follows one property and stops a branch as soon as no
completion can have it. Pruners are immutable, so branches share them:

    GenusPruner      the open darts along each boundary of the partial map, one cyclic word each.
                     Joining two darts of one word cuts it in two; joining darts of two words merges
                     them and raises the genus by one. A word of odd length needs a leaf, or another
                     odd word and a handle: odd words <= darts to create + 2·(genus left).
    NeighbourPruner  loopless and simple: each open dart needs an end at another vertex with open
                     darts (simple: not a neighbour), or at a vertex still to come.
    DegreePruner     min-degree, max-degree: looks at the new vertex, and at the darts to create.

A pruned branch still counts with all its completions, so ranks are those among ALL worlds, and
shards are cut by rank in every class. For `planar`, `genus<=G` and `loopless` alone every branch
has a world.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from functools import cache
from typing import NamedTuple, Protocol

from topo_verify.errors import InputError
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.enumeration.rank_order import MAX_ID_EDGES, IntTuple, Table
from topo_verify.world.rooted_map import World

MOST_COUNTED = 1_000_000
"""`count` lists at most this many worlds: a minute or two."""


class Pruner(Protocol):
    """Follows one property while a map grows; a step returns None if no completion can have it."""

    def join(self, dart: int, partner: int, to_create: int) -> Pruner | None:
        """The pruner after joining two open darts to an edge."""
        ...

    def hang(self, dart: int, first: int, degree: int, to_create: int) -> Pruner | None:
        """The pruner after hanging a new vertex on `dart` by its first dart, `first`."""
        ...


def ranked_tables(
    edges: int, kind: WorldClass | None = None, start: int = 0, stop: int | None = None
) -> Iterator[tuple[int, Table]]:
    """The worlds of a class with ranks start … stop-1; each with its rank among ALL worlds."""
    total = rank_order.count(edges)
    stop = total if stop is None else min(stop, total)
    kind = WorldClass() if kind is None else kind
    if edges == 0 or kind == WorldClass():
        listed = enumerate(rank_order.tables(edges, start, stop), start)
        yield from (pair for pair in listed if edges or kind.admits(pair[1]))
    else:
        yield from _grown(edges, kind, start, stop)


def require_few(edges: int, kind: WorldClass, *, by_vertices: bool = False) -> None:
    """Raise an InputError if counting would list too many worlds."""
    most = kind.most(edges) if kind.is_listed(by_vertices=by_vertices) else 0
    if most > MOST_COUNTED:
        there_are = "there may be" if kind.is_listed() else "there are"
        raise InputError(
            f"class {kind}: its worlds are counted one by one, and with {edges} edges {there_are}"
            f" {most}: expected {MOST_COUNTED} at most, ask for fewer edges; in Python"
            f" tv.worlds({edges}, cls={str(kind)!r}) lists them"
        )


@cache
def count_by_vertices(edges: int, kind: WorldClass) -> dict[int, int]:
    """`kind.count_by_vertices`; a genus and a property of the graph together by listing."""
    require_few(edges, kind, by_vertices=True)
    if not kind.is_listed(by_vertices=True):
        return kind.count_by_vertices(edges)
    numbers = Counter(len(degrees) for _, (degrees, _) in ranked_tables(edges, kind))
    return dict(sorted(numbers.items()))


def count(edges: int, kind: WorldClass) -> int:
    """`kind.count`, or the number of those listed."""
    return sum(count_by_vertices(edges, kind).values()) if kind.is_listed() else kind.count(edges)


class _Partial(NamedTuple):
    """A partial map; `rank` is that of its first completion in class `any`."""

    rank: int
    degrees: IntTuple
    opened: IntTuple
    alpha: IntTuple  # -1: open
    pruners: tuple[Pruner, ...]


def _grown(edges: int, kind: WorldClass, start: int, stop: int) -> Iterator[tuple[int, Table]]:
    stack = list(_roots(edges, kind))[::-1]
    while stack:
        partial = stack.pop()
        u, r = len(partial.opened), 2 * edges - len(partial.alpha)
        if partial.rank >= stop:
            return
        if partial.rank + rank_order.completions(u, r) <= start:
            continue
        if u:
            stack += list(_children(partial, r))[::-1]
        else:
            yield partial.rank, (partial.degrees, partial.alpha)


def _roots(edges: int, kind: WorldClass) -> Iterator[_Partial]:
    rank = 0
    for degree in range(1, 2 * edges + 1):
        pruners = _pruners(kind, edges, degree)
        if pruners is not None:
            yield _Partial(rank, (degree,), tuple(range(degree)), (-1,) * degree, pruners)
        rank += rank_order.completions(degree, 2 * edges - degree)


def _children(partial: _Partial, r: int) -> Iterator[_Partial]:
    rank, degrees, opened, alpha, pruners = partial
    dart, u, created = opened[0], len(opened), len(alpha)
    # 0: a dead end
    ways = rank_order.completions(u - 2, r) if u > 1 else 0
    for place in range(1, u) if ways else ():
        partner = opened[place]
        kept = _all(pruner.join(dart, partner, r) for pruner in pruners)
        if kept is not None:
            row = list(alpha)
            row[dart], row[partner] = partner, dart
            rest = opened[1:place] + opened[place + 1 :]
            yield _Partial(rank, degrees, rest, tuple(row), kept)
        rank += ways
    for degree in range(1, r + 1):
        ways = rank_order.completions(u + degree - 2, r - degree)
        if ways:
            kept = _all(pruner.hang(dart, created, degree, r - degree) for pruner in pruners)
            if kept is not None:
                row = [*alpha, dart, *[-1] * (degree - 1)]
                row[dart] = created
                rest = opened[1:] + tuple(range(created + 1, created + degree))
                yield _Partial(rank, (*degrees, degree), rest, tuple(row), kept)
        rank += ways


def _all(pruners: Iterator[Pruner | None]) -> tuple[Pruner, ...] | None:
    kept: list[Pruner] = []
    for pruner in pruners:
        if pruner is None:
            return None
        kept.append(pruner)
    return tuple(kept)


def _pruners(kind: WorldClass, edges: int, degree: int) -> tuple[Pruner, ...] | None:
    pruners: list[Pruner] = []
    to_create = 2 * edges - degree
    if kind.most_degree is not None or kind.least_degree:
        most_degree = 2 * edges if kind.most_degree is None else kind.most_degree
        degrees = DegreePruner(kind.least_degree, most_degree)
        if not degrees.allows(degree, to_create):
            return None
        pruners.append(degrees)
    if kind.loopless or kind.simple:
        neighbours = NeighbourPruner(kind.simple, (0,) * degree, (degree,), (0,))
        if not neighbours.feasible(to_create):
            return None
        pruners.append(neighbours)
    most = kind.most_genus if kind.genus is None else kind.genus
    if most is not None:
        words = GenusPruner((tuple(range(degree)),), most, kind.genus is not None)
        if not words.feasible(to_create):
            return None
        pruners.append(words)
    return tuple(pruners)


class DegreePruner(NamedTuple):
    """Allows vertices of these degrees."""

    least: int
    most: int

    def allows(self, degree: int, to_create: int) -> bool:
        """Whether a vertex may have the degree, and another one the darts to create, if any."""
        return self.least <= degree <= self.most and not 0 < to_create < self.least

    def join(self, dart: int, partner: int, to_create: int) -> DegreePruner | None:  # noqa: ARG002
        """This pruner, since a join changes no degree."""
        return self

    def hang(self, dart: int, first: int, degree: int, to_create: int) -> DegreePruner | None:  # noqa: ARG002
        """None if the new vertex has a degree that is not allowed, or another one will."""
        return self if self.allows(degree, to_create) else None


class GenusPruner(NamedTuple):
    """Allows `handles` further handles, and demands them if `exact`; `words` as above."""

    words: tuple[IntTuple, ...]
    handles: int
    exact: bool

    def join(self, dart: int, partner: int, to_create: int) -> GenusPruner | None:
        """Cuts the word of both darts in two, or merges their two words."""
        with_dart = next(word for word in self.words if dart in word)
        others = [word for word in self.words if word is not with_dart]
        ahead = _turned(with_dart, dart)
        if partner in with_dart:
            cut = ahead.index(partner)
            parts, handles = [ahead[:cut], ahead[cut + 1 :]], self.handles
        else:
            with_partner = next(word for word in others if partner in word)
            others.remove(with_partner)
            parts, handles = [ahead + _turned(with_partner, partner)], self.handles - 1
        # an empty word: a finished face
        words = (*others, *(part for part in parts if part))
        return self._if_feasible(GenusPruner(words, handles, self.exact), to_create)

    def hang(self, dart: int, first: int, degree: int, to_create: int) -> GenusPruner | None:
        """Puts the new vertex's other darts in the place of `dart`."""
        fresh = tuple(range(first + 1, first + degree))
        grown = (_turned(word, dart) + fresh if dart in word else word for word in self.words)
        return self._if_feasible(
            GenusPruner(tuple(filter(None, grown)), self.handles, self.exact), to_create
        )

    def _if_feasible(self, words: GenusPruner, to_create: int) -> GenusPruner | None:
        return words if words.feasible(to_create) else None

    def feasible(self, to_create: int) -> bool:
        """Whether the darts to create and the handles left can close the words."""
        odd = sum(len(word) % 2 for word in self.words)
        if self.handles < 0 or odd > to_create + 2 * self.handles:
            return False
        if not self.exact:
            return True
        # A handle takes a join that merges two words; every other join adds a word, and one
        # remains as a face. If darts remain, one edge hangs a vertex and is no join.
        joins = (sum(map(len, self.words)) + to_create) // 2 - (to_create > 0)
        return 2 * self.handles <= max(0, len(self.words) + joins - 1)


def _turned(word: IntTuple, dart: int) -> IntTuple:
    """The cyclic word without the dart, read from behind it."""
    place = word.index(dart)
    return word[place + 1 :] + word[:place]


class NeighbourPruner(NamedTuple):
    """Allows no loops and, if `simple`, no parallel edges."""

    simple: bool
    vertex: IntTuple
    opened: IntTuple  # open darts of each vertex
    near: IntTuple  # neighbours of each vertex, as a mask; 0 unless `simple`

    def join(self, dart: int, partner: int, to_create: int) -> NeighbourPruner | None:
        """None within one vertex and, if `simple`, between neighbours."""
        a, b = self.vertex[dart], self.vertex[partner]
        if a == b or self.near[a] >> b & 1:
            return None
        return self._joined(self.vertex, self.opened, self.near, (a, b), to_create)

    def hang(self, dart: int, first: int, degree: int, to_create: int) -> NeighbourPruner | None:  # noqa: ARG002
        """The new vertex has one neighbour."""
        fresh = len(self.opened)
        vertex = self.vertex + (fresh,) * degree
        opened, near = (*self.opened, degree), (*self.near, 0)
        return self._joined(vertex, opened, near, (self.vertex[dart], fresh), to_create)

    def _joined(
        self,
        vertex: IntTuple,
        opened: IntTuple,
        near: IntTuple,
        ends: tuple[int, int],
        to_create: int,
    ) -> NeighbourPruner | None:
        a, b = ends
        darts, masks = list(opened), list(near)
        darts[a] -= 1
        darts[b] -= 1
        if self.simple:
            masks[a] |= 1 << b
            masks[b] |= 1 << a
        grown = NeighbourPruner(self.simple, vertex, tuple(darts), tuple(masks))
        return grown if grown.feasible(to_create) else None

    def feasible(self, to_create: int) -> bool:
        """Whether each open dart can end at another vertex."""
        if not self.simple:
            # the largest vertex decides: max <= (sum - max) + to_create
            return 2 * max(self.opened) <= sum(self.opened) + to_create
        waiting = sum(1 << v for v, darts in enumerate(self.opened) if darts)
        return all(
            darts <= (waiting & ~self.near[v] & ~(1 << v)).bit_count() + to_create
            for v, darts in enumerate(self.opened)
            if darts
        )


def worlds(edges: int, *, cls: str = "any") -> Iterator[World]:
    """Every world of a class with this many edges, in the order of their ids, lazily.

    Args:
        edges: of each world, 0 to 200.
        cls: a class as on the command line, such as `planar` or `simple,max-degree:4`.
    Raises:
        InputError: at the call: the number is out of range, or the class unknown or empty.
    """
    if type(edges) is not int or not 0 <= edges <= MAX_ID_EDGES:
        # long integers cannot be printed
        value = "another one" if type(edges) is int else f"a {type(edges).__name__}"
        raise InputError(
            f"expected edges=N with an integer from 0 to {MAX_ID_EDGES} (larger worlds have no id),"
            f" got {value}"
        )
    return (
        World.from_code(table, name=f"m{edges}/{rank}")
        for rank, table in ranked_tables(edges, WorldClass.parse(cls))
    )
