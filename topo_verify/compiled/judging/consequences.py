"""All that follows if two places of the fold are the ends of one edge, contradictions or not.

Mirrors: `Fold.contradictions` of checkers/folding.py. Differs: it is asked only where folding on
past the first contradiction, which is quicker, did not meet the one that is cited.

A place is a number, its slot: where the fold has the other end of the dart, at a root.
"""

from __future__ import annotations

from topo_verify.compiled.events import OWN_OTHER_END, TURNED_ITSELF, TWO_OF_S, UNLIKE
from topo_verify.compiled.judging.fold import find_dart, find_node
from topo_verify.compiled.judging.layout import *
from topo_verify.compiled.kernel import Words, inlined, kernel


@kernel
def all_that_follow(J: Words, e: int, h: int) -> int:
    """A mask of the contradictions that follow if these darts of S are the ends of one edge."""
    start_consequences(J)
    one = slot_at(J, J[S_NODE + e], J[S_DART + e])
    other = slot_at(J, J[S_NODE + h], J[S_DART + h])
    put_beyond(J, one, other)
    put_beyond(J, other, one)
    while J[C_WAITING] > 0 and J[J_FULL] == 0:
        waiting = J[C_WAITING] - 2
        J[C_WAITING] = waiting
        one = find_same(J, J[F_WORK + waiting])
        other = find_same(J, J[F_WORK + waiting + 1])
        if one == other:
            continue
        if J[F_OWNER + one] == J[F_OWNER + other]:
            J[C_MET] |= 1 << TURNED_ITSELF
        for door in range(J[F_DEGREE + J[F_OWNER + one]]):
            u = find_same(J, turn_slot(J, one, door))
            v = find_same(J, turn_slot(J, other, door))
            if u != v:
                J[C_SAME + u] = v
                k = J[C_FIRST + u]
                while k >= 0:
                    put_beyond(J, v, J[C_END + k])
                    k = J[C_NEXT + k]
    for v in range(J[S_VERTICES]):
        for w in range(v):
            if entry_of(J, v) == entry_of(J, w):
                J[C_MET] |= 1 << TWO_OF_S
    return J[C_MET]


@inlined
def start_consequences(J: Words) -> None:
    """No two places are one yet; behind each is what the fold has there."""
    J[C_MET] = 0
    J[C_WAITING] = 0
    J[C_ENTRIES] = 0
    for slot in range(J[F_DOORS]):
        J[C_SAME + slot] = slot
        J[C_FIRST + slot] = -1
        if J[F_END_NODE + slot] >= 0:
            add_beyond(J, slot, slot_at(J, J[F_END_NODE + slot], J[F_END_DART + slot]))


@inlined
def slot_at(J: Words, node: int, dart: int) -> int:
    """The slot of a dart."""
    return J[F_BASE + find_node(J, node)] + find_dart(J, node, dart)


@inlined
def turn_slot(J: Words, slot: int, door: int) -> int:
    """The slot that is so many doors clockwise."""
    base = J[F_BASE + J[F_OWNER + slot]]
    degree = J[F_DEGREE + J[F_OWNER + slot]]
    return slot + door if slot + door < base + degree else slot + door - degree


@inlined
def find_same(J: Words, slot: int) -> int:
    """The slot that stands for all that are the same dart."""
    while J[C_SAME + slot] != slot:
        slot = J[C_SAME + slot]
    return slot


@inlined
def entry_of(J: Words, v: int) -> int:
    """The node that a vertex of S is."""
    e = J[S_ENTRY + v]
    return J[F_OWNER + find_same(J, slot_at(J, J[S_NODE + e], J[S_DART + e]))]


@inlined
def add_beyond(J: Words, slot: int, end: int) -> None:
    """Note one more end behind a slot."""
    k = J[C_ENTRIES]
    if k >= JUDGE_DOORS:
        J[J_FULL] = 1
    else:
        J[C_END + k] = end
        J[C_NEXT + k] = J[C_FIRST + slot]
        J[C_FIRST + slot] = k
        J[C_ENTRIES] = k + 1


@kernel
def put_beyond(J: Words, slot: int, end: int) -> None:
    """Let there be an end behind a dart: one with the end there that looks like it, or one more."""
    slot = find_same(J, slot)
    end = find_same(J, end)
    if slot == end:
        J[C_MET] |= 1 << OWN_OTHER_END
    node = J[F_OWNER + end]
    k = J[C_FIRST + slot]
    while k >= 0:
        other = J[F_OWNER + J[C_END + k]]
        if J[F_DEGREE + other] == J[F_DEGREE + node] and J[F_MARKED + other] == J[F_MARKED + node]:
            waiting = J[C_WAITING]
            if waiting + 2 > JUDGE_DOORS:
                J[J_FULL] = 1
            else:
                J[F_WORK + waiting] = end
                J[F_WORK + waiting + 1] = J[C_END + k]
                J[C_WAITING] = waiting + 2
            return
        J[C_MET] |= 1 << UNLIKE
        k = J[C_NEXT + k]
    add_beyond(J, slot, end)
