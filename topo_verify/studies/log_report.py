"""Certificates: what a log of percepts and doors proves without its world.

certificate = certify("log.csv")
certificate.map             # the world, proved; or None
certificate.witnesses       # else: two worlds, each of which shows this very log

for door in certificate.open_doors(100): ...     # at most 100, nearest to the log's end first
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field
from html import escape
from itertools import islice
from os import PathLike, fspath
from typing import Any, Literal, cast

import msgspec

from topo_verify.checkers.certificate import judge_log, showing
from topo_verify.checkers.entailment import CONCLUDED
from topo_verify.checkers.findings import Finding
from topo_verify.checkers.folding import Contradiction, Fold
from topo_verify.errors import LINE, InputError, map_size, plural, shown
from topo_verify.robot.events import Event, Move, Start, read_events
from topo_verify.robot.percept import Door, Percept
from topo_verify.studies.advice import Advice, advice, doors_of, places_from
from topo_verify.studies.log_file import event_in, read_log
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import World


@dataclass(frozen=True, slots=True)
class Certificate:
    """What a log proves: its one map, or what is left to walk.

    Attributes:
        verdict: PROVED, UNKNOWN (several worlds show the log) or REFUTED (there are findings).
        map: the one world that shows the log, or None.
        open_darts: number of darts of the fold that were never crossed.
        vertices, edges: of the map, else of the smaller witness; 0 if no world shows the log.
        entailed, decisions: the declared decisions that follow from the log before them; all.
        fold: of the log; None if no world shows it.
        source: the file of the log; "" for events.
    """

    verdict: Literal["PROVED", "UNKNOWN", "REFUTED"]
    map: World | None
    open_darts: int
    vertices: int = field(repr=False)
    edges: int = field(repr=False)
    entailed: int
    decisions: int
    findings: tuple[Finding, ...]
    log: Sequence[Event] = field(repr=False)
    fold: Fold | None = field(repr=False)
    source: str = field(repr=False, default="")

    @property
    def shown(self) -> bool:
        """Whether some world shows the log."""
        return self.fold is not None

    def open_doors(self, most: int | None = None) -> list[OpenDoor]:
        """The `most` nearest open doors of an incomplete log, nearest first."""
        return open_doors(self, most)

    @property
    def advice(self) -> Advice | None:
        """How to go on from where an incomplete log ends; else None."""
        return None if self.fold is None or self.map is not None else advice(self.fold)

    @property
    def apart(self) -> tuple[int, int] | None:
        """The events of two readings of one place that differ; None unless that refutes the log."""
        return None if self.shown else readings_apart(self.log)

    @property
    def place(self) -> int | None:
        """The place at which the log ends, a vertex of `known`; None if no world shows it."""
        return self.places[-1] if self.shown else None

    @property
    def places(self) -> tuple[int, ...]:
        """Where the robot is after each event, as a vertex of `known`; () if no world shows it."""
        if self.fold is None:
            return ()
        number: dict[int, int] = {}
        nodes = _followed(self.log, self.fold)
        return tuple([number.setdefault(node, len(number)) for node, _ in nodes])

    @property
    def known(self) -> World:
        """What the log shows of the world: its places, in the order in which it reached them.

        Door d of a place is counted as when it was first reached. An open door leads to a vertex
        of degree 1 behind all places. Of a proved map it is the map, with these numbers.

        Raises:
            InputError: no world shows the log.
        """
        return _known(self)

    def draw(self, path: str | PathLike[str] | None = None, *, doors: bool = False) -> str:
        """The picture of `known` as SVG, also written to a .svg, .png, .pdf or .html file.

        Open doors are dotted; a blue ring is where the log ends. `doors=True` numbers the doors of
        each place.

        Raises:
            InputError: no world shows the log, its picture has over 1,000 edges, or the file
                cannot be written.
        """
        from topo_verify.pictures.drawing import WHOLE, document, format_of, lay_out_known, to_svg

        kind = None if path is None else format_of(fspath(path))
        if self.edges > WHOLE:
            raise InputError(f"no picture of {self.edges:,} edges, expected up to {WHOLE:,}")
        known = self.known
        layout = lay_out_known(known, len(known.vertices) - self.open_darts)
        if path is not None and kind is not None:
            files.write(path, document(known, layout, kind, doors=doors, here=self.place))
        return to_svg(known, layout, doors=doors, here=self.place)

    def __str__(self) -> str:
        return "\n".join([_headline(self), *_next_steps(self)])

    def _repr_html_(self) -> str:
        from topo_verify.pictures.drawing import IN_NOTEBOOKS, image

        said = f"<p>{'<br>'.join(map(escape, str(self).splitlines()))}</p>"
        if not self.shown:
            return said
        if self.edges > MOST_DRAWN:
            much = f"over {MOST_DRAWN} edges take long to draw"
            return f"{said}<p>{much}; <code>certificate.draw('known.svg')</code> does it.</p>"
        return f"{said}{IN_NOTEBOOKS}{image(self.draw(doors=True), 'what the log shows')}"

    @property
    def witnesses(self) -> tuple[World, ...]:
        """Two different worlds that show an incomplete log; none for another log."""
        if self.fold is None or self.map is not None:
            return ()
        return tuple(showing(self.fold.world(hang), self.log) for hang in (1, 2))


def certify(
    log: Sequence[Event | Mapping[str, Any]] | str | PathLike[str],
) -> Certificate:
    """Judge a log, events or a file of them, without its world.

    Args:
        log: a file, or a list of events: of a trace, or dictionaries as in the lines of a file.
    Raises:
        InputError: this is no log; the log does not begin with its only `start`, or goes on
            after `finish`; its places have more than 2^20 doors together and 16 an event.
    Complexity: nearly linear for a plain log; claim 10 reads every open dart once a decision.
    """
    trace = _events(log)
    judged = judge_log(trace)
    shown = judged.broken is None
    fold, open_darts = judged.fold, judged.fold.open_darts()
    return Certificate(
        verdict="REFUTED" if judged.findings else "UNKNOWN" if judged.map is None else "PROVED",
        map=judged.map,
        open_darts=open_darts,
        vertices=len(fold.roots()) + open_darts if shown else 0,
        edges=(sum(map(fold.degree, fold.roots())) + open_darts) // 2 if shown else 0,
        entailed=sum(not conclusion.why for conclusion in judged.conclusions),
        decisions=sum(isinstance(event, CONCLUDED) for event in trace),
        findings=judged.findings,
        log=trace,
        fold=fold if shown else None,
        source=fspath(log) if isinstance(log, str | PathLike) else "",
    )


def _events(log: Sequence[Event | Mapping[str, Any]] | str | PathLike[str]) -> Sequence[Event]:
    if isinstance(log, str | PathLike):
        return read_log(log)
    if hasattr(log, "columns"):
        raise InputError(
            "expected a log: events, or a file; got a table: write it by to_csv('log.csv',"
            " index=False), with the columns door, degree and marker, and give that name"
        )
    if not hasattr(log, "__len__"):
        raise InputError(f"expected a log: events, as run.trace, or a file; got {log!r}")
    if any(isinstance(event, Mapping) for event in log):
        lines = (msgspec.json.encode(event, enc_hook=repr) for event in log)
        return tuple(read_events(lines, name="the list of events"))
    return cast("Sequence[Event]", log)


def _known(certificate: Certificate) -> World:
    fold = certificate.fold
    if fold is None:
        raise InputError("no world shows this log, so nothing is known: see its findings")
    if certificate.map is not None and not certificate.map.edges:
        return certificate.map
    reached = _reached(certificate.log, fold, set(fold.roots()))
    first: dict[int, int] = {}
    for node in reached:
        first[node] = sum(map(fold.degree, first))
    doors = sum(map(fold.degree, reached))
    rotations: list[Sequence[int]] = []
    edges: list[tuple[int, int]] = []
    for node, (_, reference) in reached.items():
        degree = fold.degree(node)
        rotations.append(range(first[node], first[node] + degree))
        for door in range(degree):
            dart = first[node] + door
            end = fold.partner((node, (reference + door) % degree))
            if end is None:
                edges.append((dart, doors + dart))
                continue
            beyond, entry = end
            other = first[beyond] + (entry - reached[beyond][1]) % fold.degree(beyond)
            if dart < other:
                edges.append((dart, other))
    rotations += [[leaf] for dart, leaf in edges if leaf == doors + dart]
    return World.from_rotations(rotations, edges, 0)


class _Noting(Fold):
    """A fold that notes the percepts that it compared last."""

    compared: tuple[Percept, Percept] | None = None

    def _require_alike(self, one: Percept, other: Percept) -> None:
        self.compared = one, other
        super()._require_alike(one, other)


def readings_apart(log: Sequence[Event]) -> tuple[int, int] | None:
    """The events of two readings that would be of one place, and differ; None: no such pair."""
    start = log[0]
    assert isinstance(start, Start), "it was judged"
    fold, events = _Noting(start.percept), {id(start.percept): 0}
    for when, event in enumerate(log):
        if isinstance(event, Move):
            events.setdefault(id(event.percept), when)
            try:
                fold.move(event.door, event.percept)
            except Contradiction:
                if fold.compared is None or fold.compared[0].is_like(fold.compared[1]):
                    return None  # of another kind
                first, second = sorted(events[id(percept)] for percept in fold.compared)
                return first, second
    return None


def said_of_readings(source: str, apart: tuple[int, int], found: int | None) -> str:
    """In words: the two readings differ, and would be of one place by what was `found`."""
    readings = " and ".join(event_in(source, when) for when in apart)
    by = ""
    if found is not None and found not in apart:
        by = f" by {event_in(source, found)}: one of the three, or a door, is wrong"
    return f"The readings of {readings} would be of one place{by}."


# ---------------------------------------------------------------- what is shown

MOST_DRAWN = 200
"""Most edges of a picture in a notebook: about a second."""

MOST_LISTED = 5
"""Most findings and open doors that a certificate lists."""


def _headline(certificate: Certificate) -> str:
    if not certificate.shown:
        proves = "no world shows this log"
    elif certificate.map is not None:
        size = map_size(certificate.vertices, certificate.edges)
        proves = f"one world alone shows this log: {size}"
    else:
        doors = plural(certificate.open_darts, "door")
        proves = f"several worlds show this log, with {doors} not known to have been crossed"
    wrong = certificate.shown and certificate.findings
    does_not_follow = "; a map or decision in it does not follow" if wrong else ""
    return f"{certificate.verdict}: {proves}{does_not_follow}"


def _next_steps(certificate: Certificate) -> Iterator[str]:
    for finding in certificate.findings[:MOST_LISTED]:
        event = "" if finding.event is None else f", {event_in(certificate.source, finding.event)}"
        yield shown(f"{finding.claim}{event}: {finding.message}", limit=LINE)
    if (apart := certificate.apart) is not None:
        yield said_of_readings(certificate.source, apart, certificate.findings[0].event)
    for door in certificate.open_doors(MOST_LISTED):
        yield f"door {door.door} of place {door.place}: {_by_doors(door.walk)}"
    if (advice := certificate.advice) is None:
        return
    if advice.walk:
        yield f"Next: {_by_doors(advice.walk)}, and certify the longer log."
    else:
        yield f"Next: go back to the marker, {_by_doors(advice.home)}, and certify the longer log."


def _by_doors(walk: Sequence[Door]) -> str:
    return shown(f"from where the log ends, take {', '.join(map(str, walk))}")


# ---------------------------------------------------------------- open doors


class OpenDoor(msgspec.Struct, frozen=True):
    """A door that the robot saw and never crossed, neither way.

    Attributes:
        event: the first event at which its place was reached.
        place: the vertex of `Certificate.known`: the number of places reached before.
        door: its number, as counted at that event.
        walk: a shortest way from where the log ends through crossed doors, this door last.
    """

    event: int
    place: int
    door: Door
    walk: tuple[Door, ...]


def open_doors(certificate: Certificate, most: int | None = None) -> list[OpenDoor]:
    """The `most` nearest open doors of an incomplete log."""
    fold = certificate.fold
    if fold is None or not certificate.open_darts:
        return []
    nearest = [*islice(_nearest(fold), most)]
    reached = _reached(certificate.log, fold, {node for node, _, _ in nearest})
    numbers = {node: number for number, node in enumerate(reached)}
    doors: list[OpenDoor] = []
    for node, dart, walk in nearest:
        event, reference = reached[node]
        door = (dart - reference) % fold.degree(node)
        doors.append(OpenDoor(event, numbers[node], door, walk))
    return doors


def _nearest(fold: Fold) -> Iterator[tuple[int, int, tuple[Door, ...]]]:
    """Each open dart by distance: a node, its dart, the doors to take."""
    for node, entry, walk in places_from(fold):
        degree = fold.degree(node)
        for door in range(degree):
            dart = (entry + door) % degree
            if fold.partner((node, dart)) is None:
                yield node, dart, (*doors_of(walk), door)


def _reached(
    log: Sequence[Event], fold: Fold, places: AbstractSet[int]
) -> dict[int, tuple[int, int]]:
    """The first event at each place, and the reference dart then, until all `places` are reached.

    In the order of the events, so that a place's index is the number of those reached before.
    """
    reached: dict[int, tuple[int, int]] = {}
    missing = set(places)
    for when, (node, reference) in enumerate(_followed(log, fold)):
        if node not in reached:
            reached[node] = when, reference
            missing.discard(node)
            if not missing:
                break
    return reached


def _followed(log: Sequence[Event], fold: Fold) -> Iterator[tuple[int, int]]:
    """Where the robot is after each event: the node of the fold, and its reference dart."""
    at = fold.find((0, 0)) if fold.degree(0) else (0, 0)
    for event in log:
        if isinstance(event, Move):
            beyond = fold.partner((at[0], at[1] + event.door))
            assert beyond is not None, "the fold is of this log, so it has crossed this door"
            at = beyond
        yield at
