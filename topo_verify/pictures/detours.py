"""What several moves show together: turns, ways home, circles, tests. None of it is a judgement."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from topo_verify.checkers.darts import KnownDart, WorldDart
from topo_verify.checkers.excursions import Excursion
from topo_verify.pictures.scenes import Moment, Playback
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Door


class Turn(NamedTuple):
    """The robot leaves a place by another dart than it came by, from which its doors count.

    Attributes:
        entry: the dart of the world by which it first came.
        stands: its reference dart now.
        door: the door that it takes, counted from `entry`.
    """

    entry: WorldDart
    stands: WorldDart
    door: Door


class Circle(NamedTuple):
    """Moves that repeat to the end of the run.

    Attributes:
        first, last: the events of the first and the last move of the first round.
        period: the moves of a round.
        moves: the moves from `first` on.
    """

    first: int
    last: int
    period: int
    moves: int

    def __str__(self) -> str:
        times = f"{self.moves // self.period:,} times in all"
        return f"events {self.first} to {self.last} repeat to the end of the run, {times}"


def turns(playback: Playback) -> dict[int, Turn]:
    """By event, the moves whose door does not count from the entry dart, except retracing ones."""
    turned: dict[int, Turn] = {}
    positions = playback.replayed.positions
    entries = [positions[0]]
    at_pose = 1
    for moment in playback.moments[1 : len(positions)]:
        number, out = moment.number, moment.left_by
        if isinstance(moment.event, ev.Augment) and _sees_marker(playback, positions[number]):
            entries = [positions[number]]  # the marker shows its reference dart
        if isinstance(moment.event, ev.Pose):
            at_pose = len(entries)
        if out is None:
            continue
        stands, entry = positions[number - 1], entries[-1]
        back = out == entry and len(entries) > 1
        if stands != entry and not (back and len(entries) > at_pose):
            turned[number] = Turn(entry, stands, playback.door(entry, out))
        if back:
            entries.pop()
        else:
            entries.append(positions[number])
    return turned


def _sees_marker(playback: Playback, dart: WorldDart) -> bool:
    return playback.map.seen_at(dart).marker is not None


def circle(playback: Playback) -> Circle | None:
    """The circle in which the robot walks at the end of a run without a map, or None.

    It is the longest end of the run, at least a third, in which places and doors repeat at least
    twice. Linear: the longest border of the reversed run gives the period.
    """
    if isinstance(playback.trace[-1], ev.Finish) or playback.replayed.illegal is not None:
        return None
    moves = [moment for moment in playback.moments if isinstance(moment.event, ev.Move)]
    steps = [(moment.left_by, moment.position) for moment in reversed(moves)]
    best = period = 0
    border = [0] * len(steps)
    for place in range(1, len(steps)):
        k = border[place - 1]
        while k and steps[k] != steps[place]:
            k = border[k - 1]
        border[place] = k + (steps[k] == steps[place])
        if 2 * (place + 1 - border[place]) <= place + 1:
            best, period = place + 1, place + 1 - border[place]
    if 3 * best < len(steps) or not best:
        return None
    start = len(moves) - best
    return Circle(moves[start].number, moves[start + period - 1].number, period, best)


def way_home(playback: Playback, dart: KnownDart, number: int) -> tuple[Door, ...]:
    """The doors of a shortest way on S, before this event, from a dart to v0."""
    came: dict[int, KnownDart | None] = {0: None}
    for vertex in (queue := [0]):
        for a in playback.darts(vertex):
            if playback.map.joined[a] < number:
                far = playback.map.alpha[a]
                if playback.vertex(far) not in came:
                    came[playback.vertex(far)] = far
                    queue.append(playback.vertex(far))
    doors: list[Door] = []
    at = dart
    while (out := came[playback.vertex(at)]) is not None:
        doors.append(playback.door(playback.map.phi[at], playback.map.phi[out]))
        at = playback.map.alpha[out]
    return tuple(doors)


class SupposedWalk:
    """Where the robot would be on S if the guess that it tests were true."""

    def __init__(self, playback: Playback) -> None:
        self._playback, self._map = playback, playback.map
        self._behind = Excursion()
        self._trail: list[KnownDart | None] = []
        self._last: tuple[KnownDart | None, int] = None, 0

    def place(self, moment: Moment, guess: int | None) -> KnownDart | None:
        """The reference dart on S; None where S does not say, or no guess is tested."""
        number, position, seen_at = moment.number, moment.position, self._map.seen_at
        if isinstance(moment.event, ev.Pose):
            edge = moment.event.edge
            is_open = self._map.is_open(edge, number)
            is_behind = is_open and position == self._map.end(KnownDart(edge))
            self._behind = Excursion(is_late=not is_behind)
        elif isinstance(moment.event, ev.Move) and position is not None:
            before = self._playback.replayed.positions[number - 1]
            self._behind.move(moment.event.door, seen_at(before).degree, seen_at(position))
        if guess is None or position is None or not self._map.is_open(guess, number):
            return None
        return self._traced(guess, number)

    def _traced(self, guess: KnownDart, number: int) -> KnownDart | None:
        word = self._behind.word
        if self._last != (guess, number - 1):
            self._trail = [guess]
        self._last = guess, number
        del self._trail[len(word) + 1 :]
        for step in word[len(self._trail) - 1 :]:
            at = self._trail[-1]
            out = None if at is None else self._map.turn(at, step.door)
            if out is not None:
                out = None if self._map.is_open(out, number) else self._map.alpha[out]
            self._trail.append(out)
        return self._trail[-1]


def tested_guesses(moments: Sequence[Moment]) -> dict[int, int]:
    """By validating move, the hypothesis that it tests: that of the next decision by motion."""
    tested: dict[int, int] = {}
    goal = None
    for moment in reversed(moments):
        event = moment.event
        if isinstance(event, ev.Pose | ev.Augment):
            goal = None
        elif isinstance(event, ev.Reject | ev.Confirm):
            goal = event.hypothesis if event.rule == "motion" else goal
        elif isinstance(event, ev.Move) and event.purpose == "validate" and goal is not None:
            tested[moment.number] = goal
    return tested
