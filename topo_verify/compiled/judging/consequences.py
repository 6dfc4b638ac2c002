"""All that follows if two places of the fold are the ends of one edge, contradictions or not.

Mirrors: `Fold.contradictions` of checkers/folding.py. Differs: it is asked only where folding on
past the first contradiction, which is quicker, did not meet the one that is cited.

A place is a number, its slot: where the fold has the other end of the dart, at a root.
"""

from __future__ import annotations

from topo_verify.compiled.events import OWN_OTHER_END, TURNED_ITSELF, TWO_OF_S, UNLIKE
from topo_verify.compiled.judging.fold import find_dart, find_node
from topo_verify.compiled.judging.layout import *
from topo_verify.compiled.kernel import inlined, kernel


@kernel
def all_that_follow(case: CaseWords, e: int, h: int) -> int:
    """A mask of the contradictions that follow if these darts of S are the ends of one edge."""
    consequences, drawn, fold = case.consequences, case.drawn, case.fold
    start_consequences(case)
    one = slot_at(fold, drawn.node[e], drawn.dart[e])
    other = slot_at(fold, drawn.node[h], drawn.dart[h])
    put_beyond(case, one, other)
    put_beyond(case, other, one)
    while consequences.waiting > 0 and case.full == 0:
        waiting = consequences.waiting - 2
        consequences.waiting = waiting
        one = find_same(consequences, fold.work[waiting])
        other = find_same(consequences, fold.work[waiting + 1])
        if one == other:
            continue
        if fold.owner[one] == fold.owner[other]:
            consequences.met |= 1 << TURNED_ITSELF
        for door in range(fold.degree[fold.owner[one]]):
            u = find_same(consequences, turn_slot(fold, one, door))
            v = find_same(consequences, turn_slot(fold, other, door))
            if u != v:
                consequences.same[u] = v
                k = consequences.first[u]
                while k >= 0:
                    put_beyond(case, v, consequences.end[k])
                    k = consequences.next[k]
    for v in range(drawn.vertices):
        for w in range(v):
            if entry_of(case, v) == entry_of(case, w):
                consequences.met |= 1 << TWO_OF_S
    return consequences.met


@inlined
def start_consequences(case: CaseWords) -> None:
    """No two places are one yet; behind each is what the fold has there."""
    consequences, fold = case.consequences, case.fold
    consequences.met = 0
    consequences.waiting = 0
    consequences.entries = 0
    for slot in range(fold.doors):
        consequences.same[slot] = slot
        consequences.first[slot] = -1
        if fold.end_node[slot] >= 0:
            add_beyond(consequences, slot, slot_at(fold, fold.end_node[slot], fold.end_dart[slot]))


@inlined
def slot_at(fold: FoldWords, node: int, dart: int) -> int:
    """The slot of a dart."""
    return fold.base[find_node(fold, node)] + find_dart(fold, node, dart)


@inlined
def turn_slot(fold: FoldWords, slot: int, door: int) -> int:
    """The slot that is so many doors clockwise."""
    base = fold.base[fold.owner[slot]]
    degree = fold.degree[fold.owner[slot]]
    return slot + door if slot + door < base + degree else slot + door - degree


@inlined
def find_same(consequences: ConsequenceWords, slot: int) -> int:
    """The slot that stands for all that are the same dart."""
    while consequences.same[slot] != slot:
        slot = consequences.same[slot]
    return slot


@inlined
def entry_of(case: CaseWords, v: int) -> int:
    """The node that a vertex of S is."""
    drawn = case.drawn
    e = drawn.entry[v]
    return case.fold.owner[
        find_same(case.consequences, slot_at(case.fold, drawn.node[e], drawn.dart[e]))
    ]


@inlined
def add_beyond(consequences: ConsequenceWords, slot: int, end: int) -> None:
    """Note one more end behind a slot."""
    k = consequences.entries
    if k >= JUDGE_DOORS:
        consequences.full = 1
    else:
        consequences.end[k] = end
        consequences.next[k] = consequences.first[slot]
        consequences.first[slot] = k
        consequences.entries = k + 1


@kernel
def put_beyond(case: CaseWords, slot: int, end: int) -> None:
    """Let there be an end behind a dart: one with the end there that looks like it, or one more."""
    consequences, fold = case.consequences, case.fold
    slot = find_same(consequences, slot)
    end = find_same(consequences, end)
    if slot == end:
        consequences.met |= 1 << OWN_OTHER_END
    node = fold.owner[end]
    k = consequences.first[slot]
    while k >= 0:
        other = fold.owner[consequences.end[k]]
        if fold.degree[other] == fold.degree[node] and fold.marked[other] == fold.marked[node]:
            waiting = consequences.waiting
            if waiting + 2 > JUDGE_DOORS:
                case.full = 1
            else:
                fold.work[waiting] = end
                fold.work[waiting + 1] = consequences.end[k]
                consequences.waiting = waiting + 2
            return
        consequences.met |= 1 << UNLIKE
        k = consequences.next[k]
    add_beyond(consequences, slot, end)
