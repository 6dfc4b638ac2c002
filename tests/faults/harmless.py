"""Differences that are no mistakes: they change the cost or nothing, and every claim must hold.

A check that reports one asks for the reference's behaviour, not for a correct one.
"""

# A decorator hides that these classes are subclasses.
# pyright: reportPrivateUsage=false

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.algorithms import CATALOGUE
from topo_verify.algorithms.beyond.folding import FoldingRule
from topo_verify.algorithms.chart import Chart, Survey
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis, Pilot
from topo_verify.algorithms.policies import Order, last, newest
from topo_verify.algorithms.rules import HistoryRule, PrefixRule, RecordsRule
from topo_verify.faults.fault import Fault, ForwardingRobot, Walks, mapper, planted
from topo_verify.robot.events import Decision, MapDart, Robot
from topo_verify.robot.percept import Percept

basic = CATALOGUE["basic"]


@planted("hypotheses", "basic", "hypotheses")
def poses_all_of_u(chart: Chart, percept: Percept, order: Order) -> list[Hypothesis]:
    """H holds darts of every signature; the first percept rejects those of another signature"""
    tree = chart.tree(0)
    return [Hypothesis(h, chart, tree) for h in order(chart.unexplored, chart, tree)]


tries_the_newest_first = Fault(
    name="tries-the-newest-first",
    module=__name__,
    part="hypotheses",
    why="other policies: depth-first, and the newest hypothesis first",
    claim=None,
    mapper=mapper("enhancement-ii", pick=last, order=newest),
)


@planted("motion", "basic", "Pilot")
class walks_along_another_tree(Pilot):
    """it walks to the next edge along the breadth-first tree of its start, not of its goal"""

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


@planted("marker", "basic", "execute")
def overlooks_a_passing_marker(pilot: Pilot, h: Hypothesis, shared: int) -> int | None:
    """before the last door only degrees are compared; the percept at v0 decides"""
    if shared < len(h.doors):
        pilot.back(shared)
    for step, expected in enumerate(h.expected):
        if step > len(pilot.doors):
            pilot.forward(h.doors[step - 1])
        percept, last = pilot.percepts[step], step == len(h.doors)
        if percept != expected if last else percept.degree != expected.degree:
            return step
    return None


@planted("prefix", "enhancement-i", "rule")
class compares_a_shorter_prefix(PrefixRule):
    """what was seen behind the last door is not compared, so more is walked"""

    def refute(self, chart: Chart, hypothesis: Hypothesis, sequences: Walks) -> Refutation | None:
        shorter = [Executed(s.doors[:-1], s.percepts) for s in sequences]
        return super().refute(chart, hypothesis, shorter)


@planted("history", "enhancement-ii", "rule")
class traces_every_sequence_again(HistoryRule):
    """all sequences of the edge are traced after each mismatch, not only the last"""

    def refute(self, chart: Chart, hypothesis: Hypothesis, sequences: Walks) -> Refutation | None:
        for number in range(len(sequences)):
            refutation = super().refute(chart, hypothesis, sequences[: number + 1])
            if refutation is not None:
                return refutation
        return None


@planted("records", "enhancement-iii-all", "rule")
class never_drops_a_record(RecordsRule):
    """T[d] stays when d is explored; nothing looks it up again"""

    def learn(self, chart: Chart, e: MapDart, entry: MapDart, sequences: Walks) -> None:
        kept = dict(self.records)
        super().learn(chart, e, entry, sequences)
        self.records = kept | self.records


@planted("report", "basic", "Chart")
class delivers_another_numbering(Chart):
    """darts have other numbers, vertices and edges are listed from the last to the first"""

    def survey(self, cost: int) -> Survey:
        # The map is compared up to isomorphism.
        names = {dart: 7 + 3 * dart for dart in range(len(self.alpha))}
        survey = super().survey(cost)
        rows = [tuple(names[d] for d in (*row[1:], *row[:1])) for row in survey.vertices[::-1]]
        edges = tuple((names[b], names[a]) for a, b in survey.edges[::-1])
        marker = None if survey.marker is None else names[survey.marker]
        return Survey(tuple(rows), edges, marker, cost)


@planted("report")
def reports_no_cost(robot: Robot) -> object:
    """the delivered map names no cost"""
    vertices, edges, marker, _ = basic(robot)
    return {"vertices": vertices, "edges": edges, "marker": marker}


class _Silent(ForwardingRobot):
    def declare(self, event: Decision) -> None:
        pass


@planted("report")
def declares_nothing(robot: Robot) -> Survey:
    """the mapper declares none of its decisions"""
    return basic(_Silent(robot))


@planted("folding", "folding", "rule")
class walks_what_it_could_conclude(FoldingRule):
    """the last hypothesis is walked, though vu is known to be a vertex of S"""

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        return None
