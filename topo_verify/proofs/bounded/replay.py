"""Counterexamples: decode an assignment, and repeat it in the simulator without a solver.

The simulated robot draws the map edge by edge, crosses e and takes the doors; the checkers judge.
All percepts are as expected; confirming h must fail `no-false-confirm`.
"""

from __future__ import annotations

from dataclasses import dataclass

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.motion import Pilot
from topo_verify.checkers import check
from topo_verify.errors import InternalError
from topo_verify.proofs.bounded.cnf import Assignment, CnfRow
from topo_verify.proofs.bounded.encoding import EncodedMap, MarkerDetail, Worlds
from topo_verify.proofs.bounded.statements import EncodedCounterexample
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Door, Percept
from topo_verify.robot.simulator import SimulatedRobot, first_percept
from topo_verify.world.enumeration.rank_order import Table
from topo_verify.world.rooted_map import World

DoorWord = tuple[Door, ...]


@dataclass(frozen=True, slots=True)
class EarlierExcursion:
    """The explored edges before an earlier excursion, the dart crossed, the doors behind it."""

    explored: frozenset[tuple[ev.MapDart, ev.MapDart]]
    e: ev.MapDart
    word: DoorWord


@dataclass(frozen=True, slots=True, kw_only=True)
class BoundedCounterexample:
    """A decoded counterexample; S and the world share one numbering of darts.

    Attributes:
        explored: the edges of S, smaller dart first.
        word: the doors executed behind e.
        own: the hypothesis' own way home.
        turned: the door of a first excursion behind e, if any.
        earlier, levels: for records, the excursion, and the depth compared.
    """

    world: World
    explored: frozenset[tuple[ev.MapDart, ev.MapDart]]
    e: ev.MapDart
    h: ev.MapDart
    word: DoorWord
    own: DoorWord
    turned: Door | None = None
    earlier: EarlierExcursion | None = None
    levels: int | None = None


def decode_table(world: Worlds, model: Assignment) -> Table:
    """The degrees and alpha of an assignment."""
    # (first dart, degree) of each vertex
    vertices = sorted(place for place, vertex in world.vertex.items() if model.holds(vertex))
    alpha = [0] * len(world.darts)
    for (a, b), joined in world.joined.items():
        if model.holds(joined):
            alpha[a], alpha[b] = b, a
    return tuple(degree for _, degree in vertices), tuple(alpha)


def decode_world(world: Worlds, model: Assignment) -> World:
    return World.from_code(decode_table(world, model))


def decoded_booleans(encoded: EncodedCounterexample) -> CnfRow:
    # Their order decides which counterexample comes first: append new ones.
    maps = [encoded.chart] if encoded.earlier is None else [encoded.earlier.chart, encoded.chart]
    rows = [encoded.world.first, tuple(encoded.world.joined.values())]
    rows += [row for chart in maps for row in (chart.known, chart.explored)]
    rows += [encoded.e, encoded.h, encoded.made or (), *encoded.executed, *encoded.own]
    rows += [] if encoded.turned is None else [encoded.turned]
    rows += [] if encoded.earlier is None else [encoded.earlier.e, *encoded.earlier.executed]
    return tuple(literal for row in rows for literal in row)


def decode(encoded: EncodedCounterexample, model: Assignment) -> BoundedCounterexample:
    world = decode_world(encoded.world, model)
    steps = sum(map(model.holds, encoded.made)) if encoded.made is not None else None
    own = encoded.own or encoded.executed
    behind = encoded.earlier
    return BoundedCounterexample(
        world=world,
        explored=_edges(world, encoded.chart, model),
        e=model.index(encoded.e),
        h=model.index(encoded.h),
        word=_word(encoded.executed if encoded.own else encoded.executed[:steps], model),
        own=_word(own[:steps], model),
        turned=None if encoded.turned is None else model.index(encoded.turned),
        earlier=None
        if behind is None
        else EarlierExcursion(
            _edges(world, behind.chart, model),
            model.index(behind.e),
            _word(behind.executed, model),
        ),
        levels=encoded.levels,
    )


def _word(rows: tuple[CnfRow, ...], model: Assignment) -> DoorWord:
    return tuple(model.index(row) for row in rows)


def _edges(
    world: World, chart: EncodedMap, model: Assignment
) -> frozenset[tuple[ev.MapDart, ev.MapDart]]:
    return frozenset(edge for edge in world.edges if model.holds(chart.explored[edge[0]]))


class Disagreement(InternalError):
    """A solver's model does not replay in the simulator: a bug of ours, please report it."""


