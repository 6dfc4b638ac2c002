"""Motion: excursions from vu, and which hypothesis is walked next from where the robot stands.

A **sequence** is what was executed for the current edge: doors from vu, and the percept behind each
(percept 0 is vu's own). The robot undoes doors k1 … kt by the moves 0, -kt, …, -k2 (modulo each
degree); back where it began, its reference dart is turned by k1, so -k1 is added to its next door.
Turning costs nothing.

    motion    back to            next hypothesis
    retrace   vu, every time     the first of H
    overlap   the end of the     the one with the longest common prefix of doors with the last
              common prefix      sequence; ties, and while nothing is executed: the first of H

Source: docs/semantics.md, sections 2, 6, 7; listing 1 lines 10-15, listing 2 lines 15-23.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

from topo_verify.algorithms.chart import Chart, Tree
from topo_verify.robot.events import MapDart, Robot
from topo_verify.robot.percept import Door, Percept, Purpose


@dataclass(frozen=True, slots=True)
class Executed:
    """A sequence: doors from vu, and len(doors) + 1 percepts, vu's own first."""

    doors: tuple[Door, ...]
    percepts: tuple[Percept, ...]


class Hypothesis:
    """The hypothesis that e ends in dart h: the way home from h, and what would be seen on it.

    The way leads along the breadth-first tree rooted at v0. It is computed when it is first asked
    for, because most hypotheses are rejected before that.
    """

    def __init__(self, dart: MapDart, chart: Chart, tree: Tree) -> None:
        # What is computed later speaks of the same S: a hypothesis is dropped before S grows.
        self.dart, self._chart, self._tree = dart, chart, tree

    @cached_property
    def arrivals(self) -> tuple[MapDart, ...]:
        """The reference darts on the way: h itself, then the dart of arrival behind each door."""
        chart, row = self._chart, [self.dart]
        # `up` leaves the vertex towards v0; the robot arrives by the other end of its edge.
        while (up := self._tree.parent[chart.vertex[row[-1]]]) is not None:
            row.append(chart.across(up))
        return tuple(row)

    @cached_property
    def doors(self) -> tuple[Door, ...]:
        """The motion sequence to v0, relative to the entry dart h. Empty if h is v0's."""
        chart, row = self._chart, self.arrivals
        # b is where it arrives, so across(b) is the dart by which it left the vertex of a.
        return tuple(chart.door(a, chart.across(b)) for a, b in pairwise(row))

    @cached_property
    def expected(self) -> tuple[Percept, ...]:
        """What is sensed at each step if the hypothesis is true; step 0 is vu itself."""
        return tuple(map(self._chart.percepts.__getitem__, self.arrivals))


class Pilot:
    """Drives the robot and counts what it costs. Lives as long as the exploration.

    Knows by how much the robot's reference dart is turned away from the dart by which it entered
    the place on its way out (`turned`), and which doors led from vu to where it stands (`doors`).
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.cost = 0
        self.turned: Door = 0
        self.doors: list[Door] = []
        self.percepts: list[Percept] = [robot.percept]

    def walk(self, chart: Chart, at: MapDart, v: int) -> MapDart:
        """Walk on S to v along the tree rooted there. Returns the reference dart at the end."""
        # Rooted at the end of the walk, so that each vertex on it has its dart towards the end.
        towards = chart.tree(v, until=chart.vertex[at]).parent
        while (exit_dart := towards[chart.vertex[at]]) is not None:
            self._move(chart.door(at, exit_dart), "walk")
            at = chart.across(exit_dart)
        return at

    def cross(self, chart: Chart, at: MapDart, e: MapDart) -> Percept:
        """Leave the known world by e. Returns the percept at vu, where excursions start."""
        percept = self._move(chart.door(at, e), "cross")
        self.turned, self.doors, self.percepts = 0, [], [percept]
        return percept

    def forward(self, door: Door) -> Percept:
        """Walk one more door of a sequence, relative to the dart by which the place was entered."""
        percept = self._move((door - self.turned) % self.robot.percept.degree, "validate")
        self.turned = 0
        self.doors.append(door)
        self.percepts.append(percept)
        return percept

    def back(self, steps: int) -> None:
        """Retrace until only this many doors of the excursion are left. 0: back at vu."""
        while len(self.doors) > steps:
            # The dart of entry leads back; the reference dart is turned away from it by `turned`.
            self._move(-self.turned % self.robot.percept.degree, "retrace")
            # It arrives by the dart that this door left by: so far is it turned from the entry.
            self.turned = self.doors.pop()
            self.percepts.pop()

    def executed(self) -> Executed:
        """The sequence that led from vu to where the robot stands."""
        return Executed(tuple(self.doors), tuple(self.percepts))

    def _move(self, door: Door, purpose: Purpose) -> Percept:
        self.cost += 1
        return self.robot.move(door, purpose)


class Choice(NamedTuple):
    """The hypothesis to walk next, and how many doors of the last sequence it shares."""

    hypothesis: Hypothesis
    shared: int


Motion = Callable[[Sequence[Hypothesis], Executed | None], Choice]


def retrace(hypotheses: Sequence[Hypothesis], last: Executed | None) -> Choice:
    """The first hypothesis, walked from vu, even where its doors were executed before."""
    return Choice(hypotheses[0], 0)  # A1.8 A1.15 A3.9 A3.24


def overlap(hypotheses: Sequence[Hypothesis], last: Executed | None) -> Choice:
    """The hypothesis that shares most doors with the last sequence, walked from where they part."""
    doors = () if last is None else last.doors
    shared = [common_prefix(h.doors, doors) for h in hypotheses]
    longest = max(shared)
    # `index` finds the first of those that tie: the order policy decides.
    return Choice(hypotheses[shared.index(longest)], longest)  # A2.7 A2.22


def common_prefix(one: Sequence[Door], other: Sequence[Door]) -> int:
    """How many doors two sequences share from vu on."""
    length = 0
    for a, b in zip(one, other, strict=False):
        if a != b:
            break
        length += 1
    return length
