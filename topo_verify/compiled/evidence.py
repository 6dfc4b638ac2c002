"""The rules that show a hypothesis false from what was seen; the complete rule is in folding.py.

    rule      mirrors of algorithms/              what differs
    prefix    enhancement_i.py, `PrefixRule`      the last sequence is the excursion itself, since
                                                  the robot stands where it ended
    history   enhancement_ii.py, `HistoryRule`    the same; `beyond` is that of enhancement_iii.py
    records   enhancement_iii.py, `RecordsRule`   a record is four words; those behind the same
                                                  place are a list, searched by door
    planar    planar.py, `PlanarRule`             the face is a mark on its darts, the number of
                                                  this e

A dropped record keeps its place until the run ends. The rule for one level writes no record behind
another, so both rules of records read alike. In a planar world only darts on e's own face of S can
be its other end.

Source: sections III-A to III-C of the paper; listing 2, lines 16-19; listing 3, lines 3, 10-16, 29;
docs/semantics.md, section 8.
"""

from __future__ import annotations

from topo_verify.compiled.chart import door, turn
from topo_verify.compiled.events import OTHER_FACE
from topo_verify.compiled.faults import *
from topo_verify.compiled.kernel import Words, kernel
from topo_verify.compiled.workspace import *


@kernel
def cite(W: Words, step: int, expected: int, observed: int, at: int) -> bool:
    """Note the evidence for a rejection without motion. True, so that a rule may return it."""
    W[EV_STEP] = step
    W[EV_EXPECTED] = expected
    W[EV_OBSERVED] = observed
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
        observed = W[PP + step]
        if planted(W, COMPARES_BEFORE_THE_DOOR):
            observed = W[PP + step - 1]
        if observed != W[CP + at]:  # A2.18
            return cite(W, step, W[CP + at], observed, at)
    return False


# ---------------------------------------------------------------- history


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
                return cite(W, step, W[PP + step], W[PP + step], exit_dart)
            if planted(W, TRACES_THROUGH_THE_UNEXPLORED):
                at = exit_dart
            else:
                return W[RULE] >= RULE_ONE and beyond(W, exit_dart, step)  # A3.13
        if W[CP + at] != W[PP + step]:  # A3.12 A3.15
            return cite(W, step, W[CP + at], W[PP + step], at)
    return False


# ---------------------------------------------------------------- records


@kernel
def observe_sequence(W: Words) -> None:
    """Keep the excursion as one of the sequences executed for e; NSEQ counts it already."""
    n = W[NDOORS]
    first = W[NSTEPS]
    if first + n + 1 > STEPS:  # each sequence is that of another dart, so all have their SQ_FIRST
        W[STOP] = STOP_FULL + FULL_STEPS
        return
    W[SQ_FIRST + W[NSEQ] - 1] = first
    W[SQ_LENGTH + W[NSEQ] - 1] = n
    for i in range(n):
        W[SQ_DOORS + first + i] = W[DOORS + i]
    for i in range(n + 1):
        W[SQ_PERCEPTS + first + i] = W[PP + i]
    W[NSTEPS] = first + n + 1


@kernel
def beyond(W: Words, exit_dart: int, step: int) -> bool:
    """Whether a percept on record behind the dart contradicts the sequence; the first is cited."""
    place = W[TREC + exit_dart]  # A3.14
    first = step
    while place >= 0:
        if W[RC_PERCEPT + place] != W[PP + step]:
            cite(W, step, W[RC_PERCEPT + place], W[PP + step], exit_dart)
            W[EV_RECORD] = exit_dart
            # Door number `step` is DOORS[step - 1], so the record's doors begin with this one.
            W[EV_FIRST] = first
            return True
        if step == W[NDOORS]:
            break
        place = behind(W, place, W[DOORS + step])
        step += 1
    return False


@kernel
def behind(W: Words, place: int, door: int) -> int:
    """The record behind a door of a place on record; -1: none."""
    place = W[RC_BEHIND + place]
    while place >= 0 and W[RC_DOOR + place] != door:
        place = W[RC_NEXT + place]
    return place


@kernel
def learn_records(W: Words, e: int, entry: int) -> None:
    """Record what the sequences showed behind unexplored darts, traced on the grown S."""
    # Before anything is recorded. Both are explored now, so neither gets a new record below.
    W[TREC + e] = -1
    W[TREC + entry] = -1
    origin = entry
    if planted(W, RECORDS_A_LOOP_FROM_DART_0):
        origin = W[CF + W[CV + entry]]
    if planted(W, RECORDS_FROM_THE_NEAR_END):
        origin = e
    for sequence in range(W[NSEQ]):  # A3.29
        at = origin
        doors = SQ_DOORS + W[SQ_FIRST + sequence]
        for step in range(1, W[SQ_LENGTH + sequence] + 1):
            exit_dart = turn(W, at, W[doors + step - 1])
            at = W[CA + exit_dart]
            if at < 0:
                record(W, exit_dart, sequence, step)
                break
        if W[STOP] != 0:
            return


@kernel
def record(W: Words, exit_dart: int, sequence: int, step: int) -> None:
    """Record the percepts of the sequence from this step on: the first, or as many as there are."""
    # What is recorded already stays: a place shows the same percept each time.
    first = W[SQ_FIRST + sequence]
    place = W[TREC + exit_dart]
    if place < 0:
        place = seen(W, W[SQ_PERCEPTS + first + step], 0)
        W[TREC + exit_dart] = place
    if W[RULE] != RULE_ALL:
        return
    for deeper in range(step + 1, W[SQ_LENGTH + sequence] + 1):
        door = W[SQ_DOORS + first + deeper - 1]
        following = behind(W, place, door)
        if following < 0:
            following = seen(W, W[SQ_PERCEPTS + first + deeper], door)
            W[RC_NEXT + following] = W[RC_BEHIND + place]
            W[RC_BEHIND + place] = following
        if W[STOP] != 0:
            return
        place = following


@kernel
def seen(W: Words, percept: int, door: int) -> int:
    """A new record of a percept, reached by a door. `STOP` is set if there is no room for it."""
    place = W[NREC]
    if place >= RECORDS:
        W[STOP] = STOP_FULL + FULL_RECORDS
        return 0
    W[NREC] = place + 1
    W[RC_PERCEPT + place] = percept
    W[RC_DOOR + place] = door
    W[RC_BEHIND + place] = -1
    W[RC_NEXT + place] = -1
    return place


# ---------------------------------------------------------------- planar


@kernel
def face(W: Words, e: int) -> None:
    """Mark the darts of S on the face of e."""
    W[NFACES] += 1
    dart = e
    while True:
        W[FACE + dart] = W[NFACES]
        # An unexplored dart is a dead end, so turn back. The next dart of the face is sigma∘alpha,
        # where alpha of an open dart is the dart itself.
        if W[CA + dart] >= 0:
            dart = W[CA + dart]
        dart = turn(W, dart, 1)
        if dart == e:
            return


@kernel
def refute_by_face(W: Words, h: int) -> bool:
    """Whether the hypothesis is false in every planar world, since it lies on another face."""
    if W[FACE + h] == W[NFACES]:
        return False
    cite(W, 0, -1, -1, -1)
    W[EV_WRONG] = OTHER_FACE
    return True
