"""What a log left open: each door that was never crossed, where to find it, and a way there.

    for door in open_doors(certify(log), 100): ...     # at most 100, nearest to its end first

The map is proved once no door is open; so this is the work that is left. What it does not show: how
much work that is. Behind an open door there may be further doors.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet
from itertools import islice

import msgspec

from topo_verify.checkers.folding import Fold
from topo_verify.robot.events import Event, Move
from topo_verify.robot.percept import Door
from topo_verify.studies.log_report import Certificate


class OpenDoor(msgspec.Struct, frozen=True):
    """A door that the robot saw and never crossed, neither way.

    Attributes:
        event: the first event of the log at which its place was reached.
        door: which door, as counted at that event.
        walk: the doors to take from where the log ends, this one last; none is shorter among the
            ways through doors that the log has crossed.
    """

    event: int
    door: Door
    walk: tuple[Door, ...]


def open_doors(certificate: Certificate, most: int | None = None) -> list[OpenDoor]:
    """The open doors of an incomplete log, breadth-first from where it ends; of others none.

    Args:
        most: name so many, the nearest; None: all.
    """
    fold = certificate.fold
    if fold is None or not certificate.open_darts:
        return []
    found = [*islice(_nearest(fold), most)]
    reached = _reached(certificate.log, fold, {node for node, _, _ in found})
    doors: list[OpenDoor] = []
    for node, dart, walk in found:
        event, reference = reached[node]
        doors.append(OpenDoor(event, (dart - reference) % fold.degree(node), walk))
    return doors


def _nearest(fold: Fold) -> Iterator[tuple[int, int, tuple[Door, ...]]]:
    """Each open dart, nearest to the robot first: a node, its dart, and the doors to take."""
    start, reference = fold.find(fold.at)
    entries = {start: reference}  # of each place found: the dart by which the search came in
    taken: dict[int, tuple[int, Door]] = {}  # from where, and by which door
    queue = [start]
    for node in queue:  # grows as it goes
        degree = fold.degree(node)
        for door in range(degree):
            dart = (entries[node] + door) % degree
            end = fold.partner((node, dart))
            if end is None:
                yield node, dart, (*_walk(taken, node), door)
            elif end[0] not in entries:
                entries[end[0]], taken[end[0]] = end[1], (node, door)
                queue.append(end[0])


def _walk(taken: dict[int, tuple[int, Door]], node: int) -> list[Door]:
    """The doors that lead to a place that was found."""
    doors: list[Door] = []
    while node in taken:
        node, door = taken[node]
        doors.append(door)
    return doors[::-1]


def _reached(
    log: Sequence[Event], fold: Fold, places: AbstractSet[int]
) -> dict[int, tuple[int, int]]:
    """Of each of these places, the first event there and the robot's reference dart then."""
    reached: dict[int, tuple[int, int]] = {}
    at = fold.find((0, 0))
    for when, event in enumerate(log):
        if isinstance(event, Move):
            beyond = fold.partner((at[0], at[1] + event.door))
            assert beyond is not None, "the fold is of this log, so it has crossed this door"
            at = beyond
        if at[0] in places and at[0] not in reached:
            reached[at[0]] = when, at[1]
            if len(reached) == len(places):
                break
    return reached