@dataclass(frozen=True, slots=True)
class ReplayedCounterexample:
    """The doors of all moves, and the event that fails the claim."""

    world: World
    doors: DoorWord
    event: int
    claim: str


def replay_confirmation(
    example: BoundedCounterexample, marker: MarkerDetail, *, whole: bool = True
) -> ReplayedCounterexample:
    """Replay a false confirmation.

    Args:
        whole: require that all percepts are as expected on a shortest way; else only the last.
    Raises:
        Disagreement: the confirmation does not happen.
    """
    run = Replayer(example)
    run.draw(example.explored)
    run.cross(example.e, marker)
    run.out(example.word)
    way = way_of(run.chart, example.h, example.word)
    vertices = [run.chart.vertex[at] for at in way]
    expected = [run.chart.percepts[at] for at in way]
    since = 0 if whole else -1
    wanted = [_seen(percept, marker) for percept in expected[since:]]
    if wanted != [_seen(percept, marker) for percept in run.pilot.percepts[since:]]:
        raise Disagreement(f"{example}: the robot sees {run.pilot.percepts}, expected {expected}")
    if vertices[-1] != 0 or (whole and run.chart.tree(0).depth[vertices[0]] != len(example.word)):
        raise Disagreement(f"{example}: the doors are not a shortest way home")
    return run.judge(ev.Confirm(example.e, example.h, "motion"), "no-false-confirm")


def way_of(chart: Chart, at: ev.MapDart, word: DoorWord) -> list[ev.MapDart]:
    way = [at]
    for door in word:
        way.append(chart.across(chart.turn(way[-1], door)))
    return way


def _seen(percept: Percept, marker: MarkerDetail) -> object:
    match marker:
        case "directed":
            return percept
        case "undirected":
            return percept.signature
        case "none":
            return percept.degree


class Replayer:
    """A robot in the counterexample's world, and the map that it draws; then it crosses e."""

    def __init__(self, example: BoundedCounterexample) -> None:
        self.world = example.world
        self.robot = SimulatedRobot(example.world, 10_000)
        self.chart = Chart(self.robot.percept)
        self.pilot = Pilot(self.robot)
        self.at: ev.MapDart = 0

    def cross(self, e: ev.MapDart, marker: MarkerDetail = "undirected") -> None:
        del self.chart.unexplored[e]
        self.at = self.pilot.walk(self.chart, self.at, self.chart.vertex[e])
        signature: MarkerDetail = "undirected" if marker == "directed" else marker
        percept = _seen(self.pilot.cross(self.chart, self.at, e), signature)
        percepts = self.chart.percepts
        alike = [h for h in self.chart.unexplored if _seen(percepts[h], signature) == percept]
        self.robot.declare(ev.Pose(e, tuple(alike)))

    def out(self, word: DoorWord) -> None:
        for door in word:
            self.pilot.forward(door)

    def judge(self, decision: ev.Decision, claim: str) -> ReplayedCounterexample:
        self.robot.declare(decision)
        trace = (ev.Start(percept=first_percept(self.world)), *self.robot.events)
        event = len(trace) - 1
        findings = [finding for judged in check(self.world, trace) for finding in judged.findings]
        if (claim, event) not in [(finding.claim, finding.event) for finding in findings]:
            raise Disagreement(f"in {self.world.text}, {claim} does not fail at {decision}")
        moves = tuple(move.door for move in trace if isinstance(move, ev.Move))
        return ReplayedCounterexample(self.world, moves, event, claim)

    def draw(self, explored: frozenset[tuple[ev.MapDart, ev.MapDart]]) -> None:
        # First the edges that find vertices, to keep their numbers.
        firsts = {rotation[0] for rotation in self.world.vertices[1:]}
        for e, end in sorted(explored, key=lambda edge: (edge[1] not in firsts, edge[1])):
            if self.chart.alpha[e] is None:
                self.cross(e)
                self.augment(e, end)

    def augment(self, e: ev.MapDart, end: ev.MapDart) -> None:
        self.pilot.back(0)
        percept = self.robot.percept
        new = end >= len(self.chart.alpha)
        if new and self.chart.add_vertex(self.pilot.percepts[0]) != end:
            raise Disagreement(f"{self.world.text}: dart {end} is not the next to be numbered")
        self.chart.join(e, end)
        self.robot.declare(ev.Augment(e, "new" if new else "loop", end, percept.degree))
        self.at = self.chart.turn(end, self.pilot.turned)
