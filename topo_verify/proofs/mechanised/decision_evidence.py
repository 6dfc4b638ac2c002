"""Evidence for the decisions of a trace: each must follow from the log as it was at that moment.

A decision is stated by facts about places of the log, each a visit and a door: an edge leads from
one to the other (`leads`), or none does. Evidence for the first is an arc that joins the two; for
the second the merges that follow from an edge between them, up to a conflict.

    reject h, confirm h   one fact about e and h
    augment loop          an edge leads from e to the other dart
    augment new           an edge leads from e to where the robot came in, and none to any other
                          dart of S that is unexplored at that moment

Which decisions follow is said by checkers/entailment.py; here those that do are put in terms of
places, as coq/Decisions.v checks them. The fold grows from one decision to the next, an assumed
edge is taken back, so the work is that of one fold and of what the assumptions add. Nothing here is
trusted: a mistake makes a certificate that is refused.

Under the planar prior a decision may follow for planar worlds only. Planarity is not defined in
Coq: such a decision has no evidence, and is left out.

Source: docs/semantics.md, section 11; docs/mechanised.md.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from topo_verify.checkers import decision_conclusions
from topo_verify.errors import InternalError
from topo_verify.proofs.mechanised.evidence import (
    Arc,
    Conflict,
    LogPlace,
    Meeting,
    ProofProducingFold,
)
from topo_verify.robot.events import Augment, Confirm, Event, Move, Reject, Start
from topo_verify.robot.percept import Door, Percept

DeclaredDecision = Reject | Confirm | Augment

MOST = 2_000_000
"""Evidence of more steps is given up: it would take hundreds of megabytes."""


@dataclass(frozen=True, slots=True)
class EdgeRefutation:
    """With an edge between the two places these arcs meet, and this contradicts."""

    meetings: tuple[Meeting, ...]
    conflict: Conflict


@dataclass(frozen=True, slots=True)
class Fact:
    """At this visit it is known where an edge leads, or does not lead.

    Attributes:
        visit: the last one of the log at that moment, counted from 1.
        one, other: the two places.
        reason: the arc that joins them; or why no edge does.
    """

    visit: int
    one: LogPlace
    other: LogPlace
    reason: Arc | EdgeRefutation


@dataclass(frozen=True, slots=True)
class EntailedDecision:
    """A declared decision that follows: its event in the trace, in words, and as facts."""

    when: int
    words: str
    facts: tuple[Fact, ...]


@dataclass(frozen=True, slots=True)
class EntailedDecisions:
    """The decisions of a trace that follow.

    Attributes:
        stated: those that have evidence, in their order; none if it has more than MOST steps.
        merges: the evidence for the log itself, up to the last of them.
        steps: how long all evidence is: visits, merges, facts and merges under assumptions.
    """

    stated: tuple[EntailedDecision, ...]
    merges: tuple[Meeting, ...]
    steps: int

    @property
    def too_long(self) -> bool:
        """Was it given up?"""
        return self.steps > MOST


def evidence_for_decisions(trace: Sequence[Event]) -> EntailedDecisions:
    """The decisions of a trace, with evidence.

    Raises:
        InternalError: one follows, and has no evidence.
    Complexity: as claim 10 itself; nearly linear, and what each assumed edge adds.
    """
    prior = any(isinstance(event, Reject) and event.rule == "planar" for event in trace)
    log = _LogSoFar()
    stated: list[EntailedDecision] = []
    spent = steps = 0
    for when, event in _following(trace):
        log.catch_up(trace, when)
        facts = log.facts(event)
        if facts:
            stated.append(EntailedDecision(when, _words(event), facts))
        elif not prior:
            raise InternalError(f"two folds of one log differ at event {when}: {_words(event)}")
        spent += sum(map(_length, facts))
        steps = log.visit + len(log.fold.meetings) + spent
        if steps > MOST:
            return EntailedDecisions((), (), steps)
    return EntailedDecisions(tuple(stated), tuple(log.fold.meetings), steps)


def _following(trace: Sequence[Event]) -> Iterator[tuple[int, DeclaredDecision]]:
    """The declared decisions that follow, with their number in the trace."""
    if not any(isinstance(event, DeclaredDecision) for event in trace):
        return
    for conclusion in decision_conclusions(trace):
        event = trace[conclusion.when]
        if not conclusion.why and isinstance(event, DeclaredDecision):
            yield conclusion.when, event


def _words(event: DeclaredDecision) -> str:
    match event:
        case Reject(edge, hypothesis):
            return f"the other end of {edge} is not {hypothesis}"
        case Confirm(edge, hypothesis):
            return f"the other end of {edge} is {hypothesis}"
        case Augment(edge, "loop", dart):
            return f"a loop: {edge} and {dart} are one edge"
        case Augment(edge, _, _, degree):
            return f"a new vertex: {edge} leads to one of degree {degree}"


def _length(fact: Fact) -> int:
    return 1 + (len(fact.reason.meetings) if isinstance(fact.reason, EdgeRefutation) else 0)


class _LogSoFar:
    """What was known at one moment of a trace: the fold, and where the darts of S are."""

    def __init__(self) -> None:
        self.fold = ProofProducingFold()
        self.next = 0  # the first event that was not looked at
        self.map_to_fold: list[LogPlace] = []  # of each dart of S, a place
        self.opened: set[int] = set()

    @property
    def visit(self) -> int:
        """Where the robot stands."""
        return len(self.fold.seen) - 1

    def catch_up(self, trace: Sequence[Event], when: int) -> None:
        """Fold what happened before this event."""
        passed = trace[self.next : when]
        percepts: list[Percept] = [e.percept for e in passed if isinstance(e, Start | Move)]
        doors: list[Door] = [event.door for event in passed if isinstance(event, Move)]
        conflict = self.fold.extend(percepts, doors)
        assert conflict is None, "what follows, follows from a log that some world shows"
        if self.next == 0:
            self.draw((1, 0))
        self.next = when

    def draw(self, entry: LogPlace) -> None:
        """A new vertex of S, seen from this place on."""
        visit, door = entry
        degree = self.fold.seen[visit].degree
        self.opened |= set(range(len(self.map_to_fold), len(self.map_to_fold) + degree))
        self.map_to_fold += [(visit, (door + step) % degree) for step in range(degree)]

    def facts(self, event: DeclaredDecision) -> tuple[Fact, ...]:
        """What a decision says, with evidence; none if there is none. S grows by it."""
        edge = event.edge
        if isinstance(event, Reject):
            found = [self.apart(edge, event.hypothesis)]
        elif isinstance(event, Augment) and event.kind == "new":
            rest = sorted(self.opened - {edge})
            entry = self.entry(edge)
            found = [self.joined(edge, entry), *(self.apart(edge, dart) for dart in rest)]
            self.draw(entry)
        else:
            other = event.dart if isinstance(event, Augment) else event.hypothesis
            found = [self.joined(edge, self.map_to_fold[other])]
        if isinstance(event, Augment):
            self.opened -= {edge, event.dart}
        facts = tuple(fact for fact in found if fact is not None)
        return facts if len(facts) == len(found) else ()

    def entry(self, edge: int) -> LogPlace:
        """The place to which the first move through a dart of S led."""
        arc = self.fold.joining(self.map_to_fold[edge])
        assert arc is not None, "an edge that leads to a new vertex was crossed"
        leaves, arrives = self.fold.edges[arc.visit]
        return arrives if arc.forwards else leaves

    def joined(self, edge: int, other: LogPlace) -> Fact | None:
        """An edge leads from a dart of S to a place."""
        one = self.map_to_fold[edge]
        arc = self.fold.joining(one)
        if arc is None or self.fold.end(arc) != self.fold.find(other):
            return None
        return Fact(self.visit, one, other, arc)

    def apart(self, edge: int, dart: int) -> Fact | None:
        """No edge leads from one dart of S to the other."""
        one, other = self.map_to_fold[edge], self.map_to_fold[dart]
        meetings, conflict = self.fold.refute(one, other)
        if conflict is None:
            return None
        return Fact(self.visit, one, other, EdgeRefutation(meetings, conflict))
