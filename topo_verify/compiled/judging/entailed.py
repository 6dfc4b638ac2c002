"""Claims 9 and 10: what the mapper concluded must follow from its history.

Mirrors: checkers/entailment.py and map_on_fold.py. Differs: there is no witness. Under the planar
prior a rejection that only some further folding could refute leaves the verdict open (`J_FULL`).

The moves alone are claim 9; with `J_LEVEL` 10, or where a rejection rests on a contradiction (claim
8 asks whether that follows), S is drawn on the fold and each decision is judged on the way.
"""

from __future__ import annotations

from topo_verify.compiled.events import (
    AUGMENT,
    BY_FOLDING,
    BY_PLANAR,
    CONFIRM,
    MOVE,
    NEW,
    OTHER_FACE,
    POSE,
    REJECT,
    TWO_OF_S,
)
from topo_verify.compiled.judging.consequences import all_that_follow
from topo_verify.compiled.judging.fold import (
    find_dart,
    find_node,
    fold_move,
    is_planar_fold,
    join_ends,
    lay_out,
    roll_back,
    start_judge_fold,
)
from topo_verify.compiled.judging.layout import *
from topo_verify.compiled.judging.layout import end_of_trace, event_size, shown
from topo_verify.compiled.kernel import Words, inlined, kernel
from topo_verify.compiled.workspace import TR


@kernel
def fold_history(W: Words, J: Words) -> bool:
    """Fold the moves and judge the decisions on the way; False: no world shows the history."""
    start_judge_fold(J, shown(W, 0))
    J[S_UNPROVED] = 0
    J[S_STANDS] = 1
    J[S_REJECTION] = 0
    end = end_of_trace(W)
    asked = J[J_LEVEL] >= 10 or J[J_CITED] > 0
    if asked:
        J[S_DARTS] = 0
        J[S_VERTICES] = 0
        add_vertex_on_fold(J, 0, 0)
    i = TR
    while i < end:
        kind = W[i]
        if kind == MOVE:
            if not fold_move(J, W[i + 1], W[i + 2]):
                return False
            i += 4
            continue
        if asked and kind != POSE and J[S_STANDS] != 0:
            conclude_event(W, J, i)
        elif kind == REJECT:
            note_rejection(J, 0)  # S is not proved any more
        i += event_size(W, J, i, end)
    return True


@inlined
def note_rejection(J: Words, cited_follows: int) -> None:
    """Take note whether the contradiction that a rejection cites follows."""
    number = J[S_REJECTION] + 1
    if number >= JUDGE_STEPS:
        J[J_FULL] = 1
    else:
        J[S_MET + number] = cited_follows
    J[S_REJECTION] = number


@kernel
def conclude_event(W: Words, J: Words, i: int) -> None:
    """One decision: whether it follows, and S behind it."""
    kind = W[i]
    e = W[i + 1]
    other = W[i + 3] if kind == AUGMENT else W[i + 2]
    is_new = kind == AUGMENT and W[i + 2] == NEW
    known = other == J[S_DARTS] if is_new else is_open_on_fold(J, other)
    if not known or not is_open_on_fold(J, e):
        J[S_UNPROVED] = 1
        J[S_STANDS] = 0
        if kind == REJECT:
            note_rejection(J, 0)
        return
    if kind == REJECT:
        cited_follows = 1 if W[i + 4] >= BY_FOLDING and is_met(W, J, i) else 0
        note_rejection(J, cited_follows)
        if may_lead_to(J, e, other):
            J[S_UNPROVED] = 1
        else:
            J[S_REFUTED + other] = e
        return
    if is_new:
        follows = not may_be_known(J, e, W[i + 4]) and not may_lead_anywhere(J, e)
    else:
        follows = not may_be_apart(J, e, other)
        if kind == AUGMENT and J[F_DEGREE + find_node(J, J[S_NODE + other])] != W[i + 4]:
            follows = False
    if not follows:
        J[S_UNPROVED] = 1
    if kind == CONFIRM:
        return
    if follows and is_new:
        follows = grow_on_fold(J, e)
    if follows:
        J[S_OPEN + e] = 0
        J[S_OPEN + other] = 0
        # On the face each goes on beyond the other.
        after = J[S_AFTER + e]
        J[S_AFTER + e] = J[S_AFTER + other]
        J[S_AFTER + other] = after
    else:  # from here on S is not proved
        J[S_STANDS] = 0


# ---------------------------------------------------------------- S on the fold


@inlined
def is_open_on_fold(J: Words, dart: int) -> bool:
    """Whether this is a dart of S, and unexplored."""
    return 0 <= dart < J[S_DARTS] and J[S_OPEN + dart] != 0


