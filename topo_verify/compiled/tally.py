"""Runs algorithms in every world of a rank range, judges each run, and counts what came of it.

`T` has one row for each algorithm: what it is, and its counts. `task.room` says how long a trace
may be.

Mirrors `Counts` in campaign/tally.py. Differs: each algorithm is counted in its own row; ranks are
kept, no findings. A run whose verdict is open interrupts the walk, so that Python has the checkers
judge it and `enter_open` count it. The walk also pauses behind as many worlds as Python asks for,
and then goes on in the same table: so Python sees what single worlds add to it.
"""

from __future__ import annotations

from topo_verify.compiled.enumeration import next_world
from topo_verify.compiled.exploration import explore
from topo_verify.compiled.judging.layout import *
from topo_verify.compiled.judging.verdict import is_world, judge
from topo_verify.compiled.kernel import WordTable, entry, kernel
from topo_verify.compiled.names import Fields, WordView
from topo_verify.compiled.native import explore_native
from topo_verify.compiled.workspace import *

_used = 0


def _column(size: int = 1) -> int:
    """The next column, or so many side by side."""
    global _used  # noqa: PLW0603  the layout is made once, when the module is loaded
    place = _used
    _used += size
    return place


KEPT_RANKS = 10
"""So many ranks are kept of failing worlds, of the dearest, and of those dearer than another."""

STATUS_COUNT = 5

T_RULE = _column()
T_MOTION = _column()
T_FAULT = _column()
T_WORLDS = _column()
T_FAILING = _column()
T_TOTAL = _column()
T_MOST = _column()
T_ATTAINED = _column()
T_DIGEST = _column()
T_COST = _column()
"""Of the last world: the cost; -1 if a claim fails."""
T_WORST = _column(KEPT_RANKS)
T_FAILING_RANKS = _column(KEPT_RANKS)
T_CLAIM_FAILING = _column(CLAIM_COUNT)
T_CLAIM_FIRST = _column(CLAIM_COUNT)
T_NEWLY_FAILING = _column()
"""In how many worlds this row is the first that fails; so the rows' sum counts no world twice."""
T_CLAIM_NEWLY_FAILING = _column(CLAIM_COUNT)
T_STATUS = _column(CLAIM_COUNT * STATUS_COUNT)
T_JUDGED = _column(CLAIM_COUNT)
T_OF = _column(CLAIM_COUNT)
T_DEARER = _column()
"""In the first row, if there are two: in how many worlds the first costs more than the second."""
T_CHEAPER = _column()
T_EXCESS = _column()
T_DEARER_RANKS = _column(KEPT_RANKS)
T_DEARER_COSTS = _column(KEPT_RANKS)
T_DEARER_OTHERS = _column(KEPT_RANKS)
T_COLUMNS = _used


class ControlWords(WordView):
    """What is asked of a walk, and where it stands."""

    level: int  # of the judge
    stop_at_first: int  # whether the first failing world ends the walk
    pause: int  # worlds until the next pause; 0: no pause
    rank: int  # of the world that lies in the workspace
    row: int  # that is next there; 0: the next world
    failed: int  # a mask of the claims that fail there in a row before


CONTROL = Fields("C", ControlWords, {})


GO_ON, ENDED, OPEN, PAUSED = range(4)
"""The states of a walk: between two worlds; at its end; at a run whose verdict is open; paused."""

MIXED = 0x9E3779B97F4A7C15 - (1 << 64)


@entry
def examine_worlds(
    run: RunWords, walk: WalkWords, case: CaseWords, control: ControlWords, T: WordTable, rows: int
) -> int:
    """Examine the worlds to come: `ENDED`, `PAUSED`, or `OPEN` at row `row` of the last one."""
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
            row = control.row
            wrong = examine_run(
                run, walk, case, control.level, T[row, T_RULE], T[row, T_MOTION], T[row, T_FAULT]
            )
            if wrong < 0:
                return OPEN
            enter(case, control, T, wrong)
            control.row = row + 1
        state = close(control, T, rows)
    return state


@kernel
def examine_run(
    run: RunWords, walk: WalkWords, case: CaseWords, level: int, rule: int, motion: int, fault: int
) -> int:
    """Run one algorithm in the world, and judge it: a mask of the claims that fail; -1: open."""
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
        wrong = -1  # the mapper declined the world, or had no room: that convicts nobody
    return wrong


