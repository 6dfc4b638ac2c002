"""Lists the worlds of a rank range inside the kernel, one after the other, in place.

The compiled twin of `world/enumeration/rank_order.py` (class `any`) and `pruned.py` (all others):
the same growth, the same order, the same ranks. The letters are theirs: `u` open darts, `r` darts
still to create, `e` the smallest open dart, `c` its partner, F(u, r) the number of completions;
`n` darts and `nv` vertices exist so far, `m2` is the number of darts at the end.

What differs: there the partial maps are values on a stack. Here ONE map grows in the workspace
(`AL`, `VT`, `ST`, `DG`), and a step back undoes the last step. The state of the walk lies in an
array of its own, `G`, so it stops at each world and goes on behind it:

    G = prepare(8, WorldClass.parse("planar"), 0, 1000)
    while next_world(W, G) >= 0:             # the rank; -1: no further world
        ...                                  # the world lies in W; it has G[G_VERTICES] vertices

For a class other than `any` the pruners of `pruning.py` are asked before each step, and told of
each step back.

What it costs is printed, class by class and beside C, by

    .venv/bin/python benchmarks/compiled.py --only enumeration

Each step reads what the one before has written, so steps do not overlap: that is the limit.

Source: docs/semantics.md, section 12.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from topo_verify.compiled.growth import *
from topo_verify.compiled.kernel import Words, WordTable, compiled, entry, inlined
from topo_verify.compiled.pruning import (
    begin_pruned,
    hang_pruned,
    join_pruned,
    look_around,
    undo_hang_pruned,
    undo_join_pruned,
)
from topo_verify.compiled.workspace import *
from topo_verify.errors import InputError
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass

if TYPE_CHECKING:
    from numpy import int64
    from numpy.typing import NDArray


@inlined
def next_world(W: Words, G: Words) -> int:
    """The rank of the next world, which lies in the workspace now; -1 if there is none."""
    if G[G_PRUNED] != 0:
        return next_pruned(W, G)
    return next_of_all(W, G)


# ---------------------------------------------------------------- other classes: pruned.py


@inlined
def next_pruned(W: Words, G: Words) -> int:  # noqa: PLR0912  split, it takes longer
    """`next_world` in any other class: `_grown` of pruned.py."""
    m2, k, n, u, nv = G[G_DARTS], G[G_DEPTH], G[G_CREATED], G[G_OPENED], G[G_VERTICES]
    while True:
        if k > 0:
            k -= 1
            e, c, rank = G[G_DART + k], G[G_PARTNER + k], G[G_AFTER + k]
            W[AL + e] = -1
            if G[G_IS_NEW + k] != 0:
                nv -= 1
                n = W[ST + nv]
                u -= W[DG + nv] - 2
                W[AL + n] = -1
                undo_hang_pruned(W, G, k, e, nv)
            else:
                W[AL + c] = -1
                u += 2
                undo_join_pruned(W, G, k, e, c)
        else:
            rank = begin_next_root(W, G)
            if rank < 0:
                G[G_DEPTH] = 0
                return -1
            n = G[G_ROOT]
            u, nv, e, c = n, 1, 0, 0
            if G[G_HAS_GENUS] != 0:
                look_around(G, 0, 0)
        # The next child of this step, its first child, and so on, down to a world.
        while u > 0:
            G[G_RANK] = rank
            c = join_from(W, G, k, e, c + 1, m2, n, u, nv)
            if c >= n:
                c = new_vertex_from(W, G, k, e, c, m2, n, u, nv)
                if c >= m2:
                    break
                nv += 1
                u += c - n - 1
                n = c + 1
            else:
                u -= 2
            rank = G[G_RANK]
            k += 1
            if u > 0:
                while W[AL + e] >= 0:
                    e += 1
                c = e
                if G[G_HAS_GENUS] != 0:
                    look_around(G, k, e)
        if u == 0:
            G[G_DEPTH], G[G_CREATED], G[G_OPENED], G[G_VERTICES] = k, n, u, nv
            return rank


@inlined
def begin_next_root(W: Words, G: Words) -> int:
    """Begin with the next root of the class in the range; its rank, or -1: no further one."""
    m2 = G[G_DARTS]
    rank = G[G_ROOT_AFTER]
    for degree in range(G[G_ROOT] + 1, m2 + 1):
        if rank >= G[G_STOP]:
            break
        after = rank + G[G_COMPLETIONS + degree * G_ROW + m2 - degree]
        if after > G[G_START] and begin_pruned(G, degree, m2 - degree):
            G[G_ROOT_AFTER] = after
            plant(W, G, degree)
            return rank
        # Also for a root that is pruned: ranks count the worlds of class `any`.
        rank = after
    G[G_ROOT] = m2
    return -1


@inlined
def join_from(W: Words, G: Words, k: int, e: int, c: int, m2: int, n: int, u: int, nv: int) -> int:
    """Join e with the first open dart from c on that is not pruned, and return it.

    `G_RANK`: before, the rank of the step with c; after, of the step that was made.
    Returns: if there is none, n or c: the first place for a new vertex's last dart.
    """
    ways = 0
    if c < n and u > 1:
        ways = G[G_COMPLETIONS + (u - 2) * G_ROW + m2 - n]
    # No way at all: the join would leave no open dart while darts remain (a dead end).
    if ways == 0:
        return max(c, n)
    rank = G[G_RANK]
    while c < n:
        if W[AL + c] < 0:
            after = rank + ways
            if after > G[G_START] and rank < G[G_STOP]:
                if join_pruned(W, G, k, e, c, u - 2, m2 - n, nv):
                    G[G_DART + k], G[G_PARTNER + k], G[G_IS_NEW + k] = e, c, 0
                    G[G_AFTER + k] = after
                    W[AL + e], W[AL + c] = c, e
                    break
            rank = after
        c += 1
    G[G_RANK] = rank
    return c


@inlined
def new_vertex_from(
    W: Words, G: Words, k: int, e: int, c: int, m2: int, n: int, u: int, nv: int
) -> int:
    """Hang a vertex on e, the first that is not pruned, whose last dart is c or more: that dart.

    `G_RANK`: before, the rank of the step with c; after, of the step that was made.
    Returns: m2, if there is none.
    """
    rank = G[G_RANK]
    while c < m2 and rank < G[G_STOP]:
        degree = c - n + 1
        ways = G[G_COMPLETIONS + (u + degree - 2) * G_ROW + m2 - c - 1]
        if ways > 0:
            after = rank + ways
            if after > G[G_START]:
                if hang_pruned(W, G, k, e, n, degree, u + degree - 2, m2 - c - 1, nv):
                    G[G_DART + k], G[G_PARTNER + k], G[G_IS_NEW + k] = e, c, 1
                    G[G_AFTER + k] = after
                    G[G_RANK] = rank
                    new_vertex(W, e, n, degree, nv)
                    return c
            rank = after
        c += 1
    return m2


# ---------------------------------------------------------------- for use from Python


@entry
def count_worlds(W: Words, G: Words) -> int:
    """How many worlds are still to come."""
    count = 0
    while next_world(W, G) >= 0:
        count += 1
    return count


@entry
def list_worlds(W: Words, G: Words, rows: WordTable, most: int) -> int:
    """Write the next worlds into rows, and return how many: rank, vertices, degrees, alpha."""
    m2 = G[G_DARTS]
    for i in range(most):
        rank = next_world(W, G)
        if rank < 0:
            return i
        vertices = G[G_VERTICES]
        rows[i, 0] = rank
        rows[i, 1] = vertices
        for v in range(vertices):
            rows[i, 2 + v] = W[DG + v]
        for d in range(m2):
            rows[i, 2 + vertices + d] = W[AL + d]
    return most


def prepare(
    edges: int, kind: WorldClass | None = None, start: int = 0, stop: int | None = None
) -> NDArray[int64]:
    """The state of an enumeration before its first world: an array of 64-bit integers, `G`.

    Args:
        kind: the class; default: any.
        start, stop: only ranks start … stop-1 (ranks in class `any`, whatever the class).
    Raises:
        InputError: more edges than the small layout has room for, or none.
    """
    import numpy as np

    if not 1 <= edges <= MOST_LISTED_EDGES:
        raise InputError(
            f"the compiled engine lists worlds with 1 … {MOST_LISTED_EDGES} edges, got {edges}:"
            " ask for fewer, or use the reference engine"
        )
    kind = WorldClass() if kind is None else kind
    G = np.zeros(G_SIZE, np.int64)
    m2, total = 2 * edges, rank_order.count(edges)
    first = min(max(0, start), total)
    G[G_DARTS], G[G_START], G[G_RANK], G[G_SKIP] = m2, first, first, first
    G[G_STOP] = total if stop is None else min(max(0, stop), total)
    for darts in range(m2 + 1):
        for r in range(darts + 1):
            G[G_COMPLETIONS + (darts - r) * G_ROW + r] = rank_order.completions(darts - r, r)
    most = kind.most_genus if kind.genus is None else kind.genus
    G[G_PRUNED] = kind != WorldClass()
    G[G_HAS_GENUS], G[G_EXACT] = most is not None, kind.genus is not None
    # No map has 2g > m; so the bound of a class that asks for more excludes (or allows) nothing.
    G[G_MOST_GENUS] = min(most or 0, edges)
    G[G_MOST_DEGREE] = min(kind.most_degree or m2, m2)
    G[G_LOOPLESS], G[G_SIMPLE] = kind.loopless or kind.simple, kind.simple
    return G


def ranked_tables(
    edges: int,
    kind: WorldClass | None = None,
    start: int = 0,
    stop: int | None = None,
    *,
    layout: WordLayout = SMALL,
) -> Iterator[tuple[int, rank_order.Table]]:
    """The same worlds as `pruned.ranked_tables` lists, with their ranks, by the kernel.

    Raises:
        InputError: numba is not installed, or so many edges cannot be listed.
    """
    import numpy as np

    G, W = prepare(edges, kind, start, stop), np.zeros(layout.constants["SIZE"], np.int64)
    rows = np.zeros((1024, 2 + edges + 1 + 2 * edges), np.int64)
    following = compiled(list_worlds, layout)
    while found := following(W, G, rows, len(rows)):
        for rank, vertices, *table in rows[:found].tolist():
            degrees, alpha = table[:vertices], table[vertices : vertices + 2 * edges]
            yield rank, (tuple(degrees), tuple(alpha))


# ---------------------------------------------------------------- class any


@inlined
def next_of_all(W: Words, G: Words) -> int:
    """`next_world` in class `any`: `tables` of rank_order.py.

    One function, with what changes at every step in variables: split, with all of it in G, it took
    1.6 times as long.
    """
    if G[G_RANK] >= G[G_STOP]:
        return -1
    m2, k, n, u, nv = G[G_DARTS], G[G_DEPTH], G[G_CREATED], G[G_OPENED], G[G_VERTICES]
    while True:
        if k > 0:  # undo the last step; its next sibling follows
            k -= 1
            e, c = G[G_DART + k], G[G_PARTNER + k]
            W[AL + e] = -1
            if G[G_IS_NEW + k] != 0:
                nv -= 1
                n = W[ST + nv]
                u -= W[DG + nv] - 2
                W[AL + n] = -1
            else:
                W[AL + c] = -1
                u += 2
        else:
            n = next_root(G)
            plant(W, G, n)
            u, nv, e, c = n, 1, 0, 0
        while u > 0:
            c = next_partner(W, c + 1, m2, n, u)
            if c >= m2:
                break
            if G[G_SKIP] > 0 and skipped(G, c, m2, n, u):
                continue
            G[G_DART + k], G[G_PARTNER + k] = e, c
            if c < n:
                W[AL + e], W[AL + c] = c, e
                u -= 2
                G[G_IS_NEW + k] = 0
            else:
                new_vertex(W, e, n, c + 1 - n, nv)
                nv += 1
                u += c - n - 1
                n = c + 1
                G[G_IS_NEW + k] = 1
            k += 1
            if u > 0:
                while W[AL + e] >= 0:
                    e += 1
                c = e
        if u == 0:
            G[G_DEPTH], G[G_CREATED], G[G_OPENED], G[G_VERTICES] = k, n, u, nv
            G[G_RANK] += 1
            return G[G_RANK] - 1


@inlined
def next_partner(W: Words, c: int, m2: int, n: int, u: int) -> int:
    """The next partner from c on: an open dart, or what would be a new vertex's last dart."""
    # A step that leaves no open dart while darts remain is a dead end.
    while c < m2:
        if c < n:
            if W[AL + c] < 0 and (u > 2 or n == m2):
                break
        elif u > 1 or c > n or n + 1 == m2:
            break
        c += 1
    return c


