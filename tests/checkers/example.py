"""One real trace, which the tests beside this file doctor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import msgspec

from tests.helpers import EIGHT, edited, failing, place, trace_of
from topo_verify import World
from topo_verify.checkers import Fold, check
from topo_verify.checkers.entailment import FoldedTrace
from topo_verify.robot.events import Augment, Event, Finish, Reject, Trace

WORLD = World.from_id("m5/434")
"""v0 is a leaf; its neighbour v1 has degree 7, with two loops and two more leaves."""

TRACE = trace_of(WORLD, "enhancement-iii-all")
FINISH = len(TRACE) - 1
MAP = TRACE[-1].map if isinstance(TRACE[-1], Finish) else None

LOOP = place(TRACE, Augment, 1)
"""Dart 2 is found to lead to dart 5; before it, 3 and 4 were rejected and 5 confirmed."""


def fold_history(trace: Sequence[Event]) -> tuple[Fold, tuple[int, str] | None]:
    """The fold of a trace; and the first event with which no world shows it, and why, or None."""
    folded = FoldedTrace(trace)
    return folded.fold, folded.read_to(len(trace))


def wrong(trace: Trace, world: World = WORLD) -> set[str]:
    """The claims 1-8 that fail."""
    return failing(world, trace) & EIGHT


def said(trace: Trace, claim: str, world: World = WORLD) -> list[str]:
    """What is said against a claim."""
    return [f.message for j in check(world, trace) if j.claim == claim for f in j.findings]


def inserted(trace: Trace, index: int, *events: Event) -> Trace:
    """The trace with more events before the one at this index."""
    return (*trace[:index], *events, *trace[index:])


def without(trace: Trace, index: int) -> Trace:
    """The trace without one event."""
    return (*trace[:index], *trace[index + 1 :])


def with_evidence(trace: Trace, index: int, **changes: Any) -> Trace:
    """The trace with other evidence in one rejection."""
    event = trace[index]
    assert isinstance(event, Reject)
    return edited(trace, index, evidence=msgspec.structs.replace(event.evidence, **changes))
