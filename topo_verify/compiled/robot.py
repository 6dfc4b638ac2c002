"""The robot: moves through the world of the workspace, counts, and writes down what happens.

Mirrors: robot/simulator.py, `SimulatedRobot`. Differs: the world's darts are numbered in the order
of discovery from the marker on, so a vertex is an interval of darts as on S, sigma is the next dart
of it, and the marker is dart 0. Where the reference raises, `STOP` is set and every caller returns.

Source: docs/semantics.md, section 2.
"""

from __future__ import annotations

from topo_verify.compiled.events import (
    AUGMENT,
    BY_MOTION,
    CONFIRM,
    MOVE,
    POSE,
    REJECT,
    REJECT_WORDS,
)
from topo_verify.compiled.kernel import Words, inlined, kernel
from topo_verify.compiled.workspace import *


@inlined
def sensed(W: Words, dart: int) -> int:
    """The percept with this dart of the world as the reference dart."""
    v = W[VT + dart]
    percept = W[DG + v] << SHIFT
    if v == 0:  # v0: from its dart d, dart 0 is -d doors further clockwise
        percept += 1
        if dart > 0:
            percept += W[DG] - dart
    return percept


@inlined
def move(W: Words, door: int, purpose: int) -> int:
    """Leave by a door and return the percept behind it. Costs 1. If it may not, `STOP` says why."""
    v = W[VT + W[POS]]
    degree = W[DG + v]
    if W[COST] >= W[BUDGET]:
        W[STOP] = STOP_BUDGET
        return 0
    if door < 0 or door >= degree:
        W[STOP] = STOP_DOOR
        return 0
    exit_dart = W[POS] + door
    if exit_dart >= W[ST + v] + degree:
        exit_dart -= degree
    dart = W[AL + exit_dart]
    W[POS] = dart
    W[COST] += 1
    percept = sensed(W, dart)
    declare(W, MOVE, door, percept, purpose)
    return percept


# ---------------------------------------------------------------- declarations


@kernel
def took(W: Words, words: int) -> int:
    """Take room for so many words of trace: where they begin. `STOP` is set if there is none."""
    i = W[NTR]
    if i + words > W[ROOM]:
        W[STOP] = STOP_FULL + FULL_TRACE
    else:
        W[NTR] = i + words
    return i


@inlined
def declare(W: Words, kind: int, first: int, second: int, third: int) -> None:
    """Write down an event of four words."""
    if W[TRACING] != 0:
        i = TR + took(W, 4)
        if W[STOP] == 0:
            W[i] = kind
            W[i + 1] = first
            W[i + 2] = second
            W[i + 3] = third


@kernel
def declare_pose(W: Words, e: int, remaining: int) -> None:
    """Put H on record: so many hypotheses, from REM on."""
    if W[TRACING] != 0:
        i = TR + took(W, 3 + remaining)
        if W[STOP] == 0:
            W[i] = POSE
            W[i + 1] = e
            W[i + 2] = remaining
            for k in range(remaining):
                W[i + 3 + k] = W[REM + k]


@kernel
def declare_reject(W: Words, e: int, h: int, by: int) -> None:
    """Put on record that h is rejected, with the evidence in EV_…; by motion: at a step of it."""
    if W[TRACING] != 0:
        step = W[EV_STEP]
        doors = 0
        if W[EV_RECORD] >= 0:
            doors = step - W[EV_FIRST]
        i = TR + took(W, REJECT_WORDS + doors)
        if W[STOP] == 0:
            W[i] = REJECT
            W[i + 1] = e
            W[i + 2] = h
            W[i + 3] = REJECT_WORDS + doors
            W[i + 4] = by
            W[i + 5] = step
            W[i + 6] = W[EV_EXPECTED]
            W[i + 7] = W[EV_OBSERVED]
            W[i + 8] = -1 if by == BY_MOTION or W[EV_WRONG] != 0 else W[NSEQ] - 1
            W[i + 9] = W[EV_AT]
            W[i + 10] = W[EV_RECORD]
            W[i + 11] = W[EV_WRONG]
            W[i + 12] = doors
            for k in range(doors):
                W[i + 13 + k] = W[DOORS + W[EV_FIRST] + k]


@kernel
def declare_confirm(W: Words, e: int, h: int, by: int) -> None:
    """Put on record that the other end of e is h."""
    declare(W, CONFIRM, e, h, by)


@kernel
def declare_augment(W: Words, e: int, kind: int, dart: int, degree: int) -> None:
    """Put on record that S has grown."""
    if W[TRACING] != 0:
        i = TR + took(W, 5)
        if W[STOP] == 0:
            W[i] = AUGMENT
            W[i + 1] = e
            W[i + 2] = kind
            W[i + 3] = dart
            W[i + 4] = degree
