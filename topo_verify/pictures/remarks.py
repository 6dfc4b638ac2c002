"""What the replay adds to an event: what speaks against a decision.

w1:4          a dart of the world and its vertex: vertex 1, dart 4 of the world file
v2:7          a dart of S and its vertex: the third vertex that was discovered, dart 7
5, marker 2   a percept: degree 5, the marker at door 2
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

from topo_verify.checkers.darts import KnownDart, WorldDart
from topo_verify.checkers.excursions import Excursion, Word
from topo_verify.pictures.detours import Turn, way_home
from topo_verify.pictures.scenes import Mismatch, Moment, Playback
from topo_verify.robot import events as ev
from topo_verify.robot.event_words import door_words, listed, percept_in_brackets
from topo_verify.robot.percept import Door, Percept


def remarks(playback: Playback, moment: Moment, turn: Turn | None = None) -> Iterator[str]:
    """What speaks against a decision that the mapper did not say.

    Args:
        turn: of a move, if its door is not counted from the dart by which the robot came.
    """
    if playback.replayed.spoiled == moment.number:
        yield "from here on the mapper's map is false; places are named by what was true of it"
    match moment.event:
        case ev.Pose() if playback.replayed.spoiled is None or moment.number < (
            playback.replayed.spoiled
        ):
            yield from _about_pose(playback, moment, moment.event)
        case ev.Reject() if moment.mismatch is not None:
            mismatch, leaves = moment.mismatch, moment.mismatch.leaves
            if leaves is not None and mismatch.evidence.record is None:
                yield _leaving(playback, moment.number, mismatch, leaves)
        case ev.Confirm():
            yield from _about_confirm(playback, moment)
        case ev.Move() if turn is not None:
            yield _turned(playback, moment.event, playback.moments[moment.number - 1], turn)
        case _:
            pass


def _leaving(playback: Playback, number: int, mismatch: Mismatch, leaves: KnownDart) -> str:
    start = map_place(playback, mismatch.traced[0])
    words = (
        f"from {start}, {door_words(mismatch.doors)} would leave S by {map_place(playback, leaves)}"
    )
    home = door_words(way_home(playback, mismatch.traced[0], number))
    return f"{words}, which is unexplored; the way home from {start} is by {home}"


class Homeward(NamedTuple):
    """The walk behind an edge beside S, as if the confirmed hypothesis were true.

    Attributes:
        start: the hypothesis, the dart by which the robot would have come in.
        took: the doors that the robot took, also if it has gone back since.
        step: the doors before the first place that differs; all doors if no place differs.
        expected, seen: the percept on S there, and the one sensed.
        arrived: the doors lead to v0 on S.
        home: the doors of a shortest way there.
    """

    start: KnownDart
    took: tuple[Door, ...]
    step: int
    expected: Percept
    seen: Percept
    arrived: bool
    home: tuple[Door, ...]

    @property
    def proves(self) -> bool:
        """Did the walk lead to the marker, and did each place on it look as on S?"""
        return self.arrived and self.expected == self.seen


def homeward(playback: Playback, moment: Moment) -> Homeward | None:
    """The walk on which a confirmation by motion rests; None if it cannot be judged.

    From the start of a way to v0 back, S and the marker fix each dart of it. So if each percept is
    as on S, the hypothesis is true.
    """
    event, chart, number = moment.event, playback.map, moment.number
    spoiled = playback.replayed.spoiled
    if not isinstance(event, ev.Confirm) or event.rule != "motion" or moment.edge != event.edge:
        return None
    if not chart.is_open(event.edge, number) or not chart.is_open(event.hypothesis, number):
        return None
    if moment.position is None or (spoiled is not None and spoiled < number):
        return None
    posed = next(m for m in playback.moments[number::-1] if isinstance(m.event, ev.Pose))
    if posed.position != chart.end(event.edge):
        return None
    word = moment.word or _taken_back(playback, posed.number, number)
    took = tuple(step.door for step in word)
    percepts = chart.seen_at(chart.end(event.edge)), *(step.percept for step in word)
    at, step = event.hypothesis, 0
    for step, door in enumerate((*took, 0)):
        out = chart.turn(at, door)
        if percepts[step] != chart.seen_at(chart.phi[at]) or step == len(took):
            break
        if chart.is_open(out, number):
            break
        at = chart.alpha[out]
    arrived = step == len(took) and playback.vertex(at) == 0
    home = way_home(playback, event.hypothesis, number)
    expected = chart.seen_at(chart.phi[at])
    return Homeward(event.hypothesis, took, step, expected, percepts[step], arrived, home)


def _taken_back(playback: Playback, posed: int, number: int) -> Word:
    """The longest walk between the last decision before event `number` and that event."""
    behind, seen_at = Excursion(), playback.map.seen_at
    longest: Word = ()
    for before, moment in pairwise(playback.moments[posed:number]):
        if isinstance(moment.event, ev.Move):
            assert before.position is not None
            assert moment.position is not None
            behind.move(
                moment.event.door, seen_at(before.position).degree, seen_at(moment.position)
            )
            longest = max(longest, tuple(behind.word), key=len)
        else:
            longest = ()
    return longest


def _about_confirm(playback: Playback, moment: Moment) -> Iterator[str]:
    way = homeward(playback, moment)
    if way is None or way.proves:
        return
    start = map_place(playback, way.start)
    if way.expected == way.seen:
        took = door_words(way.took)
        yield f"the way home from {start} is by {door_words(way.home)}; the robot took {took}"
        return
    at = f"behind {door_words(way.took[: way.step])} from {start}" if way.step else f"at {start}"
    words = f"{at} the robot would see {percept_in_brackets(way.expected)}"
    yield f"{words}; it saw {percept_in_brackets(way.seen)}"
    if not way.home:
        yield f"{start} is at v0: the way home has no door, so this percept decides"


def _turned(playback: Playback, move: ev.Move, before: Moment, turn: Turn) -> str:
    now = either_place(playback, before.known, before.position)
    came = either_place(playback, playback.known(turn.entry, before.number), turn.entry)
    words = f"turned: it came here by {came} and back by {now}"
    return f"{words}, so door {move.door} is door {turn.door} counted from {came}"


def _about_pose(playback: Playback, moment: Moment, pose: ev.Pose) -> Iterator[str]:
    edge, chart, number = pose.edge, playback.map, moment.number
    if not chart.is_open(edge, number) or moment.position is None:
        return
    crossed = playback.replayed.crossings.get(playback.replayed.crossing(chart.end(edge)), number)
    is_late = crossed < number and moment.position != chart.end(edge)
    look = chart.seen_at(chart.end(edge) if is_late else moment.position).signature
    alike = [
        dart
        for dart in sorted(chart.phi)
        if chart.is_open(dart, number) and chart.seen_at(chart.phi[dart]).signature == look
    ]
    left_out = [dart for dart in alike if dart not in (edge, *pose.hypotheses)]
    here = [dart for dart in left_out if playback.vertex(dart) == playback.vertex(edge)]
    for darts, at in (
        (here, f"the vertex that edge {edge} leaves"),
        (
            [dart for dart in left_out if dart not in here],
            f"places that look like {'the one there' if is_late else 'this one'}",
        ),
    ):
        if darts:
            yield f"it leaves out {listed(darts)}, unexplored too, at {at}"
    if is_late:
        yield f"it asks late: it crossed edge {edge} at event {crossed}, and has moved on since"
    last = next(
        (m for m in reversed(playback.moments[: moment.number]) if isinstance(m.event, ev.Move)),
        None,
    )
    phi = playback.map.phi[edge]
    if last is None or last.left_by == phi:
        return
    assert isinstance(last.event, ev.Move)
    before = playback.moments[last.number - 1]
    exit_place = either_place(playback, last.through, last.left_by)
    words = f"door {last.event.door} at event {last.number} led out by {exit_place}"
    wanted = map_place(playback, edge)
    place = playback.world.vertex_of
    if before.position is not None and place[before.position] == place[phi]:
        door = playback.door(before.position, phi)
        yield f"{words}; edge {edge} ({wanted}) was behind door {door} there"
    else:
        yield f"{words}; edge {edge} ({wanted}) is at another vertex"


# ---------------------------------------------------------------- names of darts


def world_place(playback: Playback, dart: WorldDart | None) -> str:
    """A dart of the world with its vertex; `?` where it is unknown."""
    if dart is None:
        return "?"
    return f"w{playback.world.vertex_of[dart]}:{dart}" if playback.world.alpha else "w0"


def map_place(playback: Playback, dart: KnownDart | None) -> str:
    """A dart of S with its vertex; `-` where S does not have the place."""
    return "-" if dart is None else f"v{playback.vertex(dart)}:{dart}"


def either_place(playback: Playback, known: KnownDart | None, dart: WorldDart | None) -> str:
    """A dart on S where S has it, else in the world."""
    return world_place(playback, dart) if known is None else map_place(playback, known)
