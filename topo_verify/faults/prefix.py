"""Mistakes in Enhancement I: how percepts on the common prefix are compared."""

from __future__ import annotations

from functools import partial

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis, common_prefix
from topo_verify.algorithms.rules import PrefixRule
from topo_verify.faults.fault import Walks, one_late, planted

fault = partial(planted, "prefix")


@fault("enhancement-i", "rule", claim="rejection-justified", theorem="prefix-one-too-far")
class compares_beyond_the_prefix(PrefixRule):
    """the percept behind the first door that differs is compared as well"""

    def refute(self, chart: Chart, hypothesis: Hypothesis, sequences: Walks) -> Refutation | None:
        if not sequences:
            return None
        *before, last = sequences
        shared = common_prefix(hypothesis.doors, last.doors) + 1
        doors = hypothesis.doors[: min(shared, len(last.doors))]
        return super().refute(chart, hypothesis, [*before, Executed(doors, last.percepts)])


@fault("enhancement-i", "rule", claim="rejection-justified")
class compares_before_the_door(PrefixRule):
    """what was seen before a door of the prefix is compared with what is expected behind it"""

    def refute(self, chart: Chart, hypothesis: Hypothesis, sequences: Walks) -> Refutation | None:
        return super().refute(chart, hypothesis, one_late(sequences))


@fault("enhancement-i", "rule", claim="rejection-justified")
class counts_equal_doors_anywhere(PrefixRule):
    """the length of the common prefix is the number of equal doors anywhere"""

    def refute(self, chart: Chart, hypothesis: Hypothesis, sequences: Walks) -> Refutation | None:
        if not sequences:
            return None
        *before, last = sequences
        equal = sum(map(int.__eq__, hypothesis.doors, last.doors))
        doors = hypothesis.doors[:equal]
        return super().refute(chart, hypothesis, [*before, Executed(doors, last.percepts)])
