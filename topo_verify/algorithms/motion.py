"""Motion: excursions from vu, and which hypothesis is walked next from where the robot stands.

A **sequence** is what was executed for the current edge: doors from vu, and the percept behind each
(percept 0 is vu's own). Moves 0, -kt, …, -k2 (modulo each degree) undo doors k1 … kt. The robot's
reference dart is then turned by k1, so -k1 is added to its next door. Turning costs nothing.

Source: docs/semantics.md, sections 2, 6, 7; listing 1 lines 10-15, listing 2 lines 15-23.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from topo_verify.algorithms.chart import Chart, Tree
from topo_verify.robot.events import MapDart, Robot
from topo_verify.robot.percept import Door, Percept, Purpose

T = TypeVar("T")


class on_demand(cached_property[T]):  # noqa: N801  a decorator
    """A `cached_property` without its lock, which takes longer than what is computed here."""

    if not TYPE_CHECKING:  # pragma: no branch: the types stay those of the base

        def __get__(self, instance: Any, owner: type | None = None) -> T:
            value = instance.__dict__[self.attrname] = self.func(instance)
            return value


@dataclass(frozen=True, slots=True)
class Executed:
    """A sequence: doors from vu, and len(doors) + 1 percepts, vu's first."""

    doors: tuple[Door, ...]
    percepts: tuple[Percept, ...]


class Hypothesis:
    """The hypothesis that e ends in dart h: its way home and the percepts expected on it.

    The way follows the breadth-first tree rooted at v0. Computed on demand: few are walked.
    """

    def __init__(self, dart: MapDart, chart: Chart, tree: Tree) -> None:
        # a hypothesis is dropped before S grows
        self.dart, self._chart, self._tree = dart, chart, tree

    @on_demand
    def arrivals(self) -> tuple[MapDart, ...]:
        """The reference darts on the way: h, then the dart of arrival behind each door."""
        chart, row = self._chart, [self.dart]
        while (up := self._tree.parent[chart.vertex[row[-1]]]) is not None:
            row.append(chart.across(up))
        return tuple(row)

    @on_demand
    def doors(self) -> tuple[Door, ...]:
        """The doors to v0, relative to the entry dart h."""
        chart, row = self._chart, self.arrivals
        return tuple([chart.door(a, chart.across(b)) for a, b in pairwise(row)])

    @on_demand
    def expected(self) -> tuple[Percept, ...]:
        """The percept at each step if the hypothesis is true; step 0 is vu."""
        return tuple(map(self._chart.percepts.__getitem__, self.arrivals))


class Pilot:
    """Drives the robot and counts its moves, for one exploration.

    Attributes:
        turned: by how many doors the reference dart is turned from the dart of entry.
        doors: from vu to where the robot stands.
        percepts: vu's, then the one behind each of these doors.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.cost = 0
        self.turned: Door = 0
        self.doors: list[Door] = []
        self.percepts: list[Percept] = [robot.percept]

    def walk(self, chart: Chart, at: MapDart, v: int) -> MapDart:
        """Walk on S to a vertex. Returns the reference dart there."""
        if chart.vertex[at] == v:
            return at
        towards = chart.tree(v, until=chart.vertex[at]).parent
        while (exit_dart := towards[chart.vertex[at]]) is not None:
            self._move(chart.door(at, exit_dart), "walk")
            at = chart.across(exit_dart)
        return at

    def cross(self, chart: Chart, at: MapDart, e: MapDart) -> Percept:
        """Leave S by e. Returns the percept at vu, where excursions start."""
        percept = self._move(chart.door(at, e), "cross")
        self.turned, self.doors, self.percepts = 0, [], [percept]
        return percept

    def forward(self, door: Door) -> Percept:
        """Walk one more door of a sequence, relative to the dart of entry."""
        percept = self._move((door - self.turned) % self.robot.percept.degree, "validate")
        self.turned = 0
        self.doors.append(door)
        self.percepts.append(percept)
        return percept

    def back(self, steps: int) -> None:
        """Retrace until this many doors of the excursion remain."""
        while len(self.doors) > steps:
            self._move(-self.turned % self.robot.percept.degree, "retrace")
            self.turned = self.doors.pop()
            self.percepts.pop()

    def executed(self) -> Executed:
        """The sequence from vu to where the robot stands."""
        return Executed(tuple(self.doors), tuple(self.percepts))

    def _move(self, door: Door, purpose: Purpose) -> Percept:
        self.cost += 1
        return self.robot.move(door, purpose)


class Choice(NamedTuple):
    """The hypothesis to walk next, and the number of doors it shares with the last sequence."""

    hypothesis: Hypothesis
    shared: int


Motion = Callable[[Sequence[Hypothesis], Executed | None], Choice]


def retrace(hypotheses: Sequence[Hypothesis], last: Executed | None) -> Choice:
    """The first hypothesis, walked from vu."""
    return Choice(hypotheses[0], 0)  # A1.8 A1.15 A3.9 A3.24


def overlap(hypotheses: Sequence[Hypothesis], last: Executed | None) -> Choice:
    """The hypothesis with the longest common prefix, walked from where it ends."""
    doors = () if last is None else last.doors
    shared = [common_prefix(h.doors, doors) for h in hypotheses]
    longest = max(shared)
    return Choice(hypotheses[shared.index(longest)], longest)  # A2.7 A2.22


def common_prefix(one: Sequence[Door], other: Sequence[Door]) -> int:
    """Length of the common prefix."""
    length = 0
    for a, b in zip(one, other, strict=False):
        if a != b:
            break
        length += 1
    return length
