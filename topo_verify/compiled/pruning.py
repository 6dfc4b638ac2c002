"""Stops a branch of the enumeration as soon as no completion has the properties of the class.

The compiled twin of the pruners of `world/enumeration/pruned.py`, under their names; their theory
stands there. What differs: a pruner here is changed in place by `…_join` and `…_hang`, which say
whether a completion may be left and change nothing if not, and is turned back by `…_undo_…`.

    genus        A boundary word is a cyclic list, linked both ways (`G_NEXT`, `G_BEFORE`). A join
                 links the neighbours of the two darts crosswise: that cuts one word in two, and
                 makes one of two words. What it does to the words is known before it is made, from
                 the parity of the partner's place (`look_around` walks along e's word once a step).
    neighbours   Counts and masks of each vertex. If the class is simple, a join makes nothing worse
                 for a vertex unless one of the two ends has no open dart left: only then all
                 vertices are looked at.

W is the workspace, G the state of the walk; see `growth.py`. `left` is the number of darts
still to create after the step, `opened` the number of open darts after it.
"""

from __future__ import annotations

from topo_verify.compiled.growth import *
from topo_verify.compiled.kernel import Words, inlined
from topo_verify.compiled.workspace import VT

# ---------------------------------------------------------------- one root, one step


@inlined
def begin_pruned(G: Words, degree: int, left: int) -> bool:
    """Whether the class may have a world with a root of this degree; the pruners, begun there."""
    if degree > G[G_MOST_DEGREE]:
        return False
    G[G_OPEN_AT] = degree
    G[G_NEAR] = 0
    if G[G_LOOPLESS] != 0 and degree > left:
        return False
    if G[G_HAS_GENUS] == 0:
        return True
    for d in range(degree):
        G[G_NEXT + d] = d + 1
        G[G_BEFORE + d] = d - 1
    G[G_NEXT + degree - 1] = 0
    G[G_BEFORE] = degree - 1
    G[G_HANDLES] = G[G_MOST_GENUS]
    G[G_ODD_WORDS] = degree & 1
    G[G_WORDS] = 1
    return genus_feasible(G, G[G_HANDLES], degree & 1, 1, degree, left)


@inlined
def join_pruned(
    W: Words, G: Words, k: int, e: int, c: int, opened: int, left: int, vertices: int
) -> bool:
    """Whether e may be joined with c; if so, the pruners know of it."""
    if G[G_HAS_GENUS] != 0 and not genus_join(G, k, e, c, opened, left):
        return False
    if G[G_LOOPLESS] != 0 and not neighbours_join(W, G, e, c, opened, left, vertices):
        if G[G_HAS_GENUS] != 0:
            genus_undo_join(G, k, e, c)
        return False
    return True


@inlined
def undo_join_pruned(W: Words, G: Words, k: int, e: int, c: int) -> None:
    """The pruners, as before e was joined with c."""
    if G[G_HAS_GENUS] != 0:
        genus_undo_join(G, k, e, c)
    if G[G_LOOPLESS] != 0:
        neighbours_undo_join(W, G, e, c)


@inlined
def hang_pruned(
    W: Words, G: Words, k: int, e: int, first: int, degree: int, opened: int, left: int, fresh: int
) -> bool:
    """Whether a new vertex, number `fresh`, may hang on e; if so, the pruners know of it."""
    if degree > G[G_MOST_DEGREE]:
        return False
    if G[G_HAS_GENUS] != 0 and not genus_hang(G, k, e, first, degree, opened, left):
        return False
    if G[G_LOOPLESS] != 0 and not neighbours_hang(W, G, e, degree, opened, left, fresh):
        if G[G_HAS_GENUS] != 0:
            genus_undo_hang(G, k, e)
        return False
    return True


@inlined
def undo_hang_pruned(W: Words, G: Words, k: int, e: int, fresh: int) -> None:
    """The pruners, as before the vertex hung on e."""
    if G[G_HAS_GENUS] != 0:
        genus_undo_hang(G, k, e)
    if G[G_LOOPLESS] != 0:
        neighbours_undo_hang(W, G, e, fresh)


# ---------------------------------------------------------------- GenusPruner


@inlined
def look_around(G: Words, k: int, e: int) -> None:
    """Note e's word at step k: which darts it has, and which of them stand at odd places."""
    darts = 0
    odd_places = 0
    is_odd = 1
    d = G[G_NEXT + e]
    while d != e:
        darts |= 1 << d
        if is_odd != 0:
            odd_places |= 1 << d
        is_odd ^= 1
        d = G[G_NEXT + d]
    G[G_WORD + k] = darts
    G[G_WORD_PLACES + k] = odd_places
    G[G_WORD_ODD + k] = is_odd


