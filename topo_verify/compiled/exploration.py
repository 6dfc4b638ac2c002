"""The exploration loop, which listings 1, 2 and 3 of the paper share.

    the paper's name   here
    S, U               the fields of chart.py
    e = (vk, vu)       e: the dart that leaves vk
    e', e''            h: a hypothesis, the dart by which vu would have been entered
    H                  REM, in the order of the order policy, and how many there are
    PE, P              CP of the arrivals, PP

Mirrors: algorithms/exploration.py, line by line. Differs: H is a row of darts; rules without memory
of places are not asked before the first motion, since only `folding` and `planar` can reject there.
A number selects the rule, because a kernel that is handed a function is compiled anew in every
process.
Wherever the reference may raise, this looks at `STOP` and returns.

Source: as the reference.
"""

from __future__ import annotations

from topo_verify.compiled.chart import (
    add_vertex,
    door,
    join,
    leave_u,
    start_chart,
    tree_of_v0,
    turn,
)
from topo_verify.compiled.events import (
    BY_FOLDING,
    BY_HISTORY,
    BY_MOTION,
    BY_PLANAR,
    BY_PREFIX,
    BY_RECORDS,
    LOOP,
    NEW,
)
from topo_verify.compiled.evidence import (
    cite,
    face,
    learn_records,
    observe_sequence,
    refute_by_face,
    refute_by_history,
    refute_by_prefix,
)
from topo_verify.compiled.faults import *
from topo_verify.compiled.folding import (
    arrive_fold,
    conclude,
    learn_fold,
    observe_fold,
    refute_by_folding,
    start_fold,
)
from topo_verify.compiled.kernel import Words, entry, inlined, kernel
from topo_verify.compiled.motion import back, choice, cross, forward, nearest, shortest, walk
from topo_verify.compiled.robot import (
    declare_augment,
    declare_confirm,
    declare_pose,
    declare_reject,
    sensed,
)
from topo_verify.compiled.workspace import *


@kernel
def explore(W: Words) -> int:
    """Map the world of the workspace: the cost in edge traversals; -1: `STOP` says why it ended."""
    at = start(W)
    while W[NU] > 0 and W[STOP] == 0:  # A1.3 A2.3 A3.4
        at = settle(W, at)
    return W[COST] if W[STOP] == 0 else -1  # A1.20 A2.28 A3.30


@entry
def explore_rounds(W: Words, at: int, rounds: int) -> int:
    """Part of `explore`: so many rounds of its loop, so that the caller may stop in between.

    Args:
        at: what the part before returned; -1: there was none.
    Returns:
        The robot's reference dart on S. The run is over when U is empty or `STOP` is set.
    """
    if at < 0:
        at = start(W)
    while rounds > 0 and W[NU] > 0 and W[STOP] == 0:
        at = settle(W, at)
        rounds -= 1
    return at


@kernel
def start(W: Words) -> int:
    """Stand at the marker with S as it is there: v0 alone. Returns the reference dart, on S."""
    W[POS] = 0
    W[COST] = 0
    W[STOP] = 0
    W[NTR] = 0
    start_chart(W, sensed(W, 0))  # A1.1 A1.2 A2.1 A2.2 A3.1 A3.2
    start_rule(W)
    return 0


@inlined
def settle(W: Words, at: int) -> int:
    """Explore one edge: one round of the loop. Returns the robot's reference dart on S."""
    e = nearest(W, at)  # A1.4 A2.4 A3.5
    # e leaves U before H is made, since no edge ends in its own dart; `join` explores it later.
    leave_u(W, e)
    at = walk(W, at, W[CV + e])  # A1.5 A2.5 A3.6
    if W[STOP] != 0:
        return 0
    percept = cross(W, at, e)
    if W[STOP] != 0:
        return 0
    W[NSEQ] = 0
    W[NSTEPS] = 0
    remaining = hypotheses(W, e, percept)  # A1.6 A2.6 A3.7
    declare_pose(W, e, remaining)
    arrive(W, e, percept)
    h = validate(W, e, remaining)
    if W[STOP] != 0:
        return 0
    if h >= 0:  # A1.16 A2.24 A3.25
        # Declared where the robot stands: only `localise` walks it back, if at all.
        join(W, e, h)  # loop augmentation: A1.17 A2.25 A3.26
        declare_augment(W, e, LOOP, h, percept >> SHIFT)
        entered = h
    else:  # A1.18 A2.26 A3.27
        back(W, 0)  # the last hypothesis' way: A1.15 A3.24
        if W[STOP] != 0:
            return 0
        entered = add_vertex(W, percept)
        if W[STOP] != 0:
            return 0
        join(W, e, entered)  # non-loop augmentation: A1.19 A2.27 A3.28
        declare_augment(W, e, NEW, entered, percept >> SHIFT)
    learn(W, e, entered, h < 0)
    if W[STOP] != 0:  # a walk back that the budget ends would hide the reason
        return 0
    return localise(W, entered)


