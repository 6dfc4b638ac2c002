"""The parts that run mappers in worlds and have every claim judged.

A part that meets a counterexample goes on, so as to say how many worlds fail, and keeps the
findings of the first few; worlds come smallest first, so these are the smallest. It stops early
after a few time-outs, for each may cost a whole time limit, and, if asked to, after a few failing
worlds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import get_args

import msgspec

from topo_verify.algorithms import CATALOGUE, Algorithm
from topo_verify.checkers import CLAIMS, Finding
from topo_verify.checkers.findings import Status, Verdict
from topo_verify.harness.judge import Report, in_words, judge
from topo_verify.harness.progress import Progress
from topo_verify.harness.run import Exploration, explore
from topo_verify.harness.tally import (
    KEPT_FINDINGS,
    KEPT_RUNS,
    RunCounts,
    joint_judgements,
    joint_status,
)
from topo_verify.harness.verify.parts import MapperCost, Part
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.text import plural
from topo_verify.world.rooted_map import World

MAX_TIMEOUTS = 3
"""After so many time-outs a part stops; after so many failing worlds, too, where that is asked."""


@dataclass
class Trials:
    """Runs every mapper in every one of some worlds and judges every claim. A `PartJob`.

    Attributes:
        name: of the part.
        about: which worlds these are, in words that follow "792 worlds".
        total: how many worlds there are; counted apart from the worlds themselves.
        worlds: lists them, smallest first.
        finite: the worlds are all of a finite class.
        max_failing: stop after so many failing worlds; None: never.
        where: how the command line names the one world; None: by its id.
        note: called for every run.
        counts: what the runs came to so far.
    """

    name: str
    about: str
    total: int
    worlds: Callable[[], Iterable[World]]
    targets: Sequence[Target]
    limits: Limits
    finite: bool = False
    max_failing: int | None = None
    where: str | None = None
    note: Callable[[Exploration, Report], None] | None = None

    counts: RunCounts = field(default_factory=RunCounts)
    failed_targets: dict[str, str] = field(default_factory=dict[str, str])
    """The mappers that failed, and the world in which each did so first."""
    findings: list[Finding] = field(default_factory=list[Finding])

    def work(self, tell: Progress) -> None:
        """Run the mappers in one world after the other, until too many time out or fail."""
        for world in self.worlds():
            tell(self.name, self.counts.worlds, self.total)
            for target in self.targets:
                run = explore(world, target, limits=self.limits)
                report = judge(run, where=self.where, options=self.limits.options)
                self._enter(run, report)
            self.counts.close()
            if self._timed_out or self.counts.failing == self.max_failing:
                break

    @property
    def _timed_out(self) -> bool:
        return self.counts.timeouts >= MAX_TIMEOUTS

    def _enter(self, run: Exploration, report: Report) -> None:
        """Count one run, and keep its findings if it is among the first that fail."""
        if self.note is not None:
            self.note(run, report)
        if self.counts.enter(run, report) and report.findings:
            self.failed_targets.setdefault(run.algorithm, report.world)
            # A drawn world may come twice, and then takes one place among the kept.
            if len({(f.world, f.replay) for f in self.findings}) < KEPT_RUNS:
                self.findings += report.findings[:KEPT_FINDINGS]

    # ------------------------------------------------------------ what was found

    def part(self, *, interrupted: bool = False) -> Part:
        """The part's result so far."""
        counts = self.counts
        whole = counts.worlds == self.total and not counts.undecided and not interrupted
        verdict: Verdict = "UNKNOWN"
        if counts.failing or self.findings:  # a world that was cut off may have failed already
            verdict = "REFUTED"
        elif whole:
            verdict = "EXHAUSTED" if self.finite else "SAMPLED"
        claims = part_claims(counts.statuses())
        return Part(
            part=self.name,
            verdict=verdict,
            ok=whole and verdict != "REFUTED",
            checked=counts.worlds,
            total=self.total,
            summary=self._summary(claims, interrupted=interrupted),
            failing=counts.failing,
            claims=claims,
            judgements=joint_judgements(counts.statuses(), counts.shares(), self.findings),
            findings=tuple(self.findings),
        )

    def _summary(self, claims: dict[str, dict[str, int]], *, interrupted: bool) -> str:
        counts = self.counts
        mappers = f" × {len(self.targets)} mappers" if len(self.targets) > 1 else ""
        words = f"{counts.worlds} of {plural(self.total, 'world')}{self.about}{mappers}: "
        words += self._failures(claims) if self.findings else claims_in_words(claims)
        if counts.late_runs:
            words += f"; {plural(counts.late_runs, 'run')} out of time"
        if interrupted:
            words += "; interrupted"
        elif self._timed_out and counts.worlds < self.total:
            words += f"; stopped after {counts.timeouts} time-outs"
        elif counts.worlds < self.total:
            words += f"; stopped after {counts.failing} failing worlds"
        return words

    def _failures(self, claims: dict[str, dict[str, int]]) -> str:
        failed = ", ".join(name for name, seen in claims.items() if seen["failed"])
        worlds = plural(max(self.counts.failing, 1), "of them", "of them")
        words = f"{worlds} refute {failed}, first {self.findings[0].world}"
        return words + (f" ({', '.join(self.failed_targets)})" if len(self.targets) > 1 else "")


