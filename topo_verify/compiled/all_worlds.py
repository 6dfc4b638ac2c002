"""Lists all worlds of a rank range: class `any` of enumeration.py, and the steps of the growth.

The compiled twin of `tables` in `world/enumeration/rank_order.py`. The letters stand in
enumeration.py; `n` darts and `nv` vertices exist so far, `m2` is the number of darts at the end.

Source: docs/semantics.md, section 12.
"""

from __future__ import annotations

from topo_verify.compiled.growth import (
    G_COMPLETIONS,
    G_CREATED,
    G_DART,
    G_DARTS,
    G_DEPTH,
    G_IS_NEW,
    G_OPENED,
    G_PARTNER,
    G_RANK,
    G_ROOT,
    G_ROW,
    G_SKIP,
    G_STOP,
    G_VERTICES,
)
from topo_verify.compiled.kernel import Words, inlined
from topo_verify.compiled.workspace import AL, DG, ST, VT


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