@inlined
def word_is_odd(G: Words, c: int) -> int:
    """1 if the word of c has an odd length."""
    odd = 1
    d = G[G_NEXT + c]
    while d != c:
        odd ^= 1
        d = G[G_NEXT + d]
    return odd


@inlined
def genus_feasible(
    G: Words, handles: int, odd_words: int, words: int, opened: int, left: int
) -> bool:
    """`GenusPruner.feasible`: can the words be closed with these darts and handles?"""
    if handles < 0 or odd_words > left + 2 * handles:
        return False
    if G[G_EXACT] == 0:
        return True
    joins = (opened + left) // 2
    if left > 0:
        joins -= 1
    most = words + joins - 1
    most = max(most, 0)
    return 2 * handles <= most


@inlined
def genus_join(G: Words, k: int, e: int, c: int, opened: int, left: int) -> bool:
    """`GenusPruner.join`: cuts the word of the two, or makes one word of theirs by a handle."""
    handles = G[G_HANDLES]
    odd_words = G[G_ODD_WORDS]
    words = G[G_WORDS]
    is_odd = G[G_WORD_ODD + k]
    if (G[G_WORD + k] >> c) & 1 != 0:
        # c is the i-th behind e in a word of L darts: parts of i - 1 and L - i - 1 are left.
        place_is_odd = (G[G_WORD_PLACES + k] >> c) & 1
        odd_words += (1 - place_is_odd) + ((is_odd + place_is_odd + 1) & 1) - is_odd
        words += 1
        # A part without darts is no word: it is a finished face.
        if G[G_NEXT + e] == c:
            words -= 1
        if G[G_BEFORE + e] == c:
            words -= 1
    else:
        if handles == 0:
            return False
        handles -= 1
        other = word_is_odd(G, c)
        odd_words += ((is_odd + other) & 1) - is_odd - other
        words -= 1
        if G[G_NEXT + e] == e and G[G_NEXT + c] == c:
            words -= 1
    if not genus_feasible(G, handles, odd_words, words, opened, left):
        return False
    G[G_WAS_HANDLES + k] = G[G_HANDLES]
    G[G_WAS_ODD_WORDS + k] = G[G_ODD_WORDS]
    G[G_WAS_WORDS + k] = G[G_WORDS]
    G[G_HANDLES] = handles
    G[G_ODD_WORDS] = odd_words
    G[G_WORDS] = words
    G[G_DART_NEXT + k] = G[G_NEXT + e]
    G[G_DART_BEFORE + k] = G[G_BEFORE + e]
    G[G_PARTNER_NEXT + k] = G[G_NEXT + c]
    G[G_PARTNER_BEFORE + k] = G[G_BEFORE + c]
    link_boundary(G, G[G_BEFORE + e], G[G_NEXT + c])
    # Read again: where one of the words was e or c alone, the first link has changed it.
    link_boundary(G, G[G_BEFORE + c], G[G_NEXT + e])
    return True


@inlined
def link_boundary(G: Words, d: int, after: int) -> None:
    """Let `after` stand behind d along a boundary."""
    G[G_NEXT + d] = after
    G[G_BEFORE + after] = d


@inlined
def genus_undo_join(G: Words, k: int, e: int, c: int) -> None:
    """The words as they were before the join."""
    G[G_HANDLES] = G[G_WAS_HANDLES + k]
    G[G_ODD_WORDS] = G[G_WAS_ODD_WORDS + k]
    G[G_WORDS] = G[G_WAS_WORDS + k]
    link_boundary(G, G[G_DART_BEFORE + k], e)
    link_boundary(G, e, G[G_DART_NEXT + k])
    link_boundary(G, G[G_PARTNER_BEFORE + k], c)
    link_boundary(G, c, G[G_PARTNER_NEXT + k])


@inlined
def genus_hang(G: Words, k: int, e: int, first: int, degree: int, opened: int, left: int) -> bool:
    """`GenusPruner.hang`: puts the new vertex's other darts in the place of e."""
    is_odd = G[G_WORD_ODD + k]
    odd_words = G[G_ODD_WORDS] - is_odd + ((is_odd + degree) & 1)
    after = G[G_NEXT + e]
    before = G[G_BEFORE + e]
    words = G[G_WORDS]
    if degree == 1 and after == e:
        words -= 1
    if not genus_feasible(G, G[G_HANDLES], odd_words, words, opened, left):
        return False
    G[G_WAS_ODD_WORDS + k] = G[G_ODD_WORDS]
    G[G_WAS_WORDS + k] = G[G_WORDS]
    G[G_ODD_WORDS] = odd_words
    G[G_WORDS] = words
    G[G_DART_NEXT + k] = after
    G[G_DART_BEFORE + k] = before
    if degree == 1:
        link_boundary(G, before, after)
        return True
    last = first + degree - 1
    for d in range(first + 1, last):
        link_boundary(G, d, d + 1)
    if after == e:
        link_boundary(G, last, first + 1)
    else:
        link_boundary(G, before, first + 1)
        link_boundary(G, last, after)
    return True


