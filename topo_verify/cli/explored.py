"""An entry of `explore`: one run in one world, for scripts; and what all of them come to."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import msgspec

from topo_verify.campaign.judge import Report
from topo_verify.campaign.run import Exploration
from topo_verify.checkers import Finding, Judgement, Status
from topo_verify.checkers.findings import Verdict
from topo_verify.cli.output import Result
from topo_verify.cli.runs import NamedWorld
from topo_verify.cli.walks import FoundRuns
from topo_verify.report.account import (
    Account,
    JudgedCase,
    JudgedExtent,
    JudgedSuite,
    claim_cases,
    counted,
    joint_verdict,
    outcome_of,
)
from topo_verify.report.blocks import Block
from topo_verify.studies.gap import gap as measure
from topo_verify.text import plural


class ChosenPolicies(msgspec.Struct, frozen=True):
    """The policies of a run; None for a mapper that has none."""

    pick: str | None
    order: str | None


class MeasuredGap(msgspec.Struct, frozen=True):
    """The gap of a rule to the best possible one; see `topo_verify.studies.gap`.

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
    """One run: an entry of `results`.

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
        rejected_free, rejected_moving: hypotheses rejected without motion, and by motion.
        confirmed: hypotheses confirmed.
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


def explore_account(
    entries: Sequence[ExploreEntry], blocks: Iterable[Block], found: FoundRuns
) -> Account:
    """The account of `explore`: a suite a run; the run, and a case a claim."""
    verdicts = [_verdict(entry) for entry in entries]
    failing, decided = verdicts.count("REFUTED"), verdicts.count("SAMPLED")
    words = counted(decided, len(entries), "runs")
    if failing:
        words = counted(failing, len(entries), "runs fail")
    mappers = list(dict.fromkeys(entry.algorithm for entry in entries))
    return Account(
        about=mappers[0] if len(mappers) == 1 else plural(len(mappers), "mapper"),
        extent=JudgedExtent(joint_verdict(verdicts), words),
        suites=tuple(
            JudgedSuite(_run_name(entry), tuple(_run_cases(entry)))
            for entry in entries
            if entry.same_as is None
        ),
        blocks=tuple(blocks),
        exhibits=found.exhibits,
        left_out=found.left_out,
    )


def _verdict(entry: ExploreEntry) -> Verdict:
    return "REFUTED" if entry.findings else "SAMPLED" if entry.ok else "UNKNOWN"


def _run_name(entry: ExploreEntry) -> str:
    at = "" if entry.marker is None else f", marker at dart {entry.marker}"
    return f"{entry.algorithm} in {entry.world}{at}"


def _run_cases(entry: ExploreEntry) -> Iterator[JudgedCase]:
    first, verdict = entry.findings[0] if entry.findings else None, _verdict(entry)
    yield JudgedCase(
        name="the run as a whole",
        verdict=verdict,
        outcome=outcome_of(verdict),
        message=(entry.stopped or "") if first is None else f"{first.claim}: {first.message}",
        again="" if first is None else first.replay,
    )
    yield from claim_cases(entry.judgements)
