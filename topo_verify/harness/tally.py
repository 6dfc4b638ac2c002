"""Tallies: what runs judged in worlds came to, as values that add up in the order of the worlds.

A `Tally` of some worlds and a `Tally` of the worlds behind them make one of both (`+`). Of failures
and of expensive worlds a tally keeps the first few, in the order of the worlds, and counts the
rest, so it stays small however many worlds it is about. Tallies travel between processes and lie in
the ledger as JSON: the names of their fields are part of that format.

`search/tallier.py` makes the tally of worlds that have a rank. What it counts is counted
by `RunCounts`, which does without ranks: a drawn world of a hundred edges has none that can be
computed.

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
from topo_verify.harness.observed import Observation, added, sampled
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


class PolicyCosts(msgspec.Struct, frozen=True):
    """What any policy of pick and order can cost, in edge traversals, over some worlds.

    Attributes:
        worlds: in how many worlds no claim fails, whatever is chosen; the rest is about them.
        states, choices: how many states have more than one way, and how many ways they have.
        cheapest, dearest: sums of the least and of the most that a run can cost in each world.
        reference: the sum of what the reference policies cost.
        most_saved: where the cheapest run saves the greatest share of the reference cost.
    """

    worlds: int = 0
    states: int = 0
    choices: int = 0
    cheapest: int = 0
    reference: int = 0
    dearest: int = 0
    most_saved: CostPair | None = None

    def __add__(self, other: PolicyCosts) -> PolicyCosts:
        pairs = [one for one in (self.most_saved, other.most_saved) if one is not None]
        return PolicyCosts(
            self.worlds + other.worlds,
            self.states + other.states,
            self.choices + other.choices,
            self.cheapest + other.cheapest,
            self.reference + other.reference,
            self.dearest + other.dearest,
            max(pairs, key=lambda pair: 1 - pair.other / pair.cost, default=None),
        )


class LostWorker(msgspec.Struct, frozen=True):
    """A worker that was lost in a world in which nothing went wrong when it was tried again.

    Attributes:
        edges, rank: of the world.
        how: what became of the worker, as `signal 9`.
    """

    edges: int
    rank: int
    how: str

    @property
    def world(self) -> str:
        """The id of the world."""
        return f"m{self.edges}/{self.rank}"


class Tally(msgspec.Struct, frozen=True):
    """What runs judged in some worlds came to.

    Attributes:
        worlds: in how many worlds mappers ran.
        undecided: in how many of them a run was undecided, and nothing else is wrong.
        failing: in how many a claim fails.
        timeouts: how many runs a time limit ended.
        statuses: for each claim, how many runs have which status.
        shares: for each claim, how much was judged in all runs together, of how much.
        policy_costs: of each mapper that was searched with every choice.
        claims: the claims that fail.
        failures: the first failing runs.
        costs: of each mapper.
        compared: the first mapper with the second, where there are two.
        digest: a hash of what happened in every world; `observed.py`.
        sample: some of the failing worlds and some of the others, to be run again.
        lost: workers that a stranger may have killed.
        by_checkers: in how many worlds the checkers judged again what another engine had judged.
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
    digest: str = ""
    sample: tuple[Observation, ...] = ()
    lost: tuple[LostWorker, ...] = ()
    shares: dict[str, tuple[int, int]] = {}
    policy_costs: dict[str, PolicyCosts] = {}
    by_checkers: int = 0

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
        policy_costs = dict(self.policy_costs)
        for target, found in behind.policy_costs.items():
            policy_costs[target] = policy_costs.get(target, PolicyCosts()) + found
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
            added(self.digest, behind.digest),
            sampled(self.sample + behind.sample),
            self.lost + behind.lost,
            {claim: self._share(claim, behind) for claim in {**self.shares, **behind.shares}},
            policy_costs,
            self.by_checkers + behind.by_checkers,
        )

    def _share(self, claim: str, behind: Tally) -> tuple[int, int]:
        pairs = zip(self.shares.get(claim, (0, 0)), behind.shares.get(claim, (0, 0)), strict=True)
        judged, of = (one + other for one, other in pairs)
        return judged, of


def with_failure(tally: Tally, failure: Tally) -> Tally:
    """A tally with a failure in one of its worlds that was found in another way.

    Args:
        failure: a tally of nothing but this failure.
    """
    both = tally + failure

    def place(one: Failure) -> tuple[int, int]:
        return one.edges, one.rank

    claims = {
        claim: Failing(
            failing.worlds,
            min(
                (t.claims[claim].smallest for t in (tally, failure) if claim in t.claims),
                key=place,
            ),
        )
        for claim, failing in both.claims.items()
    }
    failures = tuple(sorted(tally.failures + failure.failures, key=place)[:KEPT_RUNS])
    return msgspec.structs.replace(both, claims=claims, failures=failures)


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
    worst: tuple[Status, ...] = ("failed", "undecided")
    alike: tuple[Status, ...] = ("ok", "not-declared", "not-asked")
    for status in worst:
        if status in seen:
            return status
    for status in alike:
        if seen == {status}:
            return status
    return "partial"
