"""The search: a mapper in every world of a class, up to the smallest counterexample or EXHAUSTED.

`search` does it in one call. `Search` offers the same in steps: it has a ledger, and keeps what was
found when it is cut off.

The worlds are cut into shards by rank. Shards may be examined in any order, by any process; their
tallies are added up in the order of the ranks, and a search that stops at the first counterexample
counts nothing behind it. So the result depends on the plan alone, not on the speed of workers.

EXHAUSTED compares two numbers that are computed apart: in how many worlds mappers ran, and how many
there are (`WorldClass.count`). If they differ at the end of a search, that is a bug of ours.
"""

from __future__ import annotations

from collections.abc import Generator, Iterator, Sequence
from contextlib import closing, nullcontext

import msgspec

from topo_verify.checkers.findings import Verdict
from topo_verify.errors import InputError, InternalError
from topo_verify.harness.cluster import Cluster, ClusterPool, both_given, connected
from topo_verify.harness.engines import Engine, require_compiled
from topo_verify.harness.ledger import Ledger
from topo_verify.harness.pool import Pool
from topo_verify.harness.progress import Progress, ProgressRate
from topo_verify.harness.search.again import (
    MOST,
    ROW,
    RunAgain,
    can_run_again,
    run_again,
    with_run_again,
)
from topo_verify.harness.search.by_checkers import Interrupted
from topo_verify.harness.search.choices import require_choices
from topo_verify.harness.search.compiled_shard import EngineSeconds, warm
from topo_verify.harness.search.identity import Identity
from topo_verify.harness.search.parallel import shard_work
from topo_verify.harness.search.plan import Choices, Plan, Shard
from topo_verify.harness.search.shard import ShardResult, examine_shard
from topo_verify.harness.tally import CostTotals, Failing, Failure, LostWorker, Tally
from topo_verify.harness.targets import one_target, targets
from topo_verify.programs.loader import Mapper, Target
from topo_verify.programs.program import Program
from topo_verify.robot.limits import Limits
from topo_verify.world.enumeration.classes import WorldClass


class Size(msgspec.Struct, frozen=True):
    """The result of a search in the worlds of one size.

    Attributes:
        checked: in how many worlds every run was judged; undecided worlds are left out.
        total: how many worlds there are.
        tally: everything else.
    """

    edges: int
    checked: int
    total: int
    tally: Tally

    @property
    def failing(self) -> int:
        """In how many worlds a claim fails."""
        return self.tally.failing


class SearchResult(msgspec.Struct, frozen=True):
    """The result of a search.

    Attributes:
        plan: what was searched.
        verdict: EXHAUSTED if every world of the class was checked and no claim failed.
        checked, total: worlds.
        counterexample: the smallest, by (edges, rank).
        by_edges: by size of the worlds.
        claims: of each claim that fails, in how many worlds, and the smallest.
        from_ledger: in how many worlds mappers ran before, as a ledger says; in the rest, now.
        lost: workers that a stranger may have killed.
        again: what came of the worlds that were run again; None: none were.
    """

    plan: Plan
    verdict: Verdict
    checked: int
    total: int
    counterexample: Failure | None
    by_edges: tuple[Size, ...]
    claims: dict[str, Failing]
    from_ledger: int = 0
    lost: tuple[LostWorker, ...] = ()
    again: RunAgain | None = None

    @property
    def tally(self) -> Tally:
        """The tally of all sizes together."""
        return sum((size.tally for size in self.by_edges), Tally())

    def costs(self, edges: int, target: str) -> CostTotals:
        """The costs of a mapper in the worlds of one size."""
        return self.by_edges[edges - 1].tally.costs.get(target, CostTotals())


def search(  # noqa: PLR0913  an argument an option
    target: Mapper | str | Target,
    *,
    edges: int,
    world_class: WorldClass | None = None,
    keep_going: bool = False,
    policies: Choices = "reference",
    limits: Limits | None = None,
    workers: int = 0,
    dask: str | None = None,
    engine: Engine = "reference",
    tell: Progress | None = None,
) -> SearchResult:
    """Examine a mapper in every world of a class with 1 … `edges` edges, smallest first.

    Args:
        target: a callable, a name of the catalogue, any other TARGET. A text that names several
            lets them run in each world together.
        world_class: default: all worlds.
        keep_going: do not stop at the first counterexample.
        policies: which choices an algorithm of the catalogue is tried with; `choices.py`.
        limits: of each run.
        workers: so many processes; 0: this one. Other processes are handed the TARGET's text.
        dask: the address of a Dask scheduler, or `local`: its workers in place of processes here.
        engine: what runs algorithms of the catalogue; `compiled_shard.py`.
        tell: the progress callback.
    Raises:
        InputError: no such mapper; nothing knows how many worlds the class has; and the like.
        InternalError: mappers ran in another number of worlds than there are.
    """
    mappers = _targets(target)
    if workers and dask is not None:
        raise both_given(dask, workers)
    if (workers or dask is not None) and not isinstance(target, str):
        _require_texts(mappers)
    plan = Plan(
        targets=tuple(mapper.text for mapper in mappers),
        edges=edges,
        kind=str(world_class or WorldClass()),
        choices=policies,
        keep_going=keep_going,
        limits=limits or Limits(),
        engine=engine,
    )
    with nullcontext() if dask is None else connected(dask) as cluster:
        work = Search(plan, mappers, workers=workers, cluster=cluster)
        work.work(tell)
    if isinstance(target, str):
        work.run_again(tell)
    return work.found()


