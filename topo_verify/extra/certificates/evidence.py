"""Fold a log and record every merge, as evidence for the checker in Coq.

The fold of a log (docs/semantics.md, section 11) by union-find. Visits are counted from 1. An
**arc** is a move taken forwards or backwards, from one place (visit, dart) to another. Two arcs
that leave by one dart **meet**: they arrive at one dart. Evidence is a list of meetings, each of
which follows from those before it. The smaller class is linked under the larger, since the checker
(coq/Checker.v) follows 40 links. A mistake here makes a certificate that is refused. Complexity:
nearly linear in the number of moves.

**Decisions** rest on facts about two places: an edge joins them (evidence: an arc), or none does
(evidence: the merges that it would imply, up to a conflict).

    reject h, confirm h   one fact about e and h
    augment loop          an edge leads from e to the other dart
    augment new           an edge leads from e to where the robot came in, and none to any other
                          dart of S that is unexplored at that moment

Places are not the checkers' representatives, which later merges replace. Coq has no planarity: a
decision that follows under the planar prior only is left out; after such an augmentation all are.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from topo_verify.checkers import decision_conclusions
from topo_verify.checkers.entailment import FoldedTrace
from topo_verify.errors import InternalError
from topo_verify.robot.events import Augment, Confirm, Event, Move, Reject, Start
from topo_verify.robot.percept import Door, Percept


class Arc(NamedTuple):
    """The move from this visit, forwards or backwards."""

    forwards: bool
    visit: int


Meeting = tuple[Arc, Arc]
LogPlace = tuple[int, int]
"""A visit, from 1, and a dart, counted from the reference dart."""


@dataclass(frozen=True, slots=True)
class Arrive:
    """Arcs that leave by one dart arrive at two."""

    meeting: Meeting


@dataclass(frozen=True, slots=True)
class Marked:
    """The visit saw the marker, but not at the marked dart."""

    visit: int


@dataclass(frozen=True, slots=True)
class Alone:
    """The move would leave and arrive by one dart."""

    visit: int


@dataclass(frozen=True, slots=True)
class Illegal:
    """The log has a door or a marker beyond the degree, or no marker at the start."""


Conflict = Arrive | Marked | Alone | Illegal


class MapRow(NamedTuple):
    """A dart of a map: next and previous clockwise, partner (None: open)."""

    following: int
    previous: int
    other: int | None


@dataclass(frozen=True, slots=True)
class FoldedLog:
    """The fold of a log; `table` is the map with root dart 0, empty after a conflict."""

    meetings: tuple[Meeting, ...]
    conflict: Conflict | None
    table: tuple[MapRow, ...]

    @property
    def closed(self) -> bool:
        """Is no dart open, so that the log determines the map?"""
        return all(row.other is not None for row in self.table)


def fold_log(percepts: Sequence[Percept], doors: Sequence[Door]) -> FoldedLog:
    """Fold a log; door i leads from percept i to percept i + 1."""
    if not _legal(percepts, doors):
        return FoldedLog((), Illegal(), ())
    fold = ProofProducingFold()
    conflict = fold.extend(percepts, doors) or fold.alone()
    return FoldedLog(tuple(fold.meetings), conflict, () if conflict else fold.table())


def _legal(percepts: Sequence[Percept], doors: Sequence[Door]) -> bool:
    starts = percepts[0].marker == 0
    # This refuses degree 0, too: the robot came in by a dart.
    shown = all(p.degree > (p.marker or 0) >= 0 for p in percepts)
    return (
        starts and shown and all(0 <= k < p.degree for k, p in zip(doors, percepts, strict=False))
    )


class ProofProducingFold:
    """A union-find over visits that records its merges; index 0 of each list is a filler.

    There is no path compression, which would be hard to undo.

    Attributes:
        edges: the places where each move leaves and arrives.
        parent, offset: dart d of a visit is dart d + offset of its parent.
        size: for each root, the visits in its class.
        leaving: for each root, the first arc by each dart.
        done: changes to undo: (visit, dart) for a first arc, (visit, None) for a link.
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
        """Fold more visits and moves; return the first conflict."""
        visits = range(len(self.seen), len(self.seen) + len(percepts))
        moves = range(len(self.edges), len(self.edges) + len(doors))
        self.seen += percepts
        self.parent += visits
        self.offset += [0] * len(visits)
        self.size += [1] * len(visits)
        self.leaving += [{} for _ in visits]
        self.edges += [((v, door), (v + 1, 0)) for v, door in zip(moves, doors, strict=True)]
        # These merges follow from the percepts alone, and need no evidence.
        for visit, percept in zip(visits, percepts, strict=True):
            if percept.marker is not None:
                one, other = self.find((1, 0)), self.find((visit, percept.marker))
                if self._apart(one, other):
                    return Marked(visit)
                self._link(one, other)
        for move in moves:
            if conflict := self._cross(move):
                return conflict
        return None

    def alone(self) -> Alone | None:
        """The conflict of an edge whose darts are one."""
        edges = range(1, len(self.edges))
        return next((Alone(e) for e in edges if self._leaves(e) == self._arrives(e)), None)

    def joining(self, place: LogPlace) -> Arc | None:
        visit, dart = self.find(place)
        return self.leaving[visit].get(dart)

    def refute(self, one: LogPlace, other: LogPlace) -> tuple[tuple[Meeting, ...], Conflict | None]:
        """The meetings and the conflict that an edge implies; it is not kept."""
        met, done, number = len(self.meetings), len(self.done), len(self.edges)
        self.edges.append((one, other))
        conflict = self._cross(number) or self.alone()
        meetings = tuple(self.meetings[met:])
        self._undo(done)
        del self.meetings[met:], self.edges[number:]
        return meetings, conflict

    def _undo(self, done: int) -> None:
        # There is no path compression, which would be hard to undo.
        while len(self.done) > done:
            visit, dart = self.done.pop()
            if dart is not None:
                del self.leaving[visit][dart]
            else:
                self.size[self.parent[visit]] -= self.size[visit]
                self.parent[visit], self.offset[visit] = visit, 0

    def _leaves(self, edge: int) -> LogPlace:
        return self.find(self.edges[edge][0])

    def _arrives(self, edge: int) -> LogPlace:
        return self.find(self.edges[edge][1])

    def end(self, arc: Arc) -> LogPlace:
        return self._arrives(arc.visit) if arc.forwards else self._leaves(arc.visit)

    def find(self, place: LogPlace) -> LogPlace:
        visit, dart = place
        while self.parent[visit] != visit:
            dart += self.offset[visit]
            visit = self.parent[visit]
        return visit, dart % self.seen[visit].degree

    def _apart(self, one: LogPlace, other: LogPlace) -> bool:
        if one[0] == other[0]:
            return one != other
        return self.seen[one[0]].signature != self.seen[other[0]].signature

    def _cross(self, edge: int) -> Conflict | None:
        return self._note(Arc(forwards=True, visit=edge)) or self._note(
            Arc(forwards=False, visit=edge)
        )

    def _note(self, arc: Arc) -> Conflict | None:
        """Add an arc with the merges that follow; return the first conflict."""
        visit, dart = self._leaves(arc.visit) if arc.forwards else self._arrives(arc.visit)
        first = self._first(visit, dart, arc)
        # Not a recursion: one arc can cause as many merges as there are visits.
        todo: list[Meeting] = [] if first is arc else [(first, arc)]
        while todo:
            meeting = todo.pop()
            one, other = map(self.end, meeting)
            if self._apart(one, other):
                return Arrive(meeting)
            if one != other:
                # The checker links the second arc's end under the first one's.
                if self.size[one[0]] < self.size[other[0]]:
                    meeting, one, other = (meeting[1], meeting[0]), other, one
                self.meetings.append(meeting)
                todo += self._link(one, other)
        return None

    def _link(self, one: LogPlace, other: LogPlace) -> list[Meeting]:
        """Link the second class under the first; return the arcs that meet."""
        (kept, i), (lost, j) = one, other
        if kept == lost:
            return []
        degree = self.seen[kept].degree
        self.parent[lost], self.offset[lost] = kept, (i - j) % degree
        self.size[kept] += self.size[lost]
        self.done.append((lost, None))
        meetings: list[Meeting] = []
        for dart, arc in self.leaving[lost].items():
            first = self._first(kept, (dart + i - j) % degree, arc)
            if first is not arc:
                meetings.append((first, arc))
        return meetings

    def _first(self, visit: int, dart: int, arc: Arc) -> Arc:
        first = self.leaving[visit].setdefault(dart, arc)
        if first is arc:
            self.done.append((visit, dart))
        return first

    def table(self) -> tuple[MapRow, ...]:
        """The fold as a map, in order of discovery."""
        first: dict[int, LogPlace] = {}  # root -> entry dart, its number
        order: list[LogPlace] = []  # number -> dart
        self._discover(self.find((1, 0)), first, order)
        rows: list[MapRow] = []
        for number, (visit, dart) in enumerate(order):
            arc = self.leaving[visit].get(dart)
            other = None if arc is None else self._number(self.end(arc), first)
            low = first[visit][1]
            degree = self.seen[visit].degree
            after, before = ((number - low + step) % degree + low for step in (1, -1))
            rows.append(MapRow(after, before, other))
        return tuple(rows)

    def _discover(self, root: LogPlace, first: dict[int, LogPlace], order: list[LogPlace]) -> None:
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

    def _number(self, place: LogPlace, first: dict[int, LogPlace]) -> int:
        visit, dart = place
        entry, low = first[visit]
        return low + (dart - entry) % self.seen[visit].degree


