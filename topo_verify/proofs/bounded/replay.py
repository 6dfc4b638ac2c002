"""What a model says happens, done again in the simulator, with no solver in it.

The simulated robot draws the story's map edge by edge, crosses e and takes the doors; then the
checkers are asked about the trace.

    false confirmation   the percepts are the expected ones, as far as the mapper looks at them; it
                         confirms h, and claim `no-false-confirm` must fail just there
    false rejection      the faulty rule, in plain code on the map, finds a percept that is not the
                         expected one; it rejects h, and claim `true-hypothesis-kept` must fail

A model that does not replay is a bug of the encoding, and is reported as one (`Disagreement`).

Source: docs/semantics.md, sections 4, 6, 7 and 9.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from topo_verify.algorithms.chart import Chart, Dart
from topo_verify.algorithms.motion import Pilot, common_prefix
from topo_verify.checkers import check
from topo_verify.errors import InternalError
from topo_verify.proofs.bounded.decode import Behind, Story, Word
from topo_verify.proofs.bounded.encoding import Marker
from topo_verify.proofs.bounded.walks import Fault
from topo_verify.robot.events import Augment, Confirm, Decision, Evidence, Move, Pose, Reject, Start
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import SimulatedRobot, first_percept
from topo_verify.world.rooted_map import World

Compared = Iterator[tuple[int, Percept, Percept]]
"""Step, the percept that the rule expects, the one that it takes for observed."""


class Disagreement(InternalError):
    """What a solver's model says does not happen in the simulator: please report it."""


@dataclass(frozen=True, slots=True)
class Replay:
    """A story that came true: the doors of all moves; the event that fails the claim."""

    world: World
    doors: Word
    event: int
    claim: str


def replay_confirmation(story: Story, marker: Marker, *, whole: bool = True) -> Replay:
    """The story of a false confirmation, done.

    Args:
        marker: what of it the mapper looks at.
        whole: all percepts are as expected, and the way is a shortest one; else only the last.
    Raises:
        Disagreement: it does not happen.
    """
    run = _Run(story)
    run.cross(story.e, marker)
    run.out(story.word)
    way = _way(run.chart, story.h, story.word)
    vertices = [run.chart.vertex[at] for at in way]
    expected = [run.chart.percepts[at] for at in way]
    since = 0 if whole else -1
    wanted = [_seen(percept, marker) for percept in expected[since:]]
    if wanted != [_seen(percept, marker) for percept in run.pilot.percepts[since:]]:
        raise Disagreement(f"{story}: the robot sees {run.pilot.percepts}, expected {expected}")
    if vertices[-1] != 0 or (whole and run.chart.tree(0).depth[vertices[0]] != len(story.word)):
        raise Disagreement(f"{story}: this is no shortest way home")
    return run.judge(Confirm(story.e, story.h, "motion"), "no-false-confirm")


def replay_rejection(story: Story, rule: str, fault: Fault) -> Replay:
    """The story of a false rejection, done.

    Args:
        rule: `trace`, `prefix`, `history` or `records`.
        fault: what is changed in it.
    Raises:
        Disagreement: it does not happen.
    """
    run = _Run(story, fault)
    run.cross(story.e)
    if story.turned is not None:
        run.excursion((story.turned,))
    run.out(story.word)
    for step, expected, observed in _compared(run, story, rule, fault):
        if expected != observed:
            evidence = Evidence(step, expected, observed)
            return run.judge(Reject(story.e, story.h, "motion", evidence), "true-hypothesis-kept")
    raise Disagreement(f"{story}: the rule {rule} with the fault {fault!r} rejects nothing")


# ------------------------------------------------------------------ the faulty rules


def _compared(run: _Run, story: Story, rule: str, fault: Fault) -> Compared:
    """What the rule compares for h, in its order."""
    if rule == "records":
        return _records(run, story)
    if rule == "prefix":
        return _prefix(run, story, fault)
    way = _traced(run.chart, story.h, story.word, fault) if rule == "history" else None
    return _along(run, way or _way(run.chart, story.h, story.word), fault)


def _along(run: _Run, way: list[Dart], fault: Fault) -> Compared:
    """The percepts along a way, one for one; with the fault `shifted` one later."""
    later = int(fault == "shifted")
    for step, (at, seen) in enumerate(zip(way, run.pilot.percepts[later:], strict=False)):
        yield step, run.chart.percepts[at], seen


def _prefix(run: _Run, story: Story, fault: Fault) -> Compared:
    """The percepts on the common prefix; with the fault `one-more` one door further."""
    way = _way(run.chart, story.h, story.own)
    shared = common_prefix(story.own, story.word) + int(fault == "one-more")
    for step in range(1, min(shared, len(story.own), len(story.word)) + 1):
        yield step, run.chart.percepts[way[step]], run.pilot.percepts[step]


def _records(run: _Run, story: Story) -> Compared:
    """What was recorded behind the unexplored dart where tracing ends, as deep as doors agree."""
    assert story.earlier is not None
    step = len(_traced(run.chart, story.h, story.word))
    if run.recorded is None or step > len(story.word):
        return
    crossed = _traced(run.chart, story.h, story.word)[-1]
    d, place = run.recorded
    if run.chart.turn(crossed, story.word[step - 1]) != d:
        return
    written = story.earlier.word[place + 1 :]
    deep = 1 + common_prefix(written, story.word[step:])
    for level in range(deep if story.levels is None else min(deep, story.levels)):
        yield step + level, run.recorded_percepts[place + level], run.pilot.percepts[step + level]


