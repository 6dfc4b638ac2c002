"""rejection-justified: evidence that does not disagree, or is not there, is seen through."""

from __future__ import annotations

from typing import Any

import pytest

from tests.checkers.example import LOOP, TRACE, WORLD, inserted, said, with_evidence, wrong
from tests.helpers import edited, failing, place, trace_of
from topo_verify import World
from topo_verify.checkers import check
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept

BY_MOTION = place(TRACE, ev.Reject, 0)
BY_RECORD = next(i for i, e in enumerate(TRACE) if isinstance(e, ev.Reject) and e.rule == "records")

KNOWN = World.from_id("m4/41")
KNOWN_TRACE = trace_of(KNOWN, "enhancement-ii")
BY_HISTORY = place(KNOWN_TRACE, ev.Reject, 1)
"""Dart 4 is rejected because tracing leads to dart 6, where S shows another degree."""

DEEP = World.from_id("m7/20231")
DEEP_TRACE = trace_of(DEEP, "enhancement-iii-all")
BY_DEEP_RECORD = next(
    i
    for i, e in enumerate(DEEP_TRACE)
    if isinstance(e, ev.Reject) and e.evidence.record is not None and e.evidence.record.doors
)


SEEN, OTHER = Percept(7, None), Percept(3, None)


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"step": 0}, "observed is (degree 7, no marker)"),  # expected and observed there
        ({"step": 2}, "step 2, which it cites, was not executed"),
        ({"step": -1}, "step -1, which it cites, was not executed"),
        ({"step": 10**20}, "was not executed"),
        ({"expected": OTHER}, "expected is (degree 1, marker at door 0), not (degree 3,"),
        ({"expected": SEEN}, "expected is (degree 1, marker at door 0), not (degree 7,"),
        ({"observed": OTHER}, "observed is (degree 7, no marker), not (degree 3, no marker)"),
        ({"observed": Percept(1, 0)}, "observed is (degree 7, no marker)"),
        ({"sequence": 0}, "step 1, which it cites, was not executed"),
        ({"at": 3}, "on S the doors end at dart 0: cite that dart"),
        ({"record": ev.Record(3, ())}, "on S the doors end at dart 0: cite that dart"),
    ],
)  # fmt: skip
def test_false_evidence_from_motion_is_caught(changes: dict[str, Any], why: str) -> None:
    lie = with_evidence(TRACE, BY_MOTION, **changes)
    if changes == {"step": 0}:
        lie = with_evidence(TRACE, BY_MOTION, step=0, expected=SEEN, observed=SEEN)
        why = "(degree 7, no marker) is both expected and observed"
    assert wrong(lie) == {"rejection-justified"}
    (message,) = said(lie, "rejection-justified")
    assert message.startswith("rejecting 3 for edge 2 is not justified: ")
    assert why in message


@pytest.mark.parametrize(
    "changes",
    [
        {"sequence": None},
        {"sequence": 1},
        {"sequence": -1},
        {"sequence": 2**63},
        {"step": 0},
        {"step": 2},
        {"expected": OTHER},
        {"observed": OTHER},
        {"expected": Percept(1, None)},
        {"at": 2},
        {"at": -1},
        {"record": None},
        {"record": ev.Record(4, ())},
        {"record": ev.Record(3, (0,))},
        {"record": ev.Record(-1, ())},
    ],
)
def test_false_evidence_from_a_record_is_caught(changes: dict[str, Any]) -> None:
    assert wrong(with_evidence(TRACE, BY_RECORD, **changes)) == {"rejection-justified"}


def test_a_record_that_is_not_cited_is_named_by_where_tracing_left_s() -> None:
    lie = with_evidence(TRACE, BY_RECORD, record=None)
    (message,) = said(lie, "rejection-justified")
    on_s = "on S the doors lead to unexplored dart 3, behind which S expects nothing"
    assert message.endswith(f"{on_s}: cite its record, doors []")
    (message,) = said(edited(lie, BY_RECORD, rule="history"), "rejection-justified")
    assert message.endswith(on_s)


@pytest.mark.parametrize(
    "changes",
    [
        {"record": ev.Record(10, ())},
        {"record": ev.Record(10, (2,))},
        {"record": ev.Record(10, (3, 3))},
        {"step": 1},
        {"expected": Percept(1, None)},
        {"sequence": 0},
    ],
)
def test_false_evidence_from_a_deeper_record_is_caught(changes: dict[str, Any]) -> None:
    lie = with_evidence(DEEP_TRACE, BY_DEEP_RECORD, **changes)
    assert wrong(lie, DEEP) == {"rejection-justified"}


