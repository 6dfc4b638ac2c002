"""The robot in a simulated world: hides the world, meters the cost, records what happens.

Trusted. A mapper holds a `SimulatedRobot` and can ask it for nothing but `percept`, `move` and
`declare`. (Python hides nothing from a mapper that is determined to look: the claims are about
mappers that play by the rules, and programs that run behind a pipe cannot do otherwise.)

Source: docs/semantics.md, section 2.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache
from operator import index
from typing import NoReturn

import msgspec

from topo_verify.robot import trace_store
from topo_verify.robot.events import Decision, Event
from topo_verify.robot.limits import BudgetExceeded, MapperStopped
from topo_verify.robot.percept import PURPOSES, Door, Percept, Purpose
from topo_verify.world.rooted_map import Dart, World

_plain = msgspec.msgpack.Encoder(enc_hook=index)
_decision: msgspec.msgpack.Decoder[Decision] = msgspec.msgpack.Decoder(Decision)


class Misuse(MapperStopped):
    """The mapper asked for what a robot cannot do: a door that is not there, a malformed event."""


@lru_cache(maxsize=64)
def percepts(world: World) -> tuple[Percept, ...]:
    """The percept with each dart as the reference dart: sigma^marker(dart) = root."""
    row = [Percept(world.degrees[vertex], None) for vertex in world.vertex_of]
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
    """The dart that a door means to a robot with this reference dart: sigma^door(dart)."""
    rotation = world.vertices[world.vertex_of[dart]]
    return rotation[(world.place_of[dart] + door) % len(rotation)]


class SimulatedRobot:
    """A robot at the marker of a world. Lives for one run; `trace` grows with every call.

    Args:
        world: where the robot is; never shown to the mapper.
        budget: how many moves (edge traversals) are allowed.
    Raises (from `move` and `declare`, into the mapper):
        BudgetExceeded: one more move than the budget.
        Misuse: no such door, or no decision. Once stopped the robot never moves again.
    """

    __slots__ = ("_at", "_budget", "_cost", "_percept", "_percepts", "_stopped", "_world", "events")

    def __init__(self, world: World, budget: int) -> None:
        self._world = world
        self._budget = budget
        self._cost = 0
        self._at = world.root or 0
        self._percepts = percepts(world)
        self._percept = first_percept(world)
        self._stopped: MapperStopped | None = None
        self.events: list[Event] = []

    @property
    def percept(self) -> Percept:
        """The percept where the robot stands now."""
        return self._percept

    @property
    def cost(self) -> int:
        """Edge traversals so far."""
        return self._cost

    @property
    def stopped(self) -> MapperStopped | None:
        """Why the robot was stopped, or None; also where the mapper swallowed the exception."""
        return self._stopped

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:
        """Leave by a door and return the percept behind it. Costs 1. See `Robot.move`."""
        if self._stopped is not None or self._cost >= self._budget:
            self._stop(BudgetExceeded(f"the mapper asked for more than {self._budget} moves"))
        try:
            number = -1 if isinstance(door, bool) else index(door)
        except TypeError:
            number = -1
        if not 0 <= number < self._percept.degree:
            doors = self._percept.degree
            self._stop(Misuse(f"the mapper asked for door {door!r} at a vertex with {doors} doors"))
        if purpose is not None and purpose not in PURPOSES:
            self._stop(Misuse(f"expected a purpose of {', '.join(PURPOSES)}, got {purpose!r}"))
        self._at = self._world.alpha[exit_dart(self._world, self._at, number)]
        self._cost += 1
        self._percept = self._percepts[self._at]
        self.events.append(trace_store.move(number, self._percept, purpose))
        return self._percept

    def declare(self, event: Decision | Mapping[str, object]) -> None:
        """Put a decision on record: a `Pose`, `Reject`, `Confirm` or `Augment`, or its JSON."""
        if self._stopped is not None:
            raise self._stopped
        try:
            # Through plain data and back: a struct may have been built with anything inside.
            decision = _decision.decode(_plain.encode(event))
        except (msgspec.MsgspecError, TypeError, OverflowError) as error:
            self._stop(Misuse(f"expected a decision (pose, reject, confirm, augment): {error}"))
        self.events.append(decision)

    def _stop(self, why: MapperStopped) -> NoReturn:
        self._stopped = self._stopped or why
        raise self._stopped
