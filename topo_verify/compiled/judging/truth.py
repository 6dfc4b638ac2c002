"""Claims 1 to 8 are judged while the trace is replayed in its world.

Mirrors: checkers/replayed_trace.py, map_in_world.py and the first functions of claims.py. Differs:
what a claim asks is asked at the event, so S need not know when a dart was born; and a finding is a
bit in `J_WRONG`. Bit k stands for claim k + 1.

Positions follow from the doors alone. From the first door that is not there (`J_LEGAL`) no event
is judged; from the first false augmentation on (`J_SPOILED`) no decision.
"""

from __future__ import annotations

from topo_verify.compiled.events import (
    BY_MOTION,
    BY_PLANAR,
    CONFIRM,
    LOOP,
    MOVE,
    NEW,
    POSE,
    REJECT,
)
from topo_verify.compiled.judging.justified import keep_sequence, record_sequences, unjustified
from topo_verify.compiled.judging.layout import *
from topo_verify.compiled.judging.layout import end_of_trace, event_size, exit_of, shown
from topo_verify.compiled.kernel import Words, inlined, kernel
from topo_verify.compiled.workspace import *

HASH_PRIME = 1099511628211


@kernel
def replay(W: Words, J: Words) -> None:
    """Follow the trace, draw S, and judge each event by claims 1, 2, 3, 4, 5 and 8."""
    start_replay(W, J)
    i = TR
    end = end_of_trace(W)
    while i < end:
        size = event_size(W, J, i, end)
        if size == 0:
            return
        kind = W[i]
        if kind == MOVE:
            follow_move(W, J, i)
        else:
            J[J_SAW_POSE - POSE + kind] = 1
            if kind == REJECT and W[i + 4] == BY_PLANAR:
                J[J_SAW_PLANAR] = 1
            if J[J_LEGAL] != 0 and J[J_SPOILED] == 0:
                decide(W, J, i)
        i += size


@inlined
def start_replay(W: Words, J: Words) -> None:
    """Let S be v0, and forget the run before."""
    for at in range(J_COST, J_PHI):
        J[at] = 0
    for at in range(J_SAW_POSE, J_FATE):
        J[at] = 0
    for d in range(J[J_DARTS]):
        J[J_NUMBER + d] = -1
        J[J_FATE + d] = 0
        J[J_LEFT + d] = 0
    J[J_LEGAL] = 1
    J[J_TRUE] = 1
    J[J_FOLLOWED] = 1
    J[J_POSE_AT] = -1
    J[J_IS_LATE] = 0
    J[J_TURNED] = 0
    J[J_WORD_SIZE] = 0
    J[J_FIRST_SEQUENCE] = 0
    J[J_SEQUENCES] = 0
    J[J_ARENA] = 0
    J[J_RECORDS] = 0
    draw_vertex(W, J, 0)


@inlined
def draw_vertex(W: Words, J: Words, entry: int) -> None:
    """Let S have a vertex more, that of a dart of the world: its first dart is that one."""
    v = W[VT + entry]
    first = J[J_SIZE]
    dart = entry
    for d in range(first, first + W[DG + v]):
        J[J_PHI + d] = dart
        J[J_NUMBER + dart] = d
        J[J_ALPHA + d] = -1
        J[J_RECORD_OF + d] = -1
        dart += 1
        if dart == W[ST + v] + W[DG + v]:
            dart = W[ST + v]
    J[J_SIZE] = first + W[DG + v]


@inlined
def is_open(J: Words, dart: int) -> bool:
    """Whether this is a dart of S, and unexplored."""
    return 0 <= dart < J[J_SIZE] and J[J_ALPHA + dart] < 0


@inlined
def lesser(W: Words, dart: int) -> int:
    """The edge of the world that has this dart, by the lesser of its two."""
    return min(dart, W[AL + dart])


# ---------------------------------------------------------------- moves


@inlined
def follow_move(W: Words, J: Words, i: int) -> None:
    """One move: the position, the percept (claim 1), and the word of the excursion."""
    J[J_COST] += 1
    J[J_DOORS_HASH] = (J[J_DOORS_HASH] ^ W[i + 1]) * HASH_PRIME
    if J[J_LEGAL] == 0:
        return
    at = J[J_AT]
    v = W[VT + at]
    door = W[i + 1]
    if door < 0 or door >= W[DG + v]:
        J[J_LEGAL] = 0
        J[J_WRONG] |= 1
        return
    exit_dart = exit_of(W, at, door)
    at = W[AL + exit_dart]
    J[J_AT] = at
    J[J_CROSSED] |= 1 << min(at, exit_dart)
    J[J_FOLLOWED] += 1
    percept = shown(W, at)
    if W[i + 2] != percept:
        J[J_TRUE] = 0
        J[J_WRONG] |= 1
    # `Excursion.move`: going back by the dart of arrival cancels the last door.
    door += J[J_TURNED]
    if door >= W[DG + v]:
        door -= W[DG + v]
    size = J[J_WORD_SIZE]
    if door == 0 and size > 0:
        J[J_TURNED] = J[J_WORD_DOOR + size - 1]
        J[J_WORD_SIZE] = size - 1
    elif J[J_IS_LATE] == 0 and size >= JUDGE_STEPS:
        J[J_FULL] = 1
    elif J[J_IS_LATE] == 0:
        J[J_WORD_DOOR + size] = door
        J[J_WORD_PERCEPT + size] = percept
        J[J_WORD_SIZE] = size + 1
        J[J_TURNED] = 0