@pytest.mark.parametrize(
    "changes",
    [
        {"sequence": None},
        {"sequence": 1},
        {"at": 5},
        {"expected": OTHER},
        {"observed": Percept(2, None)},
        {"record": ev.Record(6, ())},
        {"step": 0, "expected": Percept(5, None)},
    ],
)
def test_false_evidence_from_the_known_part_of_the_map_is_caught(changes: dict[str, Any]) -> None:
    lie = with_evidence(KNOWN_TRACE, BY_HISTORY, **changes)
    assert wrong(lie, KNOWN) == {"rejection-justified"}


def test_evidence_may_leave_out_where_tracing_stood() -> None:
    assert not failing(KNOWN, with_evidence(KNOWN_TRACE, BY_HISTORY, at=None))
    assert not failing(WORLD, with_evidence(TRACE, BY_RECORD, at=None))


def test_a_record_of_what_was_seen_only_in_this_round_is_caught() -> None:
    # In m4/54 the robot does cross dart 3 while it looks for the other end of dart 2, and sees
    # degree 6 behind it, but it cannot know that this was dart 3 before it knows where it began.
    world = World.from_id("m4/54")
    trace = trace_of(world, "enhancement-iii-all")
    evidence = ev.Evidence(
        1, Percept(6, None), Percept(1, None), sequence=0, at=3, record=ev.Record(3, ())
    )
    lie = inserted(trace, 10, ev.Reject(2, 5, "records", evidence))
    assert wrong(lie, world) == {"rejection-justified"}
    assert "nothing is recorded behind dart 3" in said(lie, "rejection-justified", world)[0]


@pytest.mark.parametrize("change", [{"edge": 3}, {"edge": -1}, {"hypothesis": 0}])
def test_rejecting_what_was_not_posed_is_caught(change: dict[str, int]) -> None:
    lie = edited(TRACE, BY_MOTION, **change)
    assert wrong(lie) == {"rejection-justified"}
    assert "no such hypothesis was posed" in said(lie, "rejection-justified")[0]


def test_rejecting_after_the_map_has_grown_is_caught() -> None:
    assert wrong(inserted(TRACE, LOOP + 1, TRACE[BY_MOTION])) == {"rejection-justified"}


def test_rejecting_what_is_no_unexplored_dart_is_caught_even_if_it_was_posed() -> None:
    posed = edited(TRACE, place(TRACE, ev.Pose, 1), hypotheses=(3, 4, 5, 6, 7, 99))
    lie = edited(posed, BY_MOTION, hypothesis=99)
    assert wrong(lie) == {"true-hypothesis-posed", "rejection-justified"}
    assert "the two are not unexplored darts of S" in said(lie, "rejection-justified")[0]


def test_the_planar_rule_may_reject_what_lies_on_another_face_and_nothing_else() -> None:
    world = World.from_id("m3/50")
    trace = trace_of(world, "folding+planar")
    (reject,) = [e for e in trace if isinstance(e, ev.Reject) and e.rule == "planar"]
    assert (reject.edge, reject.hypothesis) == (1, 4)
    assert wrong(trace, world) == set()
    # Behind dart 2 of the other world nothing is explored yet: all its darts lie on one face.
    told = ev.Evidence(0, contradiction="it lies on another face than e")
    lie = edited(TRACE, BY_MOTION, rule="planar", evidence=told)
    assert wrong(lie) == {"rejection-justified"}
    message = "it does not follow that 'it lies on another face than e'"
    assert said(lie, "rejection-justified")[0].endswith(message)


@pytest.mark.parametrize("rule", ["motion", "folding"])
def test_an_edge_that_is_explored_is_in_question_no_more(rule: ev.RuleName) -> None:
    world = World.from_rotations([[0, 1], [2], [3]], [(0, 2), (1, 3)], 0)
    behind, marked = Percept(1, None), Percept(2, 1)
    evidence = ev.Evidence(0, marked, behind)  # the two percepts do disagree
    history = (ev.Start(percept=Percept(2, 0)), ev.Move(0, behind), ev.Augment(0, "new", 2, 1))
    lie = (*history, ev.Pose(0, (1,)), ev.Reject(0, 1, rule, evidence))
    findings = {one.claim: one.findings for one in check(world, lie)}["rejection-justified"]
    assert ["the two are not unexplored darts of S" in one.message for one in findings] == [True]
