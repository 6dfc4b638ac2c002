"""Runs algorithms in every world of a rank range, judges each run, and counts what came of it.

`T` has one row for each algorithm: what it is, and its counts. `ROOM` says how long a trace may be.
Mirrors `Counts` in campaign/tally.py.
Differs: each algorithm is counted in its own row; ranks are kept, no findings. A run whose verdict
is open interrupts the walk, so that Python has the checkers judge it and `enter_open` count it. The
walk also pauses behind as many worlds as Python asks for, and then goes on in the same table: so
Python sees what single worlds add to it.
"""

from __future__ import annotations

from topo_verify.compiled.enumeration import next_world
from topo_verify.compiled.exploration import explore
from topo_verify.compiled.growth import G_DARTS, G_VERTICES
from topo_verify.compiled.judging.layout import *
from topo_verify.compiled.judging.verdict import is_world, judge
from topo_verify.compiled.kernel import Words, WordTable, entry, kernel
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

C_LEVEL, C_STOP_AT_FIRST, C_PAUSE, C_RANK, C_ROW, C_FAILED, C_SIZE = range(7)
"""The places of `C`: the level of the judge; whether the first failing world ends the walk; the
number of worlds until the next pause (0: no pause); the rank of the world that lies in W, the row
that is next there (0: the next world), and a mask of the claims that fail there in a row before."""

GO_ON, ENDED, OPEN, PAUSED = range(4)
"""The states of a walk: between two worlds; at its end; at a run whose verdict is open; paused."""

MIXED = 0x9E3779B97F4A7C15 - (1 << 64)


@entry
def examine_worlds(W: Words, G: Words, J: Words, C: Words, T: WordTable, rows: int) -> int:
    """Examine the worlds to come: `ENDED`, `PAUSED`, or `OPEN` at row `C_ROW` of the last one."""
    state = GO_ON
    while state == GO_ON:
        if C[C_ROW] == 0:
            rank = next_world(W, G)
            if rank < 0:
                return ENDED
            C[C_RANK] = rank
            C[C_FAILED] = 0
        while C[C_ROW] < rows:
            row = C[C_ROW]
            wrong = examine_run(
                W, G, J, C[C_LEVEL], T[row, T_RULE], T[row, T_MOTION], T[row, T_FAULT]
            )
            if wrong < 0:
                return OPEN
            enter(J, C, T, wrong)
            C[C_ROW] = row + 1
        state = close(C, T, rows)
    return state


@kernel
def examine_run(
    W: Words, G: Words, J: Words, level: int, rule: int, motion: int, fault: int
) -> int:
    """Run one algorithm in the world, and judge it: a mask of the claims that fail; -1: open."""
    edges = G[G_DARTS] // 2
    vertices = G[G_VERTICES]
    bound = edges
    if vertices > 1:
        bound = edges * (vertices + (2 * edges - 1) * 2 * (vertices - 1))
    W[RULE] = rule
    W[MOTION] = motion
    W[FAULT] = fault
    W[BUDGET] = bound
    W[TRACING] = 1
    cost = explore(W)
    J[J_DARTS] = G[G_DARTS]
    J[J_VERTICES] = vertices
    J[J_BOUND] = bound
    J[J_LEVEL] = level
    J[J_DELIVERED] = 0 if cost < 0 else 1
    J[J_REPORTED] = cost
    wrong = judge(W, J)
    if wrong >= 0 and W[STOP] >= STOP_FULL:
        wrong = -1  # the mapper had no room: that convicts nobody
    return wrong


@kernel
def enter(J: Words, C: Words, T: WordTable, wrong: int) -> None:
    """Count a judged run in its row."""
    row = C[C_ROW]
    rank = C[C_RANK]
    cost = J[J_COST]
    T[row, T_WORLDS] += 1
    digest = (J[J_DOORS_HASH] ^ cost) * MIXED
    for k in range(J[J_LEVEL]):
        status = J[J_STATUS + k]
        T[row, T_STATUS + k * STATUS_COUNT + status] += 1
        T[row, T_JUDGED + k] += J[J_JUDGED + k]
        T[row, T_OF + k] += J[J_OF + k]
        digest = (digest ^ status) * 1099511628211
        if (wrong >> k) & 1 != 0:
            if T[row, T_CLAIM_FAILING + k] == 0:
                T[row, T_CLAIM_FIRST + k] = rank
            T[row, T_CLAIM_FAILING + k] += 1
            if (C[C_FAILED] >> k) & 1 == 0:
                T[row, T_CLAIM_NEWLY_FAILING + k] += 1
    digest = (digest ^ rank) * MIXED
    T[row, T_DIGEST] += digest ^ ((digest >> 31) & 0x1FFFFFFFF)
    T[row, T_COST] = -1
    if wrong != 0:
        if T[row, T_FAILING] < KEPT_RANKS:
            T[row, T_FAILING_RANKS + T[row, T_FAILING]] = rank
        T[row, T_FAILING] += 1
        if C[C_FAILED] == 0:
            T[row, T_NEWLY_FAILING] += 1
        C[C_FAILED] |= wrong
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
def close(C: Words, T: WordTable, rows: int) -> int:
    """Close the world, as all its runs are counted: `GO_ON`, `ENDED` or `PAUSED`."""
    C[C_ROW] = 0
    if rows == 2:
        compare_costs(T, C[C_RANK])
    if C[C_STOP_AT_FIRST] != 0:
        for row in range(rows):
            if T[row, T_FAILING] > 0:
                return ENDED
    C[C_PAUSE] -= 1
    return PAUSED if C[C_PAUSE] == 0 else GO_ON


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
def enter_open(J: Words, C: Words, T: WordTable, rows: int) -> int:
    """Count a run that the checkers judged, its verdict in J: the state of the walk behind it."""
    wrong = 0
    for k in range(J[J_LEVEL]):
        if J[J_STATUS + k] == FAILED:
            wrong |= 1 << k
    enter(J, C, T, wrong)
    C[C_ROW] += 1
    return GO_ON if C[C_ROW] < rows else close(C, T, rows)


@entry
def map_worlds(W: Words, G: Words, J: Words, rule: int, motion: int, check: int) -> int:
    """The total cost of an algorithm in the worlds to come, without a trace; -1: a map is wrong.

    Args:
        check: whether the delivered map is compared with the world.
    """
    total = 0
    W[RULE] = rule
    W[MOTION] = motion
    W[TRACING] = 0
    W[FAULT] = 0
    m = G[G_DARTS] // 2
    while next_world(W, G) >= 0:
        W[BUDGET] = m * (G[G_VERTICES] + (2 * m - 1) * 2 * G[G_VERTICES])
        cost = explore(W)
        if cost < 0:
            return -1
        total += cost
        if check != 0:
            J[J_DARTS] = 2 * m
            J[J_VERTICES] = G[G_VERTICES]
            if not is_world(W, J):
                return -1
    return total
