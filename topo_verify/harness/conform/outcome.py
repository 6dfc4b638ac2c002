"""The result of one world: one run of the implementation, judged on four levels.

    result      the map is the world, the cost is honest and within the bound
    claims      the declared decisions are sound and justified, and the history proves the map
    decisions   the run equals that of the reference, event for event
    cost        the cost relative to that of the reference

A run without a map has ONE finding on level `result`, which says what the implementation did
instead. A world is undecided, neither passed nor failed, if the implementation skips it, gives it
up, or exceeds its time while it still moves.

What this does not show: that a program behaves in the same way the next time.
"""

from __future__ import annotations

from typing import Any, Literal, get_args

import msgspec

from topo_verify.checkers import Finding, Judgement
from topo_verify.harness.conform.likeness import Difference, declares, first_difference
from topo_verify.harness.corpus import Named
from topo_verify.harness.judge import Report
from topo_verify.harness.run import Exploration
from topo_verify.programs.misbehaviour import Misbehaved
from topo_verify.robot.events import Policies
from topo_verify.robot.limits import Limits

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
    event: int | None
    expected: Any
    seen: Any
    message: str
    witness: str | None = None
    replay: str
    difference: Difference | None = None


class WorldResult(msgspec.Struct, frozen=True, kw_only=True):
    """The result of one world.

    Attributes:
        world, group: its name, and the text of WORLDS that names it.
        edges: the number of its edges.
        states: by level; `decisions` only if a reference is to be followed.
        findings: by level, the first ones.
        judgements: of each claim; its findings stand under `findings`.
        why: the reason why the world is undecided, if it is.
        timeout: whether a time limit struck.
        cost, reference: edge traversals, the implementation's and the reference's.
    """

    world: str
    group: str
    edges: int
    states: dict[str, LevelState]
    findings: dict[str, tuple[WorldFinding, ...]]
    judgements: tuple[Judgement, ...] = ()
    why: str | None = None
    timeout: bool = False
    cost: int = 0
    reference: int = 0


class ConformJob(msgspec.Struct, frozen=True, kw_only=True):
    """The questions to ask in every world, as data that can be sent to a worker.

    Attributes:
        target: the implementation, as a TARGET.
        like: the algorithm whose decisions it should make; None: decisions are not compared.
        policies: of the reference.
        limits: of each run.
        strict: ask claim 10 also in worlds with more than 2,000 edges.
        validate: refuse unknown and doubled fields in a program's messages.
        transcript: the folder for the transcripts of failing worlds.
        replay_arguments: the command line that asks for this again, without the world.
        in_process: a mapper that is not of the catalogue shares the process of the harness.
    """

    target: str
    like: str | None = None
    policies: Policies = Policies()
    limits: Limits = Limits()
    strict: bool = False
    validate: bool = False
    transcript: str | None = None
    replay_arguments: tuple[str, ...] = ()
    in_process: bool = True

    @property
    def reference(self) -> str:
        """The algorithm that costs and decisions are compared with."""
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
    """The result of one world.

    Args:
        report: the judgement on the run.
        reference: the reference's run in the same world.
        misbehaved: what the program did instead of delivering a map.
        replay: the command line for the findings, in place of the report's.
    """
    findings = [_found(finding, at, replay) for finding in report.findings]
    lost = run.map is None
    result = [found for found in findings if found.claim in RESULT]
    claims = [found for found in findings if found.claim not in RESULT]
    if lost:
        # Without a map, claims about the map and the run as a whole add nothing to the one finding.
        result = [_loss(run, misbehaved, at, replay)]
        claims = [
            found for found in claims if found.event is not None and found.claim != "map-entailed"
        ]
    open_ended = _open_ended(run, misbehaved)
    neither: LevelState = "undecided" if lost or report.undecided else "passed"
    kept: dict[str, tuple[WorldFinding, ...]] = {
        "result": () if open_ended else tuple(result[:KEPT]),
        "claims": tuple(claims[:KEPT]),
    }
    states: dict[str, LevelState] = {
        "result": open_ended or ("failed" if result else "passed"),
        "claims": "failed" if claims else open_ended or neither,
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
        judgements=report.with_findings(()).judgements,
        why=run.stopped if open_ended else None,
        timeout=run.limit in ("move-timeout", "world-timeout"),
        cost=run.cost,
        reference=reference.cost,
    )
    # With one worker as with many: what is compared and printed never holds a mapper's objects.
    return plain(made)


def plain(made: WorldResult) -> WorldResult:
    """The same result as data alone, as another process would send it: no object of the mapper."""
    return _decoder.decode(msgspec.json.encode(made, enc_hook=repr))


def undecided_by_a_stranger(made: WorldResult, how: str) -> WorldResult:
    """The result of a world that passed at the second try; the first may have met a stranger.

    Args:
        how: what became of the first try.
    """
    if "failed" in made.states.values():
        return made
    why = f"{how}, perhaps by a stranger; at the second try it passed"
    return msgspec.structs.replace(made, states=dict.fromkeys(made.states, "undecided"), why=why)


_decoder = msgspec.json.Decoder(WorldResult)


def _open_ended(run: Exploration, misbehaved: Misbehaved | None) -> LevelState | None:
    """The state of a world in which the implementation cannot be judged; None if it can."""
    if misbehaved is not None and misbehaved.kind in ("skip", "error"):
        return "skipped" if misbehaved.kind == "skip" else "errored"
    # Only this limit leaves it open: a run stopped by another one stands still or walks for ever.
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
    """The single finding of a run without a map."""
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
    """The first difference from the reference as a finding, and the state of level `decisions`."""
    difference = first_difference(reference.trace, run.trace)
    if difference is not None and difference.seen is None and run.map is None:
        return None, "undecided"  # the run was cut off before any difference
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