@inlined
def hypotheses(W: Words, e: int, percept: int) -> int:
    """H: the unexplored darts at vertices that look like vu, in the order in which to try them."""
    signature = 2 * (percept >> SHIFT) + ((percept & MASK) > 0)
    number = 0
    for v in range(W[NV]):
        if W[SG + v] == signature and W[UO + v] > 0:
            if planted(W, LEAVES_OUT_THE_DARTS_OF_VK) and v == W[CV + e]:
                continue
            if planted(W, LEAVES_OUT_THE_DARTS_OF_V0) and v == 0:
                continue
            for dart in range(W[CF + v], W[CF + v] + W[CD + v]):
                if W[UN + dart] != 0:
                    W[REM + number] = dart
                    number += 1
    if number > 0:
        # One tree serves all hypotheses, because S does not change while e is validated.
        tree_of_v0(W)
        shortest(W, number)
    if planted(W, TRIES_ONLY_THE_NEAREST_TWO) and number > 2:
        number = 2
    return number


@inlined
def validate(W: Words, e: int, remaining: int) -> int:
    """The hypothesis that is confirmed, or -1 if all are rejected."""
    if W[RULE] >= RULE_FOLDING:
        # Before any motion: with no sequence yet, only `folding` and `planar` can reject.
        remaining = sift(W, e, remaining)
    while remaining > 0 and W[STOP] == 0:  # A1.7 A2.10 A2.20 A2.21 A3.8
        h = concluded(W, remaining)
        if h >= 0:
            declare_confirm(W, e, h, BY_FOLDING)
            return h
        chosen = choice(W, remaining)
        h = W[REM + chosen]
        remaining -= 1
        for i in range(chosen, remaining):  # A1.8 A2.7 A3.9
            W[REM + i] = W[REM + i + 1]
        step = execute(W, h, W[SHARED])
        if W[STOP] != 0:
            break
        if step < 0:  # A1.12 A2.12 A3.21
            declare_confirm(W, e, h, BY_MOTION)  # A1.13 A2.13 A3.22
            return h
        # The percepts differ: A1.14 A2.14 A3.23. The robot stays: A2.15.
        declare_reject(W, e, h, BY_MOTION)
        if W[NDOORS] == 0:  # vu shows the marker: nothing was executed that a rule could use
            continue
        W[NSEQ] += 1
        if W[RULE] != RULE_NONE:
            observe(W)
            remaining = sift(W, e, remaining)
    return -1


@kernel
def concluded(W: Words, remaining: int) -> int:
    """The hypothesis that must be true because no alternative is left; -1: there is one."""
    if W[RULE] >= RULE_FOLDING:
        return conclude(W, remaining)
    if planted(W, CONFIRMS_WHAT_IS_ALONE) and remaining == 1:
        return W[REM]
    return -1


@kernel
def sift(W: Words, e: int, remaining: int) -> int:
    """Keep the hypotheses that the rule does not refute, in their order. Returns how many."""
    kept = 0
    for i in range(remaining):  # A2.16
        h = W[REM + i]
        by = refute(W, h)
        if W[STOP] != 0:
            return 0
        if by == 0:
            W[REM + kept] = h
            kept += 1  # A3.17
        else:
            declare_reject(W, e, h, by)  # A2.19 A3.16
    return kept


