"""The robot in a simulated world: hides the world, meters the cost, records what happens.

The robot stands at a vertex; its **reference dart** is the dart by which it came in, at first the
marked one. Door k is the dart k steps clockwise from the reference dart. The robot senses a
`Percept`, the number of doors and the door that the marker points at, and never a dart.

Trusted. A mapper gets a `RobotHandle`. If it runs in the same process, it can reach the simulator
through a method of the handle, so moves are counted apart from the trace. A mapper in another
process cannot reach it.

Source: docs/semantics.md, section 2.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from operator import index
from typing import NoReturn, SupportsIndex, cast

import msgspec

from topo_verify.errors import plural
from topo_verify.robot import events as ev
from topo_verify.robot.limits import BudgetExceeded, MapperStopped
from topo_verify.robot.percept import PURPOSES, Door, Percept, Purpose
from topo_verify.world.rooted_map import Dart, World

_plain = msgspec.msgpack.Encoder(enc_hook=index)
_decision: msgspec.msgpack.Decoder[ev.Decision] = msgspec.msgpack.Decoder(ev.Decision)


class Misuse(MapperStopped):
    """The mapper asked for a door that is not there, or declared a malformed event."""


@lru_cache(maxsize=64)
def percepts(world: World) -> tuple[Percept, ...]:
    """The percept with each dart as the reference dart: sigma^marker(dart) = root."""
    unmarked = [Percept(degree, None) for degree in world.degrees]
    row = [unmarked[vertex] for vertex in world.vertex_of]
    if world.root is not None:
        rotation = world.vertices[world.marker_vertex]
        for dart in rotation:
            marker = (world.place_of[world.root] - world.place_of[dart]) % len(rotation)
            row[dart] = Percept(len(rotation), marker)
    return tuple(row)


def first_percept(world: World) -> Percept:
    """The percept at the start, where the reference dart is the marked one."""
    return Percept(0, None) if world.root is None else percepts(world)[world.root]


def exit_dart(world: World, dart: Dart, door: Door) -> Dart:
    """The dart behind a door for a robot with this reference dart: sigma^door(dart)."""
    rotation = world.vertices[world.vertex_of[dart]]
    return rotation[(world.place_of[dart] + door) % len(rotation)]


def door_number(door: object, degree: int) -> Door:
    """The door as a plain int; Misuse if a vertex of this degree lacks it."""
    if type(door) is int and 0 <= door < degree:
        return door
    try:
        number = -1 if isinstance(door, bool) else index(cast("SupportsIndex", door))
    except TypeError:
        number = -1
    if not 0 <= number < degree:
        doors = plural(degree, "door")
        where = f"at a vertex with {doors}; the first is 0"
        raise Misuse(f"the mapper asked for door {door!r} {where}")
    return number


@lru_cache(maxsize=2**16)
def shared_move(door: Door, percept: Percept, purpose: Purpose | None) -> ev.Move:
    """The `Move` with these fields, one object for equal moves: eight bytes each in a trace."""
    return ev.Move(door, percept, purpose)


def require_purpose(purpose: Purpose | None) -> None:
    """Raise Misuse for an unknown purpose."""
    if purpose is not None and purpose not in PURPOSES:
        raise Misuse(f"expected a purpose of {', '.join(PURPOSES)}, got {purpose!r}")


EVIDENCE = """\
"evidence": {"step": 1, "expected": {"degree": 1, "marker": 0}, \
"observed": {"degree": 4, "marker": 2}}"""
"""An example of the field that mappers forget."""


def plain_decision(event: ev.Decision | Mapping[str, object]) -> ev.Decision:
    """The decision that a mapper declares, as a struct or as its JSON; Misuse if it is none."""
    try:
        # a struct may have been built with anything inside
        return _decision.decode(_plain.encode(event))
    except (msgspec.MsgspecError, TypeError, OverflowError) as error:
        kind = event.get("type") if isinstance(event, Mapping) else type(event).__name__
        got = f", got {kind:.40}" if isinstance(kind, str) else ""
        example = f"; as in {EVIDENCE}" if "evidence" in str(error) else ""
        expected = "expected a decision (pose, reject, confirm, augment)"
        raise Misuse(f"{expected}{got}: {ev.decode_error(error)}{example}") from None


class RobotHandle:
    """What a mapper gets of a robot: see `Robot`."""

    __slots__ = ("_percept", "declare", "move")

    def __init__(self, robot: SimulatedRobot) -> None:
        # no further layer: moves are many
        self.move, self.declare = robot.move, robot.declare
        self._percept = robot.sense

    @property
    def percept(self) -> Percept:
        """The percept where the robot stands."""
        return self._percept()

    def __repr__(self) -> str:
        return f"<Robot at {self.percept}>"


class SimulatedRobot:
    """A robot at the marker of a world. Lives for one run; `events` grows with every call.

    Args:
        budget: the most moves.
        objection: says why a decision ends the run, or nothing; called with its event number.
    Raises (from `move` and `declare`, into the mapper):
        MapperStopped: a decision to which there is an objection.
        BudgetExceeded: one more move than the budget.
        Misuse: no such door, or no decision. Once stopped the robot never moves again.
    """

    __slots__ = (
        *("_at", "_cost", "_objection", "_percept", "_percepts", "_stopped", "_world"),
        *("budget", "events"),
    )

    def __init__(
        self,
        world: World,
        budget: int,
        objection: Callable[[int, ev.Decision], str] | None = None,
    ) -> None:
        self._world = world
        self._objection = objection
        self.budget = budget
        self._cost = 0
        self._at = world.root or 0
        self._percepts = percepts(world)
        self._percept = first_percept(world)
        self._stopped: MapperStopped | None = None
        self.events: list[ev.Event] = []

    @property
    def handle(self) -> RobotHandle:
        """What a mapper is given."""
        return RobotHandle(self)

    @property
    def percept(self) -> Percept:
        """The percept where the robot stands."""
        return self._percept

    @property
    def darts(self) -> int:
        """The number of darts of the world; not for mappers."""
        return len(self._world.alpha)

    def sense(self) -> Percept:
        """The percept where the robot stands."""
        return self._percept

    @property
    def cost(self) -> int:
        """Edge traversals so far."""
        return self._cost

    @property
    def stopped(self) -> MapperStopped | None:
        """Why the robot was stopped, or None; also if the mapper swallowed the exception."""
        return self._stopped

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:
        """Leave by a door and return the percept behind it: see `Robot.move`."""
        if self._stopped is not None or self._cost >= self.budget:
            self._stop(BudgetExceeded(self.budget))
        try:
            number = door_number(door, self._percept.degree)
            require_purpose(purpose)
        except Misuse as why:
            self._stop(why)
        self._at = at = self._world.alpha[exit_dart(self._world, self._at, number)]
        self._cost += 1
        self._percept = percept = self._percepts[at]
        self.events.append(shared_move(number, percept, purpose))
        return percept

    def declare(self, event: ev.Decision | Mapping[str, object]) -> None:
        """Put a decision on record: see `plain_decision`."""
        if self._stopped is not None:
            raise self._stopped
        try:
            decision = plain_decision(event)
        except Misuse as why:
            self._stop(why)
        self.events.append(decision)
        if self._objection is not None and (false := self._objection(len(self.events), decision)):
            self._stop(MapperStopped(false))

    def settle(self) -> None:
        """Uncount a move that a time limit struck between its count and its record.

        The trace must not look forged.
        """
        recorded = sum(isinstance(event, ev.Move) for event in self.events)
        if self._cost == recorded + 1:
            self._cost = recorded

    def _stop(self, why: MapperStopped) -> NoReturn:
        self._stopped = self._stopped or why
        raise self._stopped
