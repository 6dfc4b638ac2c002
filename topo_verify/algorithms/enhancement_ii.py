"""Enhancement II: every sequence executed for this edge, traced on S (rule `history`).

Assume that the robot entered vu by dart h of S. While tracing stays on explored edges, S shows the
percept behind each door. Tracing ends at an unexplored dart; e and h count as unexplored.

Source: section III-B of the paper.
"""

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.algorithms.basic import NoRule
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis
from topo_verify.robot.events import Evidence, MapDart


class HistoryRule(NoRule):
    """Traces the last sequence from the hypothesis."""

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        """The first percept that contradicts S where the last sequence leads from h.

        Earlier sequences were traced when they were executed, and S has not changed since.
        """
        if not sequences:
            return None
        last, number = sequences[-1], len(sequences) - 1
        at = hypothesis.dart  # A3.10
        for step, door in enumerate(last.doors, 1):
            exit_dart = chart.turn(at, door)
            # e and h are joined only when h is confirmed
            arrival = chart.alpha[exit_dart]
            if arrival is None:
                return self.beyond(exit_dart, last, step, number)  # A3.13
            at = arrival  # A3.11
            if chart.percepts[at] != last.percepts[step]:  # A3.12 A3.15
                evidence = Evidence(
                    step, chart.percepts[at], last.percepts[step], sequence=number, at=at
                )
                return Refutation("history", evidence)
        return None

    def beyond(
        self, exit_dart: MapDart, sequence: Executed, step: int, number: int
    ) -> Refutation | None:
        """What contradicts step `step` of a sequence behind an unexplored dart; here nothing."""
        return None
