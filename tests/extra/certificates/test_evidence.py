"""The decisions of a trace as facts about places: those that follow are stated, and no others."""

from __future__ import annotations

import random
from collections.abc import Iterator

import pytest

from tests.helpers import EMPTY, PAPER, edited, of_type, place, trace_of, typed, worlds
from topo_verify import families
from topo_verify.checkers import Fold
from topo_verify.checkers.replayed_trace import ReplayedTrace
from topo_verify.errors import InternalError
from topo_verify.extra.certificates import evidence
from topo_verify.extra.certificates import evidence as module
from topo_verify.robot.events import Augment, Confirm, Move, Reject, Start, Trace
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import exit_dart
from topo_verify.studies.log_report import certify

BACKWARDS: Trace = (
    Start(percept=Percept(2, 0)),
    Move(0, Percept(2, None)),
    Move(1, Percept(2, 1)),
    Augment(1, "new", 2, 2),
    Augment(0, "loop", 3, 2),
)
"""A ring of two, whose second edge is explored from the end at which the robot came out of it."""

PLANAR = "m4/50"
"""Here `folding+planar` rejects what only a planar world refutes."""


def traces() -> Iterator[Trace]:
    """Traces of small worlds, and the same with one decision, percept or door changed."""
    generator = random.Random(10)
    for number, world in enumerate(worlds(range(1, 4))):
        whole = trace_of(world, [*PAPER, "folding"][number % 9])
        yield whole
        for _ in range(3):
            index = generator.randrange(1, len(whole))
            event, other = whole[index], generator.randrange(2 * len(world.edges))
            if isinstance(event, Reject | Confirm):
                yield edited(whole, index, hypothesis=other)
                yield edited(whole, index, hypothesis=event.edge)
            elif isinstance(event, Augment):
                yield edited(whole, index, dart=other)
                yield edited(whole, index, degree=event.degree + 1)
            elif isinstance(event, Move):
                yield edited(whole, index, door=generator.randrange(3))


def folded(trace: Trace, moves: int) -> tuple[Fold, list[tuple[int, int]]]:
    """The log cut after so many moves, folded by the trusted checkers."""
    (start,) = of_type(Start, trace)
    fold = Fold(start.percept)
    places = [fold.at]  # of each visit: a place that is revisited adds no node
    for move in of_type(Move, trace)[:moves]:
        fold.move(move.door, move.percept)
        places.append(fold.at)
    return fold, places


def holds(fold: Fold, places: list[tuple[int, int]], fact: evidence.Fact) -> bool:
    """Does the fold show the fact? The evidence counts visits from 1."""
    one, other = (
        (places[visit - 1][0], places[visit - 1][1] + door)
        for visit, door in (fact.one, fact.other)
    )
    if isinstance(fact.reason, evidence.EdgeRefutation):
        return any(fold.contradictions(one, other, ()))
    return fold.partner(one) == fold.find(other)


def test_what_follows_is_stated_and_nothing_else() -> None:
    different = 0
    for trace in traces():
        certificate = certify(trace)
        assert len(evidence.evidence_for_decisions(trace).stated) == certificate.entailed
        different += certificate.entailed < certificate.decisions
    assert different > 50


def test_each_fact_holds_in_the_log_cut_after_its_visit() -> None:
    for trace in traces():
        for one in evidence.evidence_for_decisions(trace).stated:
            for fact in one.facts:
                passed = trace[: one.when]
                assert fact.visit == len(of_type(Start, passed)) + len(of_type(Move, passed))
                assert holds(*folded(trace, fact.visit - 1), fact)


def output(run: ReplayedTrace, when: int) -> list[tuple[int, int, bool]]:
    """What a decision says of darts of the world: an edge leads from one to the other, or none."""
    event, s = run.trace[when], run.map
    phi = [image for _, image in sorted(s.phi.items())]
    if isinstance(event, Reject):
        return [(phi[event.edge], phi[event.hypothesis], False)]
    if isinstance(event, Confirm):
        return [(phi[event.edge], phi[event.hypothesis], True)]
    assert isinstance(event, Augment)
    leads = (phi[event.edge], phi[event.dart], True)
    unexplored = [d for d in s.phi if s.born[d] < when and s.is_open(d, when)]
    if event.kind == "loop":
        return [leads]
    return [leads, *((phi[event.edge], phi[d], False) for d in unexplored if d != event.edge)]


