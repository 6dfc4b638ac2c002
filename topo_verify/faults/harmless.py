"""Differences that are no mistakes: they change the cost or nothing, and every claim must hold.

A check that reports one asks for the reference's behaviour, not for a correct one.
"""

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.algorithms import CATALOGUE
from topo_verify.algorithms.chart import Chart, Survey
from topo_verify.algorithms.enhancement_i import PrefixRule
from topo_verify.algorithms.enhancement_ii import HistoryRule
from topo_verify.algorithms.enhancement_iii import RecordsRule
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.folding import FoldingRule
from topo_verify.algorithms.motion import Executed, Hypothesis, Pilot
from topo_verify.algorithms.policies import Order, last, newest
from topo_verify.faults.fault import Fault, ForwardingRobot, mapper
from topo_verify.robot.events import Decision, MapDart, Robot
from topo_verify.robot.percept import Percept

basic = CATALOGUE["basic"]


def _all_of_u(chart: Chart, percept: Percept, order: Order) -> list[Hypothesis]:
    tree = chart.tree(0)
    return [Hypothesis(h, chart, tree) for h in order(chart.unexplored, chart, tree)]


poses_all_of_u = Fault(
    name="poses-all-of-u",
    part="hypotheses",
    why="H holds darts of every signature; the first percept rejects those of another signature",
    claim=None,
    mapper=mapper("basic", hypotheses=_all_of_u),
)

tries_the_newest_first = Fault(
    name="tries-the-newest-first",
    part="hypotheses",
    why="other policies: depth-first, and the newest hypothesis first",
    claim=None,
    mapper=mapper("enhancement-ii", pick=last, order=newest),
)


class _OtherTree(Pilot):
    def walk(self, chart: Chart, at: MapDart, v: int) -> MapDart:
        way: list[MapDart] = []
        parent = chart.tree(chart.vertex[at]).parent
        while (up := parent[v]) is not None:
            way.append(chart.across(up))
            v = chart.vertex[way[-1]]
        for exit_dart in reversed(way):
            self._move(chart.door(at, exit_dart), "walk")
            at = chart.across(exit_dart)
        return at


walks_along_another_tree = Fault(
    name="walks-along-another-tree",
    part="motion",
    why="it walks to the next edge along the breadth-first tree of its start, not of its goal",
    claim=None,
    mapper=mapper("basic", Pilot=_OtherTree),
)


def _passes_by(pilot: Pilot, h: Hypothesis, shared: int) -> int | None:
    if shared < len(h.doors):
        pilot.back(shared)
    for step, expected in enumerate(h.expected):
        if step > len(pilot.doors):
            pilot.forward(h.doors[step - 1])
        percept, last = pilot.percepts[step], step == len(h.doors)
        # A marker on the way is a mismatch, but at v0 everything is compared.
        if percept != expected if last else percept.degree != expected.degree:
            return step
    return None


overlooks_a_passing_marker = Fault(
    name="overlooks-a-passing-marker",
    part="marker",
    why="before the last door only degrees are compared; the percept at v0 decides",
    claim=None,
    mapper=mapper("basic", execute=_passes_by),
)


class _OneDoorFewer(PrefixRule):
    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        shorter = [Executed(s.doors[:-1], s.percepts) for s in sequences]
        return super().refute(chart, hypothesis, shorter)


compares_a_shorter_prefix = Fault(
    name="compares-a-shorter-prefix",
    part="prefix",
    why="what was seen behind the last door is not compared, so more is walked",
    claim=None,
    mapper=mapper("enhancement-i", rule=_OneDoorFewer),
)


class _AllAgain(HistoryRule):
    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        looks = (
            super(_AllAgain, self).refute(chart, hypothesis, sequences[: n + 1])
            for n in range(len(sequences))
        )
        return next(filter(None, looks), None)


traces_every_sequence_again = Fault(
    name="traces-every-sequence-again",
    part="history",
    why="all sequences of the edge are traced after each mismatch, not only the last",
    claim=None,
    mapper=mapper("enhancement-ii", rule=_AllAgain),
)


class _NeverDropped(RecordsRule):
    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        kept = dict(self.records)
        super().learn(chart, e, entry, sequences)
        self.records = kept | self.records


never_drops_a_record = Fault(
    name="never-drops-a-record",
    part="records",
    why="T[d] stays when d is explored; nothing looks it up again",
    claim=None,
    mapper=mapper("enhancement-iii-all", rule=_NeverDropped),
)


class _FromTheEnd(Chart):
    def survey(self, cost: int) -> Survey:
        # The map is compared up to isomorphism.
        names = {dart: 7 + 3 * dart for dart in range(len(self.alpha))}
        survey = super().survey(cost)
        rows = [tuple(names[d] for d in (*row[1:], *row[:1])) for row in survey.vertices[::-1]]
        edges = tuple((names[b], names[a]) for a, b in survey.edges[::-1])
        marker = None if survey.marker is None else names[survey.marker]
        return Survey(tuple(rows), edges, marker, cost)


delivers_another_numbering = Fault(
    name="delivers-another-numbering",
    part="report",
    why="darts have other numbers, vertices and edges are listed from the last to the first",
    claim=None,
    mapper=mapper("basic", Chart=_FromTheEnd),
)


def _no_cost(robot: Robot) -> object:
    vertices, edges, marker, _ = basic(robot)
    return {"vertices": vertices, "edges": edges, "marker": marker}


reports_no_cost = Fault(
    name="reports-no-cost",
    part="report",
    why="the delivered map names no cost",
    claim=None,
    mapper=_no_cost,
)


class _Silent(ForwardingRobot):
    def declare(self, event: Decision) -> None:
        pass


def _declares_nothing(robot: Robot) -> Survey:
    return basic(_Silent(robot))


declares_nothing = Fault(
    name="declares-nothing",
    part="report",
    why="the mapper declares none of its decisions",
    claim=None,
    mapper=_declares_nothing,
)


class _NeverConcludes(FoldingRule):
    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        return None


walks_what_it_could_conclude = Fault(
    name="walks-what-it-could-conclude",
    part="folding",
    why="the last hypothesis is walked, though vu is known to be a vertex of S",
    claim=None,
    mapper=mapper("folding", rule=_NeverConcludes),
)
