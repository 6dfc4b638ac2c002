"""The planar prior: in a planar world, only darts on e's own face of S can be its other end.

An edge drawn inside a face of a plane map cuts it in two; an edge from one face to another would
need a handle. So two open darts of S can be joined only if they lie on one face of S, where an open
dart counts as a dead end when the face is walked. The rule is sound in every planar world. In
other worlds it rejects true hypotheses, and the checkers must find that. It may stand before any
other rule.

Source: docs/semantics.md, section 8.
"""

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation, Rule
from topo_verify.algorithms.motion import Executed, Hypothesis
from topo_verify.robot.events import Evidence, MapDart
from topo_verify.robot.percept import Percept


class PlanarRule:
    """Rejects each hypothesis on another face than e; asks another rule about the others."""

    def __init__(self, rule: Rule) -> None:
        self.rule = rule
        self.face: frozenset[MapDart] = frozenset()

    def arrive(self, chart: Chart, e: MapDart, percept: Percept) -> None:
        """Find the darts on the face of e."""
        self.face = frozenset(face(chart, e))
        self.rule.arrive(chart, e, percept)

    def observe(self, sequence: Executed) -> None:
        """Passes the sequence on to the other rule."""
        self.rule.observe(sequence)

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        """Why the hypothesis is false in every planar world, if it is."""
        if hypothesis.dart in self.face:
            return self.rule.refute(chart, hypothesis, sequences)
        message = "it lies on another face than e"
        return Refutation("planar", Evidence(0, contradiction=message))

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        """The conclusion of the other rule."""
        return self.rule.conclude(remaining)

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        """Passes the new edge on to the other rule."""
        self.rule.learn(chart, e, entry, sequences)


def face(chart: Chart, e: MapDart) -> list[MapDart]:
    """The darts of S on the face of e, from e on."""
    darts = [e]
    while True:
        across = chart.alpha[darts[-1]]  # None: an unexplored dart is a dead end, so turn back
        # The next dart of the face is sigma∘alpha, where alpha of an open dart is the dart itself.
        following = chart.turn(darts[-1] if across is None else across, 1)
        if following == e:
            return darts
        darts.append(following)
