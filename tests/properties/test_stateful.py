"""A robot and a chart against the world: whatever is explored in whatever order, S stays true.

The machine plays the mapper, and is told by the world where each edge leads: so it asks what an
algorithm relies on of the robot and of the chart alone, with no algorithm in it.
"""

from __future__ import annotations

from collections import deque

import pytest
from hypothesis import Phase, settings, stateful
from hypothesis import strategies as st

from topo_verify import World
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.motion import Hypothesis, Pilot
from topo_verify.robot.events import MapDart, Move
from topo_verify.robot.simulator import SimulatedRobot, exit_dart, percepts
from topo_verify.strategies import worlds


class Exploration(stateful.RuleBasedStateMachine):
    """S beside the world. `image` is the dart of the world that each dart of S is."""

    @stateful.initialize(world=worlds(min_edges=1, max_edges=12))
    def begin(self, world: World) -> None:
        self.world = world
        self.robot = SimulatedRobot(world, budget=10**6)
        self.chart = Chart(self.robot.percept)
        self.pilot = Pilot(self.robot)
        self.at: MapDart = 0
        self.image: list[MapDart] = []
        self._number(world.root or 0)

    def _number(self, entry: MapDart) -> None:
        degree = self.world.degrees[self.world.vertex_of[entry]]
        self.image += [exit_dart(self.world, entry, door) for door in range(degree)]

    @stateful.precondition(lambda self: self.chart.unexplored)
    @stateful.rule(data=st.data())
    def explore_an_edge(self, data: st.DataObject) -> None:
        """Walk to any unexplored dart and cross it; join it with what is truly there."""
        e = data.draw(st.sampled_from(list(self.chart.unexplored)))
        self.at = self.pilot.walk(self.chart, self.at, self.chart.vertex[e])
        percept = self.pilot.cross(self.chart, self.at, e)
        arrival = self.world.alpha[self.image[e]]
        if arrival not in self.image:
            assert self.chart.add_vertex(percept) == len(self.image)
            self._number(arrival)
        self.at = self.image.index(arrival)
        self.chart.join(e, self.at)

    @stateful.rule(data=st.data())
    def walk_to_a_vertex(self, data: st.DataObject) -> None:
        """By a shortest way on S."""
        v = data.draw(st.sampled_from(range(len(self.chart.first))))
        shortest = self.distances(v)[self.chart.vertex[self.at]]
        before = self.robot.cost
        self.at = self.pilot.walk(self.chart, self.at, v)
        assert self.chart.vertex[self.at] == v
        assert self.robot.cost - before == shortest

    @stateful.rule(data=st.data())
    def go_out_and_come_back(self, data: st.DataObject) -> None:
        """Any excursion, retraced, ends where it began, turned by what `turned` says."""
        doors = data.draw(st.lists(st.integers(0, 7), min_size=1, max_size=5))
        percept, before = self.robot.percept, self.robot.cost
        self.pilot.turned, self.pilot.doors, self.pilot.percepts = 0, [], [percept]
        for door in doors:
            self.pilot.forward(door % self.robot.percept.degree)
        self.pilot.back(0)
        assert self.robot.cost - before == 2 * len(doors)
        self.at = self.chart.turn(self.at, self.pilot.turned)

    @stateful.precondition(lambda self: self.chart.unexplored)
    @stateful.rule(data=st.data())
    def the_way_home_of_a_hypothesis_leads_home(self, data: st.DataObject) -> None:
        """If it is true: from the place of any known dart, by its doors, to what it expects."""
        h = data.draw(st.sampled_from(range(len(self.image))))
        hypothesis = Hypothesis(h, self.chart, self.chart.tree(0))
        at, shown = self.image[h], percepts(self.world)
        assert hypothesis.expected[0] == shown[at]
        for door, expected in zip(hypothesis.doors, hypothesis.expected[1:], strict=True):
            at = self.world.alpha[exit_dart(self.world, at, door)]
            assert shown[at] == expected
        assert self.world.vertex_of[at] == self.world.marker_vertex
        assert len(hypothesis.doors) == self.distances(0)[self.chart.vertex[h]]

    def distances(self, root: int) -> dict[int, int]:
        """Of each vertex of S from a vertex of S, along explored edges; by a search of its own."""
        distance, queue = {root: 0}, deque([root])
        while queue:
            v = queue.popleft()
            for dart in self.chart.darts(v):
                other = self.chart.alpha[dart]
                if other is not None and self.chart.vertex[other] not in distance:
                    distance[self.chart.vertex[other]] = distance[v] + 1
                    queue.append(self.chart.vertex[other])
        return distance

    # ------------------------------------------------------------ what is true at any time

    @stateful.invariant()
    def the_robot_stands_where_s_says(self) -> None:
        at = self.image[self.at]
        assert self.robot.percept == percepts(self.world)[at] == self.chart.percepts[self.at]

    @stateful.invariant()
    def s_is_a_part_of_the_world(self) -> None:
        assert len(set(self.image)) == len(self.image) == len(self.chart.alpha)
        for dart, other in enumerate(self.chart.alpha):
            after = self.chart.turn(dart, 1)
            assert self.world.sigma[self.image[dart]] == self.image[after]
            assert self.chart.percepts[dart] == percepts(self.world)[self.image[dart]]
            if other is not None:
                assert self.world.alpha[self.image[dart]] == self.image[other]

    @stateful.invariant()
    def unexplored_is_what_has_no_other_end(self) -> None:
        open_darts = [dart for dart, other in enumerate(self.chart.alpha) if other is None]
        assert list(self.chart.unexplored) == open_darts
        if not open_darts:
            drawn = self.chart.survey(self.robot.cost)
            assert World.from_map(drawn).is_isomorphic(self.world)

    @stateful.invariant()
    def every_move_is_on_record(self) -> None:
        moves = [event for event in self.robot.events if isinstance(event, Move)]
        assert len(moves) == self.robot.cost == self.pilot.cost


@pytest.mark.nightly
def test_whatever_is_explored_in_whatever_order_s_stays_true() -> None:
    stateful.run_state_machine_as_test(
        Exploration, settings=settings(max_examples=settings().max_examples, stateful_step_count=30)
    )


def restores_no_orientation(pilot: Pilot, steps: int) -> None:
    """`Pilot.back`, but the doors back are counted as if the robot had not turned."""
    while len(pilot.doors) > steps:
        pilot.cost += 1
        pilot.robot.move(0, "retrace")
        pilot.turned = pilot.doors.pop()
        pilot.percepts.pop()


def turns_the_other_way(chart: Chart, dart: MapDart, door: int) -> MapDart:
    v = chart.vertex[dart]
    return chart.first[v] + (dart - chart.first[v] - door) % chart.degree[v]


@pytest.mark.parametrize(
    ("part", "name", "fault"),
    [(Pilot, "back", restores_no_orientation), (Chart, "turn", turns_the_other_way)],
)
def test_a_planted_fault_is_seen(
    part: type, name: str, fault: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(part, name, fault)
    quick = settings(phases=[Phase.generate], stateful_step_count=30, database=None)
    with pytest.raises(AssertionError):
        stateful.run_state_machine_as_test(Exploration, settings=quick)
