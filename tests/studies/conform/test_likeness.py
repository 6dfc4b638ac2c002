"""Two runs event for event: where they part, and what was known then."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest

from tests.helpers import edited, place, some, trace_of, typed, worlds
from topo_verify import CATALOGUE
from topo_verify.robot import events as ev
from topo_verify.robot.event_words import event_words
from topo_verify.robot.percept import Percept
from topo_verify.studies.conform.likeness import Difference, KnownState, declares, first_difference


def by_folding(event: ev.Event) -> bool:
    return isinstance(event, ev.Reject) and event.rule == "folding"


def moves_alone(trace: ev.Trace) -> ev.Trace:
    """The run of a mapper that declares nothing."""
    return tuple(
        e for e in trace if not isinstance(e, ev.Pose | ev.Reject | ev.Confirm | ev.Augment)
    )


def test_a_run_is_like_itself() -> None:
    for world in worlds(range(1, 4)):
        for name in CATALOGUE:
            trace = trace_of(world, name)
            assert first_difference(trace, trace) is None


def test_the_smallest_world_in_which_two_algorithms_part() -> None:
    parted = first_difference(trace_of("m4/41", "enhancement-ii"), trace_of("m4/41", "basic"))
    assert parted == Difference(
        event=11,
        expected="rejects that edge 7 leads to 4 (by history): expects (2), saw (5)"
        " at step 1 of sequence 0, at dart 6",
        seen="takes door 0 and sees (5)",
        before=(
            "takes door 1 and sees (5)",
            "asks where edge 7 leads: to 3, 4, 5 or to a new vertex",
            "takes door 3 and sees (5)",
            (
                "rejects that edge 7 leads to 3 (by motion): expects (1, marker 0), saw (5)"
                " at step 1"
            ),
        ),
        state=KnownState(
            moves=4,
            vertices=(1, 5, 2),
            explored=((0, 1), (2, 6)),
            edge=7,
            left=(4, 5),
            doors=(1, 3),
        ),
        at=11,
    )


@pytest.mark.parametrize("kind", [ev.Move, ev.Pose, ev.Reject, ev.Confirm, ev.Augment])
def test_every_event_that_is_left_out_is_seen(kind: type[ev.Event]) -> None:
    trace = trace_of("m4/41", "enhancement-ii")
    at = place(trace, kind)
    parted = some(first_difference(trace, (*trace[:at], *trace[at + 1 :])))
    assert parted.event == at


def test_other_evidence_is_another_event() -> None:
    trace = trace_of("m4/41")
    at = place(trace, ev.Reject)
    rejection = typed(ev.Reject, trace[at])
    evidence = msgspec.structs.replace(rejection.evidence, step=2)
    parted = some(first_difference(trace, edited(trace, at, evidence=evidence)))
    assert parted.event == at


def test_what_is_no_promise_is_not_compared() -> None:
    runs = (trace_of(world, "folding") for world in worlds([4]))
    trace = next(run for run in runs if any(map(by_folding, run)))
    at = next(when for when, event in enumerate(trace) if by_folding(event))
    rejection = typed(ev.Reject, trace[at])
    assert rejection.evidence.contradiction is not None
    evidence = msgspec.structs.replace(rejection.evidence, contradiction="in my words")
    assert first_difference(trace, edited(trace, at, evidence=evidence)) is None
    aimless = tuple(ev.Move(e.door, e.percept) if isinstance(e, ev.Move) else e for e in trace)
    assert first_difference(trace, aimless) is None
    assert first_difference(trace, edited(trace, -1, cost=None)) is None


def test_a_run_that_ends_too_early_or_goes_on_is_seen() -> None:
    trace = trace_of("m3/14")
    assert isinstance(trace[-1], ev.Finish)
    shorter, longer = trace[:-2], (*trace[:-1], trace[1])
    early, late = first_difference(trace, shorter), first_difference(trace, longer)
    assert early is not None
    assert late is not None
    assert (early.event, early.seen) == (len(shorter), None)
    assert (late.event, late.expected) == (len(trace) - 1, None)


def test_of_a_mapper_that_declares_nothing_the_moves_are_compared() -> None:
    basic, other = trace_of("m4/41"), trace_of("m4/41", "enhancement-ii")
    assert not declares(moves_alone(basic))
    assert first_difference(basic, moves_alone(basic)) is None
    parted = some(first_difference(other, moves_alone(basic)))
    assert some(parted.expected).startswith("takes door")


def test_what_differs_can_be_read() -> None:
    """Two events that are compared and differ have different words, however little it is."""
    trace = trace_of("m4/41", "enhancement-ii")
    pose, grown, reject = (trace[place(trace, kind)] for kind in (ev.Pose, ev.Augment, ev.Reject))
    assert isinstance(reject, ev.Reject)
    hypotheses = tuple(range(40))
    record = ev.Record(3, (1, 2))
    evidence = {"step": 9, "sequence": 4, "at": 8, "record": record, "expected": Percept(9, None)}
    changed: list[tuple[ev.Event, dict[str, Any]]] = [
        (msgspec.structs.replace(pose, hypotheses=hypotheses), {"hypotheses": (*hypotheses, 40)}),
        (msgspec.structs.replace(grown, kind="loop"), {"degree": 40}),
        *(
            (reject, {"evidence": msgspec.structs.replace(reject.evidence, **{name: value})})
            for name, value in evidence.items()
        ),
    ]
    for event, fields in changed:
        assert event_words(event) != event_words(msgspec.structs.replace(event, **fields))
