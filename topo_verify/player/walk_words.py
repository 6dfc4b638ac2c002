"""An event of a run in words: what a move met, what a mapper decided and why.

    w1:4    a dart of the world and its vertex: vertex 1, dart 4, as the world file numbers them
    v2:7    a dart of S and its vertex: the third vertex that was discovered, dart 7

Percepts are short here: `5` is degree 5 with no marker, `5, marker 2` has the marker at door 2.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import assert_never

from topo_verify.checkers.darts import KnownDart, WorldDart
from topo_verify.player.detours import Turn, way_home
from topo_verify.player.scenes import Mismatch, Moment, Playback
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Door, Percept
from topo_verify.text import plural


def percept_words(percept: Percept | None) -> str:
    """A percept: its degree, and the door of the marker where the marker is."""
    if percept is None:
        return "nothing"
    marker = "" if percept.marker is None else f", marker {percept.marker}"
    return f"{percept.degree}{marker}"


def _told(percept: Percept | None) -> str:
    return "nothing" if percept is None else f"({percept_words(percept)})"


def world_place(playback: Playback, dart: WorldDart | None) -> str:
    """A dart of the world with its vertex; `?` where nobody knows it."""
    if dart is None:
        return "?"
    return f"w{playback.world.vertex_of[dart]}:{dart}" if playback.world.alpha else "w0"


def map_place(playback: Playback, dart: KnownDart | None) -> str:
    """A dart of S with its vertex; `-` where S does not have the place."""
    return "-" if dart is None else f"v{playback.vertex(dart)}:{dart}"


def either_place(playback: Playback, known: KnownDart | None, dart: WorldDart | None) -> str:
    """A dart on S where S has it, else in the world."""
    return world_place(playback, dart) if known is None else map_place(playback, known)


def listed(things: Iterable[object], none: str = "none") -> str:
    """The things with commas; a long list is cut."""
    texts = [str(thing) for thing in things]
    if len(texts) > _MOST:
        texts = [*texts[:_MOST], f"and {len(texts) - _MOST} more"]
    return ", ".join(texts) or none


_MOST = 12


def decision_words(playback: Playback, moment: Moment) -> str:
    """What an event other than a move says, in one sentence."""
    match moment.event:
        case ev.Pose(edge, hypotheses):
            to = f"to {listed(hypotheses)} or" if hypotheses else "no hypothesis, so"
            words = f"asks where edge {edge} leads: {to} to a new vertex"
        case ev.Reject():
            words = _rejects(playback, moment.number, moment.event, moment.mismatch)
        case ev.Confirm(edge, hypothesis, rule):
            words = f"confirms that edge {edge} leads to {hypothesis} (by {rule})"
        case ev.Augment(edge, "loop", dart):
            words = f"S grows: edge {edge} leads to {dart}"
        case ev.Augment(edge, _, dart, degree):
            darts = f"dart {dart}" if degree == 1 else f"darts {dart} to {dart + degree - 1}"
            words = f"S grows: edge {edge} leads to a new vertex, {darts}"
        case ev.Finish(cost, delivered):
            size = plural(len(delivered.vertices), "vertex", "vertices")
            told = "" if cost is None else f", and a cost of {cost}"
            words = f"delivers a map of {size} and {plural(len(delivered.edges), 'edge')}{told}"
        case ev.Start() | ev.Move():
            words = f"sees {_told(moment.event.percept)}"
        case _:
            assert_never(moment.event)
    return words


def _rejects(playback: Playback, number: int, event: ev.Reject, found: Mismatch | None) -> str:
    """A rejection with its evidence, and where that lies."""
    cited = event.evidence
    words = f"rejects that edge {event.edge} leads to {event.hypothesis} (by {event.rule}): "
    if cited.contradiction is not None:
        return f"{words}{cited.contradiction}"
    told = f"expects {_told(cited.expected)}, saw {_told(cited.observed)}"
    if found is None:
        spoiled = playback.replayed.spoiled
        why = "cannot be found in the walk"
        if spoiled is not None and spoiled < number:
            why = f"is not looked for: the mapper's map is false since event {spoiled}"
        return f"{words}{told} at step {cited.step}, which {why}"
    behind = f"behind {_doors(found)} from {map_place(playback, found.traced[0])}"
    behind = behind if found.doors else "behind the edge"
    of = "" if found.sequence is None else f" (sequence {found.sequence})"
    at = world_place(playback, found.trail[-1])
    return f"{words}{behind}{of} it {told} at {at}"


def _doors(found: Mismatch) -> str:
    return _door_words(found.doors)


def _door_words(doors: Sequence[Door]) -> str:
    if not doors:
        return "no door"
    return f"door{'s' if len(doors) > 1 else ''} {' '.join(map(str, doors))}"


def remarks(playback: Playback, moment: Moment, turn: Turn | None = None) -> Iterator[str]:
    """What the replay adds that the mapper did not say.

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
            found, leaves = moment.mismatch, moment.mismatch.leaves
            if leaves is not None and found.evidence.record is None:
                yield _leaving(playback, moment.number, found, leaves)
        case ev.Confirm(edge, hypothesis, "motion"):
            yield from _about_confirm(playback, moment, edge, hypothesis)
        case ev.Move() if turn is not None:
            yield _turned(playback, moment.event, playback.moments[moment.number - 1], turn)
        case _:
            pass


