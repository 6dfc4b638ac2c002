"""The basic algorithm (listing 1): every hypothesis is walked, none is rejected without motion.

Source: listing 1; H. Wang, M. Jenkin, P. Dymond, "The relative power of immovable markers in
topological mapping", ICRA 2011. Cost O(m²n) edge traversals.
"""

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.algorithms.chart import Chart, Dart
from topo_verify.algorithms.motion import Executed, Hypothesis
from topo_verify.robot.events import Evidence, Rule


class NoRule:
    """Rejects nothing without motion; remembers nothing."""

    name: Rule = "motion"

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Evidence | None:
        """Never: only motion rejects."""
        return None

    def learn(self, chart: Chart, e: Dart, entry: Dart, sequences: Sequence[Executed]) -> None:
        """Nothing to remember."""
