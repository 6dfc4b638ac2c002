"""Counts, ranks, lists and samples rooted maps, each a bare table of degrees and partners.

The letters: `m` edges; `u` open darts (known, their edge not yet); `r` darts still to create.

A rooted map grows from its root vertex. Take the smallest open dart; either join it with another
open dart, or hang a new vertex of degree `d` on it, whose darts are numbered consecutively from the
dart by which it hangs. An open dart must remain while there are darts to create. Completions depend
on `u` and `r` alone and are counted by

    F(u, r) = (u-1)·F(u-2, r) + Σ_{1<=d<=r} F(u+d-2, r-d),   F(0, 0) = 1,   F(0, r>0) = 0.

Each map arises once, in its breadth-first numbering, so no hash table is needed; the counts turn a
rank into a map and back. **Order** (a format promise): root degree ascending; then at the smallest
open dart, joins first by ascending partner, then new vertices by ascending degree.

A **table** is `(degrees, alpha)`: vertex `i` owns the next `degrees[i]` darts, `alpha[d]` is the
other dart of `d`'s edge, the root is dart 0. It is the canonical code of its world.

Source: docs/semantics.md, section 12. Planar: W. T. Tutte, "A census of planar maps", Canad. J.
    Math. 15 (1963).
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from functools import cache
from itertools import accumulate, islice
from math import comb
from operator import itemgetter
from random import Random

from topo_verify.errors import InputError

IntTuple = tuple[int, ...]
Table = tuple[IntTuple, IntTuple]

MAX_ID_EDGES = 200
"""Largest world with an id; the counts work beyond, only slower."""


def completions(open_darts: int, to_create: int) -> int:
    """F(u, r); 0 if u + r is odd."""
    half, odd = divmod(open_darts + to_create, 2)
    if odd or open_darts < 0 or to_create < 0:
        return 0
    while len(_rows) <= half:
        _rows.append(_next_row(_rows[-1]))
    return _rows[half][to_create]


_rows: list[tuple[int, ...]] = [(1,)]
"""Row t holds F(2t - r, r) for r = 0 … 2t."""


def _next_row(before: tuple[int, ...]) -> tuple[int, ...]:
    # joins come from before[r], with u - 2 open darts; none if u = 1
    total = len(before) + 1
    attached = [0, *accumulate(before)]  # Σ_d F(u+d-2, r-d) = before[0] + … + before[r-1]
    joined = [(total - r - 1) * ways for r, ways in enumerate(before)]
    return (*map(sum, zip(attached, joined, strict=False)), attached[total - 1], 0)


def count(edges: int) -> int:
    """The number of rooted maps of any genus with this many edges."""
    _require_edges(edges)
    if edges == 0:
        return 1
    return sum(completions(d, 2 * edges - d) for d in range(1, 2 * edges + 1))


def count_by_recurrence(edges: int, x: int = 1) -> int:
    """The same number, from an independent recurrence; each world counts x^(its vertices).

    M(z) = x + z·M(z)² + z·M(z) + 2z²·M'(z): D. Arquès and J.-F. Béraud, "Rooted maps on orientable
    surfaces, Riccati's equation and continued fractions", Discrete Math. 215 (2000).
    """
    _require_edges(edges)
    numbers = [x]
    for m in range(1, edges + 1):
        # z·M and 2z²·M' have the coefficients M[m-1] and 2(m-1)·M[m-1]
        squared = sum(numbers[i] * numbers[m - 1 - i] for i in range(m))
        numbers.append(squared + (2 * m - 1) * numbers[m - 1])
    return numbers[edges]


def count_planar(edges: int) -> int:
    """The number of planar rooted maps: 2·3^m·C(2m, m) / ((m+1)(m+2)) (Tutte)."""
    _require_edges(edges)
    powers: int = 2 * 3**edges
    return powers * comb(2 * edges, edges) // ((edges + 1) * (edges + 2))


def rank(table: Table) -> int:
    """The number of the map in the enumeration, from 0, in O(m²) steps on long integers.

    Args:
        table: a canonical code; any other numbering gives a meaningless number.
    """
    degrees, alpha = table
    if not alpha:
        return 0
    # add the completions of the alternatives before each step
    m2 = len(alpha)
    before = sum(completions(d, m2 - d) for d in range(1, degrees[0]))
    opened = list(range(degrees[0]))
    created, vertices = degrees[0], 1
    while opened:
        u, r = len(opened), m2 - created
        partner = alpha[opened.pop(0)]
        if partner < created:
            place = opened.index(partner)
            before += place * completions(u - 2, r)
            del opened[place]
        else:
            d = degrees[vertices]
            before += (u - 1) * completions(u - 2, r)
            before += sum(completions(u + x - 2, r - x) for x in range(1, d))
            opened += range(created + 1, created + d)
            created, vertices = created + d, vertices + 1
    return before


def unrank(edges: int, rank: int) -> Table:
    """The map of this rank; InputError if it is out of range."""
    total = count(edges)
    if not 0 <= rank < total:
        raise InputError(
            f"there is no world m{edges}/{rank}: ranks of worlds with {edges} edges run"
            f" from 0 to {total - 1}"
        )
    if edges == 0:
        return (0,), ()
    m2 = 2 * edges
    # `_choose` counts from 0
    d, rank = _choose(rank, (completions(d, m2 - d) for d in range(1, m2 + 1)))
    degrees, opened, alpha = [d + 1], list(range(d + 1)), [0] * m2
    created = d + 1
    while opened:
        u, r = len(opened), m2 - created
        dart = opened.pop(0)
        joins = (u - 1) * completions(u - 2, r)
        if rank < joins:
            place, rank = divmod(rank, completions(u - 2, r))
            partner = opened.pop(place)
        else:
            ways = (completions(u + d - 2, r - d) for d in range(1, r + 1))
            d, rank = _choose(rank - joins, ways)
            partner = created
            degrees.append(d + 1)
            opened += range(created + 1, created + d + 1)
            created += d + 1
        alpha[dart], alpha[partner] = partner, dart
    return tuple(degrees), tuple(alpha)


def _choose(rank: int, ways: Iterator[int]) -> tuple[int, int]:
    """The index of the block that the rank falls into, and the rank within it."""
    index, size = 0, next(ways)
    while rank >= size:
        index, rank, size = index + 1, rank - size, next(ways)
    return index, rank


def id_parts(text: str) -> tuple[int, int]:
    """Edges and rank of a world id, `m<edges>/<rank>`; InputError if it is not one."""
    edges, slash, rank = text.removeprefix("m").partition("/")
    # the longest rank has 437 digits
    digits = all(part.isascii() and part.isdigit() and len(part) < 1000 for part in (edges, rank))
    if not (text.startswith("m") and slash and digits):
        raise InputError(f"expected a world id m<edges>/<rank>, such as m5/17, got {text[:60]!r}")
    require_id_edges(int(edges))
    return int(edges), int(rank)


def require_id_edges(edges: int) -> None:
    """Refuse a number of edges that is too large for an id."""
    if edges > MAX_ID_EDGES:
        raise InputError(
            f"a world with {edges} edges has no id (ids go up to {MAX_ID_EDGES} edges):"
            " save it as a file (-o; in Python `save`) and name the file"
        )


def sample(edges: int, random: Random) -> Table:
    """A rooted map with this many edges, exactly uniform."""
    return unrank(edges, random.randrange(count(edges)))


_TAIL = 8
"""Completions with at most this many darts are cached."""


def tables(edges: int, start: int = 0, stop: int | None = None) -> Iterator[Table]:
    """The rooted maps of ranks start … stop-1, in order; a shard costs what it yields."""
    total = count(edges)
    stop = total if stop is None else min(stop, total)
    return islice(_tables_from(edges, start), min(max(0, stop - start), sys.maxsize))


def _tables_from(edges: int, skip: int) -> Iterator[Table]:
    if edges == 0:
        yield from [((0,), ())][skip:]
        return
    m2 = 2 * edges
    # degrees, open darts, joined darts, their partners
    stack: list[tuple[IntTuple, IntTuple, IntTuple, IntTuple]]
    stack = [((d,), tuple(range(d)), (), ()) for d in range(m2, 0, -1)]
    while stack:
        degrees, opened, joined, partners = stack.pop()
        u, created = len(opened), len(opened) + len(joined)
        r = m2 - created
        if skip and completions(u, r) <= skip:
            skip -= completions(u, r)
        elif u + r <= _TAIL:
            # slots of the cached endings
            slots = (*opened, *range(created, m2))
            place = _inverse(joined + slots)
            for more, partner_slots in islice(_endings(u, r), skip, None):
                yield degrees + more, place(partners + partner_slots(slots))
            skip = 0
        else:
            for j, partner, more in reversed(list(_steps(opened, created, r))):
                fresh = tuple(range(created + 1, created + sum(more)))
                rest = opened[1:j] + opened[j + 1 :] + fresh
                pair = (opened[0], partner)
                stack.append((degrees + more, rest, joined + pair, partners + pair[::-1]))


def _steps(opened: IntTuple, created: int, r: int) -> Iterator[tuple[int, int, IntTuple]]:
    """Each step at the smallest open dart: its partner's place and number, and new degrees."""
    # A join leaves u - 2 open darts, a new vertex u + d - 2. j = u: the partner is a new dart.
    u = len(opened)
    if u > 2 or r == 0:
        for j in range(1, u):
            yield j, opened[j], ()
    for d in range(1, r + 1):
        if u + d > 2 or r == d:
            yield u, created, (d,)


