"""Claims 9 and 10: what the mapper concluded must follow from its history.

Twin of checkers/entailment.py and map_on_fold.py. Differs: there is no witness; under the planar
prior a rejection that only some further folding could refute leaves the verdict open (`full`).
Decisions are judged only with `level` 10, or where a rejection rests on a contradiction (claim 8).
"""

from __future__ import annotations

from topo_verify.extra.fast.kernels.events import *
from topo_verify.extra.fast.kernels.judging.fold import *
from topo_verify.extra.fast.kernels.judging.layout import *
from topo_verify.extra.fast.kernels.judging.layout import end_of_trace, event_size, shown
from topo_verify.extra.fast.kernels.kernel import inlined, kernel
from topo_verify.extra.fast.kernels.workspace import *


@kernel
def start_history(run: RunWords, case: CaseWords, asked: int) -> None:
    """Start the fold of the history; if asked, draw S on it."""
    drawn = case.drawn
    start_judge_fold(case.fold, shown(run.world, 0))
    drawn.asked = asked
    drawn.unproved = 0
    drawn.stands = 1
    drawn.rejection = 0
    drawn.darts = 0
    drawn.vertices = 0
    if asked != 0:
        add_vertex_on_fold(case, 0, 0)


@kernel
def fold_history(run: RunWords, case: CaseWords) -> bool:
    """Fold the moves and judge the decisions; False: no world shows the history."""
    drawn = case.drawn
    end = end_of_trace(run.trace)
    i = run.trace.place_of("word")
    while i < end:
        kind = EventWords(run, i).kind
        if kind == MOVE:
            move = MoveWords(run, i)
            if not fold_move(case.fold, move.door, move.percept):
                return False
            i += 4
            continue
        if drawn.asked != 0 and kind != POSE and drawn.stands != 0:
            conclude_event(run, case, DecisionWords(run, i))
        elif kind == REJECT:
            note_rejection(drawn, 0)  # S is no longer proved
        i += event_size(run, case, i, end)
    return True


@inlined
def note_rejection(drawn: DrawnWords, cited_follows: int) -> None:
    number = drawn.rejection + 1
    if number >= JUDGE_STEPS:
        drawn.full = 1
    else:
        drawn.met[number] = cited_follows
    drawn.rejection = number


@kernel
def conclude_event(run: RunWords, case: CaseWords, event: DecisionWords) -> None:
    drawn = case.drawn
    rejection = RejectionWords(run, event)
    augmentation = AugmentationWords(run, event)
    kind = event.kind
    e = event.edge
    other = augmentation.dart if kind == AUGMENT else rejection.h
    is_new = kind == AUGMENT and augmentation.growth == NEW
    known = other == drawn.darts if is_new else is_open_on_fold(drawn, other)
    if not known or not is_open_on_fold(drawn, e):
        drawn.unproved = 1
        if kind == REJECT:
            note_rejection(drawn, 0)
        if kind == AUGMENT:
            drawn.stands = 0
        return
    if kind == REJECT:
        cited_follows = 1 if rejection.rule >= BY_FOLDING and is_met(run, case, rejection) else 0
        note_rejection(drawn, cited_follows)
        if may_lead_to(case, e, other):
            drawn.unproved = 1
        else:
            drawn.refuted[other] = e
        return
    if is_new:
        follows = not may_be_known(case, e, augmentation.degree) and not may_lead_anywhere(case, e)
    else:
        follows = not may_be_apart(case, e, other)
        if (
            kind == AUGMENT
            and case.fold.degree[find_node(case.fold, drawn.node[other])] != augmentation.degree
        ):
            follows = False
    if not follows:
        drawn.unproved = 1
    if kind == CONFIRM:
        return
    if follows and is_new:
        follows = grow_on_fold(case, e)
    if follows:
        drawn.open[e] = 0
        drawn.open[other] = 0
        after = drawn.after[e]
        drawn.after[e] = drawn.after[other]
        drawn.after[other] = after
    else:
        drawn.stands = 0


@inlined
def is_open_on_fold(drawn: DrawnWords, dart: int) -> bool:
    return 0 <= dart < drawn.darts and drawn.open[dart] != 0


@inlined
def add_vertex_on_fold(case: CaseWords, node: int, first: int) -> bool:
    """Add a vertex to S, its first dart at this place; False: no room."""
    drawn = case.drawn
    size = drawn.darts
    degree = case.fold.degree[node]
    if size + degree > JUDGE_DARTS:
        case.full = 1
        return False
    drawn.entry[drawn.vertices] = size
    for door in range(degree):
        dart = size + door
        drawn.node[dart] = node
        drawn.dart[dart] = first + door if first + door < degree else first + door - degree
        drawn.after[dart] = dart + 1
        drawn.open[dart] = 1
        drawn.refuted[dart] = -1
    drawn.after[size + degree - 1] = size
    drawn.darts = size + degree
    drawn.vertices += 1
    return True


