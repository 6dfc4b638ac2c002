"""Enhancement I, stage 1: percepts on the common prefix of doors (rule `prefix`).

If the ways home of two hypotheses begin with the same doors, both must expect the same percepts
there. (Stage 2 is `motion.overlap`.)

Source: section III-A of the paper; listing 2, lines 16-19.
"""

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.algorithms.basic import NoRule
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis, common_prefix
from topo_verify.robot.events import Evidence


class PrefixRule(NoRule):
    """Compares the last sequence with the hypothesis' way home."""

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        """The first percept on the common prefix that the hypothesis does not expect."""
        if not sequences:
            return None
        last = sequences[-1]
        shared = common_prefix(hypothesis.doors, last.doors)  # A2.17
        # at step 0 all hypotheses expect the same
        for step in range(1, shared + 1):
            if last.percepts[step] != hypothesis.expected[step]:  # A2.18
                evidence = Evidence(
                    step,
                    hypothesis.expected[step],
                    last.percepts[step],
                    sequence=len(sequences) - 1,
                    at=hypothesis.arrivals[step],
                )
                return Refutation("prefix", evidence)
        return None
