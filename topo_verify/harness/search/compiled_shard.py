"""Examines one shard by the compiled engine, and has the checkers judge a part of it again.

The engine runs the algorithms in every world of the shard and judges all claims there. It is not
trusted. The checkers judge again, from runs of the reference algorithms:

- the counterexamples that are kept, so each finding is one of the checkers;
- the worst worlds of the shard;
- a sample of about one world in `SAMPLE`, drawn by the plan's seed.

In these worlds both engines must agree: on the status of each claim and how much it rests on, on
the cost, and on every event of the run. If they do not, that is a bug of ours, and the search ends.

What this does not show: the other worlds were judged by the engine alone. If it is wrong in a share
p of all worlds, n sampled worlds show it with a probability of 1 - (1 - p)^n.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain
from time import process_time
from typing import TYPE_CHECKING

import msgspec

from topo_verify.checkers import CLAIMS
from topo_verify.errors import InternalError
from topo_verify.harness.judge import Report, judge
from topo_verify.harness.run import Exploration, explore
from topo_verify.harness.search.by_checkers import examine_by_checkers
from topo_verify.harness.search.plan import Plan, Shard
from topo_verify.harness.tally import (
    KEPT_FINDINGS,
    KEPT_RUNS,
    KEPT_WORLDS,
    CostComparison,
    CostPair,
    CostTotals,
    Failing,
    Failure,
    Tally,
)
from topo_verify.harness.worker import Beat
from topo_verify.programs.loader import Target
from topo_verify.world.rooted_map import World

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from topo_verify.compiled.shard import ShardCounts

JUDGED_BY = (
    "the compiled engine; every counterexample, the worst worlds and a seeded sample of 1 in 1,000"
    " by the checkers"
)
"""Who judged the worlds of a search by the compiled engine."""

SAMPLE = 1000
"""About one world in so many is judged by the checkers as well."""

SLICE = 50_000
"""So many ranks are examined between two heartbeats."""


class EngineSeconds(msgspec.Struct, frozen=True):
    """Seconds of processor time: in the compiled engine, and in the checkers."""

    engine: float = 0.0
    checkers: float = 0.0

    def __add__(self, other: EngineSeconds) -> EngineSeconds:
        return EngineSeconds(self.engine + other.engine, self.checkers + other.checkers)


def warm(plan: Plan) -> None:
    """Have the kernels compiled that a search needs, or loaded from the cache."""
    from topo_verify.compiled.explore import run_world

    _counted(plan, Shard(1, 0, 2))
    run_world(World.from_id("m1/0"), plan.targets[0], trace=True)


class CompiledShard:
    """The examination of one shard. Life cycle: `examine`, once; `tally` at any time.

    Attributes:
        seconds: what it took.
    """

    def __init__(self, plan: Plan, mappers: Sequence[Target], shard: Shard) -> None:
        self._plan, self._mappers, self._shard = plan, mappers, shard
        self._tally = Tally()
        self._checked: set[int] = set()
        self.seconds = EngineSeconds()

    def tally(self) -> Tally:
        """The tally of the worlds that were examined."""
        return msgspec.structs.replace(self._tally, by_checkers=len(self._checked))

    def examine(self, beat: Beat) -> None:
        """Examine the shard; a plan that does not keep going ends at its first failing world.

        Raises:
            InternalError: the engines disagree in a world.
        """
        shard, stop = self._shard, self._shard.stop
        for start in range(shard.start, shard.stop, SLICE):
            beat(self._tally.worlds)
            self._tally += self._slice(Shard(shard.edges, start, min(start + SLICE, stop)))
            if self._tally.failing and not self._plan.keep_going:
                stop = self._tally.failures[0].rank + 1
                break
        for rank in chain(self._worst(), self._sampled(stop)):
            beat(self._tally.worlds)
            for target in self._mappers:
                self._agreed(target, rank)

    def _slice(self, ranks: Shard) -> Tally:
        """The tally of some worlds, by the engine, with the findings of the checkers."""
        begin = process_time()
        counts = _counted(self._plan, ranks)
        self.seconds += EngineSeconds(engine=process_time() - begin)
        if any(one.undecided for one in counts):
            return self._undecided(ranks)
        found = [f for one in counts for f in self._failures(one)]
        return _as_tally(self._plan, ranks.edges, counts, found)

    def _undecided(self, ranks: Shard) -> Tally:
        """The tally of worlds among which the engine could not decide one: the checkers do that."""
        middle = (ranks.start + ranks.stop) // 2
        if middle > ranks.start:
            first = self._slice(Shard(ranks.edges, ranks.start, middle))
            if first.failing and not self._plan.keep_going:
                return first
            return first + self._slice(Shard(ranks.edges, middle, ranks.stop))
        self._checked.add(ranks.start)
        return examine_by_checkers(self._plan, self._mappers, ranks)

    # ------------------------------------------------------------ by the checkers

    def _failures(self, counts: ShardCounts) -> Iterator[tuple[int, Failure]]:
        """The first failing runs of an algorithm and the first of each claim, with findings."""
        (target,) = (one for one in self._mappers if one.text == counts.algorithm)
        firsts = {rank for failing, rank in counts.claims.values() if failing}
        for rank in sorted(firsts | {*counts.failing_ranks[:KEPT_RUNS]}):
            report = self._agreed(target, rank)
            yield rank, Failure(self._shard.edges, rank, target.text, report.findings)

    def _worst(self) -> list[int]:
        """The ranks of the worst worlds."""
        worlds = (world for costs in self._tally.costs.values() for world in costs.worst)
        return sorted({int(world.partition("/")[2]) for world in worlds})

    def _sampled(self, stop: int) -> Iterator[int]:
        """The ranks of the sampled worlds of the shard, below a rank."""
        import numpy as np

        from topo_verify.compiled.enumeration import ranked_tables

        edges, start, kind = self._shard.edges, self._shard.start, self._plan.world_class
        for begin in range(start, stop, SLICE):
            end = min(begin + SLICE, stop)
            if self._plan.kind == "any":
                ranks = np.arange(begin, end, dtype=np.uint64)
            else:
                listed = ranked_tables(edges, kind, begin, end)
                ranks = np.fromiter((rank for rank, _ in listed), np.uint64)
            drawn = _mixed(ranks, self._plan.seed, edges) % np.uint64(SAMPLE) == 0
            yield from ranks[drawn].tolist()

    def _agreed(self, target: Target, rank: int) -> Report:
        """The checkers' report on a run, after a comparison with the engine's.

        Raises:
            InternalError: they differ.
        """
        begin = process_time()
        self._checked.add(rank)
        edges = self._shard.edges
        world = World.from_id(f"m{edges}/{rank}")
        run = explore(world, target, limits=self._plan.limits)
        report = judge(run, options=self._plan.limits.options)
        (counts,) = (
            one
            for one in _counted(self._plan, Shard(edges, rank, rank + 1))
            if one.algorithm == target.text
        )
        made = explore(world, target.text, limits=self._plan.limits, engine="compiled")
        difference = _difference(run, report, made, counts)
        if difference is not None:
            raise InternalError(
                f"m{edges}/{rank}, {target.text}: the engines disagree: {difference}"
            )
        self.seconds += EngineSeconds(checkers=process_time() - begin)
        return report


def _counted(plan: Plan, ranks: Shard) -> Sequence[ShardCounts]:
    """What the engine counts in some worlds, by algorithm."""
    from topo_verify.compiled.shard import examine_range

    return examine_range(
        plan.targets,
        ranks.edges,
        plan.kind,
        ranks.start,
        ranks.stop,
        stop_at_first=not plan.keep_going,
    )


def _mixed(ranks: NDArray[np.uint64], seed: int, edges: int) -> NDArray[np.uint64]:
    """Evenly distributed numbers, one a rank, drawn by a seed: splitmix64."""
    import numpy as np

    odd = 0x9E3779B97F4A7C15
    mixed = ranks * np.uint64(odd) + np.uint64((seed * 1_000_003 + edges) * odd % (1 << 64))
    for shift, factor in ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB)):
        mixed = (mixed ^ (mixed >> np.uint64(shift))) * np.uint64(factor)
    return mixed ^ (mixed >> np.uint64(31))


def _difference(
    run: Exploration, report: Report, made: Exploration, counts: ShardCounts
) -> str | None:
    """What the engines disagree on, or None.

    Args:
        run, report: of the reference, with the checkers' judgement.
        made: the run of the compiled engine.
        counts: its judgement.
    """
    if (run.cost, run.map is None) != (made.cost, made.map is None):
        return f"cost {run.cost} by the reference, {made.cost} by the compiled engine"
    for at, (ours, theirs) in enumerate(zip(run.trace, made.trace, strict=False)):
        if ours != theirs:
            return f"event {at} is {ours} by the reference, {theirs} by the compiled engine"
    if len(run.trace) != len(made.trace):
        return f"{len(run.trace)} events by the reference, {len(made.trace)} by the compiled engine"
    if report.ok == bool(counts.failing):
        words = ("a claim fails", "no claim fails")
        return f"{words[report.ok]} by the checkers, {words[not report.ok]} by the compiled engine"
    for judgement in report.judgements:
        claim = judgement.claim
        seen = [status for status, runs in counts.statuses[claim].items() if runs]
        judged = f"{judgement.status} ({judgement.judged} of {judgement.of})"
        other = "{} ({} of {})".format(", ".join(seen), *counts.shares[claim])
        if judged != other:
            return f"{claim} is {judged} by the checkers, {other} by the compiled engine"
    return None


# ---------------------------------------------------------------- counts as a tally


def _as_tally(
    plan: Plan, edges: int, counts: Sequence[ShardCounts], found: list[tuple[int, Failure]]
) -> Tally:
    """The counts of all algorithms in the same worlds as a tally.

    Args:
        found: failing runs with their ranks.
    """
    place = {text: number for number, text in enumerate(plan.targets)}
    found = sorted(found, key=lambda one: (one[0], place[one[1].target]))
    kept = [
        msgspec.structs.replace(failure, findings=failure.findings[:KEPT_FINDINGS])
        for _, failure in found[:KEPT_RUNS]
    ]
    statuses: dict[str, dict[str, int]] = {claim: {} for claim in CLAIMS}
    for one in counts:
        for claim, seen in one.statuses.items():
            for status, runs in seen.items():
                if runs:
                    statuses[claim][status] = statuses[claim].get(status, 0) + runs
    return Tally(
        worlds=max(one.worlds for one in counts),
        failing=sum(one.newly_failing for one in counts),
        statuses=statuses,
        claims=_claims(counts, found),
        failures=tuple(kept),
        costs={one.algorithm: _costs(edges, one) for one in counts if one.worlds > one.failing},
        compared=_compared(edges, counts),
        # In the highest 64 of 256 bits, where sums of digests wrap around as the engine's do.
        digest=f"{sum(one.digest for one in counts) % (1 << 64) << 192:064x}",
        shares={
            claim: (
                sum(one.shares[claim][0] for one in counts),
                sum(one.shares[claim][1] for one in counts),
            )
            for claim in CLAIMS
        },
    )


def _claims(
    counts: Sequence[ShardCounts], found: Sequence[tuple[int, Failure]]
) -> dict[str, Failing]:
    """The claims that fail: in how many worlds for some algorithm, and the first failing run.

    Args:
        found: failing runs, by rank and algorithm; of each claim and algorithm the first is there.
    """
    claims: dict[str, Failing] = {}
    for _, failure in found:
        for claim in dict.fromkeys(finding.claim for finding in failure.findings):
            if claim not in claims:
                findings = tuple(f for f in failure.findings if f.claim == claim)
                smallest = msgspec.structs.replace(failure, findings=findings[:KEPT_FINDINGS])
                worlds = sum(one.newly_failing_claims[claim] for one in counts)
                claims[claim] = Failing(worlds, smallest)
    return claims


def _compared(edges: int, counts: Sequence[ShardCounts]) -> CostComparison:
    """The costs of the first algorithm beside those of the second, where there are two."""
    if len(counts) != 2:
        return CostComparison()
    one = counts[0]
    pairs = (CostPair(f"m{edges}/{rank}", cost, other) for rank, cost, other in one.dearer_worlds)
    return CostComparison(one.dearer, one.cheaper, one.excess, tuple(pairs)[:KEPT_WORLDS])


def _costs(edges: int, counts: ShardCounts) -> CostTotals:
    return CostTotals(
        runs=counts.worlds - counts.failing,
        total=counts.total,
        most=counts.most,
        attained=counts.attained,
        worst=tuple(f"m{edges}/{rank}" for rank in counts.worst),
    )