@inlined
def genus_undo_hang(G: Words, k: int, e: int) -> None:
    """The words as they were before the vertex hung on e."""
    G[G_ODD_WORDS] = G[G_WAS_ODD_WORDS + k]
    G[G_WORDS] = G[G_WAS_WORDS + k]
    link_boundary(G, G[G_DART_BEFORE + k], e)
    link_boundary(G, e, G[G_DART_NEXT + k])


# ---------------------------------------------------------------- NeighbourPruner


@inlined
def neighbours_join(
    W: Words, G: Words, e: int, c: int, opened: int, left: int, vertices: int
) -> bool:
    """`NeighbourPruner.join`: no loop and, if simple, no second edge between two vertices."""
    a = W[VT + e]
    b = W[VT + c]
    # Without `simple` the masks stay 0, so only the loop is refused.
    if a == b or (G[G_NEAR + a] >> b) & 1 != 0:
        return False
    G[G_OPEN_AT + a] -= 1
    G[G_OPEN_AT + b] -= 1
    if G[G_SIMPLE] != 0:
        G[G_NEAR + a] |= 1 << b
        G[G_NEAR + b] |= 1 << a
        # An end with open darts left costs the other end one place and one open dart.
        if G[G_OPEN_AT + a] > 0 and G[G_OPEN_AT + b] > 0:
            return True
    if neighbours_feasible(G, opened, left, vertices):
        return True
    neighbours_undo_join(W, G, e, c)
    return False


@inlined
def neighbours_undo_join(W: Words, G: Words, e: int, c: int) -> None:
    """The counts and masks as they were before the join."""
    a = W[VT + e]
    b = W[VT + c]
    G[G_OPEN_AT + a] += 1
    G[G_OPEN_AT + b] += 1
    G[G_NEAR + a] &= ~(1 << b)
    G[G_NEAR + b] &= ~(1 << a)


@inlined
def neighbours_hang(
    W: Words, G: Words, e: int, degree: int, opened: int, left: int, fresh: int
) -> bool:
    """`NeighbourPruner.hang`: a new vertex has no neighbour but the one that it hangs on."""
    a = W[VT + e]
    G[G_OPEN_AT + a] -= 1
    G[G_OPEN_AT + fresh] = degree - 1
    G[G_NEAR + fresh] = 0
    if G[G_SIMPLE] != 0:
        G[G_NEAR + a] |= 1 << fresh
        G[G_NEAR + fresh] = 1 << a
    if neighbours_feasible(G, opened, left, fresh + 1):
        return True
    neighbours_undo_hang(W, G, e, fresh)
    return False


@inlined
def neighbours_undo_hang(W: Words, G: Words, e: int, fresh: int) -> None:
    """The counts and masks as they were before the vertex hung on e."""
    a = W[VT + e]
    G[G_OPEN_AT + a] += 1
    G[G_NEAR + a] &= ~(1 << fresh)


@inlined
def neighbours_feasible(G: Words, opened: int, left: int, vertices: int) -> bool:
    """`NeighbourPruner.feasible`: can each open dart still end at another vertex?"""
    if G[G_SIMPLE] == 0:
        most = 0
        for v in range(vertices):
            most = max(most, G[G_OPEN_AT + v])
        return 2 * most <= opened + left
    waiting = 0
    for v in range(vertices):
        if G[G_OPEN_AT + v] > 0:
            waiting |= 1 << v
    for v in range(vertices):
        spare = G[G_OPEN_AT + v] - left
        if spare > 0 and spare > bit_count(waiting & ~G[G_NEAR + v] & ~(1 << v)):
            return False
    return True


@inlined
def bit_count(mask: int) -> int:
    """How many of the lower 32 bits are set."""
    mask = mask - ((mask >> 1) & 0x55555555)
    mask = (mask & 0x33333333) + ((mask >> 2) & 0x33333333)
    mask = (mask + (mask >> 4)) & 0x0F0F0F0F
    return ((mask * 0x01010101) >> 24) & 63
