"""Conformance: the terms of `theory.py`, evaluated on real runs, decide as the code does.

At each decision of a trace the terms tell which darts are hypotheses, which of them the rule
rejects and when, and where the motion stops. No world is needed: dart b of the terms is the number
of a percept; `rot(b, i) = root` means that the marker was sensed at door i.

What this does not show: policies, walks and costs; rule `folding`, which is compared with
`checkers/folding.py`; and `planar`, which is not sound.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from topo_verify.algorithms.chart import Chart, Tree
from topo_verify.algorithms.motion import Hypothesis
from topo_verify.proofs.first_order.terms import Function, Structure, Term, Value
from topo_verify.proofs.first_order.theory import RULES
from topo_verify.robot.events import Augment, Confirm, Event, MapDart, Move, Pose, Reject, Start
from topo_verify.robot.percept import Door, Percept
from topo_verify.robot.simulator import exit_dart
from topo_verify.world.rooted_map import World

NO_DOOR = -1
"""`rot(b, i)` where it is not the root, 0."""


class RecordTrie:
    """The records as numbered nodes: a percept, and by door the node behind."""

    def __init__(self) -> None:
        self.percepts: list[Percept] = []
        self.behind: list[dict[Door, int]] = []
        self.records: dict[MapDart, int] = {}

    def node(self, percept: Percept) -> int:
        self.percepts.append(percept)
        self.behind.append({})
        return len(self.percepts) - 1


def points(percept: Percept, door: Door) -> bool:
    return percept.marker is not None and (door - percept.marker) % percept.degree == 0


def structure(chart: Chart, percepts: Sequence[Percept], trie: RecordTrie) -> Structure:
    """S, the sensed percepts, and the records as a structure."""
    rows = {
        "root": nullary(0),
        "mroot": nullary(0),
        "succ": unary(lambda k: k + 1),
        **_of_chart(chart),
        **_of_percepts(percepts),
        **_of_records(trie),
    }
    # Beyond the largest degree, doors repeat.
    degrees = [*chart.degree, *(percept.degree for percept in percepts), 1]
    return Structure({"K": max(degrees), "M": len(chart.alpha)}, rows)


def _of_chart(chart: Chart) -> dict[str, Function]:
    percepts, alpha = chart.percepts, chart.alpha
    return {
        "explored": unary(lambda x: alpha[x] is not None),
        # No rule uses malpha at an unexplored dart.
        "malpha": unary(lambda x: x if alpha[x] is None else chart.across(x)),
        "mrot": binary(chart.turn),
        "mdeg": unary(lambda x: percepts[x].degree),
        "minv0": unary(lambda x: percepts[x].marker is not None),
        "mfirst": unary(lambda x: chart.first[chart.vertex[x]]),
    }


def _of_percepts(percepts: Sequence[Percept]) -> dict[str, Function]:
    return {
        "deg": unary(lambda b: percepts[b].degree),
        "inv0": unary(lambda b: percepts[b].marker is not None),
        "rot": binary(lambda b, i: 0 if points(percepts[b], i) else NO_DOOR),
    }


def _of_records(trie: RecordTrie) -> dict[str, Function]:
    percepts, records = trie.percepts, trie.records
    return {
        "recorded": unary(lambda x: x in records),
        "record": unary(lambda x: records.get(x, 0)),
        "deeper": binary(lambda r, k: k in trie.behind[r]),
        "behind": binary(lambda r, k: trie.behind[r].get(k, 0)),
        "rdeg": unary(lambda r: percepts[r].degree),
        "rinv0": unary(lambda r: percepts[r].marker is not None),
        "rpoints": binary(lambda r, i: points(percepts[r], i)),
    }


def nullary(value: Value) -> Function:
    return lambda: value


def unary(function: Callable[[int], Value]) -> Function:
    # This tells type checkers the number of arguments.
    return function


def binary(function: Callable[[int, int], Value]) -> Function:
    return function


def wraps(degree: int, i: int, j: int) -> bool:
    return (i - j) % degree == 0


def of_world(world: World) -> dict[str, Function]:
    """What the symbols of a world and of doors mean in this world."""
    return {
        "sigma": unary(lambda a: world.sigma[a]),
        "alpha": unary(lambda a: world.alpha[a]),
        "deg": unary(lambda a: world.degrees[world.vertex_of[a]]),
        "inv0": unary(lambda a: world.vertex_of[a] == world.marker_vertex),
        "rot": binary(lambda a, k: exit_dart(world, a, k)),
        "root": nullary(world.root or 0),
        "k0": nullary(0),
        "succ": unary(lambda k: k + 1),
        "wraps": wraps,
    }


@dataclass(frozen=True, slots=True)
class RuleRejection:
    hypothesis: MapDart
    rule: str
    step: int


@dataclass
class DescribedRule:
    """A rule as its terms describe it, while one trace is read.

    Attributes:
        rule: `none`, `prefix`, `history` or `records`.
        levels: the depth of records; None: any.
        terms: default `RULES`; a test passes changed ones.
    """

    rule: str
    levels: int | None = None
    terms: Mapping[str, Term] = field(default_factory=lambda: RULES)
    trie: RecordTrie = field(default_factory=RecordTrie)

    def posed(self, chart: Chart, e: MapDart, percept: Percept) -> set[MapDart]:
        place = structure(chart, [percept], self.trie)
        open_darts = [d for d in range(len(chart.alpha)) if chart.alpha[d] is None]
        return {h for h in open_darts if place.holds(self.terms["posed"], e=e, h=h, b=0)}

    def moved(self, chart: Chart, h: Hypothesis, percepts: Sequence[Percept]) -> int | None:
        """The step at which the motion rejects h, if any."""
        place = structure(chart, percepts, self.trie)
        if not place.holds(self.terms["alike"], x=h.dart, b=0):
            return 0
        for step in range(1, len(percepts)):
            x, k = h.arrivals[step - 1], h.doors[step - 1]
            if place.holds(self.terms["motion"], x=x, k=k, b=step):
                return step
        return None

    def refuted(
        self, place: Structure, h: Hypothesis, doors: Sequence[Door]
    ) -> RuleRejection | None:
        """The rule's rejection after these doors, if any."""
        if self.rule == "none":
            return None
        if self.rule == "prefix":
            step = self._prefix(place, h, doors)
            return None if step is None else RuleRejection(h.dart, "prefix", step)
        return self._traced(place, h.dart, doors)

    def _prefix(self, place: Structure, h: Hypothesis, doors: Sequence[Door]) -> int | None:
        for step, (own, door) in enumerate(zip(h.doors, doors, strict=False), 1):
            if place.holds(self.terms["prefix"], x=h.arrivals[step - 1], own=own, k=door, b=step):
                return step
            if own != door:
                return None
        return None

    def _traced(self, place: Structure, at: MapDart, doors: Sequence[Door]) -> RuleRejection | None:
        hypothesis, functions = at, place.functions
        node: int | None = None  # of the trie, beyond S
        depth = 0
        for step, door in enumerate(doors, 1):
            if node is None:
                if place.holds(self.terms["history"], x=at, k=door, b=step):
                    return RuleRejection(hypothesis, "history", step)
                exit_dart = int(functions["mrot"](at, door))
                if functions["explored"](exit_dart):
                    at = int(functions["malpha"](exit_dart))
                    continue
                if self.rule != "records" or not place.holds(self.terms["leaves"], x=at, k=door):
                    return None
                node = int(functions["record"](exit_dart))
            elif functions["deeper"](node, door):
                node = int(functions["behind"](node, door))
            else:
                return None
            depth += 1
            if place.holds(self.terms["record-differs"], r=node, b=step):
                return RuleRejection(hypothesis, "records", step)
            if depth == self.levels:
                return None
        return None

    def learn(
        self,
        chart: Chart,
        e: MapDart,
        entry: MapDart,
        words: Iterable[tuple[list[Door], list[Percept]]],
    ) -> None:
        """Record what was executed behind an edge, whose entry dart is known now."""
        if self.rule != "records":
            return
        # Nothing is traced out of S through an explored edge.
        self.trie.records.pop(e, None)
        self.trie.records.pop(entry, None)
        for doors, percepts in words:
            self._write(chart, entry, doors, percepts)

    def _write(self, chart: Chart, at: MapDart, doors: list[Door], percepts: list[Percept]) -> None:
        node: int | None = None
        room = self.levels
        for step, door in enumerate(doors, 1):
            if node is None:
                exit_dart = chart.turn(at, door)
                if chart.alpha[exit_dart] is not None:
                    at = chart.across(exit_dart)
                    continue
                if exit_dart not in self.trie.records:
                    self.trie.records[exit_dart] = self.trie.node(percepts[step])
                node = self.trie.records[exit_dart]
            else:
                if door not in self.trie.behind[node]:
                    self.trie.behind[node][door] = self.trie.node(percepts[step])
                node = self.trie.behind[node][door]
            room = None if room is None else room - 1
            if room == 0:
                return


