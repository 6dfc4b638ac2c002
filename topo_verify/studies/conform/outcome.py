"""A row on four levels: one run of the implementation, judged.

    result      the map is the world, the cost is honest and within the bound
    claims      the declared decisions are sound and justified, and the history proves the map
    decisions   the run equals that of the reference, event for event
    cost        the cost relative to that of the reference

A run without a map has ONE finding on level `result`, which says what the implementation did
instead. A world is undecided, neither passed nor failed, if the implementation skips it, gives it
up, or exceeds its time while it still moves; or if something else may have ended its process.

What this does not show: that a program behaves in the same way the next time.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, get_args

import msgspec

from topo_verify.campaign.row import Row
from topo_verify.checkers import Finding
from topo_verify.studies.conform.likeness import Difference, Likeness

Level = Literal["result", "claims", "decisions", "cost"]

LEVELS: tuple[Level, ...] = get_args(Level)

LevelState = Literal["passed", "failed", "skipped", "errored", "undecided", "not-declared"]
"""The state of a world on one level."""

RESULT = ("percepts-true", "map-isomorphic", "cost-honest", "cost-within-bound")
"""The claims of level `result`. All others belong to level `claims`."""

KEPT = 5
"""The most findings that are kept for a world and a level."""


class WorldFinding(msgspec.Struct, frozen=True, kw_only=True):
    """A `Finding` with its kind.

    Attributes:
        kind: what the program did instead of delivering a map (docs/oracle.md), `move-timeout`,
            `budget`, `no-map`, `decisions`; else the claim.
        difference: on level `decisions`, the first difference of the runs.
    """

    claim: str
    kind: str
    world: str
    event: int | None = None
    expected: Any = None
    seen: Any = None
    message: str
    witness: str | None = None
    replay: str = ""
    difference: Difference | None = None


@dataclass(frozen=True, slots=True)
class WorldOutcome:
    """What a row says on each level.

    Attributes:
        states: by level; `decisions` only if a reference is to be followed.
        findings: by level, the first ones.
        why: the reason why the world is undecided, if it is.
        cost, reference: edge traversals, the implementation's and the reference's.
    """

    states: dict[Level, LevelState]
    findings: dict[Level, tuple[WorldFinding, ...]]
    why: str | None
    cost: int
    reference: int


def outcome_of(row: Row, like: str) -> WorldOutcome:
    """The outcome in one world.

    Args:
        row: its note is a `Likeness`; None: a worker was lost each time.
        like: the algorithm whose decisions it should make; empty: decisions are not compared.
    """
    note = None if row.note is None else msgspec.convert(row.note, Likeness)
    # A run that lost its worker once has the map of its second try.
    lost = row.ended != "map" and row.map is None
    open_ended = _open_ended(row)
    findings = [_found(row, one) for one in row.findings]
    result = [found for found in findings if found.claim in RESULT]
    claims = [found for found in findings if found.claim not in RESULT]
    if row.ended != "map":
        result = [] if row.lost or open_ended else [_loss(row, note)]
    if lost:
        # Without a map, claims about the map and the run as a whole add nothing to the one finding.
        claims = [
            found for found in claims if found.event is not None and found.claim != "map-entailed"
        ]
    unproved = lost or any(one.status == "undecided" for one in row.claims)
    states: dict[Level, LevelState] = {
        "result": open_ended or ("failed" if result else "passed"),
        "claims": "failed" if claims else open_ended or ("undecided" if unproved else "passed"),
    }
    kept: dict[Level, tuple[WorldFinding, ...]] = {
        "result": tuple(result[:KEPT]),
        "claims": tuple(claims[:KEPT]),
    }
    if like:
        difference = None if note is None else note.difference
        states["decisions"] = _likeness(note, open_ended, lost=lost)
        failed = states["decisions"] == "failed"
        kept["decisions"] = (_parted(row, like, difference),) if difference and failed else ()
    states["cost"] = "passed" if not (lost or result) else open_ended or "undecided"
    why = row.stopped if open_ended else None
    if row.lost is not None and "failed" not in states.values():
        for level in states:
            states[level] = "undecided"
        why = row.undecided
    return WorldOutcome(states, kept, why, row.cost, 0 if note is None else note.reference)


def _open_ended(row: Row) -> LevelState | None:
    """The state of a world in which the implementation cannot be judged; None if it can."""
    if row.ended in ("skip", "error"):
        return "skipped" if row.ended == "skip" else "errored"
    # Only this limit leaves it open: a run stopped by another one stands still or walks for ever.
    late = row.ended == "world-timeout" or (row.timed_out and row.undecided is not None)
    return "undecided" if late else None


def _found(row: Row, finding: Finding) -> WorldFinding:
    return WorldFinding(
        claim=finding.claim,
        kind=finding.claim,
        world=row.world,
        event=finding.event,
        expected=finding.expected,
        seen=finding.seen,
        message=finding.message,
        witness=finding.witness,
    )


def _loss(row: Row, note: Likeness | None) -> WorldFinding:
    """The single finding of a run without a map."""
    detail = "" if note is None else note.detail
    return WorldFinding(
        claim="map-isomorphic",
        kind=row.ended,
        world=row.world,
        expected="a map",
        message=f"no map was delivered: {row.stopped}{detail}",
    )


def _likeness(note: Likeness | None, open_ended: LevelState | None, *, lost: bool) -> LevelState:
    """The state of level `decisions`."""
    if note is None:
        return "undecided"
    if note.difference is None:
        return "not-declared" if note.silent else "passed"
    if note.difference.seen is None and lost:
        return open_ended or "undecided"  # the run was cut off before any difference
    return "failed"


def _parted(row: Row, like: str, difference: Difference) -> WorldFinding:
    """The first difference from the reference as a finding."""
    ours, theirs = (side or "nothing more" for side in (difference.expected, difference.seen))
    return WorldFinding(
        claim="decisions",
        kind="decisions",
        world=row.world,
        event=difference.event,
        expected=difference.expected,
        seen=difference.seen,
        message=f"{like} does: {ours}; the mapper: {theirs}",
        difference=difference,
    )