@inlined
def next_root(G: Words) -> int:
    """The degree of the next root that has worlds in the range; those before it are passed over."""
    degree = G[G_ROOT] + 1
    ways = G[G_COMPLETIONS + degree * G_ROW + G[G_DARTS] - degree]
    while G[G_SKIP] >= ways:
        G[G_SKIP] -= ways
        degree += 1
        ways = G[G_COMPLETIONS + degree * G_ROW + G[G_DARTS] - degree]
    return degree


@inlined
def skipped(G: Words, c: int, m2: int, n: int, u: int) -> bool:
    """Whether all completions of a step lie before the range; if so, they are passed over."""
    if c < n:
        ways = G[G_COMPLETIONS + (u - 2) * G_ROW + m2 - n]
    else:
        ways = G[G_COMPLETIONS + (u + c - n - 1) * G_ROW + m2 - c - 1]
    if G[G_SKIP] < ways:
        return False
    G[G_SKIP] -= ways
    return True


# ---------------------------------------------------------------- steps


@inlined
def plant(W: Words, G: Words, degree: int) -> None:
    """Begin with a root vertex of this degree, all its darts open."""
    for d in range(G[G_DARTS]):
        W[AL + d] = -1
    W[ST] = 0
    W[DG] = degree
    for d in range(degree):
        W[VT + d] = 0
    G[G_ROOT] = degree


@inlined
def new_vertex(W: Words, e: int, first: int, degree: int, vertex: int) -> None:
    """Hang a new vertex on e by its first dart."""
    W[ST + vertex] = first
    W[DG + vertex] = degree
    for d in range(first, first + degree):
        W[VT + d] = vertex
    W[AL + e] = first
    W[AL + first] = e
