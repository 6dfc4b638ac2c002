"""The format of certificates: a first line, `HEADER`, then natural numbers and nothing else.

So a certificate can hold a log, a claim and evidence, but cannot define or prove anything.
coq/Certificate.v gives the numbers' meaning. Trusted here: `parse`, `data_file`, and `log_lines`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Literal

import msgspec

from topo_verify.errors import InputError, plural
from topo_verify.extra.certificates import evidence
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept

HEADER = "topo-verify/certificate 1"

LARGEST = 2**60
"""The largest number in a certificate; OCaml's integers have 63 bits."""

WIDEST = 1_000_000
"""Largest sum of the degrees of a log. Coq counts doors one by one."""

CertifiedStatement = Literal["map", "undetermined", "impossible"]

STATEMENTS: tuple[CertifiedStatement, ...] = ("map", "undetermined", "impossible")
"""The statements in the order of their numbers."""

Numbers = list[int]
Line = Sequence[int]


@dataclass(frozen=True, slots=True)
class CoqCertificate:
    statement: CertifiedStatement
    log: tuple[ev.Event, ...]
    fold: evidence.FoldedLog
    numbering: tuple[tuple[int, int], ...] | None
    decisions: evidence.EntailedDecisions


def parse(text: bytes, *, name: str) -> Numbers:
    """Read the numbers of a certificate.

    Raises:
        InputError: no header, or anything but natural numbers.
    """
    head, _, rest = text.partition(b"\n")
    if head != HEADER.encode():
        raise InputError(f"{name}: expected a certificate, whose first line is {HEADER!r}")
    if stray := re.search(rb"[^0-9 \n]", rest):
        line = rest.count(b"\n", 0, stray.start()) + 2
        raise InputError(
            f"{name}, line {line}: expected natural numbers, spaces and line ends,"
            f" got {stray[0].decode('latin-1')!r}"
        )
    words = rest.split()
    # 2^60 has 19 digits; Python reads long words slowly.
    return [LARGEST + 1 if len(word) > 19 else int(word) for word in words]


def doubt(numbers: Sequence[int]) -> str:
    """Why numbers are refused before a checker sees them, or ""."""
    if max(numbers, default=0) > LARGEST:
        return "a number is larger than 2^60"
    width = log_width(numbers)
    if width > WIDEST:
        return f"the places of the log have {width:,} doors together: expected at most {WIDEST:,}"
    return ""


_ARGUMENTS = {1: 2, 2: 2, 3: 3, 4: 3}
"""How many numbers follow the number of a kind of decision."""


def log_width(numbers: Sequence[int]) -> int:
    """The sum of all degrees of the log at the head of these numbers."""
    stream = iter(numbers)
    width = next(stream, 0)
    next(stream, 0)
    for _ in range(min(next(stream, 0), len(numbers))):
        kind = next(stream, -1)
        if kind == 0:
            next(stream, 0)
            width += next(stream, 0)
        for _ in range(_ARGUMENTS.get(kind, 1)):
            next(stream, 0)
    return width


def data_file(numbers: Sequence[int]) -> str:
    """The numbers as the Coq source Data.v."""
    parts = [numbers[i : i + 500] for i in range(0, len(numbers), 500)]
    # Coq's parser needs more stack for a longer list.
    defined = [
        f"Definition part_{i} : list N := [{'; '.join(map(str, part))}]."
        for i, part in enumerate(parts)
    ]
    names = "; ".join(f"part_{i}" for i in range(len(parts)))
    return "\n".join(
        [
            "From Coq Require Import List NArith.",
            "Import ListNotations.",
            "Local Open Scope N_scope.",
            *defined,
            f"Definition numbers : list N := concat [{names}].",
            "",
        ]
    )


def text_of(certificate: CoqCertificate) -> str:
    return "\n".join([HEADER, *(" ".join(map(str, line)) for line in lines_of(certificate)), ""])


def lines_of(certificate: CoqCertificate) -> Iterator[Line]:
    yield from log_lines(certificate.log)
    yield from _claim(certificate)
    decisions = certificate.decisions
    yield from _counted(map(_meeting, decisions.merges))
    reasons = {decision.when: decision.facts for decision in decisions.stated}
    declared = [when for when, e in enumerate(certificate.log) if isinstance(e, _DECISIONS)]
    while declared and declared[-1] not in reasons:
        del declared[-1]
    yield (len(declared),)
    for when in declared:
        facts = reasons.get(when, ())
        yield (len(facts), *chain.from_iterable(map(_reason, facts)))


_DECISIONS = (ev.Reject, ev.Confirm, ev.Augment)


def stated_log(trace: Sequence[ev.Event]) -> tuple[ev.Event, ...]:
    """The events of a trace that a certificate is about.

    Left out: poses; all decisions from the first on that names a number no dart has; a delivered
    value that is no map. Darts outside 0..`LARGEST` are renumbered.
    """
    end = next((i for i, event in enumerate(trace) if not _is_natural(event)), len(trace))
    kept: list[ev.Event] = []
    for i, event in enumerate(trace):
        match event:
            case ev.Finish(map=delivered) if _is_map(delivered):
                kept.append(msgspec.structs.replace(event, map=_with_natural_darts(delivered)))
            case ev.Start() | ev.Move():
                kept.append(event)
            case ev.Reject() | ev.Confirm() | ev.Augment() if i < end:
                kept.append(event)
            case _:
                pass
    return tuple(kept)


