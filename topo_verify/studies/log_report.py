"""Certificates: what a log of percepts and doors proves where nobody knows the world.

A real robot leaves a log of the doors that it took and what it sensed behind them. It proves its
map (PROVED), or it is true of several worlds (UNKNOWN: walk on), or something is wrong (REFUTED).

    certificate = certify(read_trace(log))
    certificate.map             # the world, proved; or None
    certificate.witnesses       # else: two worlds, each of which shows this very log

The checkers judge the log (checkers/certificate.py), and every world given out here is seen by them
to show it. What is added here is for people: how large, how much is left, which worlds tell.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

from topo_verify.checkers.certificate import judge_log, showing
from topo_verify.checkers.entailment import Concluded
from topo_verify.checkers.findings import Finding
from topo_verify.checkers.folding import Fold
from topo_verify.robot.events import Event
from topo_verify.world.rooted_map import World


@dataclass(frozen=True, slots=True)
class Certificate:
    """What a log proves: its one map, or what is left to walk.

    Attributes:
        verdict: PROVED: the map is proved and what was declared follows. UNKNOWN: the log is true
            of several worlds. REFUTED: there are findings.
        map: the one world that shows the log, or None.
        open_darts: how many darts of the fold were never crossed; 0 if there is a map.
        vertices, edges: of the map; else of the smaller witness; 0 if no world shows the log.
        entailed, decisions: how many of the declared decisions follow from the log before them.
        findings: what is wrong; an incomplete log that declares nothing wrong has none.
        log: what was judged.
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
        """The verdict on the log in one word."""
        if self.findings:
            return "REFUTED"
        return "UNKNOWN" if self.map is None else "PROVED"

    @property
    def shown(self) -> bool:
        """Whether some world shows the log."""
        return self.fold is not None

    @property
    def witnesses(self) -> tuple[World, ...]:
        """Two different worlds that show an incomplete log, made now; none for any other log."""
        if self.fold is None or self.map is not None:
            return ()
        return tuple(showing(self.fold.world(hang), self.log) for hang in (1, 2))


def certify(trace: Sequence[Event]) -> Certificate:
    """Judge a log without its world.

    Args:
        trace: at least `start` and `move` events; declared decisions and a delivered map are judged
            too, if there are any.
    Raises:
        InputError: the trace does not begin with its only `start`, or goes on after `finish`; or
            its places have more than 2^20 doors together, and more than 16 an event.
    Complexity: nearly linear for a plain log; claim 10 looks at every open dart once a decision.
    """
    judged = judge_log(trace)
    shown = judged.broken is None
    fold, left = judged.fold, judged.fold.open_darts()
    return Certificate(
        map=judged.map,
        open_darts=left,
        vertices=len(fold.roots()) + left if shown else 0,
        edges=(sum(map(fold.degree, fold.roots())) + left) // 2 if shown else 0,
        entailed=sum(not conclusion.why for conclusion in judged.conclusions),
        decisions=sum(isinstance(event, Concluded) for event in trace),
        findings=judged.findings,
        log=trace,
        fold=fold if shown else None,
    )