@kernel
def enter(case: CaseWords, control: ControlWords, T: WordTable, wrong: int) -> None:
    """Count a judged run in its row."""
    row = control.row
    rank = control.rank
    cost = case.cost
    T[row, T_WORLDS] += 1
    digest = (case.doors_hash ^ cost) * MIXED
    for k in range(case.level):
        status = case.status[k]
        T[row, T_STATUS + k * STATUS_COUNT + status] += 1
        T[row, T_JUDGED + k] += case.judged[k]
        T[row, T_OF + k] += case.of[k]
        digest = (digest ^ status) * 1099511628211
        if (wrong >> k) & 1 != 0:
            if T[row, T_CLAIM_FAILING + k] == 0:
                T[row, T_CLAIM_FIRST + k] = rank
            T[row, T_CLAIM_FAILING + k] += 1
            if (control.failed >> k) & 1 == 0:
                T[row, T_CLAIM_NEWLY_FAILING + k] += 1
    digest = (digest ^ rank) * MIXED
    T[row, T_DIGEST] += digest ^ ((digest >> 31) & 0x1FFFFFFFF)
    T[row, T_COST] = -1
    if wrong != 0:
        if T[row, T_FAILING] < KEPT_RANKS:
            T[row, T_FAILING_RANKS + T[row, T_FAILING]] = rank
        T[row, T_FAILING] += 1
        if control.failed == 0:
            T[row, T_NEWLY_FAILING] += 1
        control.failed |= wrong
        return
    T[row, T_COST] = cost
    T[row, T_TOTAL] += cost
    if cost > T[row, T_MOST]:
        T[row, T_MOST] = cost
        T[row, T_ATTAINED] = 0
    if cost == T[row, T_MOST]:
        if T[row, T_ATTAINED] < KEPT_RANKS:
            T[row, T_WORST + T[row, T_ATTAINED]] = rank
        T[row, T_ATTAINED] += 1


@kernel
def close(control: ControlWords, T: WordTable, rows: int) -> int:
    """Close the world, as all its runs are counted: `GO_ON`, `ENDED` or `PAUSED`."""
    control.row = 0
    if rows == 2:
        compare_costs(T, control.rank)
    if control.stop_at_first != 0:
        for row in range(rows):
            if T[row, T_FAILING] > 0:
                return ENDED
    control.pause -= 1
    return PAUSED if control.pause == 0 else GO_ON


@kernel
def compare_costs(T: WordTable, rank: int) -> None:
    """Compare what the two algorithms paid in the last world, if no claim fails."""
    cost = T[0, T_COST]
    other = T[1, T_COST]
    if cost < 0 or other < 0 or cost == other:
        return
    if cost < other:
        T[0, T_CHEAPER] += 1
        return
    if T[0, T_DEARER] < KEPT_RANKS:
        T[0, T_DEARER_RANKS + T[0, T_DEARER]] = rank
        T[0, T_DEARER_COSTS + T[0, T_DEARER]] = cost
        T[0, T_DEARER_OTHERS + T[0, T_DEARER]] = other
    T[0, T_DEARER] += 1
    T[0, T_EXCESS] = max(T[0, T_EXCESS], cost - other)


@entry
def enter_open(case: CaseWords, control: ControlWords, T: WordTable, rows: int) -> int:
    """Count a run that the checkers judged: the state of the walk behind it."""
    wrong = 0
    for k in range(case.level):
        if case.status[k] == FAILED:
            wrong |= 1 << k
    enter(case, control, T, wrong)
    control.row += 1
    return GO_ON if control.row < rows else close(control, T, rows)


@entry
def map_worlds(
    run: RunWords, walk: WalkWords, case: CaseWords, rule: int, motion: int, check: int
) -> int:
    """The total cost of an algorithm in the worlds to come, without a trace; -1: a map is wrong.

    Args:
        check: whether the delivered map is compared with the world.
    """
    task = run.task
    total = 0
    task.rule = rule
    task.motion = motion
    task.tracing = 0
    task.fault = 0
    m = walk.darts // 2
    while next_world(run.world, walk) >= 0:
        task.budget = m * (walk.vertices + (2 * m - 1) * 2 * walk.vertices)
        cost = explore(run)
        if cost < 0:
            return -1
        total += cost
        if check != 0:
            case.darts = 2 * m
            case.vertices = walk.vertices
            if not is_world(run, case):
                return -1
    return total
