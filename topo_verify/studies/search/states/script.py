"""One run of an algorithm that is told its choices one by one.

Two things are open: between two edges, which e comes next; behind e, which hypothesis is tried
next among those that the motion allows (`overlap`: those with the longest common prefix). A run
is a list of numbers, `--choices 0,2,1`: at each moment with more than one way, the number of the
way taken, in the order of the darts of S; after the end of the list, the first way.

What this does not show: other ways to walk (docs/semantics.md, section 5).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from inspect import currentframe
from types import FrameType
from typing import NamedTuple

from topo_verify.algorithms import Algorithm, exploration
from topo_verify.algorithms.chart import Chart, Survey
from topo_verify.algorithms.motion import Choice, Executed, Hypothesis
from topo_verify.algorithms.policies import oldest
from topo_verify.errors import InputError
from topo_verify.robot.events import Decision, Event, MapDart, Move, Robot, Start
from topo_verify.robot.percept import Door, Percept, Purpose


class ChoicePoint(NamedTuple):
    """A moment of a run at which there is something to choose.

    Attributes:
        e: the edge that was crossed; None: it is still to be chosen.
        ways: the darts of S among which to choose.
        frame: the function of the mapper that asks.
    """

    chart: Chart
    e: MapDart | None
    ways: tuple[MapDart, ...]
    trace: Sequence[Event]
    moves: int
    frame: FrameType | None


Chooser = Callable[[ChoicePoint], int]
"""The place among `ways` of the way to take."""


class MeteredRobot:
    """A robot that keeps the trace, which the mapper never sees."""

    def __init__(self, robot: Robot) -> None:
        self._robot, self.moves = robot, 0
        self.trace: list[Event] = [Start(percept=robot.percept)]

    @property
    def percept(self) -> Percept:
        """The percept where the robot stands now."""
        return self._robot.percept

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:
        """Leave by a door."""
        percept = self._robot.move(door, purpose)
        self.moves += 1
        self.trace.append(Move(door, percept, purpose))
        return percept

    def declare(self, event: Decision) -> None:
        """Put a decision on record, in the trace too."""
        self._robot.declare(event)
        self.trace.append(event)


@dataclass
class ScriptedPolicies:
    """The policies of one run."""

    algorithm: Algorithm
    robot: MeteredRobot
    chooser: Chooser
    chart: Chart | None = None
    e: MapDart = 0

    def pick(self, chart: Chart, _at: MapDart) -> MapDart:
        """The edge e that the script names next."""
        self.chart = chart
        self.e = self._chosen(None, tuple(chart.unexplored), currentframe())
        return self.e

    def motion(self, hypotheses: Sequence[Hypothesis], last: Executed | None) -> Choice:
        """The hypothesis to try next, among those that the motion allows."""
        by_dart = sorted(hypotheses, key=lambda h: h.dart)
        # The motion takes the first of tied hypotheses, so one that it takes in first place ties.
        firsts = (
            self.algorithm.motion([h, *(o for o in by_dart if o is not h)], last) for h in by_dart
        )
        allowed = [
            choice
            for h, choice in zip(by_dart, firsts, strict=True)
            if choice.hypothesis.dart == h.dart
        ]
        ways = tuple(choice.hypothesis.dart for choice in allowed)
        return allowed[ways.index(self._chosen(self.e, ways, currentframe()))]

    def _chosen(
        self, e: MapDart | None, ways: tuple[MapDart, ...], asked: FrameType | None
    ) -> MapDart:
        assert self.chart is not None, "pick comes first"
        if len(ways) == 1:
            return ways[0]
        frame = None if asked is None else asked.f_back
        robot = self.robot
        return ways[self.chooser(ChoicePoint(self.chart, e, ways, robot.trace, robot.moves, frame))]


def scripted(algorithm: Algorithm, chooser: Chooser) -> Callable[[Robot], Survey]:
    """The algorithm as a mapper whose every choice is made by `chooser`."""

    def explore(robot: Robot) -> Survey:
        metered = MeteredRobot(robot)
        script = ScriptedPolicies(algorithm, metered, chooser)
        return exploration.explore(
            metered, rule=algorithm.rule(), motion=script.motion, pick=script.pick, order=oldest
        )

    return explore


class Listed:
    """Makes the choices of a list, then the first way each time: a run, then `require_all`.

    A wrong number counts as 0 during the run: an exception would be the mapper's.
    """

    def __init__(self, choices: Sequence[int]) -> None:
        self._choices, self._asked, self._wrong = tuple(choices), 0, ""

    def __call__(self, moment: ChoicePoint) -> int:
        """The next number of the list."""
        if self._asked == len(self._choices):
            return 0
        number, ways = self._choices[self._asked], len(moment.ways)
        self._asked += 1
        if number < ways:
            return number
        self._wrong = self._wrong or (
            f"--choices: number {self._asked} is {number}, and there are {ways} ways there; give"
            f" one of 0 … {ways - 1}"
        )
        return 0

    def require_all(self) -> None:
        """Raise an InputError unless the run made each choice of the list."""
        if self._wrong:
            raise InputError(self._wrong)
        if self._asked < len(self._choices):
            raise InputError(
                f"--choices: expected at most {self._asked} numbers in this run, got"
                f" {len(self._choices)}; leave out the last ones"
            )


def choices_of(text: str) -> tuple[int, ...]:
    """The choices in a text such as `0,2,1`; InputError if it is no list of numbers."""
    words = [word.strip() for word in text.split(",")] if text.strip() else []
    if not all(word.isascii() and word.isdecimal() and len(word) < 6 for word in words):
        raise InputError(f"--choices {text}: expected numbers with commas, as 0,2,1")
    return tuple(map(int, words))


def choices_text(choices: Sequence[int]) -> str:
    """The choices as `--choices` takes them, without zeros at the end."""
    row = list(choices)
    while row and row[-1] == 0:
        row.pop()
    return ",".join(map(str, row)) or "0"
