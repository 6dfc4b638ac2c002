"""Advice for a robot whose log does not prove its map yet: where to go on, and the way back.

The nearest open door is bad advice: behind it lie new open doors, and only the marker shows that
two places are one. So the mapper `homing` explores **in thought**: the fold of the log answers
its moves. The robot goes to the first door that the fold does not know, and asks again.

This ends, since the mapper makes finitely many moves, and the fold answers one more each time.
What this does not show: that no shorter walk proves the map.
"""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from topo_verify.checkers.folding import Fold
from topo_verify.errors import InternalError
from topo_verify.robot.events import Decision
from topo_verify.robot.percept import Door, Percept, Purpose

ADVISER = "homing"

MOST_THOUGHTS = 20_000
"""A log of a million random moves would take hours."""


class Advice(msgspec.Struct, frozen=True):
    """How to go on from where a log ends.

    Attributes:
        walk: the doors to take; the last one was never crossed.
        home: the doors of the shortest known way back to the marker.
    """

    walk: tuple[Door, ...]
    home: tuple[Door, ...]


def advice(fold: Fold) -> Advice:
    """The advice for the fold of an incomplete log.

    After `MOST_THOUGHTS` moves the walk is empty: go home, and ask again there.
    """
    from topo_verify.algorithms import NAMED  # not needed to judge a log

    home, _ = way_to(fold, fold.find((0, 0))[0])
    try:
        NAMED[ADVISER](_Remembered(fold))
    except _UnknownDoor as unknown:
        walk, entry = way_to(fold, unknown.node)
        door = (unknown.dart - entry) % fold.degree(unknown.node)
        return Advice((*walk, door), home)
    except _EnoughThought:
        return Advice((), home)
    raise InternalError(f"{ADVISER} delivers a map, and its history has an open dart")


class _UnknownDoor(Exception):
    def __init__(self, node: int, dart: int) -> None:
        self.node, self.dart = node, dart


class _EnoughThought(Exception):
    pass


class _Remembered:
    """A robot in the fold of a log."""

    def __init__(self, fold: Fold) -> None:
        self._fold = fold
        self._home = self._at = fold.find((0, 0))
        self._moves = 0

    @property
    def percept(self) -> Percept:
        (node, reference), (home, marked) = self._at, self._home
        degree = self._fold.degree(node)
        return Percept(degree, (marked - reference) % degree if node == home and degree else None)

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:  # noqa: ARG002  a Robot has it
        if self._moves == MOST_THOUGHTS:
            raise _EnoughThought
        self._moves += 1
        node, reference = self._at
        end = self._fold.partner((node, reference + door))
        if end is None:
            raise _UnknownDoor(node, (reference + door) % self._fold.degree(node))
        self._at = end
        return self.percept

    def declare(self, event: Decision) -> None:
        pass


# ---------------------------------------------------------------- ways in a fold


def way_to(fold: Fold, place: int) -> tuple[tuple[Door, ...], int]:
    """The doors of a shortest way from the log's end to a node; the dart of arrival."""
    return next((doors_of(walk), entry) for node, entry, walk in places_from(fold) if node == place)


_Walk = tuple["_Walk", Door] | None
"""A linked list, last door first."""


def places_from(fold: Fold) -> Iterator[tuple[int, int, _Walk]]:
    """Each place by its distance from the log's end: a node, the dart of arrival, the way."""
    start, reference = fold.find(fold.at)
    reached = {start}
    queue: list[tuple[int, int, _Walk]] = [(start, reference, None)]
    for node, entry, walk in queue:  # grows as it goes
        yield node, entry, walk
        degree = fold.degree(node)
        for door in range(degree):
            end = fold.partner((node, (entry + door) % degree))
            if end is not None and end[0] not in reached:
                reached.add(end[0])
                queue.append((*end, (walk, door)))


def doors_of(walk: _Walk) -> tuple[Door, ...]:
    """The doors of a way, the first one first."""
    doors: list[Door] = []
    while walk is not None:
        walk, door = walk
        doors.append(door)
    return tuple(reversed(doors))
