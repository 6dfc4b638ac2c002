"""The trace: what happened, as one stream of events, and its file format.

A closed union of frozen structs; on disk JSON Lines, each line an object with a `type`. Moves are
what the world showed; `pose`, `reject`, `confirm` and `augment` are what a mapper declares. A trace
with its world is a certificate: the checkers need nothing else.

Darts are darts of S, the mapper's own map: v0's darts are 0 … degree-1 from the marked one on, and
each new vertex takes the next numbers, clockwise from the dart of entry.

Source: docs/semantics.md, sections 3 and 13.
"""

from __future__ import annotations

import json
from codecs import BOM_UTF8
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from io import BytesIO
from typing import Any, Literal, Protocol, TypeGuard, final, get_args

import msgspec

from topo_verify.errors import InputError
from topo_verify.robot.percept import PURPOSES, Door, Percept, Purpose
from topo_verify.world.validation import Number

MapDart = Number
"""A dart of S as a mapper declares it."""

RuleName = Literal["motion", "prefix", "history", "records", "folding", "planar"]

GrowthKind = Literal["new", "loop"]

TRACE_FORMAT: Literal["topo-verify/trace"] = "topo-verify/trace"
TRACE_VERSION = 1


class _Event(msgspec.Struct, frozen=True, tag_field="type", tag=str.lower):
    """Base of all events; the tag is the class name in lower case."""


class Record(msgspec.Struct, frozen=True):
    """Where in the records an expectation came from: T[dart], then further relative doors."""

    dart: MapDart
    doors: tuple[Door, ...]


class Evidence(msgspec.Struct, frozen=True, omit_defaults=True):
    """Why a hypothesis is rejected: two percepts at one place differ that would have to be equal.

    Attributes:
        step: how many doors behind the entered vertex (0: at that vertex itself).
        expected: what would be sensed there if the hypothesis were true.
        observed: what was sensed. Rules `folding` and `planar` may leave out both percepts.
        sequence: without motion: which sequence of this edge showed it, from 0.
        at: without motion: the dart of S where tracing stood: the dart of arrival, or, with a
            record, the unexplored dart that was crossed.
        record: the record that gave the expectation, if one did.
        contradiction: of rules `folding` and `planar`: what is wrong, in the words of
            docs/semantics.md, section 13.
    """

    step: Number
    expected: Percept | None = None
    observed: Percept | None = None
    sequence: Number | None = None
    at: MapDart | None = None
    record: Record | None = None
    contradiction: str | None = None


class MapData(msgspec.Struct, frozen=True):
    """A map as a mapper delivers it: clockwise rotations, pairs of darts, the marked dart."""

    vertices: tuple[tuple[Number, ...], ...]
    edges: tuple[tuple[Number, ...], ...]
    marker: Number | None


class Policies(msgspec.Struct, frozen=True):
    """The choices that the paper leaves open, by name: which edge next, which hypothesis first."""

    pick: str = "nearest"
    order: str = "shortest"

    def __repr__(self) -> str:
        return f"tv.Policies(pick={self.pick!r}, order={self.order!r})"

    def _repr_pretty_(self, printer: Any, _: bool) -> None:  # noqa: FBT001  asked by Hypothesis
        printer.text(repr(self))


@final
class Start(_Event, frozen=True, kw_only=True):
    """The robot stands at the marker, its reference dart the marked one.

    Attributes:
        world: the world's id, if it is known and has one.
        stopped: why a run that was over when this was written ended without a map.
    """

    format: Literal["topo-verify/trace"] = TRACE_FORMAT
    version: int = TRACE_VERSION
    algorithm: str | None = None
    policies: Policies | None = None
    world: str | None = None
    percept: Percept
    stopped: str | msgspec.UnsetType = msgspec.UNSET


@final
class Move(_Event, frozen=True, gc=False):
    """The robot left by a door and senses a percept. Cost: one edge traversal."""

    door: Door
    percept: Percept
    purpose: Purpose | None = None


@final
class Pose(_Event, frozen=True):
    """The robot has crossed `edge`; these unexplored darts of S might be its other end."""

    edge: MapDart
    hypotheses: tuple[MapDart, ...]


@final
class Reject(_Event, frozen=True):
    """The other end of `edge` is not `hypothesis`, because of the evidence."""

    edge: MapDart
    hypothesis: MapDart
    rule: RuleName
    evidence: Evidence


@final
class Confirm(_Event, frozen=True):
    """The other end of `edge` is `hypothesis`."""

    edge: MapDart
    hypothesis: MapDart
    rule: RuleName


@final
class Augment(_Event, frozen=True):
    """The map grows by a new vertex with first dart `dart`, or by a loop with other end `dart`."""

    edge: MapDart
    kind: GrowthKind
    dart: MapDart
    degree: Number


@final
class Finish(_Event, frozen=True):
    """The mapper delivers its map and, optionally, its own count of the cost."""

    cost: Number | None
    map: MapData


Decision = Pose | Reject | Confirm | Augment
Event = Start | Move | Pose | Reject | Confirm | Augment | Finish
Trace = tuple[Event, ...]
KINDS = frozenset(get_args(Event))
DECISIONS = Pose, Reject, Confirm, Augment


