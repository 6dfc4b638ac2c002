"""Mistakes in the delivered map, its marker and cost; or in when it is delivered."""

from __future__ import annotations

from functools import partial

from topo_verify.algorithms import CATALOGUE
from topo_verify.algorithms.chart import Chart, Survey
from topo_verify.algorithms.motion import Pilot
from topo_verify.algorithms.rules import NoRule
from topo_verify.faults.fault import ForwardingRobot, Walks, planted
from topo_verify.robot.events import MapDart, Robot

fault = partial(planted, "report")

basic = CATALOGUE["basic"]


@fault(claim="map-isomorphic")
def delivers_no_loops(robot: Robot) -> Survey:
    """the map leaves out every edge from a vertex to itself"""
    survey = basic(robot)
    vertex = {dart: v for v, row in enumerate(survey.vertices) for dart in row}
    return survey._replace(edges=tuple(e for e in survey.edges if vertex[e[0]] != vertex[e[1]]))


@fault(claim="map-isomorphic")
def delivers_one_edge_too_few(robot: Robot) -> Survey:
    """the map leaves out the edge that was found last"""
    survey = basic(robot)
    return survey._replace(edges=survey.edges[:-1])


@fault(claim="map-isomorphic")
def delivers_every_edge_twice(robot: Robot) -> Survey:
    """the map has an edge for every dart, not for every pair of darts"""
    survey = basic(robot)
    return survey._replace(edges=(*survey.edges, *((b, a) for a, b in survey.edges)))


@fault(claim="map-isomorphic")
def delivers_the_mirror_image(robot: Robot) -> Survey:
    """the exits of each vertex are listed anticlockwise"""
    survey = basic(robot)
    return survey._replace(vertices=tuple(row[::-1] for row in survey.vertices))


@fault("basic", "Chart", claim="map-isomorphic")
class marks_the_last_dart(Chart):
    """the map has the marker at the dart that was found last"""

    def survey(self, cost: int) -> Survey:
        last = len(self.alpha) - 1
        return super().survey(cost)._replace(marker=last if self.alpha else None)


@fault("basic", "Pilot", claim="cost-honest")
class counts_no_ways_back(Pilot):
    """retracing is not counted in the cost"""

    def back(self, steps: int) -> None:
        before = self.cost  # the robot still pays: the simulator counts every move
        super().back(steps)
        self.cost = before


@fault(claim="cost-honest")
def counts_the_start_as_a_move(robot: Robot) -> Survey:
    """the cost is the number of percepts, one more than there are moves"""
    survey = basic(robot)
    return survey._replace(cost=survey.cost + 1)


@fault(claim="cost-honest")
def takes_back_two_moves(robot: Robot) -> Survey:
    """the robot goes out and back, and removes both moves from the trace if it can reach it"""
    if robot.percept.degree:
        robot.move(0)
        robot.move(0)
    hidden = robot
    while isinstance(hidden, ForwardingRobot):
        hidden = hidden.robot
    # The trace, if it is in this process.
    trace = getattr(getattr(hidden.move, "__self__", None), "events", [])
    del trace[:2]
    return basic(robot)


class _GivesUp(BaseException):
    """Not an `Exception`, like `asyncio.CancelledError`."""


@fault(claim="map-isomorphic")
def raises_past_exception(robot: Robot) -> Survey:
    """at the end a vertex with three exits or more raises what is no Exception"""
    survey = basic(robot)
    if any(len(row) > 2 for row in survey.vertices):
        raise _GivesUp("a crossing")
    return survey


@fault("basic", "rule", claim="map-entailed")
class joins_the_last_two_unseen(NoRule):
    """when two darts are left, they are joined to one edge unseen, and the robot stops"""

    def learn(self, chart: Chart, e: MapDart, entry: MapDart, sequences: Walks) -> None:
        # They may also lead to two vertices not yet seen.
        if len(chart.unexplored) == 2:
            chart.join(*chart.unexplored)
