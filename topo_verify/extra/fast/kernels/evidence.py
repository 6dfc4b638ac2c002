"""The rules that refute a hypothesis from what was seen; the complete rule is in folding.py.

rule      twins in algorithms/          what differs
prefix    rules.py, `PrefixRule`        the last sequence is the excursion itself
history   rules.py, `HistoryRule`       the same; `beyond` is that of `RecordsRule`
records   rules.py, `RecordsRule`       a record is four words, in a list for each place
planar    beyond/planar.py, `PlanarRule`   the face is a mark on its darts
"""

from __future__ import annotations

from topo_verify.extra.fast.kernels.chart import door, turn
from topo_verify.extra.fast.kernels.events import OTHER_FACE
from topo_verify.extra.fast.kernels.faults import *
from topo_verify.extra.fast.kernels.kernel import kernel
from topo_verify.extra.fast.kernels.workspace import *


@kernel
def cite(evidence: EvidenceWords, step: int, expected: int, observed: int, at: int) -> bool:
    """Note the evidence for a rejection; return True."""
    evidence.step = step
    evidence.expected = expected
    evidence.observed = observed
    evidence.at = at
    evidence.record = -1
    evidence.wrong = 0
    return True


@kernel
def refute_by_prefix(run: RunWords, h: int) -> bool:
    excursion, chart = run.excursion, run.chart
    at = h
    for step in range(1, excursion.size + 1):
        up = chart.up[chart.vertex[at]]
        if up < 0 or door(run, at, up) != excursion.door[step - 1]:  # A2.17
            return False
        at = chart.alpha[up]
        observed = excursion.percept[step]
        if planted(run.task, COMPARES_BEFORE_THE_DOOR):
            observed = excursion.percept[step - 1]
        if observed != chart.percept[at]:  # A2.18
            return cite(run.evidence, step, chart.percept[at], observed, at)
    return False


@kernel
def refute_by_history(run: RunWords, h: int) -> bool:
    chart, excursion = run.chart, run.excursion
    at = h  # A3.10
    if planted(run.task, TRACES_FROM_THE_FIRST_DART):
        at = chart.first[chart.vertex[h]]
    for step in range(1, excursion.size + 1):
        exit_dart = turn(chart, at, excursion.door[step - 1])
        at = chart.alpha[exit_dart]  # A3.11
        if at < 0:
            if planted(run.task, TAKES_UNKNOWN_FOR_A_MISMATCH):
                return cite(
                    run.evidence, step, excursion.percept[step], excursion.percept[step], exit_dart
                )
            if planted(run.task, TRACES_THROUGH_THE_UNEXPLORED):
                at = exit_dart
            else:
                return run.task.rule >= RULE_ONE and beyond(run, exit_dart, step)  # A3.13
        if chart.percept[at] != excursion.percept[step]:  # A3.12 A3.15
            return cite(run.evidence, step, chart.percept[at], excursion.percept[step], at)
    return False


@kernel
def observe_sequence(run: RunWords) -> None:
    excursion, sequences = run.excursion, run.sequences
    n = excursion.size
    first = sequences.steps
    if first + n + 1 > STEPS:
        run.stop = STOP_FULL + FULL_STEPS
        return
    sequences.first[sequences.number - 1] = first
    sequences.length[sequences.number - 1] = n
    for i in range(n):
        sequences.door[first + i] = excursion.door[i]
    for i in range(n + 1):
        sequences.percept[first + i] = excursion.percept[i]
    sequences.steps = first + n + 1


@kernel
def beyond(run: RunWords, exit_dart: int, step: int) -> bool:
    """Does a record behind the dart contradict the sequence?"""
    records, evidence, excursion = run.records, run.evidence, run.excursion
    place = records.of_dart[exit_dart]  # A3.14
    first = step
    while place >= 0:
        if records.percept[place] != excursion.percept[step]:
            cite(evidence, step, records.percept[place], excursion.percept[step], exit_dart)
            evidence.record = exit_dart
            # Door `step` has index step - 1: the record begins here.
            evidence.first = first
            return True
        if step == excursion.size:
            break
        place = behind(records, place, excursion.door[step])
        step += 1
    return False


@kernel
def behind(records: RecordWords, place: int, door: int) -> int:
    """The record behind a door of a record; -1: none."""
    place = records.behind[place]
    while place >= 0 and records.door[place] != door:
        place = records.next[place]
    return place


@kernel
def learn_records(run: RunWords, e: int, entry: int) -> None:
    records, sequences, chart = run.records, run.sequences, run.chart
    # Both are explored now, and get no new record below.
    records.of_dart[e] = -1
    records.of_dart[entry] = -1
    origin = entry
    if planted(run.task, RECORDS_A_LOOP_FROM_DART_0):
        origin = chart.first[chart.vertex[entry]]
    if planted(run.task, RECORDS_FROM_THE_NEAR_END):
        origin = e
    for sequence in range(sequences.number):  # A3.29
        at = origin
        doors = sequences.place_of("door") + sequences.first[sequence]
        for step in range(1, sequences.length[sequence] + 1):
            exit_dart = turn(chart, at, run[doors + step - 1])
            at = chart.alpha[exit_dart]
            if at < 0:
                record(run, exit_dart, sequence, step)
                break
        if run.stop != 0:
            return


@kernel
def record(run: RunWords, exit_dart: int, sequence: int, step: int) -> None:
    sequences, records = run.sequences, run.records
    # A place shows the same percept each time.
    first = sequences.first[sequence]
    place = records.of_dart[exit_dart]
    if place < 0:
        place = seen(records, sequences.percept[first + step], 0)
        records.of_dart[exit_dart] = place
    if run.task.rule != RULE_ALL:
        return
    for deeper in range(step + 1, sequences.length[sequence] + 1):
        door = sequences.door[first + deeper - 1]
        following = behind(records, place, door)
        if following < 0:
            following = seen(records, sequences.percept[first + deeper], door)
            records.next[following] = records.behind[place]
            records.behind[place] = following
        if run.stop != 0:
            return
        place = following


@kernel
def seen(records: RecordWords, percept: int, door: int) -> int:
    """A new record; without room `stop` is set."""
    place = records.number
    if place >= RECORDS:
        records.stop = STOP_FULL + FULL_RECORDS
        return 0
    records.number = place + 1
    records.percept[place] = percept
    records.door[place] = door
    records.behind[place] = -1
    records.next[place] = -1
    return place


@kernel
def face(run: RunWords, e: int) -> None:
    faces, chart = run.faces, run.chart
    faces.number += 1
    dart = e
    while True:
        faces.face[dart] = faces.number
        # At an unexplored dart turn back: the next dart of the face is sigma∘alpha,
        # with alpha of an open dart the dart itself.
        if chart.alpha[dart] >= 0:
            dart = chart.alpha[dart]
        dart = turn(chart, dart, 1)
        if dart == e:
            return


@kernel
def refute_by_face(run: RunWords, h: int) -> bool:
    faces = run.faces
    if faces.face[h] == faces.number:
        return False
    cite(run.evidence, 0, -1, -1, -1)
    run.evidence.wrong = OTHER_FACE
    return True
