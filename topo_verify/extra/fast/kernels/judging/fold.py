"""The fold of a history, with rollback.

Twin of checkers/folding.py. Differs: a contradiction is a value: with `met` = -1 the first one ends
the folding, otherwise all are collected there as a mask. A place is a node and a dart of it;
`end_node` and `end_dart` have the other end of each, node -1: open.
"""

from __future__ import annotations

from topo_verify.extra.fast.kernels.events import OWN_OTHER_END, TURNED_ITSELF, TWO_OF_S, UNLIKE
from topo_verify.extra.fast.kernels.judging.layout import *
from topo_verify.extra.fast.kernels.kernel import inlined, kernel
from topo_verify.extra.fast.kernels.workspace import MASK, SHIFT

LEAST_TIDIED = 1 << 12
"""Nodes are dropped where this number of doors, and twice those kept, are taken."""


@inlined
def start_judge_fold(fold: FoldWords, percept: int) -> None:
    fold.nodes = 0
    fold.doors = 0
    fold.tidied = 0
    fold.undos = 0
    fold.met = -1
    fold.at = visit(fold, percept)
    fold.dart = 0


@inlined
def visit(fold: FoldWords, percept: int) -> int:
    """A new node; 0, and an open verdict, if it is full."""
    node = fold.nodes
    base = fold.doors
    degree = percept >> SHIFT
    # Identification notes up to two entries a door.
    if node >= JUDGE_NODES or 4 * (base + degree) > JUDGE_DOORS:
        fold.full = 1
        return 0
    fold.parent[node] = node
    fold.offset[node] = 0
    fold.weight[node] = 1
    fold.degree[node] = degree
    fold.marked[node] = 1 if (percept & MASK) > 0 else 0
    fold.base[node] = base
    for at in range(base, base + degree):
        fold.end_node[at] = -1
    fold.nodes = node + 1
    fold.doors = base + degree
    return node


@inlined
def find_node(fold: FoldWords, node: int) -> int:
    while fold.parent[node] != node:
        node = fold.parent[node]
    return node


@inlined
def find_dart(fold: FoldWords, node: int, dart: int) -> int:
    while fold.parent[node] != node:
        dart += fold.offset[node]
        if dart >= fold.degree[node]:
            dart -= fold.degree[node]
        node = fold.parent[node]
    return dart


@inlined
def fold_move(fold: FoldWords, door: int, percept: int) -> bool:
    """Fold a move; False: no world shows that."""
    here = find_node(fold, fold.at)
    dart = find_dart(fold, fold.at, fold.dart) + door
    if dart >= fold.degree[here]:
        dart -= fold.degree[here]
    slot = fold.base[here] + dart
    node = fold.end_node[slot]
    if node >= 0:
        entry = find_dart(fold, node, fold.end_dart[slot])
        node = find_node(fold, node)
        if fold.degree[node] != percept >> SHIFT:
            return False
        if (fold.marked[node] != 0) != ((percept & MASK) > 0):
            return False
    else:
        node = visit(fold, percept)
        entry = 0
        if fold.full != 0:
            return False
        fold.end_node[slot] = node
        fold.end_dart[slot] = 0
        fold.end_node[fold.base[node]] = here
        fold.end_dart[fold.base[node]] = dart
    fold.at = node
    fold.dart = entry
    marker = percept & MASK
    if marker > 0:
        entry += marker - 1
        if entry >= fold.degree[node]:
            entry -= fold.degree[node]
        if find_node(fold, 0) != node or find_dart(fold, 0, 0) != entry:
            wrong = make_one(fold, node, entry, 0, 0)
            fold.undos = 0
            return wrong == 0
    return True


@inlined
def met(fold: FoldWords, contradiction: int) -> bool:
    """Note a contradiction; True if it ends the folding."""
    if fold.met < 0:
        return True
    fold.met |= 1 << contradiction
    return False


@inlined
def put_end(fold: FoldWords, node: int, dart: int, end: int, end_dart: int) -> None:
    slot = fold.base[node] + dart
    fold.end_node[slot] = end
    fold.end_dart[slot] = end_dart
    fold.undo[fold.undos] = 2 * slot + 1
    fold.undos += 1


