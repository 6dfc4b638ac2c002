"""A mapper that looks right: the basic algorithm, ignoring the direction of the marker.

Wherever it sees the marker, it takes it to point at door 0. So it knows that this is the marker's
place, but not how the robot is turned there.
"""

import topo_verify as tv
from topo_verify.algorithms import Algorithm
from topo_verify.robot.events import Decision
from topo_verify.robot.percept import Purpose

BASIC: Algorithm = tv.CATALOGUE["basic"]


class Undirected:
    """A robot that does not sense the direction of the marker."""

    def __init__(self, robot: tv.Robot) -> None:
        self.robot = robot

    @property
    def percept(self) -> tv.Percept:
        degree, marker = self.robot.percept.degree, self.robot.percept.marker
        return tv.Percept(degree, None if marker is None else 0)

    def move(self, door: int, purpose: Purpose | None = None) -> tv.Percept:
        self.robot.move(door, purpose)
        return self.percept

    def declare(self, event: Decision) -> None:
        self.robot.declare(event)


def explore(robot: tv.Robot) -> object:
    """The map, as a mapper returns it."""
    return BASIC(Undirected(robot))
