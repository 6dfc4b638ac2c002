"""The fold of a history, with rollback: what percepts and doors alone prove.

Mirrors: checkers/folding.py, where the theory stands. Differs: a contradiction is a value, no
exception: with `F_MET` = -1 the first one ends the folding, otherwise all are collected there as a
mask. Changes are always noted for rollback; the list is emptied where nothing can be taken back.

A place is two numbers, a node and a dart of it. `F_END_NODE` and `F_END_DART` have the other end of
each dart of each node, as it was put; node -1: the dart is open.
"""

from __future__ import annotations

from topo_verify.compiled.events import OWN_OTHER_END, TURNED_ITSELF, UNLIKE
from topo_verify.compiled.judging.layout import *
from topo_verify.compiled.kernel import Words, inlined, kernel
from topo_verify.compiled.workspace import MASK, SHIFT


@inlined
def start_judge_fold(J: Words, percept: int) -> None:
    """The fold of a history without a move."""
    J[F_NODES] = 0
    J[F_DOORS] = 0
    J[F_UNDOS] = 0
    J[F_MET] = -1
    J[F_AT] = visit(J, percept)
    J[F_DART] = 0


@inlined
def visit(J: Words, percept: int) -> int:
    """A new node with this percept, all its darts open; 0, and an open verdict, if it is full."""
    node = J[F_NODES]
    base = J[F_DOORS]
    degree = percept >> SHIFT
    # Room is kept for what identification may note: two entries a door.
    if node >= JUDGE_NODES or 4 * (base + degree) > JUDGE_DOORS:
        J[J_FULL] = 1
        return 0
    J[F_PARENT + node] = node
    J[F_OFFSET + node] = 0
    J[F_WEIGHT + node] = 1
    J[F_DEGREE + node] = degree
    J[F_MARKED + node] = 1 if (percept & MASK) > 0 else 0
    J[F_BASE + node] = base
    for at in range(base, base + degree):
        J[F_END_NODE + at] = -1
        J[F_OWNER + at] = node
    J[F_NODES] = node + 1
    J[F_DOORS] = base + degree
    return node


@inlined
def find_node(J: Words, node: int) -> int:
    """The node that stands for all that are the same vertex."""
    while J[F_PARENT + node] != node:
        node = J[F_PARENT + node]
    return node


@inlined
def find_dart(J: Words, node: int, dart: int) -> int:
    """A dart of a node, as a dart of the node that stands for it."""
    while J[F_PARENT + node] != node:
        dart += J[F_OFFSET + node]
        if dart >= J[F_DEGREE + node]:
            dart -= J[F_DEGREE + node]
        node = J[F_PARENT + node]
    return dart


@inlined
def fold_move(J: Words, door: int, percept: int) -> bool:
    """Let the robot leave by a door and see this behind it; False: no world shows that."""
    here = find_node(J, J[F_AT])
    dart = find_dart(J, J[F_AT], J[F_DART]) + door
    if dart >= J[F_DEGREE + here]:
        dart -= J[F_DEGREE + here]
    slot = J[F_BASE + here] + dart
    node = J[F_END_NODE + slot]
    if node >= 0:
        entry = find_dart(J, node, J[F_END_DART + slot])
        node = find_node(J, node)
        if J[F_DEGREE + node] != percept >> SHIFT:
            return False
        if (J[F_MARKED + node] != 0) != ((percept & MASK) > 0):
            return False
    else:
        node = visit(J, percept)
        entry = 0
        if J[J_FULL] != 0:
            return False
        J[F_END_NODE + slot] = node
        J[F_END_DART + slot] = 0
        J[F_END_NODE + J[F_BASE + node]] = here
        J[F_END_DART + J[F_BASE + node]] = dart
    J[F_AT] = node
    J[F_DART] = entry
    marker = percept & MASK
    if marker > 0:
        entry += marker - 1
        if entry >= J[F_DEGREE + node]:
            entry -= J[F_DEGREE + node]
        # The usual case: it is v0 already, and not turned.
        if find_node(J, 0) != node or find_dart(J, 0, 0) != entry:
            wrong = make_one(J, node, entry, 0, 0)
            J[F_UNDOS] = 0
            return wrong == 0
    return True


@inlined
def met(J: Words, contradiction: int) -> bool:
    """Note a contradiction; whether it ends the folding."""
    if J[F_MET] < 0:
        return True
    J[F_MET] |= 1 << contradiction
    return False


@inlined
def put_end(J: Words, node: int, dart: int, end: int, end_dart: int) -> None:
    """Put an end behind an open dart of a root."""
    slot = J[F_BASE + node] + dart
    J[F_END_NODE + slot] = end
    J[F_END_DART + slot] = end_dart
    J[F_UNDO + J[F_UNDOS]] = 2 * slot + 1
    J[F_UNDOS] += 1