def part_claims(statuses: dict[str, dict[str, int]]) -> dict[str, dict[str, int]]:
    """For each claim, in how many runs it has which of the statuses that a part reports."""
    return {
        claim: {status: statuses.get(claim, {}).get(status, 0) for status in get_args(Status)}
        for claim in CLAIMS
    }


def claims_in_words(claims: dict[str, dict[str, int]]) -> str:
    """How many claims hold in all runs, and how many have each other status."""
    joint: dict[str, Status] = {
        claim: joint_status(seen) for claim, seen in claims.items() if any(seen.values())
    }
    return in_words(joint, "claims hold") if joint else "no run was judged"


# ---------------------------------------------------------------- one world, and what it costs


class CostTrial:
    """Runs every mapper in one world and reports what each pays there. A `PartJob`.

    A mapper of the user's is shown beside the catalogue. The verdict is SAMPLED at best: it is one
    world.
    """

    def __init__(
        self, name: str, where: str, world: World, targets: Sequence[Target], limits: Limits
    ) -> None:
        size = f", {where} ({len(world.vertices)} vertices, {len(world.edges)} edges)"
        self.world = world
        self.costs: list[MapperCost] = []
        self.trials = Trials(name, size, 1, lambda: [world], targets, limits, where=where)
        self.trials.note = self._enter
        foreign = any(not isinstance(target.mapper, Algorithm) for target in targets)
        self.references = list(CATALOGUE.values()) if foreign else []

    def work(self, tell: Progress) -> None:
        """Run the mappers, then the algorithms that they are compared with."""
        self.basic = explore(self.world, "basic").cost
        self.trials.work(tell)
        for algorithm in self.references:
            run = explore(self.world, algorithm)
            self.costs.append(self._cost(run, reference=True))

    def _enter(self, run: Exploration, report: Report) -> None:
        cost = self._cost(run, reference=False)
        self.costs.append(cost if report.ok else msgspec.structs.replace(cost, ratio=None))

    def _cost(self, run: Exploration, *, reference: bool) -> MapperCost:
        return MapperCost(
            algorithm=run.algorithm,
            cost=run.cost,
            ratio=round(run.cost / self.basic, 3),
            of_least=round(run.cost / self.world.least_cost(), 4),
            rejected_free=run.rejected_free,
            rejected_moving=run.rejected_moving,
            confirmed=run.confirmed,
            reference=reference,
        )

    def part(self, *, interrupted: bool = False) -> Part:
        """The part's result so far."""
        part = self.trials.part(interrupted=interrupted)
        return msgspec.structs.replace(part, costs=tuple(self.costs))
