"""Claims 1 to 8 are judged while the trace is replayed in its world.

Twin of checkers/replayed_trace.py, map_in_world.py and claims.py. Differs: a claim is asked at the
event; a finding is a bit in `wrong`, bit k for claim k + 1. No event is judged after the first door
that does not exist (`legal`), no decision after the first false augmentation (`spoiled`).
"""

from __future__ import annotations

from topo_verify.extra.fast.kernels.events import *
from topo_verify.extra.fast.kernels.judging.justified import (
    keep_sequence,
    record_sequences,
    unjustified,
)
from topo_verify.extra.fast.kernels.judging.layout import *
from topo_verify.extra.fast.kernels.judging.layout import end_of_trace, event_size, exit_of, shown
from topo_verify.extra.fast.kernels.kernel import inlined, kernel
from topo_verify.extra.fast.kernels.workspace import *

HASH_PRIME = 1099511628211


@kernel
def replay(run: RunWords, case: CaseWords) -> None:
    """Follow the trace on, and judge each event by claims 1, 2, 3, 4, 5 and 8."""
    i = run.trace.place_of("word")
    end = end_of_trace(run.trace)
    while i < end:
        size = event_size(run, case, i, end)
        if size == 0:
            return
        kind = EventWords(run, i).kind
        if kind == MOVE:
            follow_move(run, case, MoveWords(run, i))
        else:
            case.saw[kind] = 1
            if kind == REJECT and RejectionWords(run, i).rule == BY_PLANAR:
                case.saw_planar = 1
            if case.legal != 0 and case.spoiled == 0:
                decide(run, case, DecisionWords(run, i))
        i += size


@kernel
def start_replay(world: WorldWords, case: CaseWords) -> None:
    """Let S be v0, and forget the earlier run."""
    case.full = 0
    case.wrong = 0
    for at in range(case.place_of("cost"), case.place_of("phi")):
        case[at] = 0
    for at in range(case.place_of("saw"), case.place_of("fate")):
        case[at] = 0
    for d in range(case.darts):
        case.number[d] = -1
        case.fate[d] = 0
        case.crossed[d] = 0
        case.grown[d] = 0
    case.legal = 1
    case.true = 1
    case.followed = 1
    case.pose_edge = -1
    case.is_late = 0
    case.turned = 0
    case.word_size = 0
    case.sequences = 0
    case.arena = 0
    case.recorded = 0
    case.records = 0
    draw_vertex(world, case, 0)


@inlined
def draw_vertex(world: WorldWords, case: CaseWords, entry: int) -> None:
    v = world.vertex[entry]
    first = case.size
    dart = entry
    for d in range(first, first + world.degree[v]):
        case.phi[d] = dart
        case.number[dart] = d
        case.alpha[d] = -1
        case.record_of[d] = -1
        dart += 1
        if dart == world.first[v] + world.degree[v]:
            dart = world.first[v]
    case.size = first + world.degree[v]


@inlined
def is_open(case: CaseWords, dart: int) -> bool:
    return 0 <= dart < case.size and case.alpha[dart] < 0


@inlined
def lesser(world: WorldWords, dart: int) -> int:
    return min(dart, world.alpha[dart])


@inlined
def follow_move(run: RunWords, case: CaseWords, move: MoveWords) -> None:
    """One move: position, percept (claim 1), and the word of the excursion."""
    world = run.world
    case.cost += 1
    case.doors_hash = (case.doors_hash ^ move.door) * HASH_PRIME
    if case.legal == 0:
        return
    at = case.at
    v = world.vertex[at]
    door = move.door
    if door < 0 or door >= world.degree[v]:
        case.legal = 0
        case.wrong |= 1
        return
    exit_dart = exit_of(world, at, door)
    at = world.alpha[exit_dart]
    case.at = at
    case.crossed[min(at, exit_dart)] = 1
    case.followed += 1
    percept = shown(world, at)
    if move.percept != percept:
        case.true = 0
        case.wrong |= 1
    door += case.turned
    if door >= world.degree[v]:
        door -= world.degree[v]
    size = case.word_size
    if door == 0 and size > 0:
        case.turned = case.word_step[size - 1] & MASK
        case.word_size = size - 1
    elif case.is_late == 0 and size >= JUDGE_STEPS:
        case.full = 1
    elif case.is_late == 0:
        case.word_step[size] = percept << SHIFT | door
        case.word_size = size + 1
        case.turned = 0


