"""Mistakes in Enhancement III: what is recorded behind unexplored darts."""

# A decorator hides that these classes are subclasses.
# pyright: reportPrivateUsage=false

from __future__ import annotations

from functools import partial

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis
from topo_verify.algorithms.rules import RecordsRule
from topo_verify.faults.fault import Walks, one_late, planted
from topo_verify.robot.events import MapDart

fault = partial(planted, "records")


@fault("enhancement-iii-all", "rule", claim="rejection-justified", theorem="records-stale-root")
class records_a_loop_from_dart_0(RecordsRule):
    """after a confirmation sequences are traced from dart 0 of h's vertex, not from h"""

    def learn(self, chart: Chart, e: MapDart, entry: MapDart, sequences: Walks) -> None:
        super().learn(chart, e, entry, ())
        super().learn(chart, e, chart.first[chart.vertex[entry]], sequences)


@fault("enhancement-iii-all", "rule", claim="rejection-justified")
class records_from_the_near_end(RecordsRule):
    """sequences are traced from e, by which the robot left, not from where it came in"""

    def learn(self, chart: Chart, e: MapDart, entry: MapDart, sequences: Walks) -> None:
        super().learn(chart, entry, e, sequences)


@fault("enhancement-iii-all", "rule", claim="rejection-justified")
class files_records_by_the_door(RecordsRule):
    """records are filed by the number of the door at its vertex, so vertices share them"""

    def refute(self, chart: Chart, hypothesis: Hypothesis, sequences: Walks) -> Refutation | None:
        self.chart = chart
        return super().refute(chart, hypothesis, sequences)

    def beyond(
        self, exit_dart: MapDart, sequence: Executed, step: int, number: int
    ) -> Refutation | None:
        return super().beyond(self._door(exit_dart), sequence, step, number)

    def learn(self, chart: Chart, e: MapDart, entry: MapDart, sequences: Walks) -> None:
        self.chart = chart
        super().learn(chart, e, entry, sequences)

    def _record(self, exit_dart: MapDart, sequence: Executed, step: int) -> None:
        super()._record(self._door(exit_dart), sequence, step)

    def _door(self, dart: MapDart) -> int:
        return dart - self.chart.first[self.chart.vertex[dart]]  # not unique on S


@fault("enhancement-iii-all", "rule", claim="rejection-justified")
class keeps_records_of_the_rejected(RecordsRule):
    """a sequence is recorded as traced from each hypothesis, even from rejected ones"""

    def refute(self, chart: Chart, hypothesis: Hypothesis, sequences: Walks) -> Refutation | None:
        refutation = super().refute(chart, hypothesis, sequences)
        if refutation is None:  # not yet confirmed
            self.learn(chart, hypothesis.dart, hypothesis.dart, sequences[-1:])
        return refutation


@fault("enhancement-iii-one", "rule", claim="rejection-justified")
class compares_records_a_door_late(RecordsRule):
    """a record is compared with what was seen one door before"""

    def __init__(self) -> None:
        super().__init__(levels=1)

    def beyond(
        self, exit_dart: MapDart, sequence: Executed, step: int, number: int
    ) -> Refutation | None:
        return super().beyond(exit_dart, one_late([sequence])[0], step, number)
