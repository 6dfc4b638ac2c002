"""Planner: `homing` that learns, in the course of a run, where edges tend to end.

It differs from `homing` in two policies. Both learn from what the history has proved, and steer by
it; like every policy of steering.py they touch the cost alone.

1. **Where edges end.** In streets and lattices an edge that closes a loop mostly ends near by, and
   often a few steps along the face. So each hypothesis h for e has a **kind**: how far the vertex
   of h is from that of e on S, and after how many steps a walk along the face beside e, on either
   side, passes h. A kind's rate is how often hypotheses of that kind were true so far, drawn
   towards the rate of all kinds while few were seen. It is the prior by which `homing`'s rule 4
   weighs the hypotheses. In a world without such a habit the rates differ by chance alone.
2. **Outward.** Of two edges the one further from home may be a fraction of a move further from the
   robot: it need not be fetched later.

    letter       what it is
    U, e, h      as in history.py

Why it ends, and within the bound of claim 7: steering.py. What it saves: docs/homing.md.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

from topo_verify.algorithms.chart import Chart, Survey
from topo_verify.algorithms.folding import NodeDart
from topo_verify.algorithms.history import History
from topo_verify.algorithms.homing import most_telling_door
from topo_verify.algorithms.next_edge import outward_edge
from topo_verify.algorithms.steering import HistoryOf, explore
from topo_verify.robot.events import MapDart, Robot

FAR = 9
"""Distances and steps from here on are one kind; so are darts on no face beside e."""

LONGEST_FACE = 60
"""So many steps along a face are walked at most; those of the outer face tell nothing."""

ClosureKind = tuple[int, int]
"""How far apart two ends lie: distance on S, steps along the face; both at most `FAR`."""


def planner(robot: Robot, *, history_of: HistoryOf = History) -> Survey:
    """Map the robot's world."""
    habits = Habits()
    return explore(robot, edge=outward_edge, door=habits.door, history_of=history_of)


class Habits:
    """How often the hypotheses of each kind were true. Lives for one run.

    Attributes:
        seen, true: of each kind, the hypotheses that were posed and of them those that were true.
        asked: of each crossed edge that is not settled yet, the kinds of its hypotheses.
    """

    def __init__(self) -> None:
        self.seen: Counter[ClosureKind] = Counter()
        self.true: Counter[ClosureKind] = Counter()
        self.asked: dict[MapDart, dict[MapDart, ClosureKind]] = {}

    def door(self, history: History, e: MapDart) -> NodeDart:
        """The next door, hypotheses being weighed by the rate of their kind."""
        self._learn(history.chart)
        if e not in self.asked:
            every = kinds(history.chart, e)
            self.asked[e] = {h: every[h] for h, _ in history.hypotheses(e)}
            self.seen.update(self.asked[e].values())
        asked = self.asked[e]
        # A dart of a vertex that was new since: no kind was seen that it is of.
        return most_telling_door(history, e, lambda h: self.rate(asked.get(h, (FAR, FAR))))

    def rate(self, kind: ClosureKind) -> float:
        """How likely a hypothesis of this kind is true."""
        usual = (self.true.total() + 0.5) / (self.seen.total() + 5)
        return (self.true[kind] + 2 * usual) / (self.seen[kind] + 2)

    def _learn(self, chart: Chart) -> None:
        """Note which hypotheses came true of the edges that are settled by now."""
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
    """The darts of U on the face to the left or right of e: after how many steps along it.

    An unexplored dart is a dead end there, where the walk turns.
    """
    found: dict[MapDart, int] = {}
    for side in (-1, 1):
        at, steps = chart.turn(e, side), 0
        while at != e and steps < LONGEST_FACE:
            other = chart.alpha[at]
            if other is None:
                found[at] = min(steps, found.get(at, steps))
            else:
                steps += 1
            at = chart.turn(at if other is None else other, side)
    return found