@inlined
def slot_of(case: CaseWords, e: int) -> int:
    drawn = case.drawn
    node = drawn.node[e]
    return case.fold.base[find_node(case.fold, node)] + find_dart(case.fold, node, drawn.dart[e])


@inlined
def grow_on_fold(case: CaseWords, e: int) -> bool:
    fold = case.fold
    slot = slot_of(case, e)
    node = fold.end_node[slot]
    first = find_dart(fold, node, fold.end_dart[slot])
    return add_vertex_on_fold(case, find_node(fold, node), first)


@inlined
def on_face(drawn: DrawnWords, e: int, h: int) -> bool:
    dart = drawn.after[e]
    while dart not in (e, h):
        dart = drawn.after[dart]
    return dart == h


@inlined
def may_be_apart(case: CaseWords, e: int, h: int) -> bool:
    """Does folding leave open that e and h are no partners?"""
    fold, drawn = case.fold, case.drawn
    slot = slot_of(case, e)
    node = fold.end_node[slot]
    if node < 0 or find_node(fold, node) != find_node(fold, drawn.node[h]):
        return True
    dart = find_dart(fold, node, fold.end_dart[slot])
    return dart != find_dart(fold, drawn.node[h], drawn.dart[h])


@inlined
def may_be_known(case: CaseWords, e: int, degree: int) -> bool:
    """Whether e was not crossed, or leads to another degree or to a vertex of S."""
    fold, drawn = case.fold, case.drawn
    slot = slot_of(case, e)
    node = fold.end_node[slot]
    if node < 0:
        return True
    node = find_node(fold, node)
    if fold.degree[node] != degree:
        return True
    for v in range(drawn.vertices):  # noqa: SIM110  numba knows no such generator
        if find_node(fold, drawn.node[drawn.entry[v]]) == node:
            return True
    return False


@inlined
def may_lead_anywhere(case: CaseWords, e: int) -> bool:
    """Whether some unexplored dart may be the other end of e."""
    drawn = case.drawn
    for h in range(drawn.darts):
        if drawn.open[h] != 0 and h != e and drawn.refuted[h] != e and may_lead_to(case, e, h):
            return True
    return False


@kernel
def may_lead_to(case: CaseWords, e: int, h: int) -> bool:
    """Whether joining e to h does not contradict; under the prior: in a planar world."""
    fold, drawn = case.fold, case.drawn
    if case.saw_planar != 0 and not on_face(drawn, e, h) and h != e:
        return False
    slot = slot_of(case, e)
    end = fold.end_node[slot]
    node = find_node(fold, drawn.node[h])
    if end >= 0:
        end = find_node(fold, end)
        if fold.degree[end] != fold.degree[node]:
            return False
    mark = fold.undos
    wrong = join_ends(fold, drawn.node[e], drawn.dart[e], drawn.node[h], drawn.dart[h])
    if wrong == 0 and case.saw_planar != 0:
        if lay_out(fold) < 0 or not is_planar_fold(fold):
            case.full = 1  # the checkers look for a planar folding
    roll_back(fold, mark)
    return wrong == 0


@kernel
def is_met(run: RunWords, case: CaseWords, rejection: RejectionWords) -> bool:  # noqa: ARG001  it has the rejection's words
    fold, drawn = case.fold, case.drawn
    e = rejection.edge
    h = rejection.h
    cited = rejection.contradiction
    if rejection.rule == BY_PLANAR:
        return cited == OTHER_FACE and h != e and not on_face(drawn, e, h)
    if cited <= 0 or cited >= OTHER_FACE:
        return False
    mark = fold.undos
    fold.met = 0
    join_ends(fold, drawn.node[e], drawn.dart[e], drawn.node[h], drawn.dart[h])
    contradictions = fold.met
    fold.met = -1
    if cited == TWO_OF_S:
        for v in range(drawn.vertices):
            fold.number[find_node(fold, drawn.node[drawn.entry[v]])] = v
        for v in range(drawn.vertices):
            if fold.number[find_node(fold, drawn.node[drawn.entry[v]])] != v:
                contradictions |= 1 << TWO_OF_S
    roll_back(fold, mark)
    if (contradictions >> cited) & 1 == 0 and contradictions != 0:
        contradictions = all_that_follow(case, e, h)
    return (contradictions >> cited) & 1 != 0
