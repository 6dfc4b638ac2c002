"""What a log left open: each door that was never crossed, where to find it, and a way there.

    for door in open_doors(certify(log)): ...     # nearest to its end first

The map is proved once no door is open; so this is the work that is left. What it does not show: how
much work that is. Behind an open door there may be further doors.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import msgspec

from topo_verify.checkers.entailment import followed
from topo_verify.checkers.folding import Fold
from topo_verify.harness.log_report import Certificate
from topo_verify.robot.events import Event, Start
from topo_verify.robot.percept import Door


class OpenDoor(msgspec.Struct, frozen=True):
    """A door that the robot saw and never crossed, neither way.

    Attributes:
        event: an event of the log at which its place was reached.
        door: which door, as counted at that event.
        walk: the doors to take from where the log ends, this one last; none is shorter among the
            ways through doors that the log has crossed.
    """

    event: int
    door: Door
    walk: tuple[Door, ...]


def open_doors(certificate: Certificate) -> Iterator[OpenDoor]:
    """The open doors of an incomplete log, breadth-first from where it ends; of others none."""
    fold = certificate.fold
    if fold is None or not certificate.open_darts:
        return
    reached = _reached(certificate.log)
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
                yield OpenDoor(reached[node], dart, (*_walk(taken, node), door))
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


def _reached(log: Sequence[Event]) -> dict[int, int]:
    """Of each node of the fold of a log, the event that added it."""
    start = log[0]
    assert isinstance(start, Start)
    fold, reached = Fold(start.percept), dict[int, int]()
    for when, event in enumerate(log):
        followed(fold, event)
        reached.setdefault(fold.at[0], when)  # the robot stands at a node when it is added
    return reached
