"""Enhancement II: every sequence executed for this edge, traced on S (rule `history`).

Mirrors: algorithms/enhancement_ii.py, `HistoryRule`, and, where tracing leaves S, `beyond` of
algorithms/enhancement_iii.py. Differs: the last sequence is the excursion itself, since the robot
stands where it ended.

Source: section III-B of the paper.
"""

from __future__ import annotations

from topo_verify.compiled.chart import turn
from topo_verify.compiled.faults import (
    TAKES_UNKNOWN_FOR_A_MISMATCH,
    TRACES_FROM_THE_FIRST_DART,
    TRACES_THROUGH_THE_UNEXPLORED,
    planted,
)
from topo_verify.compiled.kernel import Words, kernel
from topo_verify.compiled.prefix import cite
from topo_verify.compiled.records import beyond
from topo_verify.compiled.workspace import CA, CF, CP, CV, DOORS, NDOORS, PP, RULE, RULE_ONE


@kernel
def refute_by_history(W: Words, h: int) -> bool:
    """Whether S (and T) shows another percept where the sequence leads from h; the first is cited.

    Earlier sequences were traced when they were executed, and S has not changed since.
    """
    at = h  # A3.10
    if planted(W, TRACES_FROM_THE_FIRST_DART):
        at = W[CF + W[CV + h]]
    for step in range(1, W[NDOORS] + 1):
        exit_dart = turn(W, at, W[DOORS + step - 1])
        # Negative also for e and h, which are joined only when h is confirmed.
        at = W[CA + exit_dart]  # A3.11
        if at < 0:
            if planted(W, TAKES_UNKNOWN_FOR_A_MISMATCH):
                return cite(W, step, W[PP + step], exit_dart)
            if planted(W, TRACES_THROUGH_THE_UNEXPLORED):
                at = exit_dart
            else:
                return W[RULE] >= RULE_ONE and beyond(W, exit_dart, step)  # A3.13
        if W[CP + at] != W[PP + step]:  # A3.12 A3.15
            return cite(W, step, W[CP + at], at)
    return False