def _leaving(playback: Playback, number: int, found: Mismatch, leaves: KnownDart) -> str:
    """That the doors of a rejection lead out of S, where S expects nothing; and which lead home."""
    start = map_place(playback, found.traced[0])
    words = f"from {start}, {_doors(found)} would leave S by {map_place(playback, leaves)}"
    home = _door_words(way_home(playback, found.traced[0], number))
    return f"{words}, which is unexplored; the way home from {start} is by {home}"


def _about_confirm(playback: Playback, moment: Moment, edge: int, h: int) -> Iterator[str]:
    """What the walk home shows that speaks against a confirmation, or that it was not walked."""
    drawn, number = playback.map, moment.number
    if not drawn.is_open(edge, number) or not drawn.is_open(h, number):
        return
    doors = tuple(step.door for step in moment.word)
    seen = drawn.seen_at(drawn.end(edge)), *(step.percept for step in moment.word)
    start, at = map_place(playback, h), h
    for step, percept in enumerate(seen):
        expected = drawn.seen_at(drawn.phi[at])
        if percept != expected:
            behind = f", behind {_door_words(doors[:step])}" if step else ""
            words = f"who comes in by {start} sees {_told(expected)}{behind}"
            yield f"{words}; the robot saw {_told(percept)}"
            if not way_home(playback, h, number):
                yield f"{start} is at v0: the way home has no door, so this percept decides"
            return
        out = drawn.turn(at, doors[step]) if step < len(doors) else at
        if step < len(doors) and drawn.is_open(out, number):
            break
        at = drawn.alpha[out] if step < len(doors) else at
    home = way_home(playback, h, number)
    if doors != home:
        took = _door_words(doors)
        yield f"the way home from {start} is by {_door_words(home)}; the robot took {took}"


def _turned(playback: Playback, move: ev.Move, before: Moment, turn: Turn) -> str:
    """That the reference dart is not the dart by which the robot came to the place."""
    now = either_place(playback, before.known, before.position)
    came = either_place(playback, playback.known(turn.entry, before.number), turn.entry)
    words = f"turned: it came here by {came} and back by {now}"
    return f"{words}, so door {move.door} is door {turn.door} counted from {came}"


def _about_pose(playback: Playback, moment: Moment, pose: ev.Pose) -> Iterator[str]:
    """Which darts it leaves out; when it crossed the edge, or by which dart it came instead."""
    edge, drawn, number = pose.edge, playback.map, moment.number
    if not drawn.is_open(edge, number) or moment.position is None:
        return
    crossed = playback.replayed.crossings.get(playback.replayed.crossing(drawn.end(edge)), number)
    is_late = crossed < number and moment.position != drawn.end(edge)
    look = drawn.seen_at(drawn.end(edge) if is_late else moment.position).signature
    alike = [
        dart
        for dart in sorted(drawn.phi)
        if drawn.is_open(dart, number) and drawn.seen_at(drawn.phi[dart]).signature == look
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
        yield f"it crossed edge {edge} at event {crossed}, and is elsewhere now"
    last = next(
        (m for m in reversed(playback.moments[: moment.number]) if isinstance(m.event, ev.Move)),
        None,
    )
    phi = playback.map.phi[edge]
    if last is None or last.left_by == phi:
        return
    assert isinstance(last.event, ev.Move)
    before = playback.moments[last.number - 1]
    left = either_place(playback, last.through, last.left_by)
    words = f"door {last.event.door} at event {last.number} led out by {left}"
    wanted = map_place(playback, edge)
    if before.position is not None and _same_vertex(playback, before.position, phi):
        door = playback.door(before.position, phi)
        yield f"{words}; edge {edge} ({wanted}) was behind door {door} there"
    else:
        yield f"{words}; edge {edge} ({wanted}) is at another vertex"


def _same_vertex(playback: Playback, one: WorldDart, other: WorldDart) -> bool:
    return playback.world.vertex_of[one] == playback.world.vertex_of[other]