def _targets(target: Mapper | str | Target) -> tuple[Target, ...]:
    return targets(target) if isinstance(target, str) else (one_target(target),)


def _require_texts(mappers: Sequence[Target]) -> None:
    """Raise an InputError unless other processes can find these mappers by their texts."""
    for mapper in mappers:
        if isinstance(mapper.mapper, Program):
            continue
        try:
            found = one_target(mapper.text).mapper
        except InputError as error:
            raise InputError(
                f"{mapper.text} cannot be handed to workers, which find a mapper by its TARGET"
                f" ({error}): search in this process (workers=0)"
            ) from None
        if found != mapper.mapper and ".py:" not in mapper.text:
            raise InputError(
                f"{mapper.text} names another mapper than the one given, and workers find a mapper"
                " by its TARGET: search in this process (workers=0)"
            )


class Search:
    """A search in steps. Life cycle: `work`, then `found`, also if the work was cut off.

    Args:
        mappers: the targets of the plan, as they run in this process.
        workers: so many processes; 0: this one.
        cluster: does the work in place of processes of this machine.
        ledger: has the tallies of finished shards, and is given those of new ones.
        identity: what the mappers rest on, if there is a ledger.
    Attributes:
        seconds: what the compiled engine and the checkers took, if that engine is the plan's.
    Raises:
        InputError: nothing knows how many worlds there are; a mapper has no such policies, or the
            engine cannot run it; workers for a mapper that has no text.
    """

    def __init__(
        self,
        plan: Plan,
        mappers: Sequence[Target],
        *,
        workers: int = 0,
        cluster: Cluster | None = None,
        ledger: Ledger | None = None,
        identity: Identity | None = None,
    ) -> None:
        require_choices(mappers, plan)
        if plan.engine == "compiled":
            require_compiled(mappers, plan.limits)
            if plan.limits.budget is not None:
                raise InputError(
                    f"--engine compiled searches with the bound of claim 7 as its budget, got"
                    f" --budget {plan.limits.budget}: leave out --budget, or --engine"
                )
        self.plan, self.mappers, self.workers, self.ledger = plan, mappers, workers, ledger
        self.cluster = cluster
        self.identity = Identity(mappers) if identity is None and ledger is not None else identity
        self.totals = plan.totals()
        self.tallies = dict.fromkeys(self.totals, Tally())
        self.from_ledger = 0
        self.again: RunAgain | None = None
        self.seconds = EngineSeconds()

    def run_again(self, tell: Progress | None = None) -> None:
        """Run some worlds again, each in a fresh process, if there is a TARGET to start it from."""
        if can_run_again(self.mappers):
            rate = ProgressRate(f"{self.plan.targets[0]}, again", 2 * MOST + 1 + ROW, tell)
            self.again = run_again(self.plan, self._tally(), rate.in_flight)

    def _tally(self) -> Tally:
        return sum(self.tallies.values(), Tally())

    def work(self, tell: Progress | None = None) -> None:
        """Examine the shards until the end, or as far as the plan says.

        Raises:
            KeyboardInterrupt: Ctrl-C; `found` has what was found before.
            InternalError: mappers ran in another number of worlds than there are.
        """
        rate = ProgressRate(", ".join(self.plan.targets), sum(self.totals.values()), tell)
        timeouts = 0
        rate.in_flight(0)
        if self.plan.engine == "compiled" and (self.cluster is None or self.cluster.is_local):
            warm(self.plan)  # here, before the workers start, which then find it in the cache
        if self.ledger is not None:
            self._examine_again(self.ledger)
        try:
            with closing(self._in_order(rate)) as tallies:
                for shard, tally in tallies:
                    self.tallies[shard.edges] += tally
                    if tally.failing and not self.plan.keep_going:
                        return
                    timeouts += tally.timeouts
                    if self.plan.max_timeouts is not None and timeouts >= self.plan.max_timeouts:
                        return
        except Interrupted as cut:
            edges = next(m for m, worlds in self.totals.items() if self.tallies[m].worlds < worlds)
            self.tallies[edges] += cut.tally
            raise
        if self.ledger is not None:
            self.ledger.require_file()
        self._require_all()

    def _in_order(self, rate: ProgressRate) -> Generator[tuple[Shard, Tally]]:
        """Every shard and its tally, in the order of their worlds."""
        ahead: dict[Shard, Tally] = {}  # finished, but not all shards before them are
        enough = False  # a shard fails: what is not begun lies behind it and does not matter

        def todo() -> Iterator[Shard]:
            for shard in self.plan.shards():
                if enough:
                    return
                if self._known(shard) is None:
                    yield shard

        with closing(self._executed(todo(), rate)) as executed:
            for shard in self.plan.shards():
                tally = ahead.pop(shard, None)
                if tally is None and (tally := self._known(shard)) is not None:
                    rate.known(tally.worlds)
                    self.from_ledger += tally.worlds
                while tally is None:
                    done, found = next(executed)
                    result = found.tally
                    self.seconds += found.seconds or EngineSeconds()
                    # A shard in which a stranger may have killed a worker is tried anew next time.
                    if self.ledger is not None and not result.lost:
                        self.ledger.put(done, result, found.loaded)
                    enough = enough or (result.failing > 0 and not self.plan.keep_going)
                    rate.finished(result.worlds)
                    ahead[done] = result
                    tally = ahead.pop(shard, None)
                yield shard, tally

    def _known(self, shard: Shard) -> Tally | None:
        """The tally of a shard that the ledger has; None if it has none."""
        tally = None if self.ledger is None else self.ledger.get(shard)
        if tally is None:
            return None
        # A search of smaller worlds alone kept more of them.
        sample = tuple(filter(self.plan.sampler.wants, tally.sample))
        return msgspec.structs.replace(tally, sample=sample)

    def _executed(
        self, todo: Iterator[Shard], rate: ProgressRate | None = None
    ) -> Generator[tuple[Shard, ShardResult]]:
        """Shards and their results, as they are finished, here or in other processes."""
        beat = None if rate is None else rate.in_flight
        depends = None if self.identity is None else self.identity.depends
        if self.cluster is not None:
            work = shard_work(self.plan, self.mappers, depends)
            with ClusterPool(self.cluster, work) as cluster:
                yield from cluster.run(todo)
        elif self.workers:
            work = shard_work(self.plan, self.mappers, depends)
            with Pool(work, self.workers, in_flight=beat) as pool:
                yield from pool.run(todo)
        else:
            for shard in todo:
                found = examine_shard(self.plan, self.mappers, shard, beat)
                loaded = None if self.identity is None else self.identity.loaded()
                yield shard, msgspec.structs.replace(found, loaded=loaded)

    def _examine_again(self, ledger: Ledger) -> None:
        """Examine some of the ledger's shards, and compare.

        No list of what a mapper rests on is complete, so the ledger is tried as well.

        Raises:
            InputError: in a world something else happened than the ledger says.
        """
        with closing(self._executed(ledger.to_examine_again())) as executed:
            for shard, result in executed:
                known = ledger.get(shard)
                if known is not None and known.digest != result.tally.digest:
                    raise InputError(
                        f"ledger {ledger.path}: examined again, some world of m{shard.edges}/"
                        f"{shard.start} … {shard.stop - 1} has another verdict, other doors or"
                        " another cost than recorded. The mapper or something that it depends on"
                        " has changed, or it does not do the same each time: remove the ledger and"
                        " search anew"
                    )

    def _require_all(self) -> None:
        """Raise an InternalError if mappers did not run in as many worlds as there are."""
        for edges, total in self.totals.items():
            if self.tallies[edges].worlds != total:
                raise InternalError(
                    f"the search ran mappers in {self.tallies[edges].worlds} worlds of class"
                    f" {self.plan.kind} where m = {edges}, and there are {total}"
                )

    def found(self) -> SearchResult:
        """The result so far."""
        sizes = tuple(
            Size(
                edges,
                self.tallies[edges].worlds - self.tallies[edges].undecided,
                total,
                self.tallies[edges],
            )
            for edges, total in self.totals.items()
        )
        tally = self._tally()
        if self.again is not None:
            tally = with_run_again(tally, self.again)
        checked, total = sum(size.checked for size in sizes), sum(self.totals.values())
        verdict: Verdict = "REFUTED" if tally.failures else "UNKNOWN"
        others = self.again is not None and self.again.others
        if checked == total and not (tally.failures or tally.lost or others):
            verdict = "EXHAUSTED"
        return SearchResult(
            plan=self.plan,
            verdict=verdict,
            checked=checked,
            total=total,
            counterexample=tally.failures[0] if tally.failures else None,
            by_edges=sizes,
            claims=tally.claims,
            from_ledger=self.from_ledger,
            lost=tally.lost,
            again=self.again,
        )
