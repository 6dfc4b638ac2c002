"""The worlds of a class, listed in the order of their ranks: grown with pruning, not filtered.

Worlds grow as in `counting`: the smallest open dart is joined with another open dart, or a new
vertex is hung on it. A **rein** follows the growth for one property and stops a branch as soon as
no completion can have the property. What it remembers is a value, so branches do not disturb each
other:

    Words       genus: the open darts along each boundary of the partial map, one cyclic word each.
                Joining two darts of one word cuts it in two, and the genus stays; joining darts of
                two words makes one of them, and the genus grows by one; a new vertex puts its other
                darts in the place of the dart that it hangs on. A word of even length can be closed
                in the plane; one of odd length needs a leaf or another odd word at the price of a
                handle. So: odd words <= darts still to create + 2·(genus left).
    Neighbours  loopless and simple: the open darts of each vertex, and (simple) a mask of its
                neighbours. Each open dart needs an end elsewhere: at a vertex with open darts that
                is no neighbour, or at one still to come.
    Degrees     max-degree: the new vertex itself.

The rank among ALL worlds comes for free: a branch that is not taken is passed over with the number
of its completions. So parts of the list are cut by rank, in every class.

Cost: every world costs its path in the tree. For `planar`, `genus<=G` and `loopless` alone no
branch ends without a world (a test says so); elsewhere some do: that costs time, and nothing else.

Source: docs/semantics.md, section 12.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple, Protocol

from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.enumeration.rank_order import Row, Table


class Rein(Protocol):
    """What one property still allows. The answer to a step: the rein behind it, None: impossible.

    `left` is the number of darts still to create behind the step.
    """

    def join(self, dart: int, partner: int, left: int) -> Rein | None:
        """Two open darts become an edge."""
        ...

    def hang(self, dart: int, first: int, degree: int, left: int) -> Rein | None:
        """A new vertex of this degree; `first` is its first dart, the one joined with `dart`."""
        ...


def ranked_tables(
    edges: int, kind: WorldClass | None = None, start: int = 0, stop: int | None = None
) -> Iterator[tuple[int, Table]]:
    """The worlds of a class with this many edges, each with its rank among ALL worlds, ascending.

    Args:
        kind: the class; default: any.
        start, stop: only ranks start … stop-1 (ranks in class `any`, whatever the class).
    """
    total = rank_order.count(edges)
    stop = total if stop is None else min(stop, total)
    kind = WorldClass() if kind is None else kind
    if edges == 0 or kind == WorldClass():
        listed = enumerate(rank_order.tables(edges, start, stop), start)
        yield from (pair for pair in listed if edges or kind.admits(pair[1]))
    else:
        yield from _grown(edges, kind, start, stop)


class _Partial(NamedTuple):
    """A partial map; `rank` is that of its first completion in class `any`."""

    rank: int
    degrees: Row
    opened: Row
    alpha: Row  # -1: open
    reins: tuple[Rein, ...]


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
        reins = _reins(kind, edges, degree)
        if reins is not None:
            yield _Partial(rank, (degree,), tuple(range(degree)), (-1,) * degree, reins)
        rank += rank_order.completions(degree, 2 * edges - degree)


def _children(partial: _Partial, r: int) -> Iterator[_Partial]:
    """What can become of the smallest open dart: joins, then new vertices, as far as allowed."""
    rank, degrees, opened, alpha, reins = partial
    dart, u, created = opened[0], len(opened), len(alpha)
    ways = rank_order.completions(u - 2, r) if u > 1 else 0
    for place in range(1, u) if ways else ():
        partner = opened[place]
        held = _all(rein.join(dart, partner, r) for rein in reins)
        if held is not None:
            row = list(alpha)
            row[dart], row[partner] = partner, dart
            rest = opened[1:place] + opened[place + 1 :]
            yield _Partial(rank, degrees, rest, tuple(row), held)
        rank += ways
    for degree in range(1, r + 1):
        ways = rank_order.completions(u + degree - 2, r - degree)
        if ways:
            held = _all(rein.hang(dart, created, degree, r - degree) for rein in reins)
            if held is not None:
                row = [*alpha, dart, *[-1] * (degree - 1)]
                row[dart] = created
                rest = opened[1:] + tuple(range(created + 1, created + degree))
                yield _Partial(rank, (*degrees, degree), rest, tuple(row), held)
        rank += ways


def _all(reins: Iterator[Rein | None]) -> tuple[Rein, ...] | None:
    """All of them, or None as soon as one is."""
    held: list[Rein] = []
    for rein in reins:
        if rein is None:
            return None
        held.append(rein)
    return tuple(held)


# ---------------------------------------------------------------- the reins


def _reins(kind: WorldClass, edges: int, degree: int) -> tuple[Rein, ...] | None:
    """What holds a growth from a root of this degree; None: no world of the class has one."""
    reins: list[Rein] = []
    left = 2 * edges - degree
    if kind.most_degree is not None:
        if degree > kind.most_degree:
            return None
        reins.append(Degrees(kind.most_degree))
    if kind.loopless or kind.simple:
        neighbours = Neighbours(kind.simple, (0,) * degree, (degree,), (0,))
        if not neighbours.feasible(left):
            return None
        reins.append(neighbours)
    most = kind.most_genus if kind.genus is None else kind.genus
    if most is not None:
        words = Words((tuple(range(degree)),), most, kind.genus is not None)
        if not words.feasible(left):
            return None
        reins.append(words)
    return tuple(reins)


class Degrees(NamedTuple):
    """No vertex has more darts."""

    most: int

    def join(self, dart: int, partner: int, left: int) -> Degrees | None:  # noqa: ARG002  see Rein
        """Changes no degree."""
        return self

    def hang(self, dart: int, first: int, degree: int, left: int) -> Degrees | None:  # noqa: ARG002
        """Unless the new vertex has too many."""
        return self if degree <= self.most else None


class Words(NamedTuple):
    """The boundaries' open darts; handles left; are all of them wanted?"""

    words: tuple[Row, ...]
    handles: int
    exact: bool

    def join(self, dart: int, partner: int, left: int) -> Words | None:
        """Cut a word in two, or make one of two."""
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
        words = (*others, *(part for part in parts if part))
        return self._if_feasible(Words(words, handles, self.exact), left)

    def hang(self, dart: int, first: int, degree: int, left: int) -> Words | None:
        """Put the new darts in the place of the one that they hang on."""
        fresh = tuple(range(first + 1, first + degree))
        grown = (_turned(word, dart) + fresh if dart in word else word for word in self.words)
        return self._if_feasible(Words(tuple(filter(None, grown)), self.handles, self.exact), left)

    def _if_feasible(self, words: Words, left: int) -> Words | None:
        return words if words.feasible(left) else None

    def feasible(self, left: int) -> bool:
        """Can the words be closed with this many darts to come, and with the handles left?"""
        odd = sum(len(word) % 2 for word in self.words)
        if self.handles < 0 or odd > left + 2 * self.handles:
            return False
        if not self.exact:
            return True
        # Of the joins to come, as many as cut a word in two must undo those that make one of two,
        # but for the words there are now and the one that is left at the end.
        joins = (sum(map(len, self.words)) + left) // 2 - (left > 0)
        return 2 * self.handles <= max(0, len(self.words) + joins - 1)


