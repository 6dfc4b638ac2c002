"""Runs algorithms in every world of a rank range, judges each run, and counts the verdicts.

Twin of `Counts` in campaign/tally.py. Differs: each algorithm has its row; ranks are kept, no
findings. An open verdict interrupts the walk: Python has the checkers judge the run, and
`enter_open` counts it. The walk also pauses after any number of worlds.
"""

from __future__ import annotations

from typing import Annotated

from topo_verify.extra.fast.kernels.enumeration import next_world
from topo_verify.extra.fast.kernels.exploration import explore
from topo_verify.extra.fast.kernels.judging.layout import *
from topo_verify.extra.fast.kernels.judging.verdict import judge
from topo_verify.extra.fast.kernels.kernel import entry, kernel
from topo_verify.extra.fast.kernels.names import Fields, Words, WordView, cursor
from topo_verify.extra.fast.kernels.native import explore_native
from topo_verify.extra.fast.kernels.workspace import *

KEPT_RANKS = 10
"""The most ranks kept of each kind: failing, most expensive, more expensive than the other."""

STATUS_COUNT = 5

PerKeptRank = Annotated[Words, "KEPT_RANKS"]
PerStatus = Annotated[Words, "STATUSES"]


class TableWords(WordView):
    letter = "T"


@cursor("T", {"KEPT_RANKS": KEPT_RANKS, "CLAIM_COUNT": CLAIM_COUNT, "STATUSES": 5 * CLAIM_COUNT})
class CountWords(WordView):
    rule: int
    motion: int
    fault: int
    worlds: int
    failing: int
    total: int
    most: int
    attained: int
    digest: int
    cost: int  # in the last world; -1 if a claim fails there
    worst: PerKeptRank
    failing_ranks: PerKeptRank
    claim_failing: PerClaim
    claim_first: PerClaim
    # worlds in which this row is the first that fails
    newly_failing: int
    claim_newly_failing: PerClaim
    status: PerStatus  # k * STATUS_COUNT + status
    judged: PerClaim
    of: PerClaim
    more: int  # worlds in which the first of two rows costs more
    less: int
    excess: int
    more_ranks: PerKeptRank
    more_costs: PerKeptRank
    more_others: PerKeptRank


COLUMNS = CountWords.extent


class ControlWords(WordView):
    """What is asked of a walk, and where it stands."""

    level: int
    stop_at_first: int
    pause: int  # worlds until the pause; 0: none
    rank: int
    row: int
    failed: int  # mask of claims that fail in an earlier row


CONTROL = Fields("C", ControlWords, {})


GO_ON, ENDED, OPEN, PAUSED = range(4)
"""The states of a walk: between two worlds; at its end; at a run whose verdict is open; paused."""

MIXED = 0x9E3779B97F4A7C15 - (1 << 64)


@entry
def examine_worlds(
    run: RunWords,
    walk: WalkWords,
    case: CaseWords,
    control: ControlWords,
    table: TableWords,
    rows: int,
) -> int:
    """Examine worlds: `ENDED`, `PAUSED`, or `OPEN` at row `row` of the last one."""
    state = GO_ON
    while state == GO_ON:
        if control.row == 0:
            rank = next_world(run.world, walk)
            if rank < 0:
                return ENDED
            control.rank = rank
            run.native.rank = rank
            control.failed = 0
        while control.row < rows:
            at = control.row * COLUMNS
            counts = CountWords(table, at)
            wrong = examine_run(
                run, walk, case, control.level, counts.rule, counts.motion, counts.fault
            )
            if wrong < 0:
                return OPEN
            enter(case, control, table, wrong)
            control.row += 1
        state = close(control, table, rows)
    return state


@kernel
def examine_run(
    run: RunWords, walk: WalkWords, case: CaseWords, level: int, rule: int, motion: int, fault: int
) -> int:
    """Run and judge one algorithm: a mask of the failing claims; -1: open."""
    task = run.task
    edges = walk.darts // 2
    vertices = walk.vertices
    bound = edges
    if vertices > 1:
        bound = edges * (vertices + (2 * edges - 1) * 2 * (vertices - 1))
    task.rule = rule
    task.motion = motion
    task.fault = fault
    task.budget = bound
    task.tracing = 1
    if rule == RULE_NATIVE:
        cost = explore_native(run, walk.darts, vertices)
        reported = run.native.reported
    else:
        cost = explore(run)
        reported = cost
    case.darts = walk.darts
    case.vertices = vertices
    case.bound = bound
    case.level = level
    case.delivered = 0 if cost < 0 else 1
    case.reported = reported
    wrong = judge(run, case)
    if wrong >= 0 and run.stop >= STOP_SKIP:
        wrong = -1  # declined, or without room
    return wrong


@kernel
def enter(case: CaseWords, control: ControlWords, table: TableWords, wrong: int) -> None:
    at = control.row * COLUMNS
    counts = CountWords(table, at)
    rank = control.rank
    cost = case.cost
    counts.worlds += 1
    digest = (case.doors_hash ^ cost) * MIXED
    for k in range(case.level):
        status = case.status[k]
        counts.status[k * STATUS_COUNT + status] += 1
        counts.judged[k] += case.judged[k]
        counts.of[k] += case.of[k]
        digest = (digest ^ status) * 1099511628211
        if (wrong >> k) & 1 != 0:
            if counts.claim_failing[k] == 0:
                counts.claim_first[k] = rank
            counts.claim_failing[k] += 1
            if (control.failed >> k) & 1 == 0:
                counts.claim_newly_failing[k] += 1
    digest = (digest ^ rank) * MIXED
    counts.digest += digest ^ ((digest >> 31) & 0x1FFFFFFFF)
    counts.cost = -1
    if wrong != 0:
        if counts.failing < KEPT_RANKS:
            counts.failing_ranks[counts.failing] = rank
        counts.failing += 1
        if control.failed == 0:
            counts.newly_failing += 1
        control.failed |= wrong
        return
    counts.cost = cost
    counts.total += cost
    if cost > counts.most:
        counts.most = cost
        counts.attained = 0
    if cost == counts.most:
        if counts.attained < KEPT_RANKS:
            counts.worst[counts.attained] = rank
        counts.attained += 1


@kernel
def close(control: ControlWords, table: TableWords, rows: int) -> int:
    """Close the world: `GO_ON`, `ENDED` or `PAUSED`."""
    control.row = 0
    if rows == 2:
        compare_costs(table, control.rank)
    if control.stop_at_first != 0:
        for row in range(rows):
            at = row * COLUMNS
            if CountWords(table, at).failing > 0:
                return ENDED
    control.pause -= 1
    return PAUSED if control.pause == 0 else GO_ON


@kernel
def compare_costs(table: TableWords, rank: int) -> None:
    first, second = 0, COLUMNS
    counts = CountWords(table, first)
    cost = counts.cost
    other = CountWords(table, second).cost
    if cost < 0 or other < 0 or cost == other:
        return
    if cost < other:
        counts.less += 1
        return
    if counts.more < KEPT_RANKS:
        counts.more_ranks[counts.more] = rank
        counts.more_costs[counts.more] = cost
        counts.more_others[counts.more] = other
    counts.more += 1
    counts.excess = max(counts.excess, cost - other)


@entry
def enter_open(case: CaseWords, control: ControlWords, table: TableWords, rows: int) -> int:
    """Count a run that the checkers judged; return the state of the walk."""
    wrong = 0
    for k in range(case.level):
        if case.status[k] == FAILED:
            wrong |= 1 << k
    enter(case, control, table, wrong)
    control.row += 1
    return GO_ON if control.row < rows else close(control, table, rows)
