"""A log judged by itself: what percepts and doors prove when the world is unknown.

Trusted. No open dart in the fold: exactly one world shows the log (PROVED). An open dart: two
different worlds show it, and no mapper could tell them apart (UNKNOWN). If no world shows the log,
or what it delivers or decides does not follow, it is REFUTED. Claim 7 is not asked of logs.

What this does not show: that the log is what happened.

Source: docs/semantics.md, section 11; docs/certify.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from topo_verify.checkers import entailment as ent
from topo_verify.checkers.claims import check, unproved
from topo_verify.checkers.findings import Finding
from topo_verify.checkers.folding import Fold
from topo_verify.checkers.replayed_trace import ReplayedTrace
from topo_verify.errors import InputError, InternalError
from topo_verify.robot.events import Event, Finish, Move, Start, require_order
from topo_verify.world.rooted_map import World

MOST_DARTS = 2**20
"""The most doors of all places of a log: a world of them takes about 2 GB."""


class JudgedLog(NamedTuple):
    """What a log proves: REFUTED if there are findings, else PROVED if it has a map, else UNKNOWN.

    Attributes:
        fold: of the log, up to `broken`.
        broken: the first event with which no world shows the log, and why; or None.
        map: the one world that shows the log, or None.
        conclusions: whether each declared decision follows from the log before it, up to the first
            that draws a wrong S.
        findings: what is wrong; an incomplete log that declares nothing wrong has none.
    """

    fold: Fold
    broken: tuple[int, str] | None
    map: World | None
    conclusions: tuple[ent.Conclusion, ...]
    findings: tuple[Finding, ...]


def judge_log(trace: Sequence[Event]) -> JudgedLog:
    """Judge a log without its world, in nearly linear time.

    Raises:
        InputError: the trace does not begin with its only `start`, or goes on after `finish`; or
            its places have more than 2^20 doors together, and more than 16 an event.
    """
    trace = require_order(trace)
    folded = ent.FoldedTrace(trace)
    fold, broken = folded.fold, folded.read_to(len(trace))
    most = max(MOST_DARTS, 16 * len(trace))
    if (darts := sum(map(fold.degree, fold.roots()))) > most:
        size = f"the places of this log have {darts} doors together: expected at most {most}"
        raise InputError(f"{size}; is a degree wrong?")
    decides = any(isinstance(event, ent.CONCLUDED) for event in trace)
    conclusions = tuple(ent.decision_conclusions(ent.FoldedTrace(trace))) if decides else ()
    if broken is not None:
        when, why = broken
        message = f"no world shows this history: {why}"
        finding = Finding("map-entailed", when, "percepts that some world shows", why, message)
        return JudgedLog(fold, broken, None, conclusions, (finding,))
    if fold.open_darts():
        delivered = [ent.map_conclusion(folded)] if type(trace[-1]) is Finish else []
        doubts = *unproved("decisions-entailed", conclusions), *unproved("map-entailed", delivered)
        return JudgedLog(fold, None, None, conclusions, doubts)
    world = showing(fold.world(), trace)
    return JudgedLog(fold, None, world, conclusions, _wrong(world, trace))


def _wrong(world: World, trace: Sequence[Event]) -> tuple[Finding, ...]:
    """What a log says that is wrong in its proved world.

    A finding without an event is about the whole run: its cost, or a missing map. A log owes
    neither.
    """
    if all(isinstance(event, Start | Move) for event in trace):
        return ()
    findings = (f for judgement in check(world, trace, strict=True) for f in judgement.findings)
    return tuple(finding for finding in findings if finding.event is not None)


def showing(world: World, trace: Sequence[Event]) -> World:
    """The world, after a check that it shows the log."""
    if not ReplayedTrace(world, trace).is_history:
        raise InternalError("a fold does not show the log that it is the fold of")
    return world
