"""Certificates: what a log of percepts and doors proves without its world.

certificate = certify(read_trace(log))
certificate.map             # the world, proved; or None
certificate.witnesses       # else: two worlds, each of which shows this very log

for door in open_doors(certificate, 100): ...     # at most 100, nearest to the log's end first
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field
from itertools import islice
from typing import Literal

import msgspec

from topo_verify.checkers.certificate import judge_log, showing
from topo_verify.checkers.entailment import CONCLUDED
from topo_verify.checkers.findings import Finding
from topo_verify.checkers.folding import Fold
from topo_verify.robot.events import Event, Move
from topo_verify.robot.percept import Door
from topo_verify.world.rooted_map import World


@dataclass(frozen=True, slots=True)
class Certificate:
    """What a log proves: its one map, or what is left to walk.

    Attributes:
        map: the one world that shows the log, or None.
        open_darts: number of darts of the fold that were never crossed.
        vertices, edges: of the map, else of the smaller witness; 0 if no world shows the log.
        entailed, decisions: the declared decisions that follow from the log before them; all.
        fold: of the log; None if no world shows it.
    """

    map: World | None
    open_darts: int
    vertices: int
    edges: int
    entailed: int
    decisions: int
    findings: tuple[Finding, ...]
    log: Sequence[Event] = field(repr=False)
    fold: Fold | None = field(repr=False)

    @property
    def verdict(self) -> Literal["PROVED", "UNKNOWN", "REFUTED"]:
        """PROVED, UNKNOWN (several worlds show the log) or REFUTED (there are findings)."""
        if self.findings:
            return "REFUTED"
        return "UNKNOWN" if self.map is None else "PROVED"

    @property
    def shown(self) -> bool:
        """Whether some world shows the log."""
        return self.fold is not None

    @property
    def witnesses(self) -> tuple[World, ...]:
        """Two different worlds that show an incomplete log; none for another log."""
        if self.fold is None or self.map is not None:
            return ()
        return tuple(showing(self.fold.world(hang), self.log) for hang in (1, 2))


def certify(trace: Sequence[Event]) -> Certificate:
    """Judge a log without its world.

    Raises:
        InputError: the trace does not begin with its only `start`, or goes on after `finish`; or
            its places have more than 2^20 doors together, and more than 16 an event.
    Complexity: nearly linear for a plain log; claim 10 reads every open dart once a decision.
    """
    judged = judge_log(trace)
    shown = judged.broken is None
    fold, open_darts = judged.fold, judged.fold.open_darts()
    return Certificate(
        map=judged.map,
        open_darts=open_darts,
        vertices=len(fold.roots()) + open_darts if shown else 0,
        edges=(sum(map(fold.degree, fold.roots())) + open_darts) // 2 if shown else 0,
        entailed=sum(not conclusion.why for conclusion in judged.conclusions),
        decisions=sum(isinstance(event, CONCLUDED) for event in trace),
        findings=judged.findings,
        log=trace,
        fold=fold if shown else None,
    )


# ---------------------------------------------------------------- open doors


class OpenDoor(msgspec.Struct, frozen=True):
    """A door that the robot saw and never crossed, neither way.

    Attributes:
        event: the first event at which its place was reached.
        door: its number, as counted at that event.
        walk: a shortest way from where the log ends through crossed doors, this door last.
    """

    event: int
    door: Door
    walk: tuple[Door, ...]


def open_doors(certificate: Certificate, most: int | None = None) -> list[OpenDoor]:
    """The `most` nearest open doors of an incomplete log."""
    fold = certificate.fold
    if fold is None or not certificate.open_darts:
        return []
    nearest = [*islice(_nearest(fold), most)]
    reached = _reached(certificate.log, fold, {node for node, _, _ in nearest})
    doors: list[OpenDoor] = []
    for node, dart, walk in nearest:
        event, reference = reached[node]
        doors.append(OpenDoor(event, (dart - reference) % fold.degree(node), walk))
    return doors


def _nearest(fold: Fold) -> Iterator[tuple[int, int, tuple[Door, ...]]]:
    """Each open dart by distance: a node, its dart, the doors to take."""
    for node, entry, walk in _places(fold):
        degree = fold.degree(node)
        for door in range(degree):
            dart = (entry + door) % degree
            if fold.partner((node, dart)) is None:
                yield node, dart, (*_doors(walk), door)


def way_to(fold: Fold, place: int) -> tuple[tuple[Door, ...], int]:
    """The doors of a shortest way from the log's end to a node; the dart of arrival."""
    return next((_doors(walk), entry) for node, entry, walk in _places(fold) if node == place)


_Walk = tuple["_Walk", Door] | None
"""A linked list, last door first."""


def _places(fold: Fold) -> Iterator[tuple[int, int, _Walk]]:
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


def _doors(walk: _Walk) -> tuple[Door, ...]:
    doors: list[Door] = []
    while walk is not None:
        walk, door = walk
        doors.append(door)
    return tuple(reversed(doors))


def _reached(
    log: Sequence[Event], fold: Fold, places: AbstractSet[int]
) -> dict[int, tuple[int, int]]:
    """The first event at each place, and the reference dart then."""
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
