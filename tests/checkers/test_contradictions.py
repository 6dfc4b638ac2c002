"""rejection-justified under the labels `folding` and `planar`: what is cited must follow."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest

from tests.checkers.example import inserted, said, with_evidence
from tests.helpers import edited, failing, of_type, place, trace_of
from topo_verify import World
from topo_verify.checkers import decision_conclusions
from topo_verify.checkers.entailment import FoldedTrace
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept

CLASH = "two degrees, or the marker and its absence, at one place"
TURNED = "a vertex would be itself, turned"
OWN = "a dart would be its own other end"
TWO = "two vertices of S would be one"
FACE = "it lies on another face than e"

WORLD = World.from_id("m5/434")
TRACE = trace_of(WORLD, "folding")
FIRST = next(i for i, e in enumerate(TRACE) if isinstance(e, ev.Reject) and e.rule == "folding")

NONSENSE = ev.Evidence(999, Percept(424242, None), Percept(424242, None))


def renamed(
    trace: ev.Trace, evidence: ev.Evidence | None, rule: ev.RuleName = "folding"
) -> ev.Trace:
    """The trace with every rejection under another label."""
    return tuple(
        msgspec.structs.replace(event, rule=rule, evidence=evidence or event.evidence)
        if isinstance(event, ev.Reject)
        else event
        for event in trace
    )


def citing(**changes: Any) -> ev.Trace:
    """The trace with other evidence in its first rejection."""
    return with_evidence(TRACE, FIRST, **changes)


@pytest.mark.parametrize("rule", ["folding", "planar"])
@pytest.mark.parametrize("evidence", [NONSENSE, None, ev.Evidence(0)])
def test_another_label_does_not_excuse_from_evidence(
    rule: ev.RuleName, evidence: ev.Evidence | None
) -> None:
    lie = renamed(trace_of(WORLD, "basic"), evidence, rule)
    assert failing(WORLD, lie) == {"rejection-justified"}
    assert len(said(lie, "rejection-justified", WORLD)) == len(of_type(ev.Reject, lie)) > 1


def test_ours_cite_the_contradiction_and_no_percepts() -> None:
    for reject in of_type(ev.Reject, TRACE):
        if reject.rule == "folding":
            told = reject.evidence.contradiction
            assert reject.evidence == ev.Evidence(0, contradiction=told)
            assert told in (CLASH, TURNED, OWN, TWO)
    assert not failing(WORLD, TRACE)


def test_percepts_may_stand_where_they_are_those_at_the_two_ends() -> None:
    # So did traces of version 1 that were recorded before.
    shown, seen = Percept(7, None), Percept(7, None)
    assert not failing(WORLD, citing(expected=shown, observed=seen))
    assert not failing(WORLD, citing(observed=seen))


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"expected": Percept(1, 0)}, "what is seen there is (degree 7, no marker), not (degr"),
        ({"observed": Percept(3, None)}, "what is seen there is (degree 7, no marker), not (de"),
        ({"step": 1}, "it rests on no step of a sequence, and cites one"),
        ({"sequence": 0}, "it rests on no step"),
        ({"at": 0}, "it rests on no step"),
        ({"record": ev.Record(3, ())}, "it rests on no step"),
        ({"contradiction": None}, "it does not follow that None"),
        ({"contradiction": "because"}, "it does not follow that 'because'"),
        ({"contradiction": TURNED}, "it does not follow that 'a vertex would be itself, turned'"),
        ({"contradiction": FACE}, "it does not follow that 'it lies on another face than e'"),
    ],
)  # fmt: skip
def test_false_evidence_of_the_complete_rule_is_caught(changes: dict[str, Any], why: str) -> None:
    lie = citing(**changes)
    assert failing(WORLD, lie) == {"rejection-justified"}
    (message,) = said(lie, "rejection-justified", WORLD)
    assert why in message


@pytest.mark.parametrize(("where", "kinds"), [("m2/4", {TURNED, OWN}), ("m4/36", {CLASH})])
def test_every_kind_of_contradiction_that_follows_may_be_cited_and_no_other(
    where: str, kinds: set[str]
) -> None:
    world = World.from_id(where)
    trace = trace_of(world, "folding")
    index = next(i for i, e in enumerate(trace) if isinstance(e, ev.Reject) and e.rule == "folding")
    for kind in (CLASH, TURNED, OWN, TWO):
        cites = edited(trace, index, evidence=ev.Evidence(0, contradiction=kind))
        assert (kind in kinds) == (not failing(world, cites))


def test_percepts_that_disagree_need_no_contradiction_and_may_cite_none() -> None:
    trace = trace_of(WORLD, "basic")
    lie = with_evidence(trace, place(trace, ev.Reject), contradiction=CLASH)
    (message,) = said(lie, "rejection-justified", WORLD)
    assert message.endswith("rule 'motion' rests on two percepts, and cites a contradiction")


@pytest.mark.parametrize("part", ["expected", "observed"])
def test_percepts_that_disagree_must_stand_there(part: str) -> None:
    trace = trace_of(WORLD, "basic")
    lie = with_evidence(trace, place(trace, ev.Reject), **{part: None})
    (message,) = said(lie, "rejection-justified", WORLD)
    assert message.endswith(", not None")


def test_the_planar_rule_must_say_what_it_rests_on() -> None:
    world = World.from_id("m3/50")
    trace = trace_of(world, "folding+planar")
    index = next(i for i, e in enumerate(trace) if isinstance(e, ev.Reject) and e.rule == "planar")
    assert not failing(world, trace)
    for told in (None, CLASH, "because"):
        lie = edited(trace, index, evidence=ev.Evidence(0, contradiction=told))
        assert failing(world, lie) == {"rejection-justified"}


def test_only_a_rejection_that_cites_a_contradiction_meets_it() -> None:
    for conclusion in decision_conclusions(FoldedTrace(TRACE)):
        event = TRACE[conclusion.when]
        assert conclusion.met is (isinstance(event, ev.Reject) and event.rule == "folding")
    assert not any(
        conclusion.met
        for conclusion in decision_conclusions(FoldedTrace(renamed(TRACE, None, "history")))
    )
    unknown = edited(TRACE, FIRST, hypothesis=10**6)
    assert [c.met for c in decision_conclusions(FoldedTrace(unknown)) if c.when == FIRST] == [False]


def test_a_confirmation_of_a_dart_that_s_lacks_leaves_s_proved() -> None:
    lie = inserted(TRACE, FIRST, ev.Confirm(10**6, 10**6, "folding"))
    assert failing(WORLD, lie) == {"no-false-confirm", "decisions-entailed"}


def test_a_rejection_that_does_not_follow_proves_no_new_vertex() -> None:
    far = Percept(3, None)
    walk = (
        ev.Start(percept=Percept(2, 0)),
        ev.Move(0, far),
        ev.Augment(0, "new", 2, 3),
        ev.Move(1, far),
    )
    lie = (*walk, ev.Reject(3, 4, "history", ev.Evidence(0)), ev.Augment(3, "new", 5, 3))
    *_, rejected, grown = decision_conclusions(FoldedTrace(lie))
    assert "the edge may well lead there" in rejected.why
    assert "the edge may well lead there" in grown.why
