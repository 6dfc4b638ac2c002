"""Enhancement I, stage 1: what was seen on the common prefix of doors (rule `prefix`).

Mirrors: algorithms/enhancement_i.py, `PrefixRule`. Differs: the last sequence is the excursion
itself, since the robot stands where it ended.

Source: section III-A of the paper; listing 2, lines 16-19.
"""

from __future__ import annotations

from topo_verify.compiled.chart import door
from topo_verify.compiled.faults import COMPARES_BEFORE_THE_DOOR, planted
from topo_verify.compiled.kernel import Words, kernel
from topo_verify.compiled.workspace import (
    CA,
    CP,
    CV,
    DOORS,
    EV_AT,
    EV_EXPECTED,
    EV_RECORD,
    EV_STEP,
    EV_WRONG,
    NDOORS,
    PAR,
    PP,
)


@kernel
def cite(W: Words, step: int, expected: int, at: int) -> bool:
    """Note the evidence for a rejection without motion. True, so that a rule may return it."""
    W[EV_STEP] = step
    W[EV_EXPECTED] = expected
    W[EV_AT] = at
    W[EV_RECORD] = -1
    W[EV_WRONG] = 0
    return True


@kernel
def refute_by_prefix(W: Words, h: int) -> bool:
    """Whether a percept on the common prefix is not what h expects; the first one is cited."""
    at = h
    for step in range(1, W[NDOORS] + 1):
        up = W[PAR + W[CV + at]]
        if up < 0 or door(W, at, up) != W[DOORS + step - 1]:  # A2.17
            return False
        at = W[CA + up]
        late = 1 if planted(W, COMPARES_BEFORE_THE_DOOR) else 0
        if W[PP + step - late] != W[CP + at]:  # A2.18
            return cite(W, step, W[CP + at], at)
    return False
