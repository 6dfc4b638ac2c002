"""Listing 1 in 30 lines: the library keeps the map S and drives the robot, the idea is yours."""

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.motion import Hypothesis, Pilot
from topo_verify.algorithms.policies import nearest, shortest
from topo_verify.robot.events import Augment, Confirm, Evidence, Pose, Reject


def explore(robot):
    chart, pilot, at = Chart(robot.percept), Pilot(robot), 0
    while chart.unexplored:
        e = nearest(chart, at)
        del chart.unexplored[e]
        seen = pilot.cross(chart, pilot.walk(chart, at, chart.vertex[e]), e)
        alike = [h for h in chart.unexplored if chart.percepts[h].signature == seen.signature]
        alike = shortest(alike, chart, home := chart.tree(0))
        robot.declare(Pose(e, tuple(alike)))
        found = next((h for h in alike if holds(robot, pilot, e, Hypothesis(h, chart, home))), None)
        entry = chart.add_vertex(seen) if found is None else found
        chart.join(e, entry)
        robot.declare(Augment(e, "new" if found is None else "loop", entry, seen.degree))
        marker = robot.percept.marker  # at v0 it tells how the robot stands
        at = chart.turn(entry, pilot.turned) if marker is None else chart.turn(0, -marker)
    return chart.survey(pilot.cost)


def holds(robot, pilot, e, h):  # walk home as if e had ended in h, and compare
    for step, expected in enumerate(h.expected):
        seen = pilot.forward(h.doors[step - 1]) if step else pilot.percepts[0]
        if seen != expected:
            robot.declare(Reject(e, h.dart, "motion", Evidence(step, expected, seen)))
            pilot.back(0)
            return False
    robot.declare(Confirm(e, h.dart, "motion"))
    return True
