"""Mistakes in Enhancement I: how percepts on the common prefix are compared."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.enhancement_i import PrefixRule
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis, common_prefix
from topo_verify.faults.fault import Fault, mapper, one_late

fault = partial(Fault, part="prefix")


class _OneDoorBeyond(PrefixRule):
    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        if not sequences:
            return None
        *before, last = sequences
        shared = common_prefix(hypothesis.doors, last.doors) + 1
        doors = hypothesis.doors[: min(shared, len(last.doors))]
        return super().refute(chart, hypothesis, [*before, Executed(doors, last.percepts)])


compares_beyond_the_prefix = fault(
    name="compares-beyond-the-prefix",
    why="the percept behind the first door that differs is compared as well",
    claim="rejection-justified",
    theorem="prefix-one-too-far",
    mapper=mapper("enhancement-i", rule=_OneDoorBeyond),
)


class _OneStepLate(PrefixRule):
    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        return super().refute(chart, hypothesis, one_late(sequences))


compares_before_the_door = fault(
    name="compares-before-the-door",
    why="what was seen before a door of the prefix is compared with what is expected behind it",
    claim="rejection-justified",
    mapper=mapper("enhancement-i", rule=_OneStepLate),
)


class _EqualAnywhere(PrefixRule):
    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        if not sequences:
            return None
        *before, last = sequences
        equal = sum(map(int.__eq__, hypothesis.doors, last.doors))
        doors = hypothesis.doors[:equal]
        return super().refute(chart, hypothesis, [*before, Executed(doors, last.percepts)])


counts_equal_doors_anywhere = fault(
    name="counts-equal-doors-anywhere",
    why="the length of the common prefix is the number of equal doors anywhere",
    claim="rejection-justified",
    mapper=mapper("enhancement-i", rule=_EqualAnywhere),
)