@kernel
def make_one(J: Words, a: int, i: int, b: int, j: int) -> int:
    """Make two places one dart, and draw what follows: the contradiction that ends it, or 0."""
    J[F_WORK] = a
    J[F_WORK + 1] = i
    J[F_WORK + 2] = b
    J[F_WORK + 3] = j
    waiting = 4
    while waiting > 0:
        waiting -= 4
        i = find_dart(J, J[F_WORK + waiting], J[F_WORK + waiting + 1])
        a = find_node(J, J[F_WORK + waiting])
        j = find_dart(J, J[F_WORK + waiting + 2], J[F_WORK + waiting + 3])
        b = find_node(J, J[F_WORK + waiting + 2])
        if a == b:
            if i != j and met(J, TURNED_ITSELF):
                return TURNED_ITSELF
            continue
        if J[F_DEGREE + a] != J[F_DEGREE + b] or J[F_MARKED + a] != J[F_MARKED + b]:
            if met(J, UNLIKE):
                return UNLIKE
            continue
        if J[F_WEIGHT + a] > J[F_WEIGHT + b]:
            a, b = b, a
            i, j = j, i
        degree = J[F_DEGREE + a]
        offset = j - i if j >= i else j - i + degree
        J[F_PARENT + a] = b
        J[F_OFFSET + a] = offset
        J[F_WEIGHT + b] += J[F_WEIGHT + a]
        J[F_UNDO + J[F_UNDOS]] = 2 * a
        J[F_UNDOS] += 1
        for dart in range(degree):
            slot = J[F_BASE + a] + dart
            if J[F_END_NODE + slot] < 0:
                continue
            end = find_node(J, J[F_END_NODE + slot])
            end_dart = find_dart(J, J[F_END_NODE + slot], J[F_END_DART + slot])
            moved = dart + offset if dart + offset < degree else dart + offset - degree
            if end == b and end_dart == moved:
                if met(J, OWN_OTHER_END):
                    return OWN_OTHER_END
                continue
            known = J[F_BASE + b] + moved
            if J[F_END_NODE + known] < 0:
                put_end(J, b, moved, end, end_dart)
                continue
            if waiting + 8 > JUDGE_DOORS:
                J[J_FULL] = 1
                return UNLIKE
            J[F_WORK + waiting] = J[F_END_NODE + known]
            J[F_WORK + waiting + 1] = J[F_END_DART + known]
            J[F_WORK + waiting + 2] = end
            J[F_WORK + waiting + 3] = end_dart
            waiting += 4
    return 0


@kernel
def join_ends(J: Words, a: int, i: int, b: int, j: int) -> int:
    """Make two places the ends of one edge, and draw what follows: as `make_one`."""
    for _ in range(2):
        node = find_node(J, a)
        dart = find_dart(J, a, i)
        end = find_node(J, b)
        end_dart = find_dart(J, b, j)
        if node == end and dart == end_dart:
            if met(J, OWN_OTHER_END):
                return OWN_OTHER_END
        else:
            slot = J[F_BASE + node] + dart
            if J[F_END_NODE + slot] < 0:
                put_end(J, node, dart, end, end_dart)
            else:
                wrong = make_one(J, J[F_END_NODE + slot], J[F_END_DART + slot], b, j)
                if wrong != 0:
                    return wrong
        a, i, b, j = b, j, a, i
    return 0


@kernel
def roll_back(J: Words, mark: int) -> None:
    """The fold as it was when so many changes were noted."""
    at = J[F_UNDOS]
    while at > mark:
        at -= 1
        change = J[F_UNDO + at]
        if change & 1 != 0:
            J[F_END_NODE + (change >> 1)] = -1
        else:
            node = change >> 1
            J[F_WEIGHT + J[F_PARENT + node]] -= J[F_WEIGHT + node]
            J[F_PARENT + node] = node
            J[F_OFFSET + node] = 0
    J[F_UNDOS] = at


@kernel
def lay_out(J: Words) -> int:
    """The fold as a map, a path of one vertex hung on every open dart: how many darts are open.

    `F_SIZE`: its darts. -1: it has more than there is room for.
    """
    size = 0
    vertices = 0
    for node in range(J[F_NODES]):
        if J[F_PARENT + node] == node:
            if size + J[F_DEGREE + node] > JUDGE_DARTS - 2:
                return -1
            J[F_NUMBER + node] = size
            J[F_FIRST + vertices] = size
            for dart in range(J[F_DEGREE + node]):
                J[F_VERTEX + size + dart] = node
            size += J[F_DEGREE + node]
            vertices += 1
    J[F_SIZE] = size
    left = 0
    for dart in range(size):
        node = J[F_VERTEX + dart]
        slot = J[F_BASE + node] + dart - J[F_NUMBER + node]
        if J[F_END_NODE + slot] < 0:
            J[F_ALPHA + dart] = -1
            left += 1
        else:
            end = find_node(J, J[F_END_NODE + slot])
            end_dart = find_dart(J, J[F_END_NODE + slot], J[F_END_DART + slot])
            J[F_ALPHA + dart] = J[F_NUMBER + end] + end_dart
    return left


@kernel
def is_planar_fold(J: Words) -> bool:
    """Whether the map of `lay_out` has genus 0, its leaves included."""
    vertices = 0
    open_darts = 0
    faces = 0
    seen = 0
    for dart in range(J[F_SIZE]):
        node = J[F_VERTEX + dart]
        if J[F_NUMBER + node] == dart:
            vertices += 1
        if J[F_ALPHA + dart] < 0:
            open_darts += 1
        if (seen >> dart) & 1 == 0:
            faces += 1
            at = dart
            while (seen >> at) & 1 == 0:
                seen |= 1 << at
                # Across the edge (a leaf turns back into its dart), then clockwise.
                if J[F_ALPHA + at] >= 0:
                    at = J[F_ALPHA + at]
                node = J[F_VERTEX + at]
                at += 1
                if at == J[F_NUMBER + node] + J[F_DEGREE + node]:
                    at = J[F_NUMBER + node]
    # Each leaf adds a vertex and, with its edge, nothing else.
    edges = (J[F_SIZE] + open_darts) // 2
    return vertices + open_darts - edges + faces == 2
