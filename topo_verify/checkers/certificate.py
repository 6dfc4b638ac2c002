"""Certificates: what a log of percepts and doors proves where nobody knows the world.

A real robot leaves a log of the doors that it took and what it sensed behind them. Folded, the log
either has no open dart: then there is one world that shows it, and that is the map. Or it has: then
two different worlds show it, and no mapper could know which one it was in.

    certificate = certify(read_trace(log))
    certificate.map          # the world, proved; or None
    certificate.witnesses    # else: two worlds, each of which shows this very log

What this does not show: that the log is what happened. Percepts that no world shows are found; a
log of another walk is a proof about another world.

Source: docs/semantics.md, section 11; docs/certify.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from topo_verify.checkers import (
    Finding,
    check,
    decision_conclusions,
    fold_history,
)
from topo_verify.checkers.replayed_trace import require_order
from topo_verify.errors import InternalError
from topo_verify.robot.events import Augment, Confirm, Event, Finish, Move, Reject, Start
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world.rooted_map import World


@dataclass(frozen=True, slots=True)
class Certificate:
    """What a log proves: its one map, or witnesses that it has none.

    Attributes:
        map: the one world that shows the log, or None.
        open_darts: how many darts of the fold were never crossed; 0 if there is a map.
        witnesses: two different worlds that show the log, if there is no map and the log is sound.
        entailed, decisions: how many of the declared decisions follow from the log before them.
        findings: what is wrong; none if the map is proved and all that was declared is right.
    """

    map: World | None
    open_darts: int
    witnesses: tuple[World, ...]
    entailed: int
    decisions: int
    findings: tuple[Finding, ...]


def certify(trace: Sequence[Event]) -> Certificate:
    """Judge a log without its world.

    Args:
        trace: at least `start` and `move` events; declared decisions and a delivered map are judged
            too, if there are any.
    Raises:
        InputError: the trace does not begin with its only `start`, or goes on after `finish`.
    Complexity: nearly linear for a plain log; claim 10 looks at every open dart once a decision.
    """
    require_order(trace)
    fold, broken = fold_history(trace)
    decisions = sum(isinstance(event, Reject | Confirm | Augment) for event in trace)
    entailed = 0
    if decisions:
        entailed = sum(not conclusion.why for conclusion in decision_conclusions(trace))
    if broken is not None:
        when, why = broken
        message = f"no world shows this history: {why}"
        finding = Finding("map-entailed", when, "percepts that some world shows", why, message)
        return Certificate(None, fold.open_darts(), (), entailed, decisions, (finding,))
    if left := fold.open_darts():
        witnesses = tuple(map(fold.world, (1, 2)))
        for witness in witnesses:
            _require_shown(witness, trace)
        message = f"two different worlds show this log, with {left} darts of its fold never crossed"
        finding = Finding("map-entailed", None, 0, left, message, witnesses[0].text)
        return Certificate(None, left, witnesses, entailed, decisions, (finding,))
    world = fold.world()
    _require_shown(world, trace)
    return Certificate(world, 0, (), entailed, decisions, _findings(world, trace))


def _findings(world: World, trace: Sequence[Event]) -> tuple[Finding, ...]:
    """The findings of all claims in the proved world, but not that a plain log delivers no map."""
    plain = not isinstance(trace[-1], Finish)
    return tuple(
        finding
        for judgement in check(world, trace, strict=True)
        for finding in judgement.findings
        if not (plain and judgement.claim in ("map-isomorphic", "map-entailed"))
        or finding.event not in (None, len(trace) - 1)
    )


def _require_shown(world: World, trace: Sequence[Event]) -> None:
    """Raise InternalError unless the world shows the log, as a proof and a witness must."""
    robot = SimulatedRobot(world, budget=len(trace))
    for event in trace:
        if isinstance(event, Move):
            robot.move(event.door)
        if isinstance(event, Start | Move) and robot.percept != event.percept:
            raise InternalError("a fold does not show the log that it is the fold of")