@kernel
def make_one(fold: FoldWords, a: int, i: int, b: int, j: int) -> int:
    """Identify two places, and what follows: the ending contradiction, or 0."""
    fold.work[0] = a
    fold.work[1] = i
    fold.work[2] = b
    fold.work[3] = j
    waiting = 4
    while waiting > 0:
        waiting -= 4
        i = find_dart(fold, fold.work[waiting], fold.work[waiting + 1])
        a = find_node(fold, fold.work[waiting])
        j = find_dart(fold, fold.work[waiting + 2], fold.work[waiting + 3])
        b = find_node(fold, fold.work[waiting + 2])
        if a == b:
            if i != j and met(fold, TURNED_ITSELF):
                return TURNED_ITSELF
            continue
        if fold.degree[a] != fold.degree[b] or fold.marked[a] != fold.marked[b]:
            if met(fold, UNLIKE):
                return UNLIKE
            continue
        if fold.weight[a] > fold.weight[b]:
            a, b = b, a
            i, j = j, i
        degree = fold.degree[a]
        offset = j - i if j >= i else j - i + degree
        fold.parent[a] = b
        fold.offset[a] = offset
        fold.weight[b] += fold.weight[a]
        fold.undo[fold.undos] = 2 * a
        fold.undos += 1
        for dart in range(degree):
            slot = fold.base[a] + dart
            if fold.end_node[slot] < 0:
                continue
            end = find_node(fold, fold.end_node[slot])
            end_dart = find_dart(fold, fold.end_node[slot], fold.end_dart[slot])
            moved = dart + offset if dart + offset < degree else dart + offset - degree
            if end == b and end_dart == moved:
                if met(fold, OWN_OTHER_END):
                    return OWN_OTHER_END
                continue
            known = fold.base[b] + moved
            if fold.end_node[known] < 0:
                put_end(fold, b, moved, end, end_dart)
                continue
            if waiting + 8 > JUDGE_DOORS:
                fold.full = 1
                return UNLIKE
            fold.work[waiting] = fold.end_node[known]
            fold.work[waiting + 1] = fold.end_dart[known]
            fold.work[waiting + 2] = end
            fold.work[waiting + 3] = end_dart
            waiting += 4
    return 0


@kernel
def join_ends(fold: FoldWords, a: int, i: int, b: int, j: int) -> int:
    """Make two places the ends of one edge: as `make_one`."""
    for _ in range(2):
        node = find_node(fold, a)
        dart = find_dart(fold, a, i)
        end = find_node(fold, b)
        end_dart = find_dart(fold, b, j)
        if node == end and dart == end_dart:
            if met(fold, OWN_OTHER_END):
                return OWN_OTHER_END
        else:
            slot = fold.base[node] + dart
            if fold.end_node[slot] < 0:
                put_end(fold, node, dart, end, end_dart)
            else:
                wrong = make_one(fold, fold.end_node[slot], fold.end_dart[slot], b, j)
                if wrong != 0:
                    return wrong
        a, i, b, j = b, j, a, i
    return 0


@kernel
def roll_back(fold: FoldWords, mark: int) -> None:
    at = fold.undos
    while at > mark:
        at -= 1
        change = fold.undo[at]
        if change & 1 != 0:
            fold.end_node[(change >> 1)] = -1
        else:
            node = change >> 1
            fold.weight[fold.parent[node]] -= fold.weight[node]
            fold.parent[node] = node
            fold.offset[node] = 0
    fold.undos = at


@kernel
def tidy_up(case: CaseWords) -> None:
    """Drop the nodes that are identified with others, if these take much room.

    A node moves towards the front alone. Node 0 is never identified with a heavier one, since a
    node with the marker joins it when it is new; so the marker's dart stays its dart 0.
    """
    fold, drawn = case.fold, case.drawn
    if fold.doors < 2 * fold.tidied + LEAST_TIDIED:
        return
    settle_places(case)
    nodes = 0
    doors = 0
    for node in range(fold.nodes):
        if fold.parent[node] != node:
            continue
        fold.parent[nodes] = nodes
        fold.weight[nodes] = fold.weight[node]
        fold.marked[nodes] = fold.marked[node]
        degree = fold.degree[node]
        base = fold.base[node]
        fold.degree[nodes] = degree
        fold.base[nodes] = doors
        for slot in range(base, base + degree):
            end = fold.end_node[slot]
            fold.end_node[doors] = fold.number[end] if end >= 0 else -1
            fold.end_dart[doors] = fold.end_dart[slot]
            doors += 1
        nodes += 1
    fold.nodes = nodes
    fold.doors = doors
    fold.tidied = doors
    fold.at = fold.number[fold.at]
    for d in range(drawn.darts):
        drawn.node[d] = fold.number[drawn.node[d]]