@inlined
def decide(run: RunWords, case: CaseWords, event: DecisionWords) -> None:
    kind = event.kind
    e = event.edge
    opened = is_open(case, e)
    truth = -1
    edge = -1
    if opened:
        truth = case.number[run.world.alpha[case.phi[e]]]
        edge = lesser(run.world, case.phi[e])
    if kind == POSE:
        pose(run, case, PoseWords(run, event), edge, truth)
    elif kind == REJECT:
        rejection = RejectionWords(run, event)
        h = rejection.h
        case.rejections += 1
        if opened and truth >= 0 and truth == h:
            case.wrong |= 1 << 2
        if unjustified(run, case, rejection):
            case.wrong |= 1 << 7
        settle_hypothesis(case, edge, h)
        if rejection.rule == BY_MOTION and case.word_size > 0:
            keep_sequence(case)
    elif kind == CONFIRM:
        h = ConfirmationWords(run, event).h
        case.confirmations += 1
        if truth < 0 or truth != h:
            case.wrong |= 1 << 3
        settle_hypothesis(case, edge, h)
    else:
        augment(run, case, AugmentationWords(run, event), edge, truth)


@inlined
def pose(run: RunWords, case: CaseWords, posed: PoseWords, edge: int, truth: int) -> None:
    """Judge a set of hypotheses by claim 2."""
    e = posed.edge
    number = posed.number
    case.posed += number
    case.poses += 1
    case.pose_edge = e
    case.turned = 0
    case.word_size = 0
    case.sequences = 0
    case.arena = case.recorded
    wrong = edge < 0 or case.crossed[edge] == 0
    if edge >= 0 and case.fate[edge] == 0:
        for word in range(edge * JUDGE_SET, edge * JUDGE_SET + JUDGE_SET):
            case.left[word] = 0
    case.is_late = edge < 0 or case.at != run.world.alpha[case.phi[e]]
    has_truth = truth < 0
    for k in range(posed.place_of("h"), posed.place_of("h") + number):
        h = run[k]
        if not is_open(case, h):
            wrong = True
        if h == truth:
            has_truth = True
        if h < 0 or h >= JUDGE_DARTS - 2:
            case.full = 1
            continue
        case.posed_by[h] = case.poses
        if edge >= 0:
            case.left[edge * JUDGE_SET + (h >> 6)] |= 1 << (h & 63)
    if wrong or not has_truth:
        case.wrong |= 1 << 1
    if edge >= 0:
        case.fate[edge] = FATE_POSED


@inlined
def settle_hypothesis(case: CaseWords, edge: int, h: int) -> None:
    if edge >= 0 and 0 <= h < JUDGE_DARTS - 2:
        case.left[edge * JUDGE_SET + (h >> 6)] &= ~(1 << (h & 63))


@inlined
def augment(
    run: RunWords, case: CaseWords, event: AugmentationWords, edge: int, truth: int
) -> None:
    """Grow S; judge by claims 2, 3 and 5."""
    world = run.world
    e = event.edge
    is_new = event.growth == NEW
    posed = e >= 0 and case.pose_edge == e
    case.augmentations += 1
    if not posed:
        case.wrong |= 1 << 1
    if is_new and truth >= 0:
        case.wrong |= 1 << 2
    size = case.size
    if edge < 0:
        case.spoiled = 1
        return
    end = world.alpha[case.phi[e]]
    dart = size if truth < 0 else truth
    true_kind = is_new if truth < 0 else event.growth == LOOP
    if not true_kind or event.dart != dart or event.degree != world.degree[world.vertex[end]]:
        case.spoiled = 1
        return
    if posed:
        case.fate[edge] = FATE_NEW if is_new else FATE_LOOP
        if left_open(case, edge, size if is_new else 0):
            case.wrong |= 1 << 2
    if is_new:
        draw_vertex(world, case, end)
    case.alpha[e] = dart
    case.alpha[dart] = e
    case.grown[edge] = 1
    if posed:
        record_sequences(world, case, dart)
    case.pose_edge = -1
    case.sequences = 0
    case.arena = case.recorded


@inlined
def left_open(case: CaseWords, edge: int, size: int) -> bool:
    """Keep the undecided hypotheses below `size` that are unexplored; whether there are any."""
    is_any = False
    for word in range(JUDGE_SET):
        mask = case.left[edge * JUDGE_SET + word]
        if mask != 0:
            for bit in range(64):
                h = 64 * word + bit
                if (mask >> bit) & 1 != 0 and (h >= size or case.alpha[h] >= 0):
                    mask &= ~(1 << bit)
            case.left[edge * JUDGE_SET + word] = mask
            is_any = is_any or mask != 0
    return is_any
