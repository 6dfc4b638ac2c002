"""Stops a branch of the enumeration as soon as no completion is in the class.

Twin of the pruners of `world/enumeration/pruned.py`, where the theory stands. Differs: `…_join` and
`…_hang` change a pruner in place, or nothing if no completion is left; `…_undo_…` turns it back. A
boundary word is a linked cyclic list; a join cuts one word in two, or joins two, as the parity of
the partner's place tells.

`left`: darts still to create after the step; `opened`: open darts after it.
"""

from __future__ import annotations

from topo_verify.extra.fast.kernels.kernel import inlined
from topo_verify.extra.fast.kernels.workspace import *


@inlined
def begin_pruned(walk: WalkWords, degree: int, left: int) -> bool:
    """Begin; False: the class has no world with this root."""
    if not walk.least_degree <= degree <= walk.most_degree or 0 < left < walk.least_degree:
        return False
    walk.open_at[0] = degree
    walk.near[0] = 0
    if walk.loopless != 0 and degree > left:
        return False
    if walk.has_genus == 0:
        return True
    for d in range(degree):
        walk.next[d] = d + 1
        walk.before[d] = d - 1
    walk.next[degree - 1] = 0
    walk.before[0] = degree - 1
    walk.handles = walk.most_genus
    walk.odd_words = degree & 1
    walk.words = 1
    return genus_feasible(walk, walk.handles, degree & 1, 1, degree, left)


@inlined
def join_pruned(
    world: WorldWords,
    walk: WalkWords,
    k: int,
    e: int,
    c: int,
    opened: int,
    left: int,
    vertices: int,
) -> bool:
    """Join e with c, if a completion is left."""
    if walk.has_genus != 0 and not genus_join(walk, k, e, c, opened, left):
        return False
    if walk.loopless != 0 and not neighbours_join(world, walk, e, c, opened, left, vertices):
        if walk.has_genus != 0:
            genus_undo_join(walk, k, e, c)
        return False
    return True


@inlined
def undo_join_pruned(world: WorldWords, walk: WalkWords, k: int, e: int, c: int) -> None:
    if walk.has_genus != 0:
        genus_undo_join(walk, k, e, c)
    if walk.loopless != 0:
        neighbours_undo_join(world, walk, e, c)


@inlined
def hang_pruned(
    world: WorldWords,
    walk: WalkWords,
    k: int,
    e: int,
    first: int,
    degree: int,
    opened: int,
    left: int,
    fresh: int,
) -> bool:
    """Hang vertex `fresh` on e, if a completion is left."""
    if not walk.least_degree <= degree <= walk.most_degree or 0 < left < walk.least_degree:
        return False
    if walk.has_genus != 0 and not genus_hang(walk, k, e, first, degree, opened, left):
        return False
    if walk.loopless != 0 and not neighbours_hang(world, walk, e, degree, opened, left, fresh):
        if walk.has_genus != 0:
            genus_undo_hang(walk, k, e)
        return False
    return True


@inlined
def undo_hang_pruned(world: WorldWords, walk: WalkWords, k: int, e: int, fresh: int) -> None:
    if walk.has_genus != 0:
        genus_undo_hang(walk, k, e)
    if walk.loopless != 0:
        neighbours_undo_hang(world, walk, e, fresh)


@inlined
def look_around(walk: WalkWords, k: int, e: int) -> None:
    """Note the darts of e's word, and those at odd places."""
    darts = 0
    odd_places = 0
    is_odd = 1
    d = walk.next[e]
    while d != e:
        darts |= 1 << d
        if is_odd != 0:
            odd_places |= 1 << d
        is_odd ^= 1
        d = walk.next[d]
    walk.word[k] = darts
    walk.word_places[k] = odd_places
    walk.word_odd[k] = is_odd


@inlined
def word_is_odd(walk: WalkWords, c: int) -> int:
    odd = 1
    d = walk.next[c]
    while d != c:
        odd ^= 1
        d = walk.next[d]
    return odd


@inlined
def genus_feasible(
    walk: WalkWords, handles: int, odd_words: int, words: int, opened: int, left: int
) -> bool:
    if handles < 0 or odd_words > left + 2 * handles:
        return False
    if walk.exact == 0:
        return True
    joins = (opened + left) // 2
    if left > 0:
        joins -= 1
    most = words + joins - 1
    most = max(most, 0)
    return 2 * handles <= most


@inlined
def genus_join(walk: WalkWords, k: int, e: int, c: int, opened: int, left: int) -> bool:
    """Cut a word, or join two by a handle."""
    handles = walk.handles
    odd_words = walk.odd_words
    words = walk.words
    is_odd = walk.word_odd[k]
    if (walk.word[k] >> c) & 1 != 0:
        # c is i places behind e in a word of L darts: parts of i - 1 and L - i - 1.
        place_is_odd = (walk.word_places[k] >> c) & 1
        odd_words += (1 - place_is_odd) + ((is_odd + place_is_odd + 1) & 1) - is_odd
        words += 1
        # A part without darts is a finished face.
        if walk.next[e] == c:
            words -= 1
        if walk.before[e] == c:
            words -= 1
    else:
        if handles == 0:
            return False
        handles -= 1
        other = word_is_odd(walk, c)
        odd_words += ((is_odd + other) & 1) - is_odd - other
        words -= 1
        if walk.next[e] == e and walk.next[c] == c:
            words -= 1
    if not genus_feasible(walk, handles, odd_words, words, opened, left):
        return False
    walk.was_handles[k] = walk.handles
    walk.was_odd_words[k] = walk.odd_words
    walk.was_words[k] = walk.words
    walk.handles = handles
    walk.odd_words = odd_words
    walk.words = words
    walk.dart_next[k] = walk.next[e]
    walk.dart_before[k] = walk.before[e]
    walk.partner_next[k] = walk.next[c]
    walk.partner_before[k] = walk.before[c]
    link_boundary(walk, walk.before[e], walk.next[c])
    # The first link may have changed it.
    link_boundary(walk, walk.before[c], walk.next[e])
    return True


