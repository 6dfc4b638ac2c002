"""The planar prior: in a planar world, only darts on e's own face of S can be its other end.

An edge between two faces of a plane map needs a handle. An open dart counts as a dead end of its
face. The prior is a rule in front of another rule, and a `History` that raises if an edge leads to
another face or two vertices of S are at one place. Darts on different faces stay so while S grows,
so refutations last.

Source: docs/semantics.md, section 8.
"""

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.algorithms.beyond.history import History
from topo_verify.algorithms.beyond.homing import homing
from topo_verify.algorithms.beyond.places import Places
from topo_verify.algorithms.beyond.planner import planner
from topo_verify.algorithms.chart import Chart, Survey
from topo_verify.algorithms.exploration import Refutation, Rule
from topo_verify.algorithms.motion import Executed, Hypothesis
from topo_verify.robot.events import Evidence, MapDart, Robot
from topo_verify.robot.percept import Percept

OTHER_FACE = Refutation("planar", Evidence(0, contradiction="it lies on another face than e"))
"""Why a hypothesis is false in every planar world."""


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
        """Pass the sequence on."""
        self.rule.observe(sequence)

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        """Why the hypothesis is false in every planar world, if it is."""
        if hypothesis.dart in self.face:
            return self.rule.refute(chart, hypothesis, sequences)
        return OTHER_FACE

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        """The conclusion of the other rule."""
        return self.rule.conclude(remaining)

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        """Pass the new edge on."""
        self.rule.learn(chart, e, entry, sequences)


class PlanarHistory(History):
    """A history that also refutes each hypothesis on another face than e."""

    allowed = "planar world"

    def __init__(self, robot: Robot) -> None:
        super().__init__(robot)
        self._faces: dict[MapDart, frozenset[MapDart]] = {}

    def suppose(self, e: MapDart, h: MapDart) -> Places | None:
        """The places if a crossed e ends in h, or None if no planar world allows that."""
        if h in self._face(e):
            return super().suppose(e, h)
        self.crossed[e].refuted[h] = OTHER_FACE
        return None

    def _face(self, e: MapDart) -> frozenset[MapDart]:
        if e not in self._faces:
            darts = frozenset(face(self.chart, e))
            self._faces.update(dict.fromkeys(darts, darts))
        return self._faces[e]

    def _settle_loop(self, e: MapDart, h: MapDart) -> None:
        if h not in self._face(e):
            raise self.impossible(f"edge {e} leads to dart {h}, on another face of S")
        super()._settle_loop(e, h)

    def _join(self, e: MapDart, other: MapDart) -> None:
        super()._join(e, other)
        self._faces.clear()


def planar_homing(robot: Robot) -> Survey:
    """`homing` in a planar world."""
    return homing(robot, history_of=PlanarHistory)


def planar_planner(robot: Robot) -> Survey:
    """`planner` in a planar world."""
    return planner(robot, history_of=PlanarHistory)


def face(chart: Chart, e: MapDart) -> list[MapDart]:
    """The darts of S on the face of e, from e on."""
    darts = [e]
    while True:
        across = chart.alpha[darts[-1]]
        # an unexplored dart is its own other end
        following = chart.turn(darts[-1] if across is None else across, 1)
        if following == e:
            return darts
        darts.append(following)
