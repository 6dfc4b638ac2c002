"""Mistakes in Enhancement II: sequences traced on S from a hypothesis."""

from __future__ import annotations

from functools import partial

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis
from topo_verify.algorithms.rules import HistoryRule
from topo_verify.faults.fault import Walks, one_late, planted
from topo_verify.robot.events import Evidence, MapDart

fault = partial(planted, "history")


@fault("enhancement-ii", "rule", claim="rejection-justified", theorem="history-through-unexplored")
class traces_through_the_unexplored(HistoryRule):
    """where a door is unexplored, tracing goes on as if it led back to the same vertex"""

    def refute(self, chart: Chart, hypothesis: Hypothesis, sequences: Walks) -> Refutation | None:
        at, number = hypothesis.dart, len(sequences) - 1
        for last in sequences[-1:]:
            for step, door in enumerate(last.doors, 1):
                exit_dart = chart.turn(at, door)
                arrival = chart.alpha[exit_dart]
                at = exit_dart if arrival is None else arrival
                expected, observed = chart.percepts[at], last.percepts[step]
                if expected != observed:
                    return Refutation("history", Evidence(step, expected, observed, number, at))
        return None


@fault("enhancement-ii", "rule", claim="rejection-justified")
class traces_from_the_first_dart(HistoryRule):
    """a sequence is traced from the first dart of h's vertex, not from h"""

    def refute(self, chart: Chart, hypothesis: Hypothesis, sequences: Walks) -> Refutation | None:
        first = chart.first[chart.vertex[hypothesis.dart]]
        return super().refute(chart, Hypothesis(first, chart, chart.tree(0)), sequences)


@fault("enhancement-ii", "rule", claim="rejection-justified")
class takes_unknown_for_a_mismatch(HistoryRule):
    """a hypothesis is rejected where tracing leaves S, though S says nothing of the place"""

    def beyond(
        self, exit_dart: MapDart, sequence: Executed, step: int, number: int
    ) -> Refutation | None:
        percept = sequence.percepts[step]  # stands for what S would show
        return Refutation("history", Evidence(step, percept, percept, number, exit_dart))


@fault("enhancement-ii", "rule", claim="rejection-justified")
class keeps_sequences_of_last_edge(HistoryRule):
    """the list of sequences is not emptied when the next edge is crossed"""

    def __init__(self) -> None:
        self.before: list[Executed] = []

    def refute(self, chart: Chart, hypothesis: Hypothesis, sequences: Walks) -> Refutation | None:
        return super().refute(chart, hypothesis, [*self.before, *sequences])

    def learn(self, chart: Chart, e: MapDart, entry: MapDart, sequences: Walks) -> None:
        self.before = list(sequences)  # these started at another vu


@fault("enhancement-ii", "rule", claim="rejection-justified", theorem="history-shifted-by-one")
class compares_a_step_earlier(HistoryRule):
    """what was seen before a door is compared with what S shows behind it"""

    def refute(self, chart: Chart, hypothesis: Hypothesis, sequences: Walks) -> Refutation | None:
        return super().refute(chart, hypothesis, one_late(sequences))