class TraceReader:
    """S, and the robot's word behind the current edge."""

    def __init__(self, start: Percept) -> None:
        self.chart = Chart(start)
        self.doors: list[Door] = []
        self.seen: list[Percept] = [start]
        self.turned: Door = 0

    def move(self, move: Move) -> None:
        """Extend the word, take back its last door, or begin a new one."""
        if move.purpose in ("walk", "cross"):
            self.doors, self.seen, self.turned = [], [move.percept], 0
        elif move.purpose == "retrace":
            self.turned = self.doors.pop()
            self.seen.pop()
        else:
            self.doors.append((move.door + self.turned) % self.seen[-1].degree)
            self.seen.append(move.percept)
            self.turned = 0

    def augment(self, event: Augment) -> MapDart:
        """Let S grow; return the entry dart."""
        if event.kind == "loop":
            self.chart.join(event.edge, event.dart)
            return event.dart
        entry = self.chart.add_vertex(self.at_vu)
        self.chart.join(event.edge, entry)
        return entry

    @property
    def at_vu(self) -> Percept:
        return self.seen[0]


def compare(trace: Sequence[Event], described: DescribedRule) -> Iterator[str]:
    """Yield each difference between a run's decisions and the terms', as a sentence."""
    start = trace[0]
    assert isinstance(start, Start)
    reading = TraceReader(start.percept)
    words: list[tuple[list[Door], list[Percept]]] = []
    expected: list[RuleRejection] = []
    remaining: list[MapDart] = []
    tree = reading.chart.tree(0)
    for when, event in enumerate(trace):
        match event:
            case Move():
                reading.move(event)
            case Pose(edge, hypotheses):
                words, expected, remaining = [], [], list(hypotheses)
                tree = reading.chart.tree(0)
                posed = described.posed(reading.chart, edge, reading.at_vu)
                if posed != set(hypotheses):
                    yield f"event {when}: posed {sorted(hypotheses)}, described {sorted(posed)}"
            case Reject(_, dart, "motion", evidence):
                h = Hypothesis(dart, reading.chart, tree)
                step = described.moved(reading.chart, h, reading.seen)
                if step != evidence.step or expected:
                    yield f"event {when}: motion rejects {dart} at {evidence.step}, not {step}"
                remaining.remove(dart)
                # After a mismatch the rule judges all remaining hypotheses.
                if reading.doors:
                    words.append((reading.doors.copy(), reading.seen.copy()))
                    expected = list(_sifted(described, reading, remaining, tree))
            case Reject(_, dart, rule, evidence):
                declared = RuleRejection(dart, rule, evidence.step)
                if not expected or expected.pop(0) != declared:
                    yield f"event {when}: {declared} is not the rejection that the rule describes"
                remaining.remove(dart)
            case Confirm(_, dart):
                h = Hypothesis(dart, reading.chart, tree)
                # The robot may have gone further than h's way home.
                percepts = reading.seen[: len(h.doors) + 1]
                if expected or described.moved(reading.chart, h, percepts) is not None:
                    yield f"event {when}: {dart} is confirmed, which the rule does not describe"
            case Augment(edge):
                if expected:
                    yield f"event {when}: the rule describes {expected}, which were not declared"
                entry = reading.augment(event)
                described.learn(reading.chart, edge, entry, words)
            case _:
                pass


def _sifted(
    described: DescribedRule, reading: TraceReader, remaining: Iterable[MapDart], tree: Tree
) -> Iterator[RuleRejection]:
    place = structure(reading.chart, reading.seen, described.trie)
    for dart in remaining:
        h = Hypothesis(dart, reading.chart, tree)
        decided = described.refuted(place, h, reading.doors)
        if decided is not None:
            yield decided
