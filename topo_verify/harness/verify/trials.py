"""The parts that run mappers in worlds and have every claim judged.

A part that meets a counterexample goes on, so as to say how many worlds fail, but keeps the
findings of the first few only; worlds come smallest first, so these are the smallest. It stops
early where going on would take for ever: after a few time-outs and, if it is told so, after a few
failing worlds.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field

import msgspec

from topo_verify.algorithms import CATALOGUE, Algorithm
from topo_verify.checkers import CLAIMS, Finding
from topo_verify.checkers.findings import Verdict
from topo_verify.harness.progress import Progress
from topo_verify.harness.run import Exploration, Report, explore, judge, undecided
from topo_verify.harness.verify.parts import Cost, Part
from topo_verify.programs.loading import Target
from topo_verify.robot.limits import Limits
from topo_verify.text import plural
from topo_verify.world.rooted_map import World

PATIENCE = 3
"""After so many time-outs (or failing worlds, where that is asked for) enough is seen."""

KEPT_RUNS, KEPT_FINDINGS = 3, 5
"""Of how many failing runs findings are kept, and how many of each."""


@dataclass
class Trials:
    """Every mapper in every one of some worlds, every claim. A `Job`.

    Attributes:
        name: of the part.
        about: which worlds, in words to be put behind "792 worlds".
        total: how many worlds there are; counted apart from the worlds themselves.
        worlds: lists them, smallest first.
        finite: they are all worlds of a finite class.
        patience: after so many failing worlds enough is seen; None: never.
        where: how the command line names the one world, if it is not by its id.
        note: told of every run.
    """

    name: str
    about: str
    total: int
    worlds: Callable[[], Iterable[World]]
    targets: Sequence[Target]
    limits: Limits
    finite: bool = False
    patience: int | None = None
    where: str | None = None
    note: Callable[[Exploration, Report], None] | None = None

    checked: int = 0
    failing: int = 0
    undecided: int = 0
    timeouts: int = 0
    failed_targets: dict[str, str] = field(default_factory=dict[str, str])
    """The mappers that failed, and the world in which each did so first."""
    claims: dict[str, Counter[str]] = field(
        default_factory=lambda: {name: Counter[str]() for name in CLAIMS}
    )
    findings: list[Finding] = field(default_factory=list[Finding])

    def work(self, tell: Progress) -> None:
        """Go through the worlds, as far as it makes sense."""
        for world in self.worlds():
            tell(self.name, self.checked, self.total)
            self._try(world)
            self.checked += 1
            if self.timeouts >= PATIENCE or self.failing == self.patience:
                break

    def _try(self, world: World) -> None:
        """Every mapper in one world."""
        failed = False
        for target in self.targets:
            run = explore(world, target, limits=self.limits)
            report = judge(run, where=self.where, options=self.limits.options)
            failed |= self._judged(run, report)
        self.failing += failed

    def _judged(self, run: Exploration, report: Report) -> bool:
        """Take one run to the books; does it fail?"""
        if self.note is not None:
            self.note(run, report)
        self.timeouts += run.limit in ("move-timeout", "world-timeout")
        if undecided(run, report):
            self.undecided += 1
            return False
        for claim, status in report.claims.items():
            self.claims[claim][status] += 1
        if report.findings:
            self.failed_targets.setdefault(run.algorithm, report.world)
            if len({(f.world, f.replay) for f in self.findings}) < KEPT_RUNS:
                self.findings += report.findings[:KEPT_FINDINGS]
        return bool(report.findings)

    # ------------------------------------------------------------ what was found

    def part(self, *, interrupted: bool = False) -> Part:
        """What was found so far."""
        whole = self.checked == self.total and not self.undecided and not interrupted
        verdict: Verdict = "UNKNOWN"
        if self.failing or self.findings:
            verdict = "REFUTED"
        elif whole:
            verdict = "EXHAUSTED" if self.finite else "SAMPLED"
        return Part(
            part=self.name,
            verdict=verdict,
            ok=whole and verdict != "REFUTED",
            checked=self.checked,
            total=self.total,
            summary=self._summary(interrupted=interrupted),
            failing=self.failing,
            claims={name: _counts(seen) for name, seen in self.claims.items()},
            findings=tuple(self.findings),
        )

    def _summary(self, *, interrupted: bool) -> str:
        mappers = f" × {len(self.targets)} mappers" if len(self.targets) > 1 else ""
        words = f"{self.checked} of {plural(self.total, 'world')}{self.about}{mappers}: "
        words += self._failures() if self.findings else claims_in_words(self.claims)
        if self.undecided:
            words += f"; {plural(self.undecided, 'run')} out of time"
        if interrupted:
            words += "; interrupted"
        elif self.timeouts >= PATIENCE and self.checked < self.total:
            words += f"; stopped after {self.timeouts} time-outs"
        elif self.checked < self.total:
            words += f"; stopped after {self.failing} failing worlds"
        return words

    def _failures(self) -> str:
        claims = ", ".join(name for name, seen in self.claims.items() if seen["failed"])
        worlds = plural(max(self.failing, 1), "of them", "of them")
        words = f"{worlds} refute {claims}, first {self.findings[0].world}"
        return words + (f" ({', '.join(self.failed_targets)})" if len(self.targets) > 1 else "")


def _counts(seen: Counter[str]) -> dict[str, int]:
    return {status: seen[status] for status in ("ok", "failed", "not-declared", "not-asked")}


def claims_in_words(claims: dict[str, Counter[str]]) -> str:
    """How many claims hold in all runs, fail in one, were declared in none or not in all."""
    hold = fail = silent = partly = 0
    for seen in claims.values():
        fail += seen["failed"] > 0
        hold += not seen["failed"] and seen["ok"] > 0 and not seen["not-declared"]
        silent += seen["not-declared"] > 0 and not (seen["ok"] or seen["failed"])
        partly += not seen["failed"] and seen["ok"] > 0 and seen["not-declared"] > 0
    words = [f"{plural(hold, 'claim holds', 'claims hold')}"]
    words += [plural(fail, "fails", "fail")] if fail else []
    words += [f"{partly} declared in some runs only, and hold there"] if partly else []
    words += [f"{silent} not declared"] if silent else []
    return ", ".join(words)


# ---------------------------------------------------------------- one world, and what it costs


class Costs:
    """Every mapper in one world, and what each of them pays there. A `Job`.

    A mapper of the user's is shown beside the catalogue. The verdict is SAMPLED at best: it is one
    world.
    """

    def __init__(
        self, name: str, where: str, world: World, targets: Sequence[Target], limits: Limits
    ) -> None:
        size = f", {where} ({len(world.vertices)} vertices, {len(world.edges)} edges)"
        self.world = world
        self.costs: list[Cost] = []
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

    def _cost(self, run: Exploration, *, reference: bool) -> Cost:
        return Cost(
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
        """What was found so far."""
        part = self.trials.part(interrupted=interrupted)
        return msgspec.structs.replace(part, costs=tuple(self.costs))
