"""Four mappers with one mistake each, as one makes them. docs/replay.md looks for the mistakes.

All four are the basic algorithm (listing 1): cross an unexplored dart e, ask which unexplored darts
h might be its other end, walk home from behind e as if it had ended in h, and compare. What each
does differently is one method.
"""

from __future__ import annotations

from topo_verify import Percept, Robot
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.motion import Hypothesis, Pilot
from topo_verify.algorithms.policies import nearest, shortest
from topo_verify.robot.events import Augment, Confirm, Evidence, Pose, Reject


class Basic:
    """The basic algorithm; this one is right."""

    def __init__(self, robot: Robot) -> None:
        self.robot, self.chart, self.pilot = robot, Chart(robot.percept), Pilot(robot)

    def explore(self) -> object:
        """Map the robot's world."""
        robot, chart, pilot, at = self.robot, self.chart, self.pilot, 0
        while chart.unexplored:
            e = nearest(chart, at)
            del chart.unexplored[e]
            seen = pilot.cross(chart, pilot.walk(chart, at, chart.vertex[e]), e)
            home = chart.tree(0)
            asked = [h for h in chart.unexplored if self.may_end_in(e, h, seen)]
            asked = shortest(asked, chart, home)
            robot.declare(Pose(e, tuple(asked)))
            found = next((h for h in asked if self.holds(e, Hypothesis(h, chart, home))), None)
            entry = chart.add_vertex(seen) if found is None else found
            chart.join(e, entry)
            robot.declare(Augment(e, "new" if found is None else "loop", entry, seen.degree))
            marker = robot.percept.marker  # at v0 it tells how the robot stands
            at = chart.turn(entry, pilot.turned) if marker is None else chart.turn(0, -marker)
        return chart.survey(pilot.cost)

    def may_end_in(self, e: int, h: int, seen: Percept) -> bool:  # noqa: ARG002  others ask for e
        """Whether e may end in h, by the look of the place behind e."""
        return self.chart.percepts[h].signature == seen.signature

    def holds(self, e: int, h: Hypothesis) -> bool:
        """Walk home as if e had ended in h, and compare what is seen; if it differs, go back."""
        for step, expected in enumerate(h.expected):
            seen = self.forward(h.doors[step - 1]) if step else self.pilot.percepts[0]
            if not self.alike(seen, expected):
                self.robot.declare(Reject(e, h.dart, "motion", Evidence(step, expected, seen)))
                self.pilot.back(0)
                return False
        self.robot.declare(Confirm(e, h.dart, "motion"))
        return True

    def forward(self, door: int) -> Percept:
        """Walk one more door of the way home."""
        return self.pilot.forward(door)

    def alike(self, seen: Percept, expected: Percept) -> bool:
        """Whether a place looks as it should."""
        return seen == expected


class Forgetful(Basic):
    def forward(self, door: int) -> Percept:
        self.pilot.turned = 0
        return super().forward(door)


class Credulous(Basic):
    def holds(self, e: int, h: Hypothesis) -> bool:
        self.robot.declare(Confirm(e, h.dart, "motion"))
        return True


class Counting(Basic):
    def alike(self, seen: Percept, expected: Percept) -> bool:
        return seen.degree == expected.degree


class Outgoing(Basic):
    def may_end_in(self, e: int, h: int, seen: Percept) -> bool:
        elsewhere = self.chart.vertex[h] != self.chart.vertex[e]
        return elsewhere and super().may_end_in(e, h, seen)


def a(robot: Robot) -> object:
    """A mapper with one mistake."""
    return Forgetful(robot).explore()


def b(robot: Robot) -> object:
    """A mapper with one mistake."""
    return Credulous(robot).explore()


def c(robot: Robot) -> object:
    """A mapper with one mistake."""
    return Counting(robot).explore()


def d(robot: Robot) -> object:
    """A mapper with one mistake."""
    return Outgoing(robot).explore()


def astray(robot: Robot) -> object:
    """Counts the doors from 1, so that the last one is not there."""
    return robot.move(robot.move(0).degree)
