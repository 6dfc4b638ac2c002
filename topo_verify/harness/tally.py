"""Tallies: what runs judged in worlds came to, as values that add up in the order of the worlds.

A `Tally` of some worlds and a `Tally` of the worlds behind them make one of both (`+`). Of failures
and of expensive worlds a tally keeps the first few, in the order of the worlds, and counts the
rest, so it stays small however many worlds it is about. Tallies travel between processes and lie in
the ledger as JSON: the names of their fields are part of that format.

A `Tallier` makes the tally of worlds that have a rank. What it counts is counted by `RunCounts`,
which does without ranks: a drawn world of a hundred edges has none that can be computed.

Two other counts stand apart, for they are of other things: `conform` counts the states of a world
on each of its levels, `compare` the kinds of change between two runs.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import msgspec

from topo_verify.checkers import CLAIMS, Finding, Judgement, Status
from topo_verify.harness.judge import Report, undecided
from topo_verify.harness.run import Exploration

KEPT_RUNS, KEPT_FINDINGS = 3, 5
"""How many failing runs are kept, and how many findings of each."""

KEPT_WORLDS = 10
"""How many of the worlds that have something in common are named; all are counted."""


class Failure(msgspec.Struct, frozen=True):
    """A run in which a claim fails: a counterexample.

    Attributes:
        edges, rank: of the world.
        target: the mapper.
        findings: what is wrong, at most `KEPT_FINDINGS`, in the order of the claims.
    """

    edges: int
    rank: int
    target: str
    findings: tuple[Finding, ...]

    @property
    def world(self) -> str:
        """The id of the world."""
        return f"m{self.edges}/{self.rank}"

    @property
    def claim(self) -> str:
        """The first claim that fails."""
        return self.findings[0].claim

    @property
    def message(self) -> str:
        """What is wrong, in one sentence."""
        return self.findings[0].message

    @property
    def replay(self) -> str:
        """The command line that shows the run again."""
        return self.findings[0].replay


class Failing(msgspec.Struct, frozen=True):
    """In how many worlds a claim fails, and the smallest of them."""

    worlds: int
    smallest: Failure

    def __add__(self, other: Failing) -> Failing:
        return Failing(self.worlds + other.worlds, self.smallest)


class CostTotals(msgspec.Struct, frozen=True):
    """Costs of the runs in which no claim fails, in edge traversals.

    Attributes:
        runs, total: how many runs, and the sum of their costs.
        most: the highest cost.
        attained: in how many worlds a run costs that much.
        worst: the ids of the first of these worlds.
    """

    runs: int = 0
    total: int = 0
    most: int = 0
    attained: int = 0
    worst: tuple[str, ...] = ()

    def __add__(self, other: CostTotals) -> CostTotals:
        runs, total = self.runs + other.runs, self.total + other.total
        if self.most != other.most:
            dearest = max(self, other, key=lambda costs: costs.most)
            return CostTotals(runs, total, dearest.most, dearest.attained, dearest.worst)
        worst = tuple(dict.fromkeys(self.worst + other.worst))[:KEPT_WORLDS]
        return CostTotals(runs, total, self.most, self.attained + other.attained, worst)


class CostPair(msgspec.Struct, frozen=True):
    """A world in which the first mapper costs more than the second."""

    world: str
    cost: int
    other: int


class CostComparison(msgspec.Struct, frozen=True):
    """The costs of two mappers in the same worlds.

    Attributes:
        dearer, cheaper: in how many worlds the first costs more, less, than the second.
        most: the largest excess.
        first: the first worlds in which it costs more.
    """

    dearer: int = 0
    cheaper: int = 0
    most: int = 0
    first: tuple[CostPair, ...] = ()

    def __add__(self, other: CostComparison) -> CostComparison:
        return CostComparison(
            self.dearer + other.dearer,
            self.cheaper + other.cheaper,
            max(self.most, other.most),
            (self.first + other.first)[:KEPT_WORLDS],
        )


class Tally(msgspec.Struct, frozen=True):
    """What runs judged in some worlds came to.

    Attributes:
        worlds: in how many worlds mappers ran.
        undecided: in how many of them a run was undecided, and nothing else is wrong.
        failing: in how many a claim fails.
        timeouts: how many runs a time limit ended.
        statuses: for each claim, how many runs have which status.
        shares: for each claim, how much was judged in all runs together, of how much.
        claims: the claims that fail.
        failures: the first failing runs.
        costs: of each mapper.
        compared: the first mapper with the second, where there are two.
    """

    worlds: int = 0
    undecided: int = 0
    failing: int = 0
    timeouts: int = 0
    statuses: dict[str, dict[str, int]] = {}
    claims: dict[str, Failing] = {}
    failures: tuple[Failure, ...] = ()
    costs: dict[str, CostTotals] = {}
    compared: CostComparison = CostComparison()
    shares: dict[str, tuple[int, int]] = {}

    def __add__(self, behind: Tally) -> Tally:
        statuses = {claim: dict(seen) for claim, seen in self.statuses.items()}
        for claim, seen in behind.statuses.items():
            row = statuses.setdefault(claim, {})
            for status, number in seen.items():
                row[status] = row.get(status, 0) + number
        claims, costs = dict(self.claims), dict(self.costs)
        for claim, failing in behind.claims.items():
            claims[claim] = claims[claim] + failing if claim in claims else failing
        for target, spent in behind.costs.items():
            costs[target] = costs.get(target, CostTotals()) + spent
        return Tally(
            self.worlds + behind.worlds,
            self.undecided + behind.undecided,
            self.failing + behind.failing,
            self.timeouts + behind.timeouts,
            statuses,
            claims,
            (self.failures + behind.failures)[:KEPT_RUNS],
            costs,
            self.compared + behind.compared,
            {claim: self._share(claim, behind) for claim in {**self.shares, **behind.shares}},
        )

    def _share(self, claim: str, behind: Tally) -> tuple[int, int]:
        pairs = zip(self.shares.get(claim, (0, 0)), behind.shares.get(claim, (0, 0)), strict=True)
        judged, of = (one + other for one, other in pairs)
        return judged, of


# ---------------------------------------------------------------- counting


@dataclass
class RunCounts:
    """Counts runs judged in worlds. Life cycle: `enter` every run in a world, `close` the world.

    Attributes:
        worlds, failing, undecided, timeouts: as in a `Tally`.
        late_runs: how many runs were out of time and say nothing else.
    """

    worlds: int = 0
    failing: int = 0
    undecided: int = 0
    timeouts: int = 0
    late_runs: int = 0
    # Counting whole rows of statuses is cheaper than counting ten claims in each run.
    _rows: Counter[tuple[str, ...]] = field(default_factory=Counter[tuple[str, ...]])
    _judged: Counter[str] = field(default_factory=Counter[str])
    _of: Counter[str] = field(default_factory=Counter[str])
    _fails: bool = False
    _open: bool = False

    def enter(self, run: Exploration, report: Report) -> bool:
        """Count a run; False: it was out of time, and nothing else of it counts."""
        self.timeouts += run.limit in ("move-timeout", "world-timeout")
        if undecided(run, report):
            self._open = True
            if not report.ok:
                self.late_runs += 1
                return False
        self._rows[tuple(report.claims.values())] += 1
        for judgement in report.judgements:
            self._judged[judgement.claim] += judgement.judged
            self._of[judgement.claim] += judgement.of
        self._fails |= not report.ok
        return True

    def close(self) -> bool:
        """Count the world, now that all its runs were entered; does a claim fail in it?"""
        fails = self._fails
        self.worlds += 1
        self.failing += fails
        self.undecided += self._open and not fails
        self._fails = self._open = False
        return fails

    def statuses(self) -> dict[str, dict[str, int]]:
        """For each claim, how many runs have which status."""
        statuses: dict[str, dict[str, int]] = {claim: {} for claim in CLAIMS}
        for row, runs in self._rows.items():
            for claim, status in zip(CLAIMS, row, strict=True):
                statuses[claim][status] = statuses[claim].get(status, 0) + runs
        return statuses

    def shares(self) -> dict[str, tuple[int, int]]:
        """For each claim, how much was judged in all runs together, of how much."""
        return {claim: (self._judged[claim], self._of[claim]) for claim in CLAIMS}


def joint_judgements(
    statuses: Mapping[str, Mapping[str, int]],
    shares: Mapping[str, tuple[int, int]],
    findings: Sequence[Finding],
) -> tuple[Judgement, ...]:
    """The judgement of each claim on many runs: `ok` only if it is `ok` in each."""
    return tuple(
        Judgement(
            claim,
            joint_status(statuses[claim]),
            *shares.get(claim, (0, 0)),
            tuple(finding for finding in findings if finding.claim == claim),
        )
        for claim in CLAIMS
        if any(statuses.get(claim, {}).values())
    )


def joint_status(runs: Mapping[str, int]) -> Status:
    """The status of a claim in many runs, of which so many have each status."""
    seen = {status for status, number in runs.items() if number}
    for status in ("failed", "undecided"):
        if status in seen:
            return status
    alike: tuple[Status, ...] = ("ok", "not-declared", "not-asked")
    return next((status for status in alike if seen == {status}), "partial")


@dataclass
class Tallier:
    """Makes the tally of worlds of one size, which come in the order of their ranks.

    Life cycle: `open` a world, `enter` its runs, `close` it; `tally` at any time.

    Attributes:
        edges: the size of the worlds.
        targets: the mappers that run in each world; if they are two, their costs are compared.
    """

    edges: int
    targets: tuple[str, ...]
    counts: RunCounts = field(default_factory=RunCounts)
    _rank: int = -1
    _claims: dict[str, Failing] = field(default_factory=dict[str, Failing])
    _failures: list[Failure] = field(default_factory=list[Failure])
    _costs: dict[str, _CostCounts] = field(default_factory=dict[str, "_CostCounts"])
    _compared: CostComparison = field(default_factory=CostComparison)
    # of the world that is open: the first failure of each claim, and the costs
    _failed: dict[str, Failure] = field(default_factory=dict[str, Failure])
    _paid: dict[str, int] = field(default_factory=dict[str, int])

    def open(self, rank: int) -> None:
        """Go on to the next world."""
        self._rank, self._failed, self._paid = rank, {}, {}

    def enter(self, run: Exploration, report: Report) -> None:
        """Count a run in the open world."""
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
        return self.counts.close()

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
            shares=self.counts.shares(),
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