DeclaredDecision = Reject | Confirm | Augment

MOST = 2_000_000
"""Longer evidence is not made: it would take hundreds of megabytes."""


@dataclass(frozen=True, slots=True)
class EdgeRefutation:
    meetings: tuple[Meeting, ...]
    conflict: Conflict


@dataclass(frozen=True, slots=True)
class Fact:
    """The arc that joins two places, or why no edge does, proved at a visit."""

    visit: int
    one: LogPlace
    other: LogPlace
    reason: Arc | EdgeRefutation


@dataclass(frozen=True, slots=True)
class EntailedDecision:
    """The index of a decision that follows, and its facts."""

    when: int
    facts: tuple[Fact, ...]


@dataclass(frozen=True, slots=True)
class EntailedDecisions:
    """The decisions of a trace that follow, in order; none if their evidence exceeds MOST steps.

    Attributes:
        merges: the evidence for the log up to the last decision.
    """

    stated: tuple[EntailedDecision, ...]
    merges: tuple[Meeting, ...]
    steps: int

    @property
    def too_long(self) -> bool:
        return self.steps > MOST


def evidence_for_decisions(trace: Sequence[Event]) -> EntailedDecisions:
    """The decisions of a trace that follow, with evidence.

    Raises:
        InternalError: a decision follows, but lacks evidence.
    """
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
    """Yield the index and event of each decision that follows."""
    if not any(isinstance(event, DeclaredDecision) for event in trace):
        return
    for conclusion in decision_conclusions(FoldedTrace(trace)):
        event = trace[conclusion.when]
        if not conclusion.why and isinstance(event, DeclaredDecision):
            yield conclusion.when, event


