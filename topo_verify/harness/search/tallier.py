"""Makes the tally of worlds of one size, run by run."""

from __future__ import annotations

from dataclasses import dataclass, field

from topo_verify.checkers import Finding
from topo_verify.harness.judge import Report
from topo_verify.harness.observed import (
    Observation,
    Sampler,
    added,
    digest,
    run_hash,
    sampled,
    world_hash,
)
from topo_verify.harness.run import Exploration
from topo_verify.harness.tally import (
    KEPT_FINDINGS,
    KEPT_RUNS,
    KEPT_WORLDS,
    CostComparison,
    CostPair,
    CostTotals,
    Failing,
    Failure,
    LostWorker,
    PolicyCosts,
    RunCounts,
    Tally,
)


@dataclass
class Tallier:
    """Makes the tally of worlds of one size, which come in the order of their ranks.

    Life cycle: `open` a world, `enter` its runs, `close` it; `tally` at any time.

    Attributes:
        edges: the size of the worlds.
        targets: the mappers that run in each world; if they are two, their costs are compared.
        sampler: which worlds are kept to be run again.
    """

    edges: int
    targets: tuple[str, ...]
    sampler: Sampler
    counts: RunCounts = field(default_factory=RunCounts)
    _rank: int = -1
    _claims: dict[str, Failing] = field(default_factory=dict[str, Failing])
    _failures: list[Failure] = field(default_factory=list[Failure])
    _costs: dict[str, _CostCounts] = field(default_factory=dict[str, "_CostCounts"])
    _compared: CostComparison = field(default_factory=CostComparison)
    _digest: str = ""
    _timeouts: int = 0
    _lost: list[LostWorker] = field(default_factory=list[LostWorker])
    _sample: list[Observation] = field(default_factory=list[Observation])
    _policy_costs: dict[str, PolicyCosts] = field(default_factory=dict[str, PolicyCosts])
    # of the world that is open: the first failure of each claim, and the costs
    _failed: dict[str, Failure] = field(default_factory=dict[str, Failure])
    _paid: dict[str, int] = field(default_factory=dict[str, int])
    _runs: list[bytes] = field(default_factory=list[bytes])

    def open(self, rank: int) -> None:
        """Go on to the next world."""
        self._rank, self._failed, self._paid, self._runs = rank, {}, {}, []

    def enter(self, run: Exploration, report: Report, killed: str | None = None) -> None:
        """Count a run in the open world.

        Args:
            killed: the signal with which a stranger may have ended a run before.
        """
        if killed is not None:
            self._lost.append(LostWorker(self.edges, self._rank, killed))
        self._runs.append(run_hash(run, report))
        if not self.counts.enter(run, report):
            return
        if report.ok:
            self._costs.setdefault(run.algorithm, _CostCounts()).enter(self._rank, run.cost)
            self._paid[run.algorithm] = run.cost
            return
        findings = report.findings
        for claim in dict.fromkeys(finding.claim for finding in findings):
            first = tuple(f for f in findings if f.claim == claim)
            self._failed.setdefault(claim, self._failure(run, first))
        if len(self._failures) < KEPT_RUNS:
            self._failures.append(self._failure(run, findings))

    def enter_range(self, target: str, costs: PolicyCosts) -> None:
        """Count what any policies can cost a mapper in the open world."""
        known = self._policy_costs.get(target, PolicyCosts())
        self._policy_costs[target] = known + costs

    def _failure(self, run: Exploration, findings: tuple[Finding, ...]) -> Failure:
        return Failure(self.edges, self._rank, run.algorithm, findings[:KEPT_FINDINGS])

    def close(self) -> bool:
        """Count the open world; does a claim fail in it?"""
        for claim, failure in self._failed.items():
            failing = Failing(1, failure)
            known = self._claims.get(claim)
            self._claims[claim] = failing if known is None else known + failing
        if len(self.targets) == 2 and len(self._paid) == 2:
            self._compare(*(self._paid[target] for target in self.targets))
        timeouts, fails = self.counts.timeouts, self.counts.close()
        self._observe(fails=fails, timed_out=timeouts > self._timeouts)
        self._timeouts = timeouts
        return fails

    def _observe(self, *, fails: bool, timed_out: bool) -> None:
        key = self.sampler.key(self.edges, self._rank)
        seen = Observation(key, self.edges, self._rank, fails, world_hash(self._runs))
        self._digest = added(self._digest, digest(seen))
        # A world that was out of time may be in time when it is run again.
        if self.sampler.wants(seen) and not timed_out:
            self._sample.append(seen)

    def _compare(self, cost: int, other: int) -> None:
        if cost != other:
            dearer = cost > other
            pairs = (CostPair(f"m{self.edges}/{self._rank}", cost, other),) if dearer else ()
            self._compared += CostComparison(dearer, not dearer, max(0, cost - other), pairs)

    def tally(self) -> Tally:
        """The tally of all closed worlds."""
        return Tally(
            worlds=self.counts.worlds,
            undecided=self.counts.undecided,
            failing=self.counts.failing,
            timeouts=self.counts.timeouts,
            statuses=self.counts.statuses(),
            claims=self._claims,
            failures=tuple(self._failures),
            costs={target: costs.totals(self.edges) for target, costs in self._costs.items()},
            compared=self._compared,
            digest=self._digest,
            sample=sampled(self._sample),
            lost=tuple(self._lost),
            shares=self.counts.shares(),
            policy_costs=self._policy_costs,
        )


@dataclass
class _CostCounts:
    """Counts what one mapper pays; `worst` holds the first ranks at which it pays the most."""

    runs: int = 0
    total: int = 0
    most: int = 0
    attained: int = 0
    last: int = -1
    worst: list[int] = field(default_factory=list[int])

    def enter(self, rank: int, cost: int) -> None:
        """Count one run of a mapper."""
        self.runs += 1
        self.total += cost
        if cost < self.most:
            return
        if cost > self.most or not self.worst:
            self.most, self.attained, self.last, self.worst = cost, 0, -1, []
        if rank != self.last:  # several policies may cost the most in one world
            self.last = rank
            self.attained += 1
            if len(self.worst) < KEPT_WORLDS:
                self.worst.append(rank)

    def totals(self, edges: int) -> CostTotals:
        """The counts as a value."""
        worst = tuple(f"m{edges}/{rank}" for rank in self.worst)
        return CostTotals(self.runs, self.total, self.most, self.attained, worst)
