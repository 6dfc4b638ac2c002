"""decisions-entailed under the planar prior: proved, refuted by a planar world, or undecided."""

from __future__ import annotations

import pytest

from tests.checkers.test_witnesses import assert_wrong_in
from tests.helpers import trace_of
from topo_verify import World
from topo_verify.checkers import check, decision_conclusions, entailment
from topo_verify.checkers.darts import KnownDart
from topo_verify.checkers.entailment import FURTHER, Conclusion, FoldedTrace
from topo_verify.checkers.folding import Fold
from topo_verify.checkers.map_on_fold import MapOnFold
from topo_verify.robot.events import Augment, Event, Evidence, Move, Reject, Start, Trace
from topo_verify.robot.simulator import SimulatedRobot

FACE = "it lies on another face than e"


def rejecting(place: str, doors: list[int], e: int, h: int) -> Trace:
    """A walk in a planar world, after which one dart of v0 is said not to lead to another."""
    robot = SimulatedRobot(World.from_id(place), len(doors))
    history: list[Event] = [Start(percept=robot.percept)]
    history += [Move(door, robot.move(door)) for door in doors]
    return (*history, Reject(e, h, "planar", Evidence(0, contradiction=FACE)))


def told(trace: Trace) -> Conclusion:
    """The conclusion on the only decision of a trace."""
    (conclusion,) = decision_conclusions(FoldedTrace(trace))
    return conclusion


PROVED = rejecting("m5/6361", [8, 4, 7], 0, 4)
REFUTED = rejecting("m6/51256", [3, 2, 1, 2, 3, 1, 0], 4, 5)
OPEN = rejecting("m5/4139", [1, 5, 2, 1, 1], 0, 2)
"""In each the fold with the edge is not planar, and its ends lie on one face of S."""


def test_where_no_further_folding_is_planar_the_decision_follows() -> None:
    assert told(PROVED).why == ""


def test_a_planar_world_that_folds_it_further_is_found() -> None:
    conclusion = told(REFUTED)
    assert conclusion.why == "the edge may well lead there"
    assert conclusion.witness is not None
    assert conclusion.witness.is_planar
    assert_wrong_in(conclusion.witness, REFUTED, conclusion.when)


def test_where_the_search_is_given_up_the_decision_is_undecided_and_never_ok() -> None:
    conclusion = told(OPEN)
    assert conclusion.why == entailment.UNDECIDED[0]
    assert conclusion.witness is None
    *others, judgement = check(World.from_id("m5/4139"), OPEN)
    assert (judgement.claim, judgement.status) == ("decisions-entailed", "undecided")
    assert (judgement.judged, judgement.of) == (0, 4)
    assert judgement.findings == ()
    assert "undecided" not in {other.status for other in others}


def test_where_an_edge_would_make_two_vertices_of_s_one_it_costs_no_folding() -> None:
    """S was proved so far, so they differ in every planar world, whatever the fold says."""
    robot = SimulatedRobot(World.from_id("m3/31"), 3)
    fold = Fold(robot.percept)
    for door in (0, 2, 1):
        fold.move(door, robot.move(door))
    on_fold = MapOnFold(fold)
    on_fold.grow(Augment(0, "new", 3, 3))
    on_fold.grow(Augment(2, "new", 6, 3))  # as if the prior had told it from the vertex before
    e, ends = KnownDart(1), [KnownDart(7)]
    assert ends[0] in on_fold.face(e)
    decide = entailment._may_lead_to  # pyright: ignore[reportPrivateUsage]
    assert decide(on_fold, e, ends, iter(())) == entailment.FOLLOWS
    why, witness = decide(on_fold, e, ends, None)
    assert why == "the edge may well lead there"
    assert witness is not None
    assert witness.id == "m3/31"


def test_the_search_is_given_up_after_so_many_foldings() -> None:
    assert FURTHER == 300


@pytest.mark.parametrize("trace", [PROVED, REFUTED, OPEN])
def test_without_the_prior_each_of_them_is_refuted_by_the_fold_alone(trace: Trace) -> None:
    reject = trace[-1]
    assert isinstance(reject, Reject)
    said = (*trace[:-1], Reject(reject.edge, reject.hypothesis, "history", Evidence(0)))
    conclusion = told(said)
    assert conclusion.witness is not None
    assert not conclusion.witness.is_planar


def test_what_lies_on_another_face_costs_no_folding(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(entailment, "FURTHER", 0)
    trace = trace_of("m4/50", "folding+planar")
    assert any(isinstance(event, Reject) and event.rule == "planar" for event in trace)
    assert not any(conclusion.why for conclusion in decision_conclusions(FoldedTrace(trace)))
