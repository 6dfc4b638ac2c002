"""The planar prior: in a planar world, only darts on e's own face of S can be its other end.

An edge drawn inside a face of a plane map cuts it in two; an edge from one face to another would
need a handle. So two open darts of S can be joined only if they lie on one face of S, where an open
dart counts as a dead end when the face is walked. Sound on every planar world, and on no other:
there it must be caught. May stand before any rule.

Source: docs/semantics.md, section 11.
"""

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.algorithms.chart import Chart, Dart
from topo_verify.algorithms.exploration import Refutation, Rule
from topo_verify.algorithms.motion import Executed, Hypothesis
from topo_verify.robot.events import Evidence
from topo_verify.robot.percept import Percept


class PlanarRule:
    """Rejects what lies on another face than e, before any motion; then asks another rule."""

    def __init__(self, rule: Rule) -> None:
        self.rule = rule
        self.percept = Percept(0, None)  # vu's
        self.face: frozenset[Dart] = frozenset()

    def arrive(self, chart: Chart, e: Dart, percept: Percept) -> None:
        """Walk the face of e."""
        self.percept = percept
        self.face = frozenset(face(chart, e))
        self.rule.arrive(chart, e, percept)

    def observe(self, sequence: Executed) -> None:
        """Nothing to keep for this rule."""
        self.rule.observe(sequence)

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        """Why the hypothesis is false in every planar world, if it is."""
        if hypothesis.dart in self.face:
            return self.rule.refute(chart, hypothesis, sequences)
        seen, told = chart.percepts[hypothesis.dart], "it lies on another face than e"
        return Refutation("planar", Evidence(0, seen, self.percept, contradiction=told))

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        """As the other rule concludes."""
        return self.rule.conclude(remaining)

    def learn(self, chart: Chart, e: Dart, entry: Dart, sequences: Sequence[Executed]) -> None:
        """Nothing to remember for this rule."""
        self.rule.learn(chart, e, entry, sequences)


def face(chart: Chart, e: Dart) -> list[Dart]:
    """The darts of S on the face of e, from e on."""
    darts = [e]
    while True:
        across = chart.alpha[darts[-1]]
        following = chart.turn(darts[-1] if across is None else across, 1)
        if following == e:
            return darts
        darts.append(following)
