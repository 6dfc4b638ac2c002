"""Mistakes in the delivered map, its marker and cost; or in when it is delivered."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from topo_verify.algorithms import CATALOGUE
from topo_verify.algorithms.basic import NoRule
from topo_verify.algorithms.chart import Chart, Survey
from topo_verify.algorithms.motion import Executed, Pilot
from topo_verify.faults.fault import Fault, ForwardingRobot, mapper
from topo_verify.robot.events import MapDart, Robot

fault = partial(Fault, part="report")

basic = CATALOGUE["basic"]


def _no_loops(robot: Robot) -> Survey:
    survey = basic(robot)
    vertex = {dart: v for v, row in enumerate(survey.vertices) for dart in row}
    return survey._replace(edges=tuple(e for e in survey.edges if vertex[e[0]] != vertex[e[1]]))


delivers_no_loops = fault(
    name="delivers-no-loops",
    why="the map leaves out every edge from a vertex to itself",
    claim="map-isomorphic",
    mapper=_no_loops,
)


def _one_too_few(robot: Robot) -> Survey:
    survey = basic(robot)
    return survey._replace(edges=survey.edges[:-1])


delivers_one_edge_too_few = fault(
    name="delivers-one-edge-too-few",
    why="the map leaves out the edge that was found last",
    claim="map-isomorphic",
    mapper=_one_too_few,
)


def _every_dart(robot: Robot) -> Survey:
    survey = basic(robot)
    return survey._replace(edges=(*survey.edges, *((b, a) for a, b in survey.edges)))


delivers_every_edge_twice = fault(
    name="delivers-every-edge-twice",
    why="the map has an edge for every dart, not for every pair of darts",
    claim="map-isomorphic",
    mapper=_every_dart,
)


def _mirrored(robot: Robot) -> Survey:
    survey = basic(robot)
    return survey._replace(vertices=tuple(row[::-1] for row in survey.vertices))


delivers_the_mirror_image = fault(
    name="delivers-the-mirror-image",
    why="the exits of each vertex are listed anticlockwise",
    claim="map-isomorphic",
    mapper=_mirrored,
)


class _MarkerWhereItStands(Chart):
    def survey(self, cost: int) -> Survey:
        last = len(self.alpha) - 1
        return super().survey(cost)._replace(marker=last if self.alpha else None)


marks_the_last_dart = fault(
    name="marks-the-last-dart",
    why="the map has the marker at the dart that was found last",
    claim="map-isomorphic",
    mapper=mapper("basic", Chart=_MarkerWhereItStands),
)


class _WaysBackAreFree(Pilot):
    def back(self, steps: int) -> None:
        before = self.cost  # the robot still pays: the simulator counts every move
        super().back(steps)
        self.cost = before


counts_no_ways_back = fault(
    name="counts-no-ways-back",
    why="retracing is not counted in the cost",
    claim="cost-honest",
    mapper=mapper("basic", Pilot=_WaysBackAreFree),
)


def _over(robot: Robot) -> Survey:
    survey = basic(robot)
    return survey._replace(cost=survey.cost + 1)


counts_the_start_as_a_move = fault(
    name="counts-the-start-as-a-move",
    why="the cost is the number of percepts, one more than there are moves",
    claim="cost-honest",
    mapper=_over,
)


def _two_for_nothing(robot: Robot) -> Survey:
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


takes_back_two_moves = fault(
    name="takes-back-two-moves",
    why="the robot goes out and back, and removes both moves from the trace if it can reach it",
    claim="cost-honest",
    mapper=_two_for_nothing,
)


class _GivesUp(BaseException):
    """Not an `Exception`, like `asyncio.CancelledError`."""


def _cancelled(robot: Robot) -> Survey:
    survey = basic(robot)
    if any(len(row) > 2 for row in survey.vertices):
        raise _GivesUp("a crossing")
    return survey


raises_past_exception = fault(
    name="raises-past-exception",
    why="at the end a vertex with three exits or more raises what is no Exception",
    claim="map-isomorphic",
    mapper=_cancelled,
)


class _TwoDartsLeft(NoRule):
    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        # They may also lead to two vertices not yet seen.
        if len(chart.unexplored) == 2:
            chart.join(*chart.unexplored)


joins_the_last_two_unseen = fault(
    name="joins-the-last-two-unseen",
    why="when two darts are left, they are joined to one edge unseen, and the robot stops",
    claim="map-entailed",
    mapper=mapper("basic", rule=_TwoDartsLeft),
)
