"""Mistakes in Enhancement III: what is recorded behind unexplored darts."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.enhancement_iii import RecordsRule
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis
from topo_verify.faults.fault import Fault, mapper, one_late
from topo_verify.robot.events import MapDart

fault = partial(Fault, part="records")


class _LoopsFromDart0(RecordsRule):
    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        super().learn(chart, e, entry, ())  # drops T[e] and T[h], as the reference does
        super().learn(chart, e, chart.first[chart.vertex[entry]], sequences)


records_a_loop_from_dart_0 = fault(
    name="records-a-loop-from-dart-0",
    why="after a confirmation sequences are traced from dart 0 of h's vertex, not from h",
    claim="rejection-justified",
    theorem="records-stale-root",
    mapper=mapper("enhancement-iii-all", rule=_LoopsFromDart0),
)


class _FromTheOtherEnd(RecordsRule):
    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        super().learn(chart, entry, e, sequences)


records_from_the_near_end = fault(
    name="records-from-the-near-end",
    why="sequences are traced from e, by which the robot left, not from where it came in",
    claim="rejection-justified",
    mapper=mapper("enhancement-iii-all", rule=_FromTheOtherEnd),
)


class _ByDoor(RecordsRule):
    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        self.chart = chart
        return super().refute(chart, hypothesis, sequences)

    def beyond(
        self, exit_dart: MapDart, sequence: Executed, step: int, number: int
    ) -> Refutation | None:
        return super().beyond(self._door(exit_dart), sequence, step, number)

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        self.chart = chart
        super().learn(chart, e, entry, sequences)

    def _record(self, exit_dart: MapDart, sequence: Executed, step: int) -> None:
        super()._record(self._door(exit_dart), sequence, step)

    def _door(self, dart: MapDart) -> int:
        return dart - self.chart.first[self.chart.vertex[dart]]  # not unique on S


files_records_by_the_door = fault(
    name="files-records-by-the-door",
    why="records are filed by the number of the door at its vertex, so vertices share them",
    claim="rejection-justified",
    mapper=mapper("enhancement-iii-all", rule=_ByDoor),
)


class _OnSuspicion(RecordsRule):
    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        refutation = super().refute(chart, hypothesis, sequences)
        if refutation is None:  # not yet confirmed
            self.learn(chart, hypothesis.dart, hypothesis.dart, sequences[-1:])
        return refutation


keeps_records_of_the_rejected = fault(
    name="keeps-records-of-the-rejected",
    why="a sequence is recorded as traced from each hypothesis, even from rejected ones",
    claim="rejection-justified",
    mapper=mapper("enhancement-iii-all", rule=_OnSuspicion),
)


class _OneStepLate(RecordsRule):
    def beyond(
        self, exit_dart: MapDart, sequence: Executed, step: int, number: int
    ) -> Refutation | None:
        return super().beyond(exit_dart, one_late([sequence])[0], step, number)


compares_records_a_door_late = fault(
    name="compares-records-a-door-late",
    why="a record is compared with what was seen one door before",
    claim="rejection-justified",
    mapper=mapper("enhancement-iii-one", rule=lambda: _OneStepLate(levels=1)),
)
