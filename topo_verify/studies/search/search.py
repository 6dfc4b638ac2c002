"""The search: a mapper in every world of a class, up to the smallest counterexample or EXHAUSTED.

`search_campaign` makes the campaign, `Search.work` adds up its results by the number of edges, and
`Search.entry` derives the verdict. For EXHAUSTED two numbers must agree: of the worlds in which the
mapper ran, and of the worlds of the class, whose count does not use the enumeration of the search.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import nullcontext

import msgspec
from msgspec.structs import astuple

from topo_verify import extras
from topo_verify.campaign import campaign as c
from topo_verify.campaign.backend import Elsewhere, here, pooled
from topo_verify.campaign.drawn_row import is_of_catalogue
from topo_verify.campaign.engine import EngineSeconds, engine_of, usual_engine
from topo_verify.campaign.examiner import examiner_of
from topo_verify.campaign.judge import Report
from topo_verify.campaign.progress import Progress
from topo_verify.campaign.row import PolicyCosts, Row
from topo_verify.campaign.tally import KEPT_PAIRS, KEPT_WORST, Costs, Pairs, Tally, notable
from topo_verify.campaign.targets import is_found_again, one_target, targets
from topo_verify.checkers import Judgement
from topo_verify.checkers.findings import Verdict
from topo_verify.errors import InputError, InternalError, ShortTraceback, plural
from topo_verify.programs.loader import Mapper, Target, is_library
from topo_verify.programs.program import Program
from topo_verify.robot.limits import Limits, given_limits
from topo_verify.studies.search.again import CLAIM, Repetition, RunAgain
from topo_verify.studies.search.choices import SHARD, WAYS, Choices, require_choices
from topo_verify.studies.search.failing_run import LOOK, report_of
from topo_verify.studies.search.states.every import BY_EVERY_CLAIM, Decider
from topo_verify.world.enumeration.classes import WorldClass

DONE: tuple[Verdict, ...] = ("EXHAUSTED", "SAMPLED")
"""The verdicts of a completed search that refuted nothing."""


class Counterexample(msgspec.Struct, frozen=True):
    """A world in which a claim fails, and the command that shows it again."""

    world: str
    edges: int
    claim: str
    message: str
    replay: str


class FailingClaim(msgspec.Struct, frozen=True):
    """The number of worlds in which a claim fails, and the smallest."""

    claim: str
    failing: int
    smallest: Counterexample


class LostWorker(msgspec.Struct, frozen=True):
    """A world in which a worker was lost or stood still, and how; a second try went well."""

    world: str
    how: str


class UndecidedWorld(msgspec.Struct, frozen=True):
    """A world in which a run decides nothing, and why."""

    world: str
    why: str


class CostPair(msgspec.Struct, frozen=True):
    """A world in which the first mapper costs more than the second."""

    world: str
    cost: int
    other: int


class CostComparison(Pairs, frozen=True, kw_only=True):
    """The costs of two mappers in the same worlds.

    Attributes:
        dearer, cheaper: number of worlds where the first costs more, and less.
        most: the largest excess of the first.
        totals: what each costs in the worlds where it is right, in edge traversals.
        first: the first worlds in which it costs more.
    """

    totals: tuple[int, int]
    first: tuple[CostPair, ...]


class EveryCost(PolicyCosts, frozen=True, kw_only=True):
    """With --policies every: what any policy of pick and order can cost.

    Attributes:
        decided_by: who made the judged choices: the `mapper`.
        judged_by: what judged them.
    """

    decided_by: Decider
    judged_by: str


class ByEdges(msgspec.Struct, frozen=True):
    """The worlds of one size.

    Attributes:
        checked, total, failing, undecided: numbers of worlds.
        runs: the number of runs in which no claim fails; the costs are theirs.
        max_cost, total_cost: in edge traversals.
        attained: the number of worlds with the highest cost.
        worst: the first of these worlds.
        compare: with --compare, where A costs more than B, and where less.
        every: with --policies every, the range of the costs.
    """

    edges: int
    checked: int
    total: int
    failing: int
    undecided: int
    runs: int
    max_cost: int
    total_cost: int
    attained: int
    worst: tuple[str, ...]
    compare: CostComparison | None
    every: EveryCost | None


class SearchEntry(msgspec.Struct, frozen=True, rename={"kind": "class"}):
    """One search: an entry of `results`.

    Attributes:
        edges: the most edges of the worlds.
        checked: number of worlds in which every run was judged.
        counterexample: the smallest, by (edges, rank).
        claims: for each failing claim, the number of worlds, and the smallest.
        not_declared: the claims that no run declared anything about.
        from_ledger: number of worlds that the store has.
        lost: worlds in which a worker was lost, perhaps not by the mapper's fault.
        undecided: the first of the other worlds that are not decided.
        run_again: the worlds that were run again, alone and in a row.
        engine: what ran and judged; judged_by: the same in words.
        decided_by: with --policies every, who made the choices: the `mapper`; else null.
        by_checkers: number of worlds in which the checkers judged.
    """

    target: str
    kind: str
    edges: int
    policies: str
    checked: int
    total: int
    verdict: Verdict
    counterexample: Counterexample | None
    by_edges: tuple[ByEdges, ...]
    claims: tuple[FailingClaim, ...]
    not_declared: tuple[str, ...]
    judgements: tuple[Judgement, ...]
    from_ledger: int
    lost: tuple[LostWorker, ...]
    undecided: UndecidedWorld | None
    run_again: RunAgain | None
    engine: str
    decided_by: Decider | None
    judged_by: str
    by_checkers: int


class SearchInterrupted(ShortTraceback, KeyboardInterrupt):
    """Ctrl-C stopped a search.

    Attributes:
        entry: the result so far; a class without a counterexample is UNKNOWN.
    """

    def __init__(self, entry: SearchEntry) -> None:
        self.entry = entry
        super().__init__(
            f"interrupted after {entry.checked} of {plural(entry.total, 'world')}, so far"
            f" {entry.verdict}; the attribute `entry` of this exception has the result"
        )


def search_campaign(  # noqa: PLR0913  an argument an option
    mappers: Sequence[Target],
    *,
    edges: int,
    kind: str = "any",
    choices: Choices = "reference",
    keep_going: bool = False,
    limits: Limits | None = None,
    seed: int = 0,
    in_process: bool = True,
    engine: str | None = None,
) -> c.Campaign:
    """The campaign of a search; default engine: the `usual_engine`.

    InputError: a mapper has no such policies, or the engine cannot run it.
    """
    limits = given_limits(limits)
    if engine is None:
        engine = usual_engine(mappers, sum(c.Ranks(edges, kind).totals().values()))
    engine_of(engine).require_search(mappers, limits, choices)
    if choices != "reference":
        require_choices(mappers, choices, edges)
    return c.Campaign(
        worlds=c.Ranks(edges, kind, engine_of(engine).shard(mappers) or SHARD[choices]),
        mappers=tuple(mapper.text for mapper in mappers),
        limits=limits,
        in_process=in_process,
        engine=engine,
        stop=c.Stop(
            failing=None if keep_going else 1,
            lost=c.MAX_LOST if any(map(is_library, mappers)) else None,
        ),
        keep="notable",
        look=LOOK,
        ways=WAYS[choices],
        seed=seed,
    )


def search(  # noqa: PLR0913  an argument an option
    target: Mapper | str | Target,
    *,
    edges: int = 5,
    cls: WorldClass | str = "any",
    keep_going: bool = False,
    policies: Choices = "reference",
    limits: Limits | None = None,
    workers: int = 0,
    cluster: str | None = None,
    engine: str | None = None,
    tell: Progress | None = None,
) -> SearchEntry:
    """Examine a mapper in every world of a class with 1 to `edges` edges, smallest first.

    Args:
        target: a callable or a TARGET, which may name several mappers.
        cls: a class, or its text, as in `worlds(cls=...)`.
        keep_going: do not stop at the first counterexample.
        policies: which choices a catalogue algorithm is tried with; `choices.py`.
        workers: number of worker processes; 0: this one.
        cluster: the address of a scheduler, or `local`; needs the extra that works on clusters.
        tell: a progress callback, called with words (what is done, how fast), the amount done and
            the total, such as `print`; default: silent. (To resume a search, use the command line
            with `--ledger`.)
    Raises:
        InputError: no such mapper; no formula counts the class; and the like.
        SearchInterrupted: Ctrl-C; its `entry` is the result so far. After it, in a notebook:
            `import sys; sys.last_value.entry`.
    """
    mappers = targets(target) if isinstance(target, str) else (one_target(target),)
    if (workers or cluster is not None) and not isinstance(target, str):
        _require_texts(mappers)
    campaign = search_campaign(
        mappers,
        edges=edges,
        kind=str(cls),
        choices=policies,
        keep_going=keep_going,
        limits=limits,
        engine=engine,
    )
    local = not workers and not examiner_of(campaign).needs_worker
    elsewhere: Elsewhere | None = None if cluster is None else extras.backend("cluster")(cluster)
    with nullcontext() if elsewhere is None else elsewhere.opened(workers or None) as opened:
        if opened is not None:
            backend = opened(None)
        else:
            backend = here(mappers) if local else pooled(workers)
        study = Search(campaign, mappers, backend, repeats=isinstance(target, str))
        try:
            study.work(tell)
            study.run_again(tell)
        except KeyboardInterrupt:
            raise SearchInterrupted(study.entry()) from None
    return study.entry()


def _require_texts(mappers: Sequence[Target]) -> None:
    """Raise an InputError unless other processes can find these mappers."""
    for mapper in mappers:
        if isinstance(mapper.mapper, Program):
            continue
        if not is_found_again(mapper.text):
            raise InputError(
                f"{mapper.text} cannot be handed to workers, which find a mapper by its TARGET:"
                " put it into a file, or search in this process (workers=0)"
            )
        try:
            loaded = one_target(mapper.text).mapper
        except InputError as error:
            raise InputError(
                f"{mapper.text} cannot be handed to workers, which find a mapper by its TARGET"
                f" ({error}): search in this process (workers=0)"
            ) from None
        if loaded != mapper.mapper and ".py:" not in mapper.text:
            raise InputError(
                f"{mapper.text} names another mapper than the one given, and workers find a mapper"
                " by its TARGET: search in this process (workers=0)"
            )


class Search:
    """A search in steps: `work`, `run_again`, then `entry`, also if they were cut off.

    Args:
        repeats: some worlds are run again, if there is a TARGET to start the mapper from.
    """

    def __init__(
        self,
        campaign: c.Campaign,
        mappers: Sequence[Target],
        backend: c.Backend,
        store: c.ShardMemory | None = None,
        *,
        repeats: bool = True,
    ) -> None:
        assert isinstance(campaign.worlds, c.Ranks)
        self._repeats = repeats and len(mappers) == 1 and not is_of_catalogue(mappers[0])
        self.campaign, self.mappers, self._backend, self._store = campaign, mappers, backend, store
        self.worlds = campaign.worlds
        self.totals = self.worlds.totals()
        self.tallies = dict.fromkeys(self.totals, Tally())
        self.rows: tuple[Row, ...] = ()
        self.from_store = 0
        self.again: RunAgain | None = None
        self.seconds = EngineSeconds()

    def work(self, tell: Progress | None = None) -> None:
        """Examine the shards until the end, or as far as the campaign goes.

        After Ctrl-C, `entry` has the results before it. InternalError: mappers ran in another
        number of worlds than there are.
        """
        known = set[str]() if self._store is None else {s.key for s in self._store.known()}
        for shard, result in c.results(self.campaign, self._backend, store=self._store, tell=tell):
            self.tallies[shard.edges] += result.tally
            self.rows = notable((*self.rows, *result.rows), self.campaign.seed)
            self.seconds += result.seconds
            self.from_store += result.tally.worlds * (shard.key in known)
        if self.campaign.stop.reached(self.tally):
            return
        for edges, total in self.totals.items():
            if self.tallies[edges].worlds != total:
                raise InternalError(
                    f"the search ran mappers in {self.tallies[edges].worlds} worlds of class"
                    f" {self.worlds.kind} where m = {edges}, and there are {total}"
                )

    def run_again(self, tell: Progress | None = None) -> None:
        """Run some worlds again, if that is due; after Ctrl-C `entry` has the runs before it."""
        if self._repeats:
            repetition = Repetition(self.campaign, self.rows, self.tally)
            try:
                repetition.run(tell)
            finally:
                self.again = repetition.result()

    # ------------------------------------------------------------ what was found

    @property
    def tally(self) -> Tally:
        """The tally of all sizes."""
        return sum(self.tallies.values(), Tally())

    @property
    def choices(self) -> Choices:
        """Which policies the mappers are tried with."""
        return next(choices for choices, ways in WAYS.items() if ways == self.campaign.ways)

    @property
    def failing(self) -> list[Row]:
        """The failing rows in order; a world that is not the same stands there as that."""
        rows = {(row.edges, row.place, row.turn): row for row in self.rows if row.failed}
        for row in () if self.again is None else self.again.rows:
            rows[row.edges, row.place, row.turn] = row
        return [rows[place] for place in sorted(rows)]

    def report(self, example: Counterexample) -> Report | None:
        """The judged run of an example, if it was kept."""
        rows = (row for row in self.rows if row.world == example.world and row.failed)
        reports = (report_of(row, example.claim) for row in rows)
        return next((report for report in reports if report is not None), None)

    def entry(self, *, compare: bool = False) -> SearchEntry:
        """The result so far; `compare`: with the costs of two mappers."""
        campaign, tally, failing = self.campaign, self.tally, self.failing
        sizes = tuple(self._size(edges, compare=compare) for edges in self.totals)
        checked, total = sum(size.checked for size in sizes), sum(self.totals.values())
        examiner = examiner_of(campaign)
        return SearchEntry(
            target=",".join(campaign.mappers),
            kind=self.worlds.kind,
            edges=self.worlds.edges,
            policies=self.choices,
            checked=checked,
            total=total,
            verdict=self._verdict(whole=checked == total),
            counterexample=_counterexample(failing[0]) if failing else None,
            by_edges=sizes,
            claims=self._claims(),
            not_declared=tuple(
                claim
                for claim, runs in tally.statuses.items()
                if runs and runs.keys() <= {"not-declared", "not-asked"}
            ),
            judgements=tally.judgements(),
            from_ledger=self.from_store,
            lost=tuple(
                LostWorker(row.world, row.lost) for row in self.rows if row.is_lost and row.lost
            ),
            undecided=next(
                (
                    UndecidedWorld(row.world, row.undecided)
                    for row in self.rows
                    if row.undecided and not row.is_lost
                ),
                None,
            ),
            run_again=self.again,
            engine=campaign.engine,
            decided_by="mapper" if self.choices == "every" else None,
            judged_by=BY_EVERY_CLAIM if self.choices == "every" else examiner.judged_by,
            by_checkers=examiner.judged_by_checkers(tally),
        )

    def _verdict(self, *, whole: bool) -> Verdict:
        if self.failing:
            return "REFUTED"
        if not whole or self.tally.lost or (self._repeats and not self._is_repeated):
            return "UNKNOWN"
        return "EXHAUSTED"

    @property
    def _is_repeated(self) -> bool:
        return self.again is not None and self.again.is_same

    def _claims(self) -> tuple[FailingClaim, ...]:
        rows = [row for row in self.rows if row.failed]
        numbers = dict(self.tally.claims)
        if self.again is not None and self.again.rows:
            rows += self.again.rows
            numbers[CLAIM] = len(self.again.rows)
        return tuple(
            FailingClaim(
                claim,
                number,
                _counterexample(next(row for row in rows if claim in row.failed), claim),
            )
            for claim, number in numbers.items()
        )

    def _size(self, edges: int, *, compare: bool) -> ByEdges:
        tally, mapper = self.tallies[edges], self.campaign.mappers[0]
        costs = tally.costs.get(mapper, Costs())
        mine = [r for r in self.rows if r.edges == edges and r.mapper == mapper and r.right]
        worst = dict.fromkeys(row.world for row in mine if row.cost == costs.most)
        return ByEdges(
            edges=edges,
            checked=tally.worlds - tally.undecided,
            total=self.totals[edges],
            failing=tally.failing,
            undecided=tally.undecided,
            runs=costs.runs,
            max_cost=costs.most,
            total_cost=costs.total,
            attained=costs.attained,
            worst=tuple(worst)[:KEPT_WORST],
            compare=self._compared(tally, mine) if compare else None,
            every=EveryCost(*astuple(tally.choices), decided_by="mapper", judged_by=BY_EVERY_CLAIM)
            if self.choices == "every"
            else None,
        )

    def _compared(self, tally: Tally, mine: Sequence[Row]) -> CostComparison:
        second = self.campaign.mappers[1]
        others = {row.world: row.cost for row in self.rows if row.mapper == second and row.right}
        pairs = [
            CostPair(row.world, row.cost, others[row.world])
            for row in mine
            if row.cost > others.get(row.world, row.cost)
        ]
        a, b = (tally.costs.get(mapper, Costs()).total for mapper in self.campaign.mappers)
        kept = tuple(pairs[:KEPT_PAIRS])
        return CostComparison(*astuple(tally.pairs), totals=(a, b), first=kept)


def _counterexample(row: Row, claim: str | None = None) -> Counterexample:
    finding = next(f for f in row.findings if claim in (None, f.claim))
    return Counterexample(row.world, row.edges, finding.claim, finding.message, finding.replay)
