"""Evidence for the checker in Coq: a log is folded, and every merge is recorded.

The fold of a log (docs/semantics.md, section 11) by union-find, the way the checker in
coq/Checker.v runs it again: visits are counted from 1; an **arc** is a move taken forwards or
backwards; it leaves by one place (visit, dart) and arrives at another. Two arcs that leave by one
dart **meet**: they arrive at one dart. Evidence is the list of meetings, in an order in which the
checker can verify each from those before it. The checker repeats the merges and believes nothing
else, so this file is not trusted: a mistake here makes a certificate that the checker refuses.
Where the conclusion is true, some evidence is accepted (coq/Accepted.v): this file finds it faster.

The smaller of two classes is linked under the larger, so a chain of parents is at most as long as
the logarithm of the number of visits. The checker follows 40 links.

    fold = fold_log(percepts, doors)
    fold.meetings     # the evidence
    fold.table        # the map: for each dart the next, the previous and the other dart
    fold.conflict     # the contradiction if no world shows the log, else None

Complexity: nearly linear in the number of moves, times that logarithm.

**Decisions** of a trace follow, each from the log as it was at that moment. A decision rests on
facts about places of the log, each a visit and a door: an edge leads from one to the other, or none
does. The evidence for the first is an arc that joins the two; for the second the merges that follow
from an edge between them, up to a conflict.

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

Source: docs/semantics.md, section 11; docs/proofs.md.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from topo_verify.checkers import decision_conclusions
from topo_verify.errors import InternalError
from topo_verify.robot.events import Augment, Confirm, Event, Move, Reject, Start
from topo_verify.robot.percept import Door, Percept


class Arc(NamedTuple):
    """The move that starts at this visit, taken forwards or backwards."""

    forwards: bool
    visit: int


Meeting = tuple[Arc, Arc]
LogPlace = tuple[int, int]
"""A visit, counted from 1, and a dart of its vertex, counted from the reference dart."""


@dataclass(frozen=True, slots=True)
class Arrive:
    """Conflict: two arcs that leave by one dart arrive at places that cannot be one dart."""

    meeting: Meeting


@dataclass(frozen=True, slots=True)
class Marked:
    """Conflict: this visit saw the marker, and its place cannot be the marked dart."""

    visit: int


@dataclass(frozen=True, slots=True)
class Alone:
    """Conflict: the move that starts at this visit would leave and arrive by one dart."""

    visit: int


@dataclass(frozen=True, slots=True)
class Illegal:
    """Conflict: a door or a marker beyond the degree, or a start away from the marker."""


Conflict = Arrive | Marked | Alone | Illegal


class MapRow(NamedTuple):
    """A dart of a map: the next and the previous one clockwise, and its partner; None: open."""

    following: int
    previous: int
    other: int | None


@dataclass(frozen=True, slots=True)
class FoldedLog:
    """The result of folding a log.

    Attributes:
        meetings: the evidence.
        conflict: the contradiction if no world shows the log; None if some world does.
        table: the fold as a map whose root is dart 0; empty if there is a conflict.
    """

    meetings: tuple[Meeting, ...]
    conflict: Conflict | None
    table: tuple[MapRow, ...]

    @property
    def closed(self) -> bool:
        """Whether no dart is open, so that the log determines the map."""
        return all(row.other is not None for row in self.table)


def fold_log(percepts: Sequence[Percept], doors: Sequence[Door]) -> FoldedLog:
    """The fold of the log of these percepts; door i leads from percept i to percept i + 1."""
    if not _legal(percepts, doors):
        return FoldedLog((), Illegal(), ())
    fold = ProofProducingFold()
    conflict = fold.extend(percepts, doors) or fold.alone()
    return FoldedLog(tuple(fold.meetings), conflict, () if conflict else fold.table())


def _legal(percepts: Sequence[Percept], doors: Sequence[Door]) -> bool:
    starts = percepts[0].marker == 0
    # Degree 0 is refused as well: a place to which the robot came has a dart.
    shown = all(p.degree > (p.marker or 0) >= 0 for p in percepts)
    return (
        starts and shown and all(0 <= k < p.degree for k, p in zip(doors, percepts, strict=False))
    )


class ProofProducingFold:
    """A union-find over visits that records its merges; it grows by `extend`.

    Visits and moves are counted from 1, as in Coq: index 0 of each list is a filler.

    Attributes:
        seen: the percept at each visit.
        edges: of each move, the place where it leaves and the place where it arrives.
        parent, offset: a visit's parent in the union-find; its dart d is dart d + offset there.
        size: of a root, the number of visits in its class.
        leaving: of a root, the first arc that leaves by each dart.
        meetings: the evidence so far.
        done: a log of changes, for `refute` to undo: (visit, dart) for a dart that got its first
            arc, (visit, None) for a root that was linked under another.
    """

    def __init__(self) -> None:
        self.seen = [Percept(0, None)]
        self.edges: list[tuple[LogPlace, LogPlace]] = [((0, 0), (0, 0))]
        self.parent = [0]
        self.offset = [0]
        self.size = [1]
        self.leaving: list[dict[int, Arc]] = [{}]
        self.meetings: list[Meeting] = []
        self.done: list[tuple[int, int | None]] = []

    def extend(self, percepts: Sequence[Percept], doors: Sequence[Door]) -> Conflict | None:
        """Fold more visits and the moves that lead there; return the first conflict."""
        visits = range(len(self.seen), len(self.seen) + len(percepts))
        moves = range(len(self.edges), len(self.edges) + len(doors))
        self.seen += percepts
        self.parent += visits
        self.offset += [0] * len(visits)
        self.size += [1] * len(visits)
        self.leaving += [{} for _ in visits]
        # Move v leads from visit v to visit v + 1, and arrives by dart 0 there.
        self.edges += [((v, door), (v + 1, 0)) for v, door in zip(moves, doors, strict=True)]
        # Markers first: these merges follow from the percepts alone, and need no evidence.
        for visit, percept in zip(visits, percepts, strict=True):
            if percept.marker is not None:
                one, other = self.find((1, 0)), self.find((visit, percept.marker))
                if self.apart(one, other):
                    return Marked(visit)
                self.link(one, other)
        for move in moves:
            if conflict := self.cross(move):
                return conflict
        return None

    def alone(self) -> Alone | None:
        """The conflict of the first edge whose two darts are one; None if there is none."""
        edges = range(1, len(self.edges))
        return next((Alone(e) for e in edges if self.leaves(e) == self.arrives(e)), None)

    def joining(self, place: LogPlace) -> Arc | None:
        """The first arc that leaves by this dart; None if the dart is open."""
        visit, dart = self.find(place)
        return self.leaving[visit].get(dart)

    def refute(self, one: LogPlace, other: LogPlace) -> tuple[tuple[Meeting, ...], Conflict | None]:
        """The meetings that follow from an edge between two places, and the conflict, if any.

        The fold is unchanged afterwards.
        """
        met, done, number = len(self.meetings), len(self.done), len(self.edges)
        self.edges.append((one, other))
        conflict = self.cross(number) or self.alone()
        found = tuple(self.meetings[met:])
        # An assumed edge leaves no trace: the next decision starts from the log alone.
        self._undo(done)
        del self.meetings[met:], self.edges[number:]
        return found, conflict

    def _undo(self, done: int) -> None:
        # In reverse order: a link is undone only after the arcs that it brought along. There is no
        # path compression anywhere, since what it changes could not be undone so simply.
        while len(self.done) > done:
            visit, dart = self.done.pop()
            if dart is not None:
                del self.leaving[visit][dart]
            else:
                self.size[self.parent[visit]] -= self.size[visit]
                self.parent[visit], self.offset[visit] = visit, 0

    def leaves(self, edge: int) -> LogPlace:
        """The place where a move, or an assumed edge, leaves."""
        return self.find(self.edges[edge][0])

    def arrives(self, edge: int) -> LogPlace:
        """The place where a move, or an assumed edge, arrives."""
        return self.find(self.edges[edge][1])

    def end(self, arc: Arc) -> LogPlace:
        """The place where an arc arrives."""
        return self.arrives(arc.visit) if arc.forwards else self.leaves(arc.visit)

    def find(self, place: LogPlace) -> LogPlace:
        """The representative of all places that are the same dart."""
        visit, dart = place
        while self.parent[visit] != visit:
            dart += self.offset[visit]
            visit = self.parent[visit]
        return visit, dart % self.seen[visit].degree

    def apart(self, one: LogPlace, other: LogPlace) -> bool:
        """Whether two representatives cannot be one dart."""
        if one[0] == other[0]:
            return one != other
        return self.seen[one[0]].signature != self.seen[other[0]].signature

    def cross(self, edge: int) -> Conflict | None:
        """Add an edge as two arcs, forwards and backwards; return the first conflict."""
        return self.note(Arc(forwards=True, visit=edge)) or self.note(
            Arc(forwards=False, visit=edge)
        )

    def note(self, arc: Arc) -> Conflict | None:
        """Add an arc and make all merges that follow; return the first conflict."""
        visit, dart = self.leaves(arc.visit) if arc.forwards else self.arrives(arc.visit)
        first = self.first(visit, dart, arc)
        # A stack, not a recursion: one arc can set off as many merges as there are visits.
        todo: list[Meeting] = [] if first is arc else [(first, arc)]
        while todo:
            meeting = todo.pop()
            one, other = map(self.end, meeting)
            if self.apart(one, other):
                return Arrive(meeting)
            if one != other:
                # The checker links the end of the second arc under that of the first: swap both.
                if self.size[one[0]] < self.size[other[0]]:
                    meeting, one, other = (meeting[1], meeting[0]), other, one
                self.meetings.append(meeting)
                todo += self.link(one, other)
        return None

    def link(self, one: LogPlace, other: LogPlace) -> list[Meeting]:
        """Link the class of the second place under that of the first; return the arcs that meet."""
        (kept, i), (lost, j) = one, other
        if kept == lost:
            return []
        # Dart i of `kept` and dart j of `lost` are one dart.
        degree = self.seen[kept].degree
        self.parent[lost], self.offset[lost] = kept, (i - j) % degree
        self.size[kept] += self.size[lost]
        self.done.append((lost, None))
        found: list[Meeting] = []
        for dart, arc in self.leaving[lost].items():
            first = self.first(kept, (dart + i - j) % degree, arc)
            if first is not arc:
                found.append((first, arc))
        return found

    def first(self, visit: int, dart: int, arc: Arc) -> Arc:
        """The arc that left first by a dart of a root: this one, if there was none."""
        # Noted in `done` only if it is new, since `_undo` deletes what is noted there.
        first = self.leaving[visit].setdefault(dart, arc)
        if first is arc:
            self.done.append((visit, dart))
        return first

    def table(self) -> tuple[MapRow, ...]:
        """The fold as a map: vertices in order of discovery, each numbered from its entry dart."""
        first: dict[int, LogPlace] = {}  # root visit -> its entry dart, the number of that dart
        order: list[LogPlace] = []  # number -> dart
        self.discover(self.find((1, 0)), first, order)
        rows: list[MapRow] = []
        for number, (visit, dart) in enumerate(order):
            arc = self.leaving[visit].get(dart)
            other = None if arc is None else self.number(self.end(arc), first)
            # The darts of a vertex have consecutive numbers from `low` on.
            low = first[visit][1]
            degree = self.seen[visit].degree
            after, before = ((number - low + step) % degree + low for step in (1, -1))
            rows.append(MapRow(after, before, other))
        return tuple(rows)

    def discover(self, root: LogPlace, first: dict[int, LogPlace], order: list[LogPlace]) -> None:
        """Number the darts breadth-first, those of each vertex from its entry dart on."""
        todo = [root]
        for visit, entry in todo:
            if visit in first:
                continue
            first[visit] = entry, len(order)
            degree = self.seen[visit].degree
            darts = [(visit, (entry + step) % degree) for step in range(degree)]
            order += darts
            arcs = (self.leaving[visit].get(dart) for _, dart in darts)
            todo += [self.end(arc) for arc in arcs if arc is not None]

    def number(self, place: LogPlace, first: dict[int, LogPlace]) -> int:
        """The number of a dart in the table."""
        visit, dart = place
        entry, low = first[visit]
        return low + (dart - entry) % self.seen[visit].degree


# ------------------------------------------------------------ evidence for the decisions of a trace

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