def _way(chart: Chart, at: Dart, word: Word) -> list[Dart]:
    """The reference darts on a way over explored darts, the first included."""
    way = [at]
    for door in word:
        way.append(chart.across(chart.turn(way[-1], door)))
    return way


def _traced(chart: Chart, at: Dart, word: Word, fault: Fault = "") -> list[Dart]:
    """The reference darts while a word is traced, until it crosses an unexplored dart."""
    way = [at]
    for door in word:
        here = chart.first[chart.vertex[way[-1]]] if fault == "absolute-doors" else way[-1]
        leave = chart.turn(here, door)
        arrive = chart.alpha[leave]
        if arrive is None and fault != "through-unexplored":
            break
        way.append(leave if arrive is None else arrive)
    return way


def _seen(percept: Percept, marker: Marker) -> object:
    """What a mapper compares that looks at so much of the marker."""
    match marker:
        case "directed":
            return percept
        case "undirected":
            return percept.signature
        case "none":
            return percept.degree


# ------------------------------------------------------------------ the robot


class _Run:
    """A robot in the story's world that draws the story's map. Lives for one replay."""

    def __init__(self, story: Story, fault: Fault = "") -> None:
        self.world = story.world
        self.robot = SimulatedRobot(story.world, 10_000)
        self.chart = Chart(self.robot.percept)
        self.pilot = Pilot(self.robot)
        self.at: Dart = 0
        self.recorded: tuple[Dart, int] | None = None  # T's dart; the place of its first percept
        self.recorded_percepts: tuple[Percept, ...] = ()
        if story.earlier is not None:
            self._learn(story.earlier, fault)
        self._draw(story.explored)

    def cross(self, e: Dart, marker: Marker = "undirected") -> None:
        """Walk to e, cross it, pose the hypotheses that look like what is there."""
        del self.chart.unexplored[e]
        self.at = self.pilot.walk(self.chart, self.at, self.chart.vertex[e])
        signature: Marker = "undirected" if marker == "directed" else marker
        seen = _seen(self.pilot.cross(self.chart, self.at, e), signature)
        percepts = self.chart.percepts
        alike = [h for h in self.chart.unexplored if _seen(percepts[h], signature) == seen]
        self.robot.declare(Pose(e, tuple(alike)))

    def out(self, word: Word) -> None:
        """Take these doors."""
        for door in word:
            self.pilot.forward(door)

    def excursion(self, word: Word) -> None:
        """Out and back, and then forget that the reference dart is turned."""
        self.out(word)
        self.pilot.back(0)
        self.pilot.turned = 0

    def judge(self, decision: Decision, claim: str) -> Replay:
        """Declare it; the checkers must find that the claim fails, at just this event."""
        self.robot.declare(decision)
        trace = (Start(percept=first_percept(self.world)), *self.robot.events)
        event = len(trace) - 1
        findings = [found for judged in check(self.world, trace) for found in judged.findings]
        if (claim, event) not in [(found.claim, found.event) for found in findings]:
            raise Disagreement(f"in {self.world.text}, {claim} does not fail at {decision}")
        moves = tuple(move.door for move in trace if isinstance(move, Move))
        return Replay(self.world, moves, event, claim)

    def _draw(self, explored: frozenset[tuple[Dart, Dart]]) -> None:
        """Explore these edges: first those that find vertices, in their order, then the others."""
        firsts = {rotation[0] for rotation in self.world.vertices[1:]}
        for e, end in sorted(explored, key=lambda edge: (edge[1] not in firsts, edge[1])):
            if self.chart.alpha[e] is None:
                self.cross(e)
                self._augment(e, end)

    def _augment(self, e: Dart, end: Dart) -> None:
        """Back behind e: join it with its end, at a new vertex if S has none there."""
        self.pilot.back(0)
        percept = self.robot.percept
        new = end >= len(self.chart.alpha)
        if new and self.chart.add_vertex(self.pilot.percepts[0]) != end:
            raise Disagreement(f"{self.world.text}: dart {end} is not the next to be numbered")
        self.chart.join(e, end)
        self.robot.declare(Augment(e, "new" if new else "loop", end, percept.degree))
        self.at = self.chart.turn(end, self.pilot.turned)

    def _learn(self, behind: Behind, fault: Fault) -> None:
        """Draw the earlier map, execute the word behind its dart, trace it again from there."""
        self._draw(behind.explored)
        self.cross(behind.e)
        self.out(behind.word)
        self.recorded_percepts = tuple(self.pilot.percepts[1:])
        entry = self.world.alpha[behind.e]
        self._augment(behind.e, entry)
        vertex = self.chart.vertex[entry]
        way = _traced(
            self.chart, self.chart.first[vertex] if fault == "first-dart" else entry, behind.word
        )
        if len(way) <= len(behind.word):
            self.recorded = self.chart.turn(way[-1], behind.word[len(way) - 1]), len(way) - 1
