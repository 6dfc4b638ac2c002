"""Enhancement III: records of what was seen behind unexplored darts (rule `records`).

Mirrors: algorithms/enhancement_iii.py, `RecordsRule`. Differs: a record is four words; those behind
the same place are a list, searched by door. A dropped record keeps its place until the run ends.
The rule for one level writes no record behind another, so both rules read alike.

Source: section III-C of the paper; listing 3, lines 3, 10-16, 29.
"""

from __future__ import annotations

from topo_verify.compiled.chart import turn
from topo_verify.compiled.faults import (
    RECORDS_A_LOOP_FROM_DART_0,
    RECORDS_FROM_THE_NEAR_END,
    planted,
)
from topo_verify.compiled.kernel import Words, kernel
from topo_verify.compiled.prefix import cite
from topo_verify.compiled.workspace import (
    CA,
    CF,
    CV,
    DOORS,
    EV_FIRST,
    EV_RECORD,
    FULL_RECORDS,
    FULL_STEPS,
    NDOORS,
    NREC,
    NSEQ,
    NSTEPS,
    PP,
    RC_BEHIND,
    RC_DOOR,
    RC_NEXT,
    RC_PERCEPT,
    RECORDS,
    RULE,
    RULE_ALL,
    SQ_DOORS,
    SQ_FIRST,
    SQ_LENGTH,
    SQ_PERCEPTS,
    STEPS,
    STOP,
    STOP_FULL,
    TREC,
)


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
