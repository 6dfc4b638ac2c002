"""What became of one world: a run of the implementation's, judged on four levels.

    result      the map is the world, the cost is honest and within the bound
    claims      the decisions that it declares are sound and justified, and the map is proved
    decisions   event for event as the reference that it is to be like
    cost        what it pays beside the reference

A run without a map has ONE finding on level `result`, which says what the implementation did
instead. A world that it skips or gives up, or in which it runs out of time though it moves on, is
not decided: neither passed nor failed.

What this does not show: a program that behaves differently in the same world another time.
"""

from __future__ import annotations

from typing import Any, Literal, get_args

import msgspec

from topo_verify.checkers import Finding, Status
from topo_verify.harness.conform.likeness import Difference, declares, first_difference
from topo_verify.harness.corpus import Named
from topo_verify.harness.run import Exploration, Report
from topo_verify.programs.program import Misbehaved
from topo_verify.robot.events import Policies
from topo_verify.robot.limits import Limits

Level = Literal["result", "claims", "decisions", "cost"]

LEVELS: tuple[Level, ...] = get_args(Level)

LevelState = Literal["passed", "failed", "skipped", "errored", "undecided", "not-declared"]
"""What became of a world on one level."""

RESULT = ("percepts-true", "map-isomorphic", "cost-honest", "cost-within-bound")
"""The claims of level `result`; all others are of level `claims`."""

KEPT = 5
"""So many findings of a world are kept on a level."""


class WorldFinding(msgspec.Struct, frozen=True, kw_only=True):
    """One thing that is wrong; the fields of `Finding`, and its kind.

    Attributes:
        kind: what the program did instead of delivering a map (docs/oracle.md), `move-timeout`,
            `budget`, `no-map`, `decisions`; else the claim.
        difference: on level `decisions`: where the runs part, and what was known then.
    """

    claim: str
    kind: str
    world: str
    event: int | None
    expected: Any
    seen: Any
    message: str
    witness: str | None = None
    replay: str
    difference: Difference | None = None


class WorldResult(msgspec.Struct, frozen=True, kw_only=True):
    """What became of one world.

    Attributes:
        world, group: its name, and the text of WORLDS that led to it.
        edges: of the world.
        states: by level; `decisions` only where it is asked for.
        findings: by level, those that were kept.
        claims: the status of each claim.
        why: why it is not decided, if it is not.
        timeout: a time limit struck.
        cost, reference: edge traversals, the implementation's and the reference's.
    """

    world: str
    group: str
    edges: int
    states: dict[str, LevelState]
    findings: dict[str, tuple[WorldFinding, ...]]
    claims: dict[str, Status] = {}
    why: str | None = None
    timeout: bool = False
    cost: int = 0
    reference: int = 0


class ConformJob(msgspec.Struct, frozen=True, kw_only=True):
    """What is asked of every world, as plain data that a worker can be handed.

    Attributes:
        target: the implementation, as a TARGET.
        like: the algorithm whose decisions it is to make; None: that is not asked.
        policies: of the reference.
        limits: of one run.
        validate: refuse what the protocol passes over.
        transcript: the folder for what was said in failing worlds.
        replay_arguments: the command line that asks for this again, without the world.
    """

    target: str
    like: str | None = None
    policies: Policies = Policies()
    limits: Limits = Limits()
    validate: bool = False
    transcript: str | None = None
    replay_arguments: tuple[str, ...] = ()

    @property
    def reference(self) -> str:
        """The algorithm that costs are relative to."""
        return self.like or "basic"


