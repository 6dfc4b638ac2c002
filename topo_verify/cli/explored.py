"""An entry of `explore`: one run in one world, for scripts."""

from __future__ import annotations

import msgspec

from topo_verify.checkers import Finding, Judgement, Status
from topo_verify.cli.output import Result
from topo_verify.cli.runs import NamedWorld
from topo_verify.harness.gap import gap as measure
from topo_verify.harness.judge import Report
from topo_verify.harness.run import Exploration


class ChosenPolicies(msgspec.Struct, frozen=True):
    """The policies of a run; None for a mapper that has none."""

    pick: str | None
    order: str | None


class MeasuredGap(msgspec.Struct, frozen=True):
    """The gap of a rule to the best possible one; see `topo_verify.harness.gap`.

    Attributes:
        false: false hypotheses posed.
        walked: how many of them were rejected by motion.
        refutable: how many were walked although the history before the walk refuted them.
        share: refutable / false.
    """

    false: int
    walked: int
    refutable: int
    share: float


class ExploreEntry(msgspec.Struct, frozen=True):
    """One run: an entry of `results`; docs/commands.md.

    Attributes:
        least_cost: the least cost of a proof (docs/semantics.md, section 11).
        isomorphic: the map is the world.
        entailed: the history alone proves the map.
        ok: no claim failed, and the run ended in time.
        claims: the status of each claim.
        judgements: the same, with how much of the run each status rests on.
        stopped: why the mapper delivered no map, or None.
        gap: with --gap, if the mapper declares every decision; otherwise None.
        marker: the dart that the marker points at, as the world's file numbers darts.
        place: the vertex where the marker lies, likewise.
        same_as: with `--marker all`, the least dart from which the world looks the same, if that
            is another one: the two are one rooted map, so this run is that one's.
    """

    world: str
    algorithm: str
    policies: ChosenPolicies
    vertices: int
    edges: int
    genus: int
    cost: int
    least_cost: int
    isomorphic: bool
    entailed: bool
    ok: bool
    findings: tuple[Finding, ...]
    rejected_free: int
    rejected_moving: int
    confirmed: int
    claims: dict[str, Status]
    judgements: tuple[Judgement, ...]
    stopped: str | None
    gap: MeasuredGap | None
    marker: int | None
    place: int
    same_as: int | None = None


def explore_result(
    run: Exploration,
    at: NamedWorld,
    report: Report,
    *,
    incomplete: bool,
    gap: bool = False,
) -> Result[ExploreEntry]:
    """The entry of a judged run, and what it means for the exit code.

    Args:
        incomplete: the run was out of time, or declined by its mapper.
        gap: measure the gap of the rule.
    """
    # The gap is a share of all false hypotheses: a mapper that declares only some has none.
    measured = None
    if gap and report.ok and not {"not-declared", "partial"} & {*report.claims.values()}:
        found = measure(run.trace)
        measured = MeasuredGap(*found, share=found.share)
    policies = run.policies
    entry = ExploreEntry(
        world=at.name,
        algorithm=run.algorithm,
        policies=ChosenPolicies(policies.pick, policies.order)
        if policies
        else ChosenPolicies(None, None),
        vertices=len(at.world.vertices),
        edges=len(at.world.edges),
        genus=at.world.genus,
        cost=run.cost,
        least_cost=at.world.least_cost(),
        isomorphic=report.claims["map-isomorphic"] == "ok",
        entailed=report.claims["map-entailed"] == "ok",
        ok=not report.findings and not incomplete,
        findings=report.findings,
        rejected_free=run.rejected_free,
        rejected_moving=run.rejected_moving,
        confirmed=run.confirmed,
        claims=report.claims,
        judgements=report.judgements,
        stopped=run.stopped,
        gap=measured,
        marker=at.world.root,
        place=0 if at.world.root is None else at.world.vertex_of[at.world.root],
    )
    return Result(entry, failed=bool(report.findings), incomplete=incomplete)