def _turned(word: Row, dart: int) -> Row:
    """What follows the dart in a cyclic word, up to it."""
    place = word.index(dart)
    return word[place + 1 :] + word[:place]


class Neighbours(NamedTuple):
    """No loops and, if `simple`, no two edges between the same two vertices."""

    simple: bool
    vertex: Row  # of each dart
    opened: Row  # how many open darts each vertex has
    near: Row  # the neighbours of each vertex, as a mask (simple alone)

    def join(self, dart: int, partner: int, left: int) -> Neighbours | None:
        """Not with the own vertex; simple: nor with a neighbour."""
        a, b = self.vertex[dart], self.vertex[partner]
        if a == b or self.near[a] >> b & 1:
            return None
        return self._joined(self.vertex, self.opened, self.near, (a, b), left)

    def hang(self, dart: int, first: int, degree: int, left: int) -> Neighbours | None:  # noqa: ARG002
        """A new vertex is nobody's neighbour yet."""
        fresh = len(self.opened)
        vertex = self.vertex + (fresh,) * degree
        opened, near = (*self.opened, degree), (*self.near, 0)
        return self._joined(vertex, opened, near, (self.vertex[dart], fresh), left)

    def _joined(
        self, vertex: Row, opened: Row, near: Row, ends: tuple[int, int], left: int
    ) -> Neighbours | None:
        a, b = ends
        darts, masks = list(opened), list(near)
        darts[a] -= 1
        darts[b] -= 1
        if self.simple:
            masks[a] |= 1 << b
            masks[b] |= 1 << a
        grown = Neighbours(self.simple, vertex, tuple(darts), tuple(masks))
        return grown if grown.feasible(left) else None

    def feasible(self, left: int) -> bool:
        """Is there an end elsewhere for each open dart?"""
        if not self.simple:
            return 2 * max(self.opened) <= sum(self.opened) + left
        waiting = sum(1 << v for v, darts in enumerate(self.opened) if darts)
        return all(
            darts <= (waiting & ~self.near[v] & ~(1 << v)).bit_count() + left
            for v, darts in enumerate(self.opened)
            if darts
        )
