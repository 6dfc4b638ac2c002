"""One shard examined: every mapper in every world of it, every claim, one `Tally`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial

import msgspec

from topo_verify.checkers import CLAIMS
from topo_verify.harness.run import Exploration, Report, undecided
from topo_verify.harness.search.choices import examinations
from topo_verify.harness.search.plan import Plan, Shard
from topo_verify.harness.tally import (
    KEPT_FINDINGS,
    KEPT_RUNS,
    KEPT_WORLDS,
    Compared,
    Costs,
    Failing,
    Failure,
    Pair,
    Tally,
)
from topo_verify.programs.loading import Target
from topo_verify.world.enumeration.pruned import ranked_tables
from topo_verify.world.rooted_map import World

Beat = Callable[[int], None]
"""Called before each run and each judgement: how many worlds of the shard are done."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C in the middle of a shard; `tally` is what was found before."""

    def __init__(self, tally: Tally) -> None:
        super().__init__()
        self.tally = tally


def examine_shard(
    plan: Plan, mappers: Sequence[Target], shard: Shard, beat: Beat | None = None
) -> Tally:
    """Every mapper in every world of a shard, or to the first world in which a claim fails.

    Which of the two, the plan says.

    Raises:
        Interrupted: Ctrl-C.
    """
    books = _Books()
    texts = [target.text for target in mappers]
    try:
        for rank, table in ranked_tables(shard.edges, plan.world_class, shard.start, shard.stop):
            world = World.from_code(table)
            books.open(shard.edges, rank)
            for target in mappers:
                for run, report in examinations(target, plan, world, partial(_beat, beat, books)):
                    books.enter(run, report)
            if books.close(texts) and not plan.keep_going:
                break
            if books.timeouts == plan.patience:
                break
    except KeyboardInterrupt:
        raise Interrupted(_plain(books.tally())) from None
    return _plain(books.tally())


def _beat(beat: Beat | None, books: _Books) -> None:
    if beat is not None:
        beat(books.worlds)


def _plain(tally: Tally) -> Tally:
    """The same tally as it comes out of a ledger or another process: data, no mapper's objects."""
    return msgspec.json.decode(msgspec.json.encode(tally), type=Tally)


@dataclass
class _Books:
    """The books of one shard: `open` a world, `enter` its runs, `close` it; at last, `tally`."""

    edges: int = 0
    rank: int = 0
    worlds: int = 0
    undecided: int = 0
    failing: int = 0
    timeouts: int = 0
    patterns: Counter[tuple[str, ...]] = field(default_factory=Counter[tuple[str, ...]])
    claims: dict[str, Failing] = field(default_factory=dict[str, Failing])
    failures: list[Failure] = field(default_factory=list[Failure])
    costs: dict[str, _Spent] = field(default_factory=dict[str, "_Spent"])
    compared: Compared = field(default_factory=Compared)

    def open(self, edges: int, rank: int) -> None:
        """The next world."""
        self.edges, self.rank = edges, rank
        self._wrong: dict[str, Failure] = {}
        self._open_ended = False
        self._here: dict[str, int] = {}

    def enter(self, run: Exploration, report: Report) -> None:
        """A run in it."""
        self.timeouts += run.limit in ("move-timeout", "world-timeout")
        if undecided(run, report):
            self._open_ended = True
            return
        self.patterns[tuple(report.claims.values())] += 1
        if report.ok:
            spent = self.costs.setdefault(run.algorithm, _Spent())
            spent.enter(self.rank, run.cost)
            self._here[run.algorithm] = run.cost
            return
        findings = report.findings
        for claim in dict.fromkeys(finding.claim for finding in findings):
            first = tuple(f for f in findings if f.claim == claim)[:KEPT_FINDINGS]
            self._wrong.setdefault(claim, Failure(self.edges, self.rank, run.algorithm, first))
        if len(self.failures) < KEPT_RUNS:
            kept = findings[:KEPT_FINDINGS]
            self.failures.append(Failure(self.edges, self.rank, run.algorithm, kept))

    def close(self, targets: Sequence[str]) -> bool:
        """The world is done; does a claim fail in it?"""
        self.worlds += 1
        self.failing += bool(self._wrong)
        self.undecided += self._open_ended and not self._wrong
        for claim, failure in self._wrong.items():
            failing = Failing(1, failure)
            known = self.claims.get(claim)
            self.claims[claim] = failing if known is None else known + failing
        if len(targets) == 2 and len(self._here) == 2:
            self._compare(*(self._here[target] for target in targets))
        return bool(self._wrong)

    def _compare(self, cost: int, other: int) -> None:
        if cost != other:
            pair = (Pair(f"m{self.edges}/{self.rank}", cost, other),)
            dearer = cost > other
            self.compared += Compared(dearer, not dearer, max(0, cost - other), pair[: int(dearer)])

    def tally(self) -> Tally:
        """What stands in the books."""
        statuses: dict[str, dict[str, int]] = {claim: {} for claim in CLAIMS}
        for pattern, runs in self.patterns.items():
            for claim, status in zip(CLAIMS, pattern, strict=True):
                statuses[claim][status] = statuses[claim].get(status, 0) + runs
        return Tally(
            worlds=self.worlds,
            undecided=self.undecided,
            failing=self.failing,
            timeouts=self.timeouts,
            statuses=statuses,
            claims=self.claims,
            failures=tuple(self.failures),
            costs={target: spent.costs(self.edges) for target, spent in self.costs.items()},
            compared=self.compared,
        )


@dataclass
class _Spent:
    """What one mapper has spent so far; `worst` are ranks, the first that cost the most."""

    runs: int = 0
    total: int = 0
    most: int = 0
    attained: int = 0
    last: int = -1
    worst: list[int] = field(default_factory=list[int])

    def enter(self, rank: int, cost: int) -> None:
        """One run."""
        self.runs += 1
        self.total += cost
        if cost < self.most:
            return
        if cost > self.most or not self.worst:
            self.most, self.attained, self.last, self.worst = cost, 0, -1, []
        if rank != self.last:  # of several policies in one world, the first alone
            self.last = rank
            self.attained += 1
            if len(self.worst) < KEPT_WORLDS:
                self.worst.append(rank)

    def costs(self, edges: int) -> Costs:
        """As a value."""
        worst = tuple(f"m{edges}/{rank}" for rank in self.worst)
        return Costs(self.runs, self.total, self.most, self.attained, worst)
