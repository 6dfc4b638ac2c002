"""Evidence that the decisions of a trace follow, each from the log as it was at that moment.

A decision rests on facts about places of the log, each a visit and a door: an edge leads from one
to the other, or none does. The evidence for the first is an arc that joins the two; for the second
the merges that follow from an edge between them, up to a conflict.

    reject h, confirm h   one fact about e and h
    augment loop          an edge leads from e to the other dart
    augment new           an edge leads from e to where the robot came in, and none to any other
                          dart of S that is unexplored at that moment

checkers/entailment.py finds which decisions follow; here is the evidence, in the order in which
coq/Decisions.v asks for it. That program finds the facts itself, from the event: it is told the
reasons only. The fold grows from one decision to the next and an assumed edge is taken back, so the
work is one fold and what the assumptions add. This file is not trusted: a mistake here makes a
certificate that the checker refuses.

The map on the fold is kept here a second time, apart from the checkers': a fact names the place of
the log where a dart was seen, and the checkers keep representatives, which later merges replace.

Under the planar prior a decision may follow for planar worlds only. Planarity is not defined in
Coq: such a decision has no evidence, and is left out. If it is an augmentation, S is not proved
from there on, and so no later decision has evidence either.

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
"""Longer evidence is not made: it would take hundreds of megabytes."""


@dataclass(frozen=True, slots=True)
class EdgeRefutation:
    """Why no edge joins two places: with one, these arcs meet, up to this conflict."""

    meetings: tuple[Meeting, ...]
    conflict: Conflict


@dataclass(frozen=True, slots=True)
class Fact:
    """A statement about two places that the log proves up to a visit, with its evidence.

    Attributes:
        visit: the last visit of the log at that moment, counted from 1.
        one, other: the two places.
        reason: the arc that joins them; or the reason why no edge does.
    """

    visit: int
    one: LogPlace
    other: LogPlace
    reason: Arc | EdgeRefutation


@dataclass(frozen=True, slots=True)
class EntailedDecision:
    """A declared decision that follows: the index of its event, and the facts it rests on."""

    when: int
    facts: tuple[Fact, ...]


@dataclass(frozen=True, slots=True)
class EntailedDecisions:
    """The decisions of a trace that follow, with their evidence.

    Attributes:
        stated: those that have evidence, in order; none if it would have more than MOST steps.
        merges: the evidence for the log itself, up to the last decision.
        steps: the length of all evidence: visits, merges, facts, merges under assumptions.
    """

    stated: tuple[EntailedDecision, ...]
    merges: tuple[Meeting, ...]
    steps: int

    @property
    def too_long(self) -> bool:
        """Whether the evidence was not made, for its length."""
        return self.steps > MOST


def evidence_for_decisions(trace: Sequence[Event]) -> EntailedDecisions:
    """The decisions of a trace that follow, with evidence for each.

    Raises:
        InternalError: a decision follows, and no evidence is found for it.
    Complexity: nearly linear in the length of the trace, and what each assumed edge adds.
    """
    # With the planar prior, a decision may follow for planar worlds only and lack evidence here.
    prior = any(isinstance(event, Reject) and event.rule == "planar" for event in trace)
    log = LogSoFar()
    stated: list[EntailedDecision] = []
    spent = steps = 0
    for when, event in following(trace):
        log.catch_up(trace, when)
        facts = log.facts(event)
        if facts:
            stated.append(EntailedDecision(when, facts))
        elif not prior:
            raise InternalError(f"two folds of one log differ at event {when}: {event}")
        elif isinstance(event, Augment):
            break
        spent += sum(map(_length, facts))
        steps = log.visit + len(log.fold.meetings) + spent
        if steps > MOST:
            return EntailedDecisions((), (), steps)
    return EntailedDecisions(tuple(stated), tuple(log.fold.meetings), steps)


def following(trace: Sequence[Event]) -> Iterator[tuple[int, DeclaredDecision]]:
    """The declared decisions that follow, each with the index of its event."""
    if not any(isinstance(event, DeclaredDecision) for event in trace):
        return
    for conclusion in decision_conclusions(trace):
        event = trace[conclusion.when]
        if not conclusion.why and isinstance(event, DeclaredDecision):
            yield conclusion.when, event


def _length(fact: Fact) -> int:
    return 1 + (len(fact.reason.meetings) if isinstance(fact.reason, EdgeRefutation) else 0)


class LogSoFar:
    """The log up to one moment of a trace: its fold, and the map S on the fold."""

    def __init__(self) -> None:
        self.fold = ProofProducingFold()
        self.next = 0  # the index of the first event that is not folded yet
        self.map_to_fold: list[LogPlace] = []  # dart of S -> the place where it was seen
        self.opened: set[int] = set()  # the darts of S that are unexplored

    @property
    def visit(self) -> int:
        """The last visit so far."""
        return len(self.fold.seen) - 1

    def catch_up(self, trace: Sequence[Event], when: int) -> None:
        """Fold all events before this one."""
        passed = trace[self.next : when]
        percepts: list[Percept] = [e.percept for e in passed if isinstance(e, Start | Move)]
        doors: list[Door] = [event.door for event in passed if isinstance(event, Move)]
        conflict = self.fold.extend(percepts, doors)
        assert conflict is None, "decisions are judged only where some world shows the log"
        if self.next == 0:
            # v0, from the marked dart on, which is the reference dart of the first visit.
            self.draw((1, 0))
        self.next = when

    def draw(self, entry: LogPlace) -> None:
        """Add a vertex to S; its first dart was seen at this place."""
        visit, door = entry
        degree = self.fold.seen[visit].degree
        self.opened |= set(range(len(self.map_to_fold), len(self.map_to_fold) + degree))
        self.map_to_fold += [(visit, (door + step) % degree) for step in range(degree)]

    def facts(self, event: DeclaredDecision) -> tuple[Fact, ...]:
        """The facts of a decision, or () if one lacks evidence; an augmentation grows S."""
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
            # For a new vertex, `dart` is its first one, which `draw` has just added.
            self.opened -= {edge, event.dart}
        # All or nothing: half of the facts of an augmentation would state less than it declares.
        facts = tuple(fact for fact in found if fact is not None)
        return facts if len(facts) == len(found) else ()

    def entry(self, edge: int) -> LogPlace:
        """The place where the first move through a dart of S arrived."""
        arc = self.fold.joining(self.map_to_fold[edge])
        assert arc is not None, "the edge to a new vertex was crossed before the vertex is added"
        leaves, arrives = self.fold.edges[arc.visit]
        return arrives if arc.forwards else leaves

    def joined(self, edge: int, other: LogPlace) -> Fact | None:
        """The fact that an edge leads from a dart of S to a place; None if it does not follow."""
        one = self.map_to_fold[edge]
        arc = self.fold.joining(one)
        if arc is None or self.fold.end(arc) != self.fold.find(other):
            return None
        return Fact(self.visit, one, other, arc)

    def apart(self, edge: int, dart: int) -> Fact | None:
        """The fact that no edge joins two darts of S; None if it does not follow."""
        one, other = self.map_to_fold[edge], self.map_to_fold[dart]
        meetings, conflict = self.fold.refute(one, other)
        if conflict is None:
            return None
        return Fact(self.visit, one, other, EdgeRefutation(meetings, conflict))