# ---------------------------------------------------------------- decisions


@inlined
def decide(W: Words, J: Words, i: int) -> None:
    """Judge a decision, and take note of it."""
    kind = W[i]
    e = W[i + 1]
    opened = is_open(J, e)
    truth = -1
    edge = -1
    if opened:
        truth = J[J_NUMBER + W[AL + J[J_PHI + e]]]
        edge = lesser(W, J[J_PHI + e])
    if kind == POSE:
        pose(W, J, i, edge, truth)
    elif kind == REJECT:
        h = W[i + 2]
        J[J_REJECTIONS] += 1
        if opened and truth >= 0 and truth == h:
            J[J_WRONG] |= 1 << 2
        if unjustified(W, J, i):
            J[J_WRONG] |= 1 << 7
        settle_hypothesis(J, edge, h)
        if W[i + 4] == BY_MOTION and J[J_WORD_SIZE] > 0:
            keep_sequence(J)
    elif kind == CONFIRM:
        h = W[i + 2]
        J[J_CONFIRMATIONS] += 1
        if truth < 0 or truth != h:
            J[J_WRONG] |= 1 << 3
        settle_hypothesis(J, edge, h)
    else:
        augment(W, J, i, edge, truth)


@inlined
def pose(W: Words, J: Words, i: int, edge: int, truth: int) -> None:
    """A set of hypotheses: claim 2."""
    e = W[i + 1]
    number = W[i + 2]
    J[J_POSED] += number
    J[J_POSE_AT] = i
    J[J_POSE_EDGE] = e
    J[J_TURNED] = 0
    J[J_WORD_SIZE] = 0
    J[J_FIRST_SEQUENCE] = J[J_SEQUENCES]
    wrong = edge < 0 or J[J_CROSSED] & (1 << edge) == 0
    J[J_IS_LATE] = edge < 0 or J[J_AT] != W[AL + J[J_PHI + e]]
    has_truth = truth < 0
    hypotheses = 0
    for k in range(i + 3, i + 3 + number):
        h = W[k]
        if not is_open(J, h):
            wrong = True
        if h == truth:
            has_truth = True
        if h < 0 or h >= JUDGE_DARTS - 2:
            J[J_FULL] = 1
        else:
            hypotheses |= 1 << h
    if wrong or not has_truth:
        J[J_WRONG] |= 1 << 1
    if edge >= 0:
        J[J_FATE + edge] = FATE_POSED
        J[J_LEFT + edge] |= hypotheses


@inlined
def settle_hypothesis(J: Words, edge: int, h: int) -> None:
    """A hypothesis behind an edge has its fate."""
    if edge >= 0 and 0 <= h < JUDGE_DARTS - 2:
        J[J_LEFT + edge] &= ~(1 << h)


@inlined
def augment(W: Words, J: Words, i: int, edge: int, truth: int) -> None:
    """S grows: claims 2, 3 and 5."""
    e = W[i + 1]
    is_new = W[i + 2] == NEW
    posed = J[J_POSE_AT] >= 0 and J[J_POSE_EDGE] == e
    J[J_AUGMENTATIONS] += 1
    if not posed:
        J[J_WRONG] |= 1 << 1
    if is_new and truth >= 0:
        J[J_WRONG] |= 1 << 2
    size = J[J_SIZE]
    if edge < 0:
        J[J_SPOILED] = 1
        return
    end = W[AL + J[J_PHI + e]]
    dart = size if truth < 0 else truth
    true_kind = is_new if truth < 0 else W[i + 2] == LOOP
    if not true_kind or W[i + 3] != dart or W[i + 4] != W[DG + W[VT + end]]:
        J[J_SPOILED] = 1
        return
    if posed:
        left = J[J_LEFT + edge] if is_new else 0
        if is_new:
            # Open when S grows: the darts that were open, and those that come with the new vertex.
            now_open = ((1 << (size + W[DG + W[VT + end]])) - 1) ^ ((1 << size) - 1)
            for d in range(size):
                if J[J_ALPHA + d] < 0:
                    now_open |= 1 << d
            left &= now_open
        J[J_LEFT + edge] = left
        J[J_FATE + edge] = FATE_NEW if is_new else FATE_LOOP
        if left != 0:
            J[J_WRONG] |= 1 << 2
    if is_new:
        draw_vertex(W, J, end)
    J[J_ALPHA + e] = dart
    J[J_ALPHA + dart] = e
    J[J_GROWN] |= 1 << edge
    if posed:
        record_sequences(W, J, dart)
    J[J_POSE_AT] = -1
    J[J_FIRST_SEQUENCE] = J[J_SEQUENCES]
