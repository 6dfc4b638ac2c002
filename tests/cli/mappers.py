"""Mappers of a user's: a right one, a silent one, slow ones, and one for each way to be wrong."""

from __future__ import annotations

import itertools
import time
from pathlib import Path
from typing import Any

from topo_verify import CATALOGUE, Percept, Robot
from topo_verify.faults.fault import ForwardingRobot
from topo_verify.robot.events import Decision, Evidence, Pose, Reject
from topo_verify.robot.percept import Door, Purpose


class Mute(ForwardingRobot):
    def declare(self, event: Decision) -> None:
        pass


class Curt(ForwardingRobot):
    told = False

    def declare(self, event: Decision) -> None:  # noqa: ARG002  it says what it likes
        degree = self.home.degree
        if not self.told and degree > 1 and self.percept.marker is None:
            evidence = Evidence(0, Percept(degree, degree - 1), self.percept)
            self.robot.declare(Pose(0, (1,)))
            self.robot.declare(Reject(0, 1, "motion", evidence))
        self.told = True

    def __init__(self, robot: Robot) -> None:
        super().__init__(robot)
        self.home = robot.percept


class Undirected(ForwardingRobot):
    def seen(self, percept: Percept) -> Percept:
        return Percept(percept.degree, None if percept.marker is None else 0)


def right(robot: Robot) -> object:
    return CATALOGUE["enhancement-i"](robot)


def curt(robot: Robot) -> object:
    """Declares one pose, and one rejection that is trivially right."""
    return CATALOGUE["basic"](Curt(robot))


def silent(robot: Robot) -> object:
    return CATALOGUE["enhancement-i"](Mute(robot))


def ignores_direction(robot: Robot) -> object:
    return CATALOGUE["basic"](Undirected(robot))


def guesses(robot: Robot) -> dict[str, Any]:
    """That every world is one edge, after one move."""
    robot.move(0)
    return {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}


def nonsense(_robot: Robot) -> object:
    print("this must not stand among the results")  # noqa: T201  that is what it is wrong about
    return 42


def raises(_robot: Robot) -> object:
    raise ValueError("no\x1b[31m way\nat all")


def loops(_robot: Robot) -> object:
    return all(number >= 0 for number in itertools.count())  # one line: a finding names it


def walks(robot: Robot) -> object:
    while True:
        robot.move(0)


def strolls(robot: Robot) -> object:
    """Right, but it takes its time between moves."""

    class Slow(ForwardingRobot):
        def move(self, door: Door, purpose: Purpose | None = None) -> Percept:
            time.sleep(0.05)
            return super().move(door, purpose)

    return CATALOGUE["basic"](Slow(robot))


def raises_or_strolls(robot: Robot) -> object:
    return raises(robot) if robot.percept.degree == 1 else strolls(robot)


def starts_and_sleeps(robot: Robot) -> object:
    """Right in worlds of one edge; elsewhere it tells a test that it is at work, and sleeps."""
    result = CATALOGUE["basic"](robot)
    if len(result.edges) > 1:
        Path("at-work").touch()
        time.sleep(60)
    return result


def lucky(robot: Robot) -> dict[str, Any]:
    """That every world is a triangle, which three moves of a walk there and back do not prove."""
    for door in (1, 1, 0):
        robot.move(door % robot.percept.degree)
    return {"vertices": [[0, 1], [2, 3], [4, 5]], "edges": [[1, 2], [3, 4], [5, 0]], "marker": 0}