def left_out(trace: Sequence[ev.Event]) -> str:
    """Which decisions or map no certificate states, and why, or ""."""
    log = stated_log(trace)
    decisions = decisions_in(trace) - decisions_in(log)
    reasons: list[str] = []
    if decisions:
        reasons.append(
            f"{plural(decisions, 'decision')} of the log cannot be stated nor proved: from"
            f" the first on that names a number below 0 or above {WIDEST:,}, which no dart has"
        )
    if isinstance(trace[-1], ev.Finish) and not isinstance(log[-1], ev.Finish):
        reasons.append(
            "the delivered value cannot be stated nor proved: expected edges of two darts,"
            " and a marker unless there is no dart"
        )
    return "; ".join(reasons)


def decisions_in(log: Sequence[ev.Event]) -> int:
    return sum(isinstance(event, _DECISIONS) for event in log)


def log_lines(log: Sequence[ev.Event]) -> Iterator[Line]:
    """Yield the numbers of a log from `stated_log`, line by line."""
    begin = log[0]
    assert isinstance(begin, ev.Start)
    yield percept_line(begin.percept)
    yield from _counted(filter(None, map(event_line, log)))
    end = log[-1]
    if not isinstance(end, ev.Finish):
        yield (0,)
        return
    yield (1,)
    yield from _counted((len(darts), *darts) for darts in end.map.vertices)
    yield from _counted(end.map.edges)
    yield (end.map.marker or 0,)


def _is_natural(event: ev.Event) -> bool:
    match event:
        case ev.Reject(edge, other) | ev.Confirm(edge, other):
            return 0 <= edge <= WIDEST and 0 <= other <= WIDEST
        case ev.Augment(edge, _, dart, degree):
            return all(0 <= number <= WIDEST for number in (edge, dart, degree))
        case _:
            return True


def _is_map(delivered: ev.MapData) -> bool:
    return (delivered.marker is None) == (delivered.vertices == ((),)) and all(
        len(edge) == 2 for edge in delivered.edges
    )


def _with_natural_darts(delivered: ev.MapData) -> ev.MapData:
    marker = () if delivered.marker is None else (delivered.marker,)
    darts = [*chain.from_iterable((*delivered.vertices, *delivered.edges)), *marker]
    if all(0 <= dart <= LARGEST for dart in darts):
        return delivered
    number = {dart: i for i, dart in enumerate(dict.fromkeys(darts))}
    return ev.MapData(
        tuple(tuple(number[dart] for dart in vertex) for vertex in delivered.vertices),
        tuple((number[one], number[two]) for one, two in delivered.edges),
        None if delivered.marker is None else number[delivered.marker],
    )


def event_line(event: ev.Event) -> Line | None:
    """The numbers of a move or a decision; None for other events."""
    match event:
        case ev.Move(door, percept):
            return (0, door, *percept_line(percept))
        case ev.Reject(edge, hypothesis):
            return (1, edge, hypothesis)
        case ev.Confirm(edge, hypothesis):
            return (2, edge, hypothesis)
        case ev.Augment(edge, kind, dart, degree):
            return (3 if kind == "loop" else 4, edge, dart, degree)
        case _:
            return None


def _claim(certificate: CoqCertificate) -> Iterator[Line]:
    fold, numbering = certificate.fold, certificate.numbering
    yield (STATEMENTS.index(certificate.statement),)
    if certificate.statement != "impossible":
        rows = ((row.following, row.previous, optional(row.other)) for row in fold.table)
        yield from _counted(rows)
    if certificate.statement != "undetermined":
        yield from _counted(map(_meeting, fold.meetings))
    if certificate.statement == "impossible":
        yield _conflict(fold.conflict or evidence.Illegal())
    if certificate.statement == "map":
        yield (0,) if numbering is None else (1,)
        if numbering is not None:
            yield from _counted(numbering)


def _counted(lines: Iterable[Line]) -> Iterator[Line]:
    elements = list(lines)
    yield (len(elements),)
    yield from elements


def optional(number: int | None) -> int:
    """0 for None, else the next number; one below 0 stays so, and is refused."""
    return 0 if number is None else number + 1 if number >= 0 else number


def percept_line(percept: Percept) -> Line:
    return (percept.degree, optional(percept.marker))


def _arc(arc: evidence.Arc) -> Line:
    return (int(arc.forwards), arc.visit)


def _meeting(meeting: evidence.Meeting) -> Line:
    return (*_arc(meeting[0]), *_arc(meeting[1]))


def _conflict(conflict: evidence.Conflict) -> Line:
    match conflict:
        case evidence.Arrive(meeting):
            return (0, *_meeting(meeting))
        case evidence.Marked(visit):
            return (1, visit)
        case evidence.Alone(visit):
            return (2, visit)
        case evidence.Illegal():
            return (1, 1)  # a filler: an illegal log needs no conflict


def _reason(fact: evidence.Fact) -> Line:
    match fact.reason:
        case evidence.Arc() as arc:
            return (0, *_arc(arc))
        case why:
            merges = chain.from_iterable(map(_meeting, why.meetings))
            return (1, len(why.meetings), *merges, *_conflict(why.conflict))