def _inverse(darts: IntTuple) -> itemgetter[IntTuple]:
    """A getter that reorders a row from the order `darts` to ascending darts."""
    # never one index: an itemgetter would return no tuple
    return itemgetter(*sorted(range(len(darts)), key=darts.__getitem__))


@cache
def _endings(u: int, r: int) -> tuple[tuple[IntTuple, itemgetter[IntTuple]], ...]:
    """All completions over slots: 0 … u-1 are the open darts, u … u+r-1 the darts to come.

    Each is (further degrees, getter of every slot's partner).
    """
    endings: list[tuple[IntTuple, itemgetter[IntTuple]]] = []
    slots = tuple(range(u + r))
    for _, partner, more in _steps(slots[:u], u, r):
        rest = tuple(s for s in slots if s not in (0, partner))
        if not rest:
            return ((more, itemgetter(1, 0)),)
        # `rest` has the form of slots again
        place = _inverse((0, partner, *rest))
        for further, partners in _endings(u - 2 + sum(more), r - sum(more)):
            row = place((partner, 0, *partners(rest)))
            endings.append((more + further, itemgetter(*row)))
    return tuple(endings)


def _require_edges(edges: int) -> None:
    if edges < 0:
        raise InputError(f"expected 0 or more edges, got {edges}")