@inlined
def settle_places(case: CaseWords) -> None:
    """Name every place by its representative, and number these."""
    fold, drawn = case.fold, case.drawn
    fold.dart = find_dart(fold, fold.at, fold.dart)
    fold.at = find_node(fold, fold.at)
    for d in range(drawn.darts):
        drawn.dart[d] = find_dart(fold, drawn.node[d], drawn.dart[d])
        drawn.node[d] = find_node(fold, drawn.node[d])
    nodes = 0
    for node in range(fold.nodes):
        if fold.parent[node] == node:
            fold.number[node] = nodes
            nodes += 1
            for slot in range(fold.base[node], fold.base[node] + fold.degree[node]):
                end = fold.end_node[slot]
                if end >= 0:
                    fold.end_dart[slot] = find_dart(fold, end, fold.end_dart[slot])
                    fold.end_node[slot] = find_node(fold, end)


@kernel
def lay_out(fold: FoldWords) -> int:
    """The fold as a map, with a leaf on every open dart: the number of open darts.

    `fold.size`: its darts; -1: too many.
    """
    size = 0
    vertices = 0
    for node in range(fold.nodes):
        if fold.parent[node] == node:
            if size + fold.degree[node] > JUDGE_DARTS - 2:
                return -1
            fold.number[node] = size
            fold.first[vertices] = size
            for dart in range(fold.degree[node]):
                fold.vertex[size + dart] = node
            size += fold.degree[node]
            vertices += 1
    fold.size = size
    open_darts = 0
    for dart in range(size):
        node = fold.vertex[dart]
        slot = fold.base[node] + dart - fold.number[node]
        if fold.end_node[slot] < 0:
            fold.alpha[dart] = -1
            open_darts += 1
        else:
            end = find_node(fold, fold.end_node[slot])
            end_dart = find_dart(fold, fold.end_node[slot], fold.end_dart[slot])
            fold.alpha[dart] = fold.number[end] + end_dart
    return open_darts


@kernel
def is_planar_fold(fold: FoldWords) -> bool:
    vertices = 0
    open_darts = 0
    faces = 0
    for dart in range(fold.size):
        fold.seen[dart] = 0
    for dart in range(fold.size):
        node = fold.vertex[dart]
        if fold.number[node] == dart:
            vertices += 1
        if fold.alpha[dart] < 0:
            open_darts += 1
        if fold.seen[dart] == 0:
            faces += 1
            at = dart
            while fold.seen[at] == 0:
                fold.seen[at] = 1
                # A leaf turns back into its dart.
                if fold.alpha[at] >= 0:
                    at = fold.alpha[at]
                node = fold.vertex[at]
                at += 1
                if at == fold.number[node] + fold.degree[node]:
                    at = fold.number[node]
    edges = (fold.size + open_darts) // 2
    return vertices + open_darts - edges + faces == 2


#
# Asked only where folding on past the first contradiction, which is quicker, did not meet the one
# that is cited. A place is a number, its slot: where the fold has the other end of the dart, at a
# root.


@kernel
def all_that_follow(case: CaseWords, e: int, h: int) -> int:
    """The contradictions that follow if these darts of S are one edge, as a mask."""
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
        fold.number[entry_of(case, v)] = v
    for v in range(drawn.vertices):
        if fold.number[entry_of(case, v)] != v:
            consequences.met |= 1 << TWO_OF_S
    return consequences.met


@inlined
def start_consequences(case: CaseWords) -> None:
    consequences, fold = case.consequences, case.fold
    consequences.met = 0
    consequences.waiting = 0
    consequences.entries = 0
    for node in range(fold.nodes):
        for slot in range(fold.base[node], fold.base[node] + fold.degree[node]):
            fold.owner[slot] = node
            consequences.same[slot] = slot
            consequences.first[slot] = -1
            end = fold.end_node[slot]
            if end >= 0:
                add_beyond(consequences, slot, slot_at(fold, end, fold.end_dart[slot]))


@inlined
def slot_at(fold: FoldWords, node: int, dart: int) -> int:
    return fold.base[find_node(fold, node)] + find_dart(fold, node, dart)


@inlined
def turn_slot(fold: FoldWords, slot: int, door: int) -> int:
    base = fold.base[fold.owner[slot]]
    degree = fold.degree[fold.owner[slot]]
    return slot + door if slot + door < base + degree else slot + door - degree


@inlined
def find_same(consequences: ConsequenceWords, slot: int) -> int:
    while consequences.same[slot] != slot:
        slot = consequences.same[slot]
    return slot


@inlined
def entry_of(case: CaseWords, v: int) -> int:
    drawn = case.drawn
    e = drawn.entry[v]
    return case.fold.owner[
        find_same(case.consequences, slot_at(case.fold, drawn.node[e], drawn.dart[e]))
    ]


@inlined
def add_beyond(consequences: ConsequenceWords, slot: int, end: int) -> None:
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
    """Put an end behind a dart: one that looks like an end there, or another."""
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
