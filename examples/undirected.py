"""Two ideas that save hardware, and are wrong: a marker without a direction, and no marker at all.

Both mappers run the basic algorithm with a robot that senses less. `undirected` senses only whether
the marker is there, `unmarked` does not sense the marker at all. docs/search.md finds the smallest
worlds in which this is too little.
"""

from __future__ import annotations

from topo_verify import CATALOGUE, Percept, Robot
from topo_verify.robot.events import Decision
from topo_verify.robot.percept import Door, Purpose


class Undirected(Percept, frozen=True):
    """A percept compared by degree and presence of the marker, not by its direction."""

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Percept) and self.signature == other.signature

    def __ne__(self, other: object) -> bool:
        return not self == other

    def __hash__(self) -> int:
        return hash(self.signature)


class Blurred:
    """A robot that senses less than the one behind it."""

    def __init__(self, robot: Robot) -> None:
        self.robot = robot

    @property
    def percept(self) -> Percept:
        """The percept; comparing it ignores the direction of the marker."""
        return Undirected(self.robot.percept.degree, self.robot.percept.marker)

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:
        """Make the move with the robot behind."""
        self.robot.move(door, purpose)
        return self.percept

    def declare(self, event: Decision) -> None:
        """Hand the declaration to the robot behind."""
        self.robot.declare(event)


class Blind(Blurred):
    """A robot that does not sense the marker."""

    @property
    def percept(self) -> Percept:
        """The percept without the marker."""
        return Percept(self.robot.percept.degree, None)


def undirected(robot: Robot) -> object:
    """The basic algorithm, with a marker that has no direction."""
    return CATALOGUE["basic"](Blurred(robot))


def unmarked(robot: Robot) -> object:
    """The basic algorithm, with no marker."""
    return CATALOGUE["basic"](Blind(robot))
