"""S with the truth in brackets, the doors of a place, the circle in which a robot walks: as lines.

S is listed vertex by vertex, the darts of each clockwise, and in brackets what is so in the world:

    0-1        dart 0 is explored, its other end is dart 1; so it is in the world
    2-?[4]     dart 2 is unexplored, and leads to dart 4
    2-?[w3:9]  dart 2 is unexplored, and leads to a place that S does not have: vertex 3, dart 9
    2-6![4]    S is false: it has dart 2 lead to dart 6, and it leads to dart 4
"""

from __future__ import annotations

from collections.abc import Iterator

from topo_verify.checkers.darts import KnownDart, WorldDart
from topo_verify.errors import InputError
from topo_verify.player.names import either_place, listed, map_place, world_place
from topo_verify.player.scenes import DeclaredMap, Moment, Playback
from topo_verify.robot import events as ev
from topo_verify.text import plural
from topo_verify.world.rooted_map import World

MOST_VERTICES = 12
"""Of a larger S only the vertices are listed that the moment is about."""

MOST_DARTS = 40
"""So many darts of a vertex are listed."""


def known_map(playback: Playback, moment: Moment) -> Iterator[str]:
    """S after an event, as it is declared, with the truth in brackets: a line a vertex."""
    declared = playback.map_at(moment.number)
    other = {a: b for edge in declared.edges for a, b in (edge, edge[::-1])}
    chosen = _chosen(declared, moment)
    for number in chosen:
        first, degree = declared.vertices[number]
        darts = range(first, first + min(degree, MOST_DARTS))
        ends = [_end(playback, dart, other.get(dart), moment.number) for dart in darts]
        at = playback.map.phi.get(KnownDart(first)) if _is_true(playback, first, moment) else None
        name = "no such vertex" if at is None else world_place(playback, at).partition(":")[0]
        more = " …" if degree > MOST_DARTS else ""
        yield f"v{number} ({name}): {'  '.join(ends) or 'no dart'}{more}"
    if left := len(declared.vertices) - len(chosen):
        yield f"and {plural(left, 'vertex', 'vertices')} more"


def _is_true(playback: Playback, dart: int, moment: Moment) -> bool:
    return playback.map.born.get(KnownDart(dart), moment.number + 1) <= moment.number


def _end(playback: Playback, dart: int, says: int | None, number: int) -> str:
    """A dart of S: its other end as S has it, and in brackets what is so where that differs."""
    words = f"{dart}-{'?' if says is None else says}"
    if playback.map.born.get(KnownDart(dart), number + 1) > number:
        return words
    leads = playback.map.end(KnownDart(dart))
    known = playback.known(leads, number)
    true = world_place(playback, leads) if known is None else str(known)
    if says is None:
        return f"{words}[{true}]"
    return words if str(says) == true else f"{words}![{true}]"


def _chosen(declared: DeclaredMap, moment: Moment) -> list[int]:
    """The vertices of S to list: all of a small one, else those that the moment is about."""
    everything = [*range(len(declared.vertices))]
    if len(everything) <= MOST_VERTICES:
        return everything
    event = moment.event
    about = {moment.edge, moment.known, *moment.hypotheses[:MOST_VERTICES]}
    if isinstance(event, ev.Reject | ev.Confirm):
        about.add(event.hypothesis)
    if isinstance(event, ev.Augment):
        about |= {event.edge, event.dart}
    return [v for v in everything if _has(declared.vertices[v], about)]


def _has(vertex: tuple[int, int], darts: set[int | None]) -> bool:
    first, degree = vertex
    return any(dart is not None and first <= dart < first + degree for dart in darts)


# ---------------------------------------------------------------- a place and its doors


def doors_of(playback: Playback, number: int) -> Iterator[str]:
    """The vertex where the robot stands after an event, and where each of its doors leads."""
    stands = playback.replayed.positions[number]
    degree = playback.map.seen_at(stands).degree
    known = playback.known(stands, number)
    at = world_place(playback, stands)
    at = at if known is None else f"{map_place(playback, known)} ({at})"
    yield f"The robot stands at {at}, a vertex with {plural(degree, 'door')}:"
    for door in range(min(degree, MOST_DARTS)):
        far = playback.map.beyond(stands, door)
        back = "back, " if door == 0 and number else ""
        yield f"  door {door}: {back}to {_named(playback, far, number)}"
    if degree > MOST_DARTS:
        yield f"  and {degree - MOST_DARTS} more"


def _named(playback: Playback, dart: WorldDart, number: int) -> str:
    known = playback.known(dart, number)
    there = world_place(playback, dart)
    return f"{there}, not on S" if known is None else f"{map_place(playback, known)} ({there})"


def never_crossed(playback: Playback) -> str | None:
    """A sentence that lists the edges of the world that the robot never crossed; None: it did."""
    last = len(playback.trace)
    left = [
        " to ".join(
            either_place(playback, playback.known(WorldDart(dart), last), WorldDart(dart))
            for dart in (a, b)
        )
        for a, b in playback.world.edges
        if a not in playback.replayed.crossings
    ]
    return f"Never crossed: {listed(left)}." if left else None


def difference_of_maps(playback: Playback) -> str | None:
    """Where the delivered map first differs from the world; None: it does not, or there is none."""
    finish = playback.trace[-1]
    if not isinstance(finish, ev.Finish):
        return None
    try:
        ours, theirs = playback.world.code, World.from_map(finish.map).code
    except InputError:
        return None
    head = "Both numbered breadth-first and clockwise from the marker on:"
    for vertex, (one, other) in enumerate(zip(ours[0], theirs[0], strict=False)):
        if one != other:
            return f"{head} vertex {vertex} has degree {one} in the world and {other} in the map."
    for dart, (one, other) in enumerate(zip(ours[1], theirs[1], strict=False)):
        if one != other:
            return f"{head} dart {dart} leads to {one} in the world and to {other} in the map."
    return None
