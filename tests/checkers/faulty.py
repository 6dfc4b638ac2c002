"""Mappers with one fault each, made of the pieces of the real ones.

`Misled` stands between an algorithm and its robot and bends what passes; a rule, an order or a
map with a fault in it goes through the same exploration loop as the real ones.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from topo_verify.algorithms import CATALOGUE
from topo_verify.algorithms.basic import NoRule
from topo_verify.algorithms.chart import Chart, Dart, Survey, Tree
from topo_verify.algorithms.exploration import Refutation, Rule, explore
from topo_verify.algorithms.motion import (
    Executed,
    Hypothesis,
    Motion,
    common_prefix,
    overlap,
    retrace,
)
from topo_verify.algorithms.policies import Order, nearest, shortest
from topo_verify.faults.fault import ForwardingRobot
from topo_verify.robot.events import Evidence
from topo_verify.robot.percept import Door, Percept, Purpose
from topo_verify.robot.simulator import SimulatedRobot

basic = CATALOGUE["basic"]


class Vague(Percept, frozen=True, gc=False):
    """A percept whose marker points somewhere: any two directions are equal."""

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Percept) and self.signature == other.signature

    def __ne__(self, other: object) -> bool:  # a Struct has one of its own
        return not self == other

    __hash__ = Percept.__hash__


class Undirected(ForwardingRobot):
    """Sees the marker, does not compare where it points."""

    def seen(self, percept: Percept) -> Percept:
        return Vague(percept.degree, percept.marker)


class Blind(ForwardingRobot):
    """Does not see the marker."""

    def seen(self, percept: Percept) -> Percept:
        return Percept(percept.degree, None)


class Wandering(ForwardingRobot):
    """Walks every edge two hundred times more."""

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:
        percept = super().move(door, purpose)
        for _ in range(200):
            super().move(0)
        return percept


def ignores_the_direction_of_the_marker(robot: SimulatedRobot) -> Survey:
    return basic(Undirected(robot))


def ignores_the_marker(robot: SimulatedRobot) -> Survey:
    return basic(Blind(robot))


def wanders(robot: SimulatedRobot) -> Survey:
    return basic(Wandering(robot))._replace(cost=robot.cost)


def does_not_count_its_first_move(robot: SimulatedRobot) -> Survey:
    survey = basic(robot)
    return survey._replace(cost=survey.cost - 1)


def knows_it_beforehand(_robot: SimulatedRobot) -> Survey:
    """A single edge, it says, whatever the world."""
    return Survey(((0,), (1,)), ((0, 1),), 0, 0)


def with_rule(
    rule: Callable[[], Rule], *, order: Order = shortest, motion: Motion = retrace
) -> Callable[[SimulatedRobot], Survey]:
    """A mapper with this rule, this order, this motion."""
    return lambda robot: explore(robot, rule=rule(), motion=motion, pick=nearest, order=order)


def all_but_the_last(darts: Iterable[Dart], chart: Chart, tree: Tree) -> list[Dart]:
    """The order `shortest`, with the last hypothesis left out where there are two."""
    row = shortest(darts, chart, tree)
    return row[:-1] if len(row) > 1 else row


class OffByOne(NoRule):
    """Rule `prefix` with every percept taken for the one behind the next door."""

    def refute(
        self,
        chart: Chart,  # noqa: ARG002  all rules have one signature
        hypothesis: Hypothesis,
        sequences: Sequence[Executed],
    ) -> Refutation | None:
        for last in sequences[-1:]:
            for step in range(1, common_prefix(hypothesis.doors, last.doors) + 1):
                expected, observed = hypothesis.expected[step], last.percepts[step - 1]
                if expected != observed:
                    evidence = Evidence(step, expected, observed, sequence=len(sequences) - 1)
                    return Refutation("prefix", evidence)
        return None


forgets_a_hypothesis = with_rule(NoRule, order=all_but_the_last)
compares_off_by_one = with_rule(OffByOne, motion=overlap)