@inlined
def add_vertex_on_fold(J: Words, node: int, first: int) -> bool:
    """Let S have a vertex more, its first dart at this place; False: there is no room."""
    size = J[S_DARTS]
    degree = J[F_DEGREE + node]
    if size + degree > JUDGE_DARTS:
        J[J_FULL] = 1
        return False
    J[S_ENTRY + J[S_VERTICES]] = size
    for door in range(degree):
        dart = size + door
        J[S_NODE + dart] = node
        J[S_DART + dart] = first + door if first + door < degree else first + door - degree
        J[S_AFTER + dart] = dart + 1
        J[S_OPEN + dart] = 1
        J[S_REFUTED + dart] = -1
    J[S_AFTER + size + degree - 1] = size
    J[S_DARTS] = size + degree
    J[S_VERTICES] += 1
    return True


@inlined
def slot_of(J: Words, e: int) -> int:
    """Where the other end of a dart of S is kept."""
    node = J[S_NODE + e]
    return J[F_BASE + find_node(J, node)] + find_dart(J, node, J[S_DART + e])


@inlined
def grow_on_fold(J: Words, e: int) -> bool:
    """Let S have the vertex behind e."""
    slot = slot_of(J, e)
    node = J[F_END_NODE + slot]
    first = find_dart(J, node, J[F_END_DART + slot])
    return add_vertex_on_fold(J, find_node(J, node), first)


@inlined
def on_face(J: Words, e: int, h: int) -> bool:
    """Whether h is on the face of e."""
    dart = J[S_AFTER + e]
    while dart not in (e, h):
        dart = J[S_AFTER + dart]
    return dart == h


# ---------------------------------------------------------------- whether it follows


@inlined
def may_be_apart(J: Words, e: int, h: int) -> bool:
    """Folding does not make e and h partners."""
    slot = slot_of(J, e)
    node = J[F_END_NODE + slot]
    if node < 0 or find_node(J, node) != find_node(J, J[S_NODE + h]):
        return True
    dart = find_dart(J, node, J[F_END_DART + slot])
    return dart != find_dart(J, J[S_NODE + h], J[S_DART + h])


@inlined
def may_be_known(J: Words, e: int, degree: int) -> bool:
    """The edge e was not crossed, or leads to another degree, or to a vertex of S."""
    slot = slot_of(J, e)
    node = J[F_END_NODE + slot]
    if node < 0:
        return True
    node = find_node(J, node)
    if J[F_DEGREE + node] != degree:
        return True
    for v in range(J[S_VERTICES]):  # noqa: SIM110  numba knows no such generator
        if find_node(J, J[S_NODE + J[S_ENTRY + v]]) == node:
            return True
    return False


@inlined
def may_lead_anywhere(J: Words, e: int) -> bool:
    """Some unexplored dart that is not refuted may be the other end of e."""
    for h in range(J[S_DARTS]):
        if J[S_OPEN + h] != 0 and h != e and J[S_REFUTED + h] != e and may_lead_to(J, e, h):
            return True
    return False


@kernel
def may_lead_to(J: Words, e: int, h: int) -> bool:
    """Folding with e joined to h meets no contradiction; under the prior: in a planar world."""
    if J[J_SAW_PLANAR] != 0 and not on_face(J, e, h) and h != e:
        return False
    slot = slot_of(J, e)
    end = J[F_END_NODE + slot]
    node = find_node(J, J[S_NODE + h])
    if end >= 0:  # the usual case, seen at once
        end = find_node(J, end)
        if J[F_DEGREE + end] != J[F_DEGREE + node]:
            return False
    mark = J[F_UNDOS]
    wrong = join_ends(J, J[S_NODE + e], J[S_DART + e], J[S_NODE + h], J[S_DART + h])
    if wrong == 0 and J[J_SAW_PLANAR] != 0:
        if lay_out(J) < 0 or not is_planar_fold(J):
            J[J_FULL] = 1  # some further folding may be planar: the checkers look for it
    roll_back(J, mark)
    return wrong == 0


@kernel
def is_met(W: Words, J: Words, i: int) -> bool:
    """Whether the contradiction that a rejection cites follows from the history."""
    e = W[i + 1]
    h = W[i + 2]
    cited = W[i + 11]
    if W[i + 4] == BY_PLANAR:
        return cited == OTHER_FACE and h != e and not on_face(J, e, h)
    if cited <= 0 or cited >= OTHER_FACE:
        return False
    mark = J[F_UNDOS]
    J[F_MET] = 0
    join_ends(J, J[S_NODE + e], J[S_DART + e], J[S_NODE + h], J[S_DART + h])
    found = J[F_MET]
    J[F_MET] = -1
    if cited == TWO_OF_S:
        seen = J[S_VERTICES]
        for v in range(seen):
            for w in range(v):
                if find_node(J, J[S_NODE + J[S_ENTRY + v]]) == find_node(
                    J, J[S_NODE + J[S_ENTRY + w]]
                ):
                    found |= 1 << TWO_OF_S
    roll_back(J, mark)
    if (found >> cited) & 1 == 0 and found != 0:  # it may follow where the fold drew no more
        found = all_that_follow(J, e, h)
    return (found >> cited) & 1 != 0