def world_result(
    run: Exploration,
    report: Report,
    at: Named,
    job: ConformJob,
    *,
    reference: Exploration,
    misbehaved: Misbehaved | None = None,
    replay: str = "",
) -> WorldResult:
    """What became of a world.

    Args:
        report: on the run; its findings are told anew with `replay`.
        reference: the run of the algorithm that it is compared with.
        misbehaved: what the program did instead of delivering a map.
    """
    findings = [_found(finding, at, replay) for finding in report.findings]
    lost = run.map is None
    result = [found for found in findings if found.claim in RESULT]
    claims = [found for found in findings if found.claim not in RESULT]
    if lost:
        result = [_loss(run, misbehaved, at, replay)]
        claims = [
            found for found in claims if found.event is not None and found.claim != "map-entailed"
        ]
    open_ended = _open_ended(run, misbehaved)
    kept: dict[str, tuple[WorldFinding, ...]] = {
        "result": () if open_ended else tuple(result[:KEPT]),
        "claims": tuple(claims[:KEPT]),
    }
    states: dict[str, LevelState] = {
        "result": open_ended or ("failed" if result else "passed"),
        "claims": "failed" if claims else (open_ended or "undecided") if lost else "passed",
    }
    if job.like is not None:
        found, states["decisions"] = _likeness(run, reference, at, job.like, replay)
        kept["decisions"] = () if found is None else (found,)
        if states["decisions"] == "undecided" and open_ended:
            states["decisions"] = open_ended
    states["cost"] = "passed" if not (lost or result) else open_ended or "undecided"
    made = WorldResult(
        world=at.name,
        group=at.group,
        edges=len(at.world.edges),
        states=states,
        findings=kept,
        claims=report.claims,
        why=run.stopped if open_ended else None,
        timeout=run.limit in ("move-timeout", "world-timeout"),
        cost=run.cost,
        reference=reference.cost,
    )
    return plain(made)


def plain(made: WorldResult) -> WorldResult:
    """The same outcome as it comes out of another process: data, no mapper's objects."""
    return _decoder.decode(msgspec.json.encode(made, enc_hook=repr))


_decoder = msgspec.json.Decoder(WorldResult)


def _open_ended(run: Exploration, misbehaved: Misbehaved | None) -> LevelState | None:
    """Why nobody knows whether the implementation is right in this world, if so."""
    if misbehaved is not None and misbehaved.kind in ("skip", "error"):
        return "skipped" if misbehaved.kind == "skip" else "errored"
    return "undecided" if run.limit == "world-timeout" else None


def _found(finding: Finding, at: Named, replay: str) -> WorldFinding:
    return WorldFinding(
        claim=finding.claim,
        kind=finding.claim,
        world=at.name,
        event=finding.event,
        expected=finding.expected,
        seen=finding.seen,
        message=finding.message,
        witness=finding.witness,
        replay=replay,
    )


def _loss(run: Exploration, misbehaved: Misbehaved | None, at: Named, replay: str) -> WorldFinding:
    """The one finding of a run without a map."""
    kind = misbehaved.kind if misbehaved is not None else run.limit or "no-map"
    detail = misbehaved.detail if misbehaved is not None else ""
    return WorldFinding(
        claim="map-isomorphic",
        kind=kind,
        world=at.name,
        event=None,
        expected="a map",
        seen=None,
        message=f"no map was delivered: {run.stopped}{detail}",
        replay=replay,
    )


def _likeness(
    run: Exploration, reference: Exploration, at: Named, like: str, replay: str
) -> tuple[WorldFinding | None, LevelState]:
    """Does it do as the reference does?"""
    difference = first_difference(reference.trace, run.trace)
    if difference is not None and difference.seen is None and run.map is None:
        return None, "undecided"  # as far as it went
    if difference is None:
        silent = bool(at.world.edges) and not declares(run.trace)
        return None, "not-declared" if silent else "passed"
    ours, theirs = (side or "nothing more" for side in (difference.expected, difference.seen))
    found = WorldFinding(
        claim="decisions",
        kind="decisions",
        world=at.name,
        event=difference.event,
        expected=difference.expected,
        seen=difference.seen,
        message=f"{like} does: {ours}; the mapper: {theirs}",
        replay=replay,
        difference=difference,
    )
    return found, "failed"