def _length(fact: Fact) -> int:
    return 1 + (len(fact.reason.meetings) if isinstance(fact.reason, EdgeRefutation) else 0)


class LogSoFar:
    """The log before one event, and the map S on its fold."""

    def __init__(self) -> None:
        self.fold = ProofProducingFold()
        self.next = 0  # first event not folded yet
        self.map_to_fold: list[LogPlace] = []  # dart of S -> where it was seen
        self.opened: set[int] = set()  # unexplored darts of S

    @property
    def visit(self) -> int:
        return len(self.fold.seen) - 1

    def catch_up(self, trace: Sequence[Event], when: int) -> None:
        passed = trace[self.next : when]
        percepts: list[Percept] = [e.percept for e in passed if isinstance(e, Start | Move)]
        doors: list[Door] = [event.door for event in passed if isinstance(event, Move)]
        conflict = self.fold.extend(percepts, doors)
        assert conflict is None, "decisions are judged only where some world shows the log"
        if self.next == 0:
            self.draw((1, 0))
        self.next = when

    def draw(self, entry: LogPlace) -> None:
        """Add a vertex to S; its first dart was seen here."""
        visit, door = entry
        degree = self.fold.seen[visit].degree
        self.opened |= set(range(len(self.map_to_fold), len(self.map_to_fold) + degree))
        self.map_to_fold += [(visit, (door + step) % degree) for step in range(degree)]

    def facts(self, event: DeclaredDecision) -> tuple[Fact, ...]:
        """The facts of a decision, or () if one lacks evidence; an augmentation grows S."""
        edge = event.edge
        if isinstance(event, Reject):
            facts_or_none = [self._apart(edge, event.hypothesis)]
        elif isinstance(event, Augment) and event.kind == "new":
            rest = sorted(self.opened - {edge})
            entry = self.entry(edge)
            facts_or_none = [self.joined(edge, entry), *(self._apart(edge, dart) for dart in rest)]
            self.draw(entry)
        else:
            other = event.dart if isinstance(event, Augment) else event.hypothesis
            facts_or_none = [self.joined(edge, self.map_to_fold[other])]
        if isinstance(event, Augment):
            self.opened -= {edge, event.dart}
        # Some facts of an augmentation would state less than it declares.
        facts = tuple(fact for fact in facts_or_none if fact is not None)
        return facts if len(facts) == len(facts_or_none) else ()

    def entry(self, edge: int) -> LogPlace:
        """Where the first move through a dart of S arrived."""
        arc = self.fold.joining(self.map_to_fold[edge])
        assert arc is not None, "the edge to a new vertex was crossed before the vertex is added"
        leaves, arrives = self.fold.edges[arc.visit]
        return arrives if arc.forwards else leaves

    def joined(self, edge: int, other: LogPlace) -> Fact | None:
        """The fact that an edge leads from a dart of S to a place."""
        dart = self.map_to_fold[edge]
        arc = self.fold.joining(dart)
        if arc is None or self.fold.end(arc) != self.fold.find(other):
            return None
        return Fact(self.visit, dart, other, arc)

    def _apart(self, edge: int, dart: int) -> Fact | None:
        one, other = self.map_to_fold[edge], self.map_to_fold[dart]
        meetings, conflict = self.fold.refute(one, other)
        if conflict is None:
            return None
        return Fact(self.visit, one, other, EdgeRefutation(meetings, conflict))