def is_decision(event: Event) -> TypeGuard[Decision]:
    """Whether an event that is exactly of its kind is a decision; faster than `isinstance`."""
    return type(event) in DECISIONS


class Robot(Protocol):
    """What a mapper is given: it can look, move, and say what it concludes."""

    @property
    def percept(self) -> Percept:
        """The percept where the robot stands."""
        ...

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:
        """Leave by this door (0 … degree-1) and return the percept behind it. Costs 1."""
        ...

    def declare(self, event: Decision) -> None:
        """Put a decision on record, so that the checkers judge it. Costs nothing."""
        ...


_encoder = msgspec.json.Encoder()
_decoder: msgspec.json.Decoder[Event] = msgspec.json.Decoder(Event)


def write_trace(trace: Iterable[Event]) -> bytes:
    """The trace as JSON Lines; the same bytes for the same trace."""
    return _encoder.encode_lines(trace)


def read_trace(text: bytes, *, name: str = "trace") -> Trace:
    """The trace in these JSON Lines; arguments and errors as of `read_events`."""
    return tuple(read_events(BytesIO(text), name=name))


def read_events(lines: Iterable[bytes], *, name: str = "trace") -> Iterator[Event]:
    """The events in these lines of JSON; empty lines and a byte order mark are passed over.

    Equal moves are one object, so a long log takes eight bytes a move.

    Args:
        name: what to call the input in messages.
    Raises:
        InputError: a line is not an event or has a key twice, the first is not a `start`, or its
            version is newer.
    """
    moves: dict[bytes, Move] = {}
    begun = False
    pieces = (piece for line in lines for piece in line.splitlines())
    for number, piece in enumerate(pieces, 1):
        line = piece.removeprefix(BOM_UTF8) if number == 1 else piece
        event: Event | None = moves.get(line)
        if event is None:
            if not line.strip():
                continue
            event = _event(line, f"{name}, line {number}")
            if isinstance(event, Move) and len(moves) < _MOST_KEPT:
                moves[line] = event
        if not begun:
            _require_start(event, name)
            begun = True
        yield event
    if not begun:
        _require_start(None, name)


_WORDS = {"kind": get_args(GrowthKind), "rule": get_args(RuleName), "purpose": PURPOSES}
"""The words of each field that has one of a few."""


def decode_error(error: Exception) -> str:
    """What msgspec says of a message, and the words that the field may have."""
    text = str(error)
    words = _WORDS.get(text.rstrip("`").rpartition(".")[2], ())
    return f"{text}: expected {' or '.join(words)}" if words and "enum" in text else text


_MOST_KEPT = 2**16
"""Distinct Move lines that are shared; most logs have fewer."""


_EXAMPLE = '{"type": "move", "door": 0, "percept": {"degree": 3, "marker": null}}'


def _event(line: bytes, place: str) -> Event:
    doubled: list[str] = []

    def see(pairs: list[tuple[str, object]]) -> None:
        times = Counter(key for key, _ in pairs)
        doubled.extend(key for key, number in times.items() if number > 1)

    try:
        event = _decoder.decode(line)
        # msgspec keeps the last of two equal keys
        json.loads(line, object_pairs_hook=see, parse_int=str, strict=False)
    except (msgspec.MsgspecError, RecursionError, ValueError) as error:
        raise InputError(
            f"{place}: expected an event of a trace, as {_EXAMPLE}: {decode_error(error)}"
        ) from error
    if doubled:
        raise InputError(f"{place}: the key {doubled[0]!r} stands twice: leave one of the two out")
    return event


def require_order(trace: Sequence[Event]) -> Sequence[Event]:
    """The trace, each event exactly of its kind, so that `type` tells them apart.

    Raises:
        InputError: the trace does not begin with its only `start` and end with any `finish`, or it
            has something else in it.
    """
    kinds = [*map(type, trace)]
    if (  # the usual case, quickly
        kinds[:1] == [Start]
        and Start not in kinds[1:]
        and Finish not in kinds[:-1]
        and KINDS.issuperset(kinds)
    ):
        return trace
    for when, event in enumerate(trace or (None,)):
        ends = isinstance(event, Finish) and when + 1 < len(trace)
        if isinstance(event, Start) != (when == 0) or ends:
            rule = "a trace begins with its only 'start' and does not go on after 'finish'"
            raise InputError(f"event {when} of the trace is out of order: {rule}")
        if not isinstance(event, Event):
            kind = type(event).__name__
            raise InputError(f"event {when} of the trace is a {kind}: expected an event")
    return tuple(map(_plain, trace))


def _plain(event: Event) -> Event:
    """The event without what a subclass adds: no claim speaks of that."""
    base: type[Event] = next(kind for kind in KINDS if isinstance(event, kind))
    return base(**{name: getattr(event, name) for name in base.__struct_fields__})


def _require_start(head: Event | None, name: str) -> None:
    if not isinstance(head, Start):
        example = '{"type": "start", "percept": {"degree": 3, "marker": 0}}'
        raise InputError(
            f"{name}: expected an event of type 'start' in the first line, as {example}"
        )
    if head.version > TRACE_VERSION:
        raise InputError(
            f"{name}: trace version {head.version} is newer than {TRACE_VERSION}, the newest that"
            " this topo-verify reads: update it"
        )
