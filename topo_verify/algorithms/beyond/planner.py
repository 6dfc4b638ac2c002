"""Planner: `homing` that learns during a run where edges tend to end.

In streets and lattices an edge that closes a loop mostly ends near by, often a few steps along the
face. A hypothesis h for e has a **kind**: the distance on S between the vertices of h and e, and
the steps after which a walk along the face beside e passes h. The rate at which a kind's hypotheses
came true, drawn towards the rate of all while they are few, is the prior of `homing`'s doors.

Source: docs/homing.md.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

from topo_verify.algorithms.beyond.folding import NodeDart
from topo_verify.algorithms.beyond.history import History
from topo_verify.algorithms.beyond.homing import most_telling_door
from topo_verify.algorithms.beyond.next_edge import outward_edge
from topo_verify.algorithms.beyond.steering import HistoryOf, explore
from topo_verify.algorithms.chart import Chart, Survey
from topo_verify.robot.events import MapDart, Robot

FAR = 9
"""Distances and steps from here on are one kind."""

LONGEST_FACE = 60
"""Most steps along a face; those of the outer face tell nothing."""

ClosureKind = tuple[int, int]
"""Distance on S and steps along the face between two ends, both at most `FAR`."""


def planner(robot: Robot, *, history_of: HistoryOf = History) -> Survey:
    """Map the robot's world."""
    habits = Habits()
    return explore(robot, edge=outward_edge, door=habits.door, history_of=history_of)


class Habits:
    """How often the hypotheses of each kind were true, in one run.

    Attributes:
        asked: of each crossed edge not yet settled, the kinds of its hypotheses.
    """

    def __init__(self) -> None:
        self.posed: Counter[ClosureKind] = Counter()
        self.true: Counter[ClosureKind] = Counter()
        self.asked: dict[MapDart, dict[MapDart, ClosureKind]] = {}

    def door(self, history: History, e: MapDart) -> NodeDart:
        """The next door, with hypotheses weighed by the rate of their kind."""
        self._learn(history.chart)
        if e not in self.asked:
            every = kinds(history.chart, e)
            self.asked[e] = {h: every[h] for h, _ in history.hypotheses(e)}
            self.posed.update(self.asked[e].values())
            history.notes.clear()  # the rates have changed
        asked = self.asked[e]
        return most_telling_door(history, e, lambda h: self.rate(asked.get(h, (FAR, FAR))))

    def rate(self, kind: ClosureKind) -> float:
        """How likely a hypothesis of this kind is true."""
        usual = (self.true.total() + 0.5) / (self.posed.total() + 5)
        return (self.true[kind] + 2 * usual) / (self.posed[kind] + 2)

    def _learn(self, chart: Chart) -> None:
        for e in [e for e in self.asked if chart.alpha[e] is not None]:
            kind = self.asked.pop(e).get(chart.across(e))
            if kind is not None:
                self.true[kind] += 1


def kinds(chart: Chart, e: MapDart) -> Mapping[MapDart, ClosureKind]:
    """The kind of each other dart of U, as a hypothesis for e."""
    depth = chart.tree(chart.vertex[e]).depth
    along = face_steps(chart, e)
    return {
        h: (min(depth[chart.vertex[h]], FAR), min(along.get(h, FAR), FAR))
        for h in chart.unexplored
        if h != e
    }


def face_steps(chart: Chart, e: MapDart) -> dict[MapDart, int]:
    """The darts of U on the face to the left or right of e, with the steps to each."""
    steps_to: dict[MapDart, int] = {}
    for side in (-1, 1):
        at, steps = chart.turn(e, side), 0
        while at != e and steps < LONGEST_FACE:
            other = chart.alpha[at]
            if other is None:
                steps_to[at] = min(steps, steps_to.get(at, steps))
            else:
                steps += 1
            at = chart.turn(at if other is None else other, side)
    return steps_to
