"""The basic algorithm (listing 1): no rule rejects; each hypothesis is walked until it differs.

One case needs no move. The robot sees the marker at vu, and the hypothesis predicts another
direction of it: the hypothesis is rejected at once, and reports count it as rejected free.

Source: H. Wang, M. Jenkin, P. Dymond, "The relative power of immovable markers in topological
    mapping", ICRA 2011. Cost O(m²n) edge traversals.
"""

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis
from topo_verify.robot.events import MapDart
from topo_verify.robot.percept import Percept


class NoRule:
    """Rejects nothing without motion; remembers nothing."""

    def arrive(self, chart: Chart, e: MapDart, percept: Percept) -> None:
        """Keep nothing of the percept at vu."""

    def observe(self, sequence: Executed) -> None:
        """Keep nothing of the sequence."""

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        """None: only motion rejects."""
        return None

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        """None: only motion confirms."""
        return None

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        """Keep nothing of the sequences behind e."""