def test_the_facts_are_what_was_decided_about_darts_of_the_world() -> None:
    news = 0
    for number, world in enumerate([*worlds(range(1, 4)), families.lattice(4, 4)]):
        run = ReplayedTrace(world, trace_of(world, [*PAPER, "folding"][number % 9]))
        moments = zip(run.positions, run.trace, strict=True)
        visits = [at for at, event in moments if isinstance(event, Start | Move)]
        for one in evidence.evidence_for_decisions(run.trace).stated:
            found: list[tuple[int, int, bool]] = []
            for fact in one.facts:
                start, end = (
                    exit_dart(world, visits[visit - 1], door)
                    for visit, door in (fact.one, fact.other)
                )
                found.append((start, end, isinstance(fact.reason, evidence.Arc)))
            assert found == output(run, one.when)
            news += len(found) > 1
    assert news > 50


def test_a_new_vertex_is_where_the_robot_came_in_and_no_other_unexplored_dart() -> None:
    trace = trace_of(families.lattice(3, 3))
    first = evidence.evidence_for_decisions(trace).stated[0]
    assert first.when == place(trace, Augment)
    leads, *rest = first.facts
    assert (leads.one, leads.other, leads.reason) == ((1, 0), (2, 0), evidence.Arc(True, 1))
    assert [(fact.one, fact.other) for fact in rest] == [((1, 0), (1, 1))]
    assert all(isinstance(fact.reason, evidence.EdgeRefutation) for fact in rest)


def test_a_new_vertex_may_be_where_the_robot_came_from() -> None:
    new, loop = evidence.evidence_for_decisions(BACKWARDS).stated
    assert [(fact.one, fact.other) for fact in new.facts] == [((1, 1), (2, 1)), ((1, 1), (1, 0))]
    assert [(fact.one, fact.other) for fact in loop.facts] == [((1, 0), (2, 0))]
    assert certify(BACKWARDS).entailed == 2


def test_a_dart_is_not_its_own_partner_and_that_may_be_the_only_conflict() -> None:
    trace = trace_of("m3/5")
    when = place(trace, Reject)
    rejected = typed(Reject, trace[when])
    changed = evidence.evidence_for_decisions(edited(trace, when, hypothesis=rejected.edge))
    (fact,) = next(one.facts for one in changed.stated if one.when == when)
    assert fact.one == fact.other
    assert isinstance(fact.reason, evidence.EdgeRefutation)
    assert isinstance(fact.reason.conflict, evidence.Alone)


def test_where_nothing_is_declared_nothing_is_stated() -> None:
    trace = trace_of(families.lattice(3, 3))
    for plain in (tuple(e for e in trace if isinstance(e, Start | Move)), trace_of(EMPTY)):
        found = evidence.evidence_for_decisions(plain)
        assert (found.stated, found.merges, found.steps) == ((), (), 0)


def test_what_follows_in_planar_worlds_only_is_not_stated() -> None:
    trace = trace_of(PLANAR, "folding+planar")
    assert len(evidence.evidence_for_decisions(trace).stated) == 8
    assert certify(trace).entailed == 9


def test_evidence_that_is_too_long_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    trace = trace_of(families.lattice(3, 3))
    steps = evidence.evidence_for_decisions(trace).steps
    monkeypatch.setattr(module, "MOST", steps)
    assert not evidence.evidence_for_decisions(trace).too_long
    monkeypatch.setattr(module, "MOST", steps - 1)
    found = evidence.evidence_for_decisions(trace)
    assert found.too_long
    assert found.stated == ()


def test_a_decision_that_follows_without_evidence_is_a_bug_of_ours(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    trace = trace_of(families.lattice(3, 3))

    def nothing(*_: object) -> tuple[tuple[evidence.Meeting, ...], evidence.Conflict | None]:
        return (), None

    monkeypatch.setattr(evidence.ProofProducingFold, "refute", nothing)
    with pytest.raises(InternalError, match="two folds of one log differ at event 3"):
        evidence.evidence_for_decisions(trace)