@inlined
def execute(W: Words, h: int, shared: int) -> int:
    """Walk the hypothesis' way home. Returns the first step whose percept differs; -1 if none.

    Args:
        shared: how many doors the way shares with the last sequence; the robot goes back only so
            far and does not walk them again.
    """
    length = W[DEP + W[CV + h]]
    if shared < length:  # else its whole way is executed already: no motion
        back(W, shared)  # A1.15 A2.23 A3.24
        if W[STOP] != 0:
            return 0
    at = h
    step = 0
    while True:  # A1.9 A1.10 A2.8 A2.9 A3.18 A3.19
        # What is shared is not walked again, but compared it is: the robot has seen those percepts.
        if W[PP + step] != W[CP + at]:  # A1.11 A2.11 A3.20
            if overlooked(W, at, step, length):
                return -1
            cite(W, step, W[CP + at], W[PP + step], -1)
            return step
        up = W[PAR + W[CV + at]]
        if up < 0:
            return -1
        step += 1
        if step > W[NDOORS]:
            forward(W, door(W, at, up))
            if W[STOP] != 0:
                return 0
        at = W[CA + up]


@kernel
def overlooked(W: Words, at: int, step: int, length: int) -> bool:
    """Whether a planted mistake takes this mismatch for none: the marker is seen, turned."""
    alike = W[SG + W[CV + at]] == 2 * (W[PP + step] >> SHIFT) + ((W[PP + step] & MASK) > 0)
    if planted(W, IGNORES_DIRECTION_AT_THE_END) and step > 0:
        return step == length and alike
    if planted(W, IGNORES_DIRECTION_BEHIND_E) and step == 0:
        return length == 0 and alike
    return False


@inlined
def localise(W: Words, entered: int) -> int:
    """The robot's reference dart on S, once vu's entry dart is known; it may walk back to vu first.

    At v0 the marker tells the reference dart, so the robot stays. Elsewhere it goes back to vu,
    where its reference dart is turned away from the entry dart as the way back turned it.
    """
    marker = sensed(W, W[POS]) & MASK  # 1 + marker
    if planted(W, GOES_ON_AS_IF_JUST_COME_IN):
        back(W, 0)
        return entered
    if marker > 0:
        # The marker points at dart 0, `marker` doors clockwise from the reference dart.
        return 0 if marker == 1 else W[CD] - marker + 1
    back(W, 0)
    turned = W[TURNED]
    while turned < 0:
        turned += W[CD + W[CV + entered]]
    return turn(W, entered, turned)


# ---------------------------------------------------------------- the rule, by its number


@kernel
def start_rule(W: Words) -> None:
    """Forget the run before."""
    W[NREC] = 0
    if W[RULE] >= RULE_FOLDING:
        start_fold(W)


@kernel
def arrive(W: Words, e: int, percept: int) -> None:
    """Take note that the robot has crossed e and senses this percept at vu."""
    if W[RULE] >= RULE_FOLDING:
        if W[RULE] == RULE_PLANAR:
            face(W, e)
        arrive_fold(W, e, percept)


@kernel
def observe(W: Words) -> None:
    """Take note of a sequence that was executed and ended in a mismatch."""
    if W[RULE] >= RULE_FOLDING:
        observe_fold(W)
    elif W[RULE] >= RULE_ONE:
        observe_sequence(W)


@kernel
def refute(W: Words, h: int) -> int:
    """The rule that shows the hypothesis to be false, one of BY_…; 0: it may be true."""
    rule = W[RULE]
    if rule == RULE_PREFIX:
        return BY_PREFIX if refute_by_prefix(W, h) else 0
    if rule < RULE_FOLDING:
        if not refute_by_history(W, h):
            return 0
        return BY_HISTORY if W[EV_RECORD] < 0 else BY_RECORDS
    if rule == RULE_PLANAR and refute_by_face(W, h):
        return BY_PLANAR
    return BY_FOLDING if refute_by_folding(W, h) else 0


@kernel
def learn(W: Words, e: int, entry: int, new: int) -> None:
    """Take note that S has grown: the robot crossed e and came in by dart `entry`."""
    if W[RULE] >= RULE_FOLDING:
        learn_fold(W, entry, new)
    elif W[RULE] >= RULE_ONE:
        learn_records(W, e, entry)
