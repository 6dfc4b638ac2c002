"""What an examination found, as values that add up in the order of the worlds.

A `Tally` of some worlds and a `Tally` of the worlds behind them make one of both (`+`). What is
kept of failures and of dear worlds is the smallest worlds, and few of them, so a tally stays small
however many worlds it is about. Tallies travel between processes and lie in the ledger as JSON.
"""

from __future__ import annotations

import msgspec

from topo_verify.checkers import Finding

KEPT_RUNS, KEPT_FINDINGS = 3, 5
"""Of how many failing runs findings are kept, and how many of each."""

KEPT_WORLDS = 10
"""Of the worlds that have something in common, so many are named; all are counted."""


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
        """The world's id."""
        return f"m{self.edges}/{self.rank}"

    @property
    def claim(self) -> str:
        """The first claim that fails."""
        return self.findings[0].claim

    @property
    def message(self) -> str:
        """One sentence."""
        return self.findings[0].message

    @property
    def replay(self) -> str:
        """The command line that shows it again."""
        return self.findings[0].replay


class Failing(msgspec.Struct, frozen=True):
    """In how many worlds a claim fails, and the smallest of them."""

    worlds: int
    smallest: Failure

    def __add__(self, other: Failing) -> Failing:
        return Failing(self.worlds + other.worlds, self.smallest)


class Costs(msgspec.Struct, frozen=True):
    """What runs in which no claim fails cost, in edge traversals.

    Attributes:
        runs, total: how many, and the sum of their costs.
        most: the highest cost.
        attained: in how many worlds.
        worst: the ids of the first of these.
    """

    runs: int = 0
    total: int = 0
    most: int = 0
    attained: int = 0
    worst: tuple[str, ...] = ()

    def __add__(self, other: Costs) -> Costs:
        runs, total = self.runs + other.runs, self.total + other.total
        if self.most != other.most:
            dear = max(self, other, key=lambda costs: costs.most)
            return Costs(runs, total, dear.most, dear.attained, dear.worst)
        worst = tuple(dict.fromkeys(self.worst + other.worst))[:KEPT_WORLDS]
        return Costs(runs, total, self.most, self.attained + other.attained, worst)


class Pair(msgspec.Struct, frozen=True):
    """A world in which the first mapper costs more than the second."""

    world: str
    cost: int
    other: int


class Compared(msgspec.Struct, frozen=True):
    """The costs of two mappers in the same worlds.

    Attributes:
        dearer, cheaper: in how many worlds the first costs more, less, than the second.
        most: the largest excess.
        first: the first worlds in which it costs more.
    """

    dearer: int = 0
    cheaper: int = 0
    most: int = 0
    first: tuple[Pair, ...] = ()

    def __add__(self, other: Compared) -> Compared:
        return Compared(
            self.dearer + other.dearer,
            self.cheaper + other.cheaper,
            max(self.most, other.most),
            (self.first + other.first)[:KEPT_WORLDS],
        )


class Tally(msgspec.Struct, frozen=True):
    """What was found in some worlds.

    Attributes:
        worlds: how many were gone into.
        undecided: in how many of them a run was out of time, and nothing else is wrong.
        failing: in how many a claim fails.
        timeouts: how many runs a time limit ended.
        statuses: of each claim, how many runs have which status.
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
    costs: dict[str, Costs] = {}
    compared: Compared = Compared()

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
            costs[target] = costs.get(target, Costs()) + spent
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
        )