@inlined
def link_boundary(walk: WalkWords, d: int, after: int) -> None:
    walk.next[d] = after
    walk.before[after] = d


@inlined
def genus_undo_join(walk: WalkWords, k: int, e: int, c: int) -> None:
    walk.handles = walk.was_handles[k]
    walk.odd_words = walk.was_odd_words[k]
    walk.words = walk.was_words[k]
    link_boundary(walk, walk.dart_before[k], e)
    link_boundary(walk, e, walk.dart_next[k])
    link_boundary(walk, walk.partner_before[k], c)
    link_boundary(walk, c, walk.partner_next[k])


@inlined
def genus_hang(
    walk: WalkWords, k: int, e: int, first: int, degree: int, opened: int, left: int
) -> bool:
    is_odd = walk.word_odd[k]
    odd_words = walk.odd_words - is_odd + ((is_odd + degree) & 1)
    after = walk.next[e]
    before = walk.before[e]
    words = walk.words
    if degree == 1 and after == e:
        words -= 1
    if not genus_feasible(walk, walk.handles, odd_words, words, opened, left):
        return False
    walk.was_odd_words[k] = walk.odd_words
    walk.was_words[k] = walk.words
    walk.odd_words = odd_words
    walk.words = words
    walk.dart_next[k] = after
    walk.dart_before[k] = before
    if degree == 1:
        link_boundary(walk, before, after)
        return True
    last = first + degree - 1
    for d in range(first + 1, last):
        link_boundary(walk, d, d + 1)
    if after == e:
        link_boundary(walk, last, first + 1)
    else:
        link_boundary(walk, before, first + 1)
        link_boundary(walk, last, after)
    return True


@inlined
def genus_undo_hang(walk: WalkWords, k: int, e: int) -> None:
    walk.odd_words = walk.was_odd_words[k]
    walk.words = walk.was_words[k]
    link_boundary(walk, walk.dart_before[k], e)
    link_boundary(walk, e, walk.dart_next[k])


@inlined
def neighbours_join(
    world: WorldWords, walk: WalkWords, e: int, c: int, opened: int, left: int, vertices: int
) -> bool:
    """No loop and, if simple, no double edge."""
    a = world.vertex[e]
    b = world.vertex[c]
    # Without `simple` the masks stay 0.
    if a == b or (walk.near[a] >> b) & 1 != 0:
        return False
    walk.open_at[a] -= 1
    walk.open_at[b] -= 1
    if walk.simple != 0:
        walk.near[a] |= 1 << b
        walk.near[b] |= 1 << a
        if walk.open_at[a] > 0 and walk.open_at[b] > 0:
            return True
    if neighbours_feasible(walk, opened, left, vertices):
        return True
    neighbours_undo_join(world, walk, e, c)
    return False


@inlined
def neighbours_undo_join(world: WorldWords, walk: WalkWords, e: int, c: int) -> None:
    a = world.vertex[e]
    b = world.vertex[c]
    walk.open_at[a] += 1
    walk.open_at[b] += 1
    walk.near[a] &= ~(1 << b)
    walk.near[b] &= ~(1 << a)


@inlined
def neighbours_hang(
    world: WorldWords, walk: WalkWords, e: int, degree: int, opened: int, left: int, fresh: int
) -> bool:
    a = world.vertex[e]
    walk.open_at[a] -= 1
    walk.open_at[fresh] = degree - 1
    walk.near[fresh] = 0
    if walk.simple != 0:
        walk.near[a] |= 1 << fresh
        walk.near[fresh] = 1 << a
    if neighbours_feasible(walk, opened, left, fresh + 1):
        return True
    neighbours_undo_hang(world, walk, e, fresh)
    return False


@inlined
def neighbours_undo_hang(world: WorldWords, walk: WalkWords, e: int, fresh: int) -> None:
    a = world.vertex[e]
    walk.open_at[a] += 1
    walk.near[a] &= ~(1 << fresh)


@inlined
def neighbours_feasible(walk: WalkWords, opened: int, left: int, vertices: int) -> bool:
    if walk.simple == 0:
        most = 0
        for v in range(vertices):
            most = max(most, walk.open_at[v])
        return 2 * most <= opened + left
    waiting = 0
    for v in range(vertices):
        if walk.open_at[v] > 0:
            waiting |= 1 << v
    for v in range(vertices):
        spare = walk.open_at[v] - left
        if spare > 0 and spare > bit_count(waiting & ~walk.near[v] & ~(1 << v)):
            return False
    return True


@inlined
def bit_count(mask: int) -> int:
    mask = mask - ((mask >> 1) & 0x55555555)
    mask = (mask & 0x33333333) + ((mask >> 2) & 0x33333333)
    mask = (mask + (mask >> 4)) & 0x0F0F0F0F
    return ((mask * 0x01010101) >> 24) & 63
