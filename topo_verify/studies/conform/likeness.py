"""Finds the first event in which two runs in one world differ.

Compared are moves with their percepts and declared decisions with their evidence; for a mapper
without declarations moves alone. Not compared: the purpose of a move, the choice among several
contradictions, the final map.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import zip_longest

import msgspec

from topo_verify.robot import events as ev
from topo_verify.robot.event_words import event_words

SHOWN = 4
"""Events shown before the first difference."""


class KnownState(msgspec.Struct, frozen=True):
    """The knowledge that two runs share when they part.

    Attributes:
        moves: edge traversals so far.
        vertices: the degree of each vertex of S.
        explored: the explored edges of S, lesser dart first.
        edge: the dart whose other end is in question, or null.
        left: its hypotheses that were neither rejected nor confirmed.
        doors: the doors taken since S last grew.
    """

    moves: int
    vertices: tuple[int, ...]
    explored: tuple[tuple[int, int], ...]
    edge: int | None
    left: tuple[int, ...]
    doors: tuple[int, ...]


class Difference(msgspec.Struct, frozen=True):
    """The first event in which a mapper differs from the reference.

    Attributes:
        event: its index in the mapper's trace.
        at: the index of the reference's event.
        expected, seen: the reference's event and the mapper's, in words; null: no more events.
        before: the last events in which they agree.
        state: the knowledge at this point.
    """

    event: int
    expected: str | None
    seen: str | None
    before: tuple[str, ...]
    state: KnownState
    at: int


class Likeness(msgspec.Struct, frozen=True, omit_defaults=True):
    """The note about a run beside a reference.

    Attributes:
        reference: the cost of the reference, in edge traversals.
        silent: the world has edges, and no decision is declared.
        detail: further words about why a program was stopped.
    """

    reference: int
    silent: bool = False
    difference: Difference | None = None
    detail: str = ""


def declares(trace: Iterable[ev.Event]) -> bool:
    """Whether the trace holds a declared decision."""
    return any(isinstance(event, ev.Pose | ev.Reject | ev.Confirm | ev.Augment) for event in trace)


def first_difference(reference: ev.Trace, mapper: ev.Trace) -> Difference | None:
    """The first difference between the two runs, or None."""
    silent = not declares(mapper)
    ours = _events(reference, silent=silent)
    theirs = _events(mapper, silent=silent)
    for place, (ours_now, theirs_now) in enumerate(zip_longest(ours, theirs)):
        expected = None if ours_now is None else _bare(ours_now[1])
        observed = None if theirs_now is None else _bare(theirs_now[1])
        if expected != observed:
            upto = len(reference) if ours_now is None else ours_now[0]
            return Difference(
                event=len(mapper) if theirs_now is None else theirs_now[0],
                expected=None if expected is None else event_words(expected),
                seen=None if observed is None else event_words(observed),
                before=tuple(
                    event_words(event) for _, event in ours[max(0, place - SHOWN) : place]
                ),
                state=_state(reference[:upto]),
                at=upto,
            )
    return None


def _events(trace: ev.Trace, *, silent: bool) -> list[tuple[int, ev.Event]]:
    kinds = (ev.Move,) if silent else (ev.Move, ev.Pose, ev.Reject, ev.Confirm, ev.Augment)
    return [(when, event) for when, event in enumerate(trace) if isinstance(event, kinds)]


def _bare(event: ev.Event) -> ev.Event:
    if isinstance(event, ev.Move):
        return ev.Move(event.door, event.percept)
    if isinstance(event, ev.Reject) and event.rule in ("folding", "planar"):
        return msgspec.structs.replace(event, evidence=ev.Evidence(event.evidence.step))
    return event


def _state(trace: Sequence[ev.Event]) -> KnownState:
    """The knowledge of the reference after these events."""
    vertices: list[int] = []
    explored: list[tuple[int, int]] = []
    edge: int | None = None
    hypotheses: list[int] = []
    doors: list[int] = []
    for event in trace:
        match event:
            case ev.Start(percept=percept):
                vertices.append(percept.degree)
            case ev.Move(door):
                doors.append(door)
            case ev.Pose():
                edge, hypotheses = event.edge, list(event.hypotheses)
            case ev.Reject(hypothesis=h) | ev.Confirm(hypothesis=h) if h in hypotheses:
                hypotheses.remove(h)
            case ev.Augment(end, kind, dart, degree):
                explored.append((min(end, dart), max(end, dart)))
                vertices += [degree] if kind == "new" else []
                edge, hypotheses, doors = None, [], []
            case _:
                pass
    moves = sum(isinstance(event, ev.Move) for event in trace)
    return KnownState(
        moves, tuple(vertices), tuple(explored), edge, tuple(hypotheses), tuple(doors)
    )
