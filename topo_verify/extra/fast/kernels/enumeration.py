"""Lists the worlds of a rank range inside the kernel.

Twin of `world/enumeration/rank_order.py` (class `any`) and `pruned.py` (other classes), with their
letters: `u` open darts, `r` darts to create, `e` the smallest open dart, `c` its partner, F(u, r)
the number of completions; `n` darts and `nv` vertices so far, `m2` darts at the end. Differs: ONE
map grows in the workspace, and a step back undoes the last step:

    walk = WalkWords(prepare(8, WorldClass.parse("planar"), 0, 1000))
    while next_world(world, walk) >= 0:      # the rank; -1: no further world
        ...                                  # it has walk.vertices vertices
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from topo_verify.errors import InputError
from topo_verify.extra.fast.kernels.kernel import WordTable, compiled, entry, inlined
from topo_verify.extra.fast.kernels.pruning import *
from topo_verify.extra.fast.kernels.workspace import *
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass

if TYPE_CHECKING:
    from numpy import int64
    from numpy.typing import NDArray


@inlined
def next_world(world: WorldWords, walk: WalkWords) -> int:
    """Place the next world; return its rank, or -1."""
    if walk.pruned != 0:
        return next_pruned(world, walk)
    return next_of_all(world, walk)


@inlined
def next_pruned(world: WorldWords, walk: WalkWords) -> int:  # noqa: PLR0912  split, it takes longer
    """`next_world` in other classes: `_grown` of pruned.py."""
    m2, k, n, u, nv = walk.darts, walk.depth, walk.created, walk.opened, walk.vertices
    while True:
        if k > 0:
            k -= 1
            e, c, rank = walk.dart[k], walk.partner[k], walk.after[k]
            world.alpha[e] = -1
            if walk.is_new[k] != 0:
                nv -= 1
                n = world.first[nv]
                u -= world.degree[nv] - 2
                world.alpha[n] = -1
                undo_hang_pruned(world, walk, k, e, nv)
            else:
                world.alpha[c] = -1
                u += 2
                undo_join_pruned(world, walk, k, e, c)
        else:
            rank = begin_next_root(world, walk)
            if rank < 0:
                walk.depth = 0
                return -1
            n = walk.root
            u, nv, e, c = n, 1, 0, 0
            if walk.has_genus != 0:
                look_around(walk, 0, 0)
        while u > 0:
            walk.rank = rank
            c = join_from(world, walk, k, e, c + 1, m2, n, u, nv)
            if c >= n:
                c = new_vertex_from(world, walk, k, e, c, m2, n, u, nv)
                if c >= m2:
                    break
                nv += 1
                u += c - n - 1
                n = c + 1
            else:
                u -= 2
            rank = walk.rank
            k += 1
            if u > 0:
                while world.alpha[e] >= 0:
                    e += 1
                c = e
                if walk.has_genus != 0:
                    look_around(walk, k, e)
        if u == 0:
            walk.depth, walk.created, walk.opened, walk.vertices = k, n, u, nv
            return rank


@inlined
def begin_next_root(world: WorldWords, walk: WalkWords) -> int:
    m2 = walk.darts
    rank = walk.root_after
    for degree in range(walk.root + 1, m2 + 1):
        if rank >= walk.stop:
            break
        after = rank + walk.completions[degree * G_ROW + m2 - degree]
        if after > walk.start and begin_pruned(walk, degree, m2 - degree):
            walk.root_after = after
            plant(world, walk, degree)
            return rank
        # Ranks count pruned roots too.
        rank = after
    walk.root = m2
    return -1


@inlined
def join_from(
    world: WorldWords, walk: WalkWords, k: int, e: int, c: int, m2: int, n: int, u: int, nv: int
) -> int:
    """Join e with the first open dart from c on that is not pruned; return it (n or c: none).

    `rank`: before, that of the step with c; after, of the step made.
    """
    ways = 0
    if c < n and u > 1:
        ways = walk.completions[(u - 2) * G_ROW + m2 - n]
    # A dead end: no dart would be open while darts remain.
    if ways == 0:
        return max(c, n)
    rank = walk.rank
    while c < n:
        if world.alpha[c] < 0:
            after = rank + ways
            if after > walk.start and rank < walk.stop:
                if join_pruned(world, walk, k, e, c, u - 2, m2 - n, nv):
                    walk.dart[k], walk.partner[k], walk.is_new[k] = e, c, 0
                    walk.after[k] = after
                    world.alpha[e], world.alpha[c] = c, e
                    break
            rank = after
        c += 1
    walk.rank = rank
    return c


@inlined
def new_vertex_from(
    world: WorldWords, walk: WalkWords, k: int, e: int, c: int, m2: int, n: int, u: int, nv: int
) -> int:
    """Hang a vertex on e whose last dart is the first not pruned from c on; return it (m2: none).

    `rank`: as in `join_from`.
    """
    rank = walk.rank
    while c < m2 and rank < walk.stop:
        degree = c - n + 1
        ways = walk.completions[(u + degree - 2) * G_ROW + m2 - c - 1]
        if ways > 0:
            after = rank + ways
            if after > walk.start:
                if hang_pruned(world, walk, k, e, n, degree, u + degree - 2, m2 - c - 1, nv):
                    walk.dart[k], walk.partner[k], walk.is_new[k] = e, c, 1
                    walk.after[k] = after
                    walk.rank = rank
                    new_vertex(world, e, n, degree, nv)
                    return c
            rank = after
        c += 1
    return m2


@entry
def count_worlds(world: WorldWords, walk: WalkWords) -> int:
    count = 0
    while next_world(world, walk) >= 0:
        count += 1
    return count


@entry
def list_worlds(world: WorldWords, walk: WalkWords, rows: WordTable, most: int) -> int:
    """Write worlds into rows (rank, vertices, degrees, alpha); return how many."""
    m2 = walk.darts
    for i in range(most):
        rank = next_world(world, walk)
        if rank < 0:
            return i
        vertices = walk.vertices
        rows[i, 0] = rank
        rows[i, 1] = vertices
        for v in range(vertices):
            rows[i, 2 + v] = world.degree[v]
        for d in range(m2):
            rows[i, 2 + vertices + d] = world.alpha[d]
    return most


def prepare(
    edges: int, kind: WorldClass | None = None, start: int = 0, stop: int | None = None
) -> NDArray[int64]:
    """The state of an enumeration of ranks start … stop-1 (of class `any`).

    Raises:
        InputError: too many edges, or none.
    """
    import numpy as np

    if not 1 <= edges <= MOST_LISTED_EDGES:
        raise InputError(
            f"the compiled engine lists worlds with 1 … {MOST_LISTED_EDGES} edges, got {edges}:"
            " ask for fewer, or use the reference engine"
        )
    kind = WorldClass() if kind is None else kind
    words = np.zeros(GROWTH.size, np.int64)
    walk = WalkWords(words)
    m2, total = 2 * edges, rank_order.count(edges)
    walk.darts = m2
    walk.start = walk.rank = walk.skip = min(max(0, start), total)
    walk.stop = total if stop is None else min(max(0, stop), total)
    for darts in range(m2 + 1):
        for r in range(darts + 1):
            walk.completions[(darts - r) * G_ROW + r] = rank_order.completions(darts - r, r)
    most = kind.most_genus if kind.genus is None else kind.genus
    walk.pruned = kind != WorldClass()
    walk.has_genus, walk.exact = most is not None, kind.genus is not None
    # No map has 2g > m.
    walk.most_genus = min(most or 0, edges)
    walk.least_degree = min(kind.least_degree, m2 + 1)
    walk.most_degree = min(kind.most_degree or m2, m2)
    walk.loopless, walk.simple = kind.loopless or kind.simple, kind.simple
    return words


def ranked_tables(
    edges: int,
    kind: WorldClass | None = None,
    start: int = 0,
    stop: int | None = None,
) -> Iterator[tuple[int, rank_order.Table]]:
    """The rank and the table of each world of a class, as `pruned.ranked_tables` gives them.

    Raises:
        InputError: numba is missing, or there are too many edges.
    """
    import numpy as np

    walk, space = prepare(edges, kind, start, stop), np.zeros(SMALL.at("SIZE"), np.int64)
    rows = np.zeros((1024, 2 + edges + 1 + 2 * edges), np.int64)
    following = compiled(list_worlds, SMALL)
    while listed := following(space, walk, rows, len(rows)):
        for rank, vertices, *table in rows[:listed].tolist():
            degrees, alpha = table[:vertices], table[vertices : vertices + 2 * edges]
            yield rank, (tuple(degrees), tuple(alpha))


@inlined
def next_of_all(world: WorldWords, walk: WalkWords) -> int:
    """`next_world` in class `any`: `tables` of rank_order.py.

    Split, with all in `walk`, it took 1.6 times as long.
    """
    if walk.rank >= walk.stop:
        return -1
    m2, k, n, u, nv = walk.darts, walk.depth, walk.created, walk.opened, walk.vertices
    while True:
        if k > 0:
            k -= 1
            e, c = walk.dart[k], walk.partner[k]
            world.alpha[e] = -1
            if walk.is_new[k] != 0:
                nv -= 1
                n = world.first[nv]
                u -= world.degree[nv] - 2
                world.alpha[n] = -1
            else:
                world.alpha[c] = -1
                u += 2
        else:
            n = next_root(walk)
            plant(world, walk, n)
            u, nv, e, c = n, 1, 0, 0
        while u > 0:
            c = next_partner(world, c + 1, m2, n, u)
            if c >= m2:
                break
            if walk.skip > 0 and skipped(walk, c, m2, n, u):
                continue
            walk.dart[k], walk.partner[k] = e, c
            if c < n:
                world.alpha[e], world.alpha[c] = c, e
                u -= 2
                walk.is_new[k] = 0
            else:
                new_vertex(world, e, n, c + 1 - n, nv)
                nv += 1
                u += c - n - 1
                n = c + 1
                walk.is_new[k] = 1
            k += 1
            if u > 0:
                while world.alpha[e] >= 0:
                    e += 1
                c = e
        if u == 0:
            walk.depth, walk.created, walk.opened, walk.vertices = k, n, u, nv
            walk.rank += 1
            return walk.rank - 1


@inlined
def next_partner(world: WorldWords, c: int, m2: int, n: int, u: int) -> int:
    # A dead end: no dart would be open while darts remain.
    while c < m2:
        if c < n:
            if world.alpha[c] < 0 and (u > 2 or n == m2):
                break
        elif u > 1 or c > n or n + 1 == m2:
            break
        c += 1
    return c


@inlined
def next_root(walk: WalkWords) -> int:
    degree = walk.root + 1
    ways = walk.completions[degree * G_ROW + walk.darts - degree]
    while walk.skip >= ways:
        walk.skip -= ways
        degree += 1
        ways = walk.completions[degree * G_ROW + walk.darts - degree]
    return degree


@inlined
def skipped(walk: WalkWords, c: int, m2: int, n: int, u: int) -> bool:
    """Skip a step whose completions all lie before the range."""
    if c < n:
        ways = walk.completions[(u - 2) * G_ROW + m2 - n]
    else:
        ways = walk.completions[(u + c - n - 1) * G_ROW + m2 - c - 1]
    if walk.skip < ways:
        return False
    walk.skip -= ways
    return True


@inlined
def plant(world: WorldWords, walk: WalkWords, degree: int) -> None:
    for d in range(walk.darts):
        world.alpha[d] = -1
    world.first[0] = 0
    world.degree[0] = degree
    for d in range(degree):
        world.vertex[d] = 0
    walk.root = degree


@inlined
def new_vertex(world: WorldWords, e: int, first: int, degree: int, vertex: int) -> None:
    world.first[vertex] = first
    world.degree[vertex] = degree
    for d in range(first, first + degree):
        world.vertex[d] = vertex
    world.alpha[e] = first
    world.alpha[first] = e
