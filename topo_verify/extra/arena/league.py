"""The league table: places, paired intervals, counterexamples.

A mapper has a place in a suite if it was judged in all its worlds and no claim failed in any run
of the call.

**Intervals.** With F families of equal weight, of which family f has n worlds, mean x and sample
variance s², the standard error of the mean is the root of Σ s²/n over F. An **exact** family,
every world of a finite class, has none. The interval is Student's, at 95 %; its degrees of
freedom are those of B. L. Welch (Biometrika 34, 1947): (Σ a)² / Σ (a² / (n-1)) with a = s²/n.
Two mappers are compared by their **paired** differences.

**Ties.** A mapper shares the place of the one above it unless the interval of its paired
difference from the first mapper with that place lies above 0.
"""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import sqrt
from operator import attrgetter
from statistics import fmean, variance
from typing import NamedTuple, TypeVar

import msgspec

from topo_verify.algorithms import Algorithm, Steered
from topo_verify.campaign.judge import replay_line
from topo_verify.campaign.row import Row
from topo_verify.campaign.tally import Counts
from topo_verify.checkers import Judgement, Status
from topo_verify.extra.arena.suites import Suite, SuiteFamily
from topo_verify.programs.delivery import WAS_AT
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.studies.conform.conform import file_name

T = TypeVar("T")


class LeagueBehind(msgspec.Struct, frozen=True):
    """The excess cost of a mapper over the first of the table, in the same worlds.

    Attributes:
        mapper: the first of the table.
        mean, low, high: of the differences of cost / LB.
    """

    mapper: str
    mean: float
    low: float | None
    high: float | None


class LostWorld(msgspec.Struct, frozen=True):
    """A world in which a mapper costs more than the first of the table.

    Attributes:
        other: the cost of the first of the table.
        excess: the difference, as a multiple of the least cost.
        show: the command line that writes a page with both runs side by side.
    """

    world: str
    edges: int
    least: int
    cost: int
    other: int
    excess: float
    show: str


class FamilyCosts(msgspec.Struct, frozen=True):
    """The mean costs of a mapper in one family of a suite.

    Attributes:
        family: its name.
        edges, least, cost: means.
    """

    family: str
    worlds: int
    edges: float
    least: float
    cost: float
    ratio: MeanInterval


class MostExpensiveWorld(msgspec.Struct, frozen=True):
    """The world in which a mapper's cost is the highest multiple of the least one."""

    world: str
    edges: int
    least: int
    cost: int
    ratio: float


class LeagueCounterexample(msgspec.Struct, frozen=True):
    """The first world in which a claim fails.

    Attributes:
        world: as the command line names it; empty if the mapper cannot be loaded.
        ended: `map`, a limit, a misbehaviour, `no-map`, `worker-lost` or `not-loaded`.
        over_budget: --budget ended the run, and nothing else is wrong up to there.
    """

    suite: str
    world: str
    edges: int
    ended: str
    claim: str
    message: str
    replay: str
    over_budget: bool

    @property
    def where(self) -> str:
        """The claim that fails, and the world, if any."""
        return f"{self.claim} in {self.world}" if self.world else self.claim


class LeagueEntry(msgspec.Struct, frozen=True, kw_only=True):
    """A mapper in a suite.

    Attributes:
        name: as the tables show it; the TARGET without --name.
        worlds, total: worlds judged, of how many.
        undecided: worlds that were out of time or declined; `why`: the first reasons.
        place: 1 is the best; null: no place. Mappers that cannot be told apart share one.
        ratio: cost / LB, the mean over families.
        losses: where it loses most against the first of the table.
        rejected_free: hypotheses rejected without a move since the decision before, in all worlds.
        rejected_moving: hypotheses rejected by a move, in all worlds.
        ms_per_move: milliseconds of processor time; varies from run to run.
    """

    mapper: str
    name: str
    suite: str
    worlds: int
    total: int
    undecided: int
    why: tuple[str, ...]
    place: int | None
    ratio: MeanInterval | None
    behind: LeagueBehind | None
    losses: tuple[LostWorld, ...] = ()
    families: tuple[FamilyCosts, ...]
    rejected_free: int
    rejected_moving: int
    ms_per_move: float | None
    claims: dict[str, Status]
    judgements: tuple[Judgement, ...]
    dearest: MostExpensiveWorld | None
    counterexample: LeagueCounterexample | None


KEPT_REASONS = 3

KEPT_LOSSES = 3

MORE_MOVES = 100
"""Moves of a counterexample's run after the failing event. A wrong mapper may make millions."""


@dataclass(frozen=True)
class League:
    """The mappers and suites, and the runs so far, by mapper and world.

    Attributes:
        names: of mappers in tables, by TARGET.
        broken: why a TARGET cannot be loaded or started.
        peaks: the most kibibytes of a mapper; None: unknown.
        remarks: sentences that the report shows below the standings.
    """

    mappers: tuple[Target, ...]
    suites: tuple[Suite, ...]
    seed: int
    limits: Limits = field(default_factory=Limits)
    names: Mapping[str, str] = field(default_factory=dict[str, str])
    broken: Mapping[str, str] = field(default_factory=dict[str, str])
    rows: dict[tuple[str, str], Row] = field(default_factory=dict[tuple[str, str], Row], repr=False)
    peaks: dict[tuple[str, str], int | None] = field(
        default_factory=dict[tuple[str, str], int | None], repr=False
    )
    remarks: list[str] = field(default_factory=list[str], repr=False)

    def plays(self, mapper: Target, suite: Suite) -> bool:
        """Whether a mapper plays a suite: one that assumes planar worlds plays no others."""
        assumes = mapper.mapper.assumes if isinstance(mapper.mapper, Algorithm | Steered) else None
        return assumes != "planar" or suite.planar

    def worlds_of(self, mapper: Target) -> list[str]:
        """The worlds that a mapper plays, each once, in order."""
        suites = [suite for suite in self.suites if self.plays(mapper, suite)]
        return list(dict.fromkeys(world for suite in suites for world in suite.worlds(self.seed)))

    @property
    def planned(self) -> int:
        """The number of runs."""
        return sum(len(self.worlds_of(mapper)) for mapper in self.mappers)

    def _counted(self, mapper: Target) -> dict[str, Row]:
        rows: dict[str, Row] = {}
        for world in self.worlds_of(mapper):
            if (row := self.rows.get((mapper.text, world))) is not None:
                rows[world] = row
                if row.failed:  # what follows depends on the workers
                    break
        return rows

    def name(self, mapper: str) -> str:
        """The name of a mapper in tables."""
        return self.names.get(mapper, mapper)

    def memory(self, entry: LeagueEntry) -> float | None:
        """The mebibytes of a mapper in its most expensive world, if known."""
        if entry.dearest is None:
            return None
        kibibytes = self.peaks.get((entry.mapper, entry.dearest.world))
        return None if kibibytes is None else round(kibibytes / 1024, 1)

    def entries(self) -> list[LeagueEntry]:
        """The table, suite by suite: ranked mappers first."""
        counted = {mapper.text: self._counted(mapper) for mapper in self.mappers}
        return [entry for suite in self.suites for entry in self._table(suite, counted)]

    def runs(self, mapper: str, suite: Suite) -> list[Row]:
        """A mapper's finished runs in a suite, in the order of its worlds."""
        runs = (self.rows.get((mapper, world)) for world in suite.worlds(self.seed))
        return [run for run in runs if run is not None]

    # ------------------------------------------------------------ a suite

    def _table(self, suite: Suite, counted: Mapping[str, Mapping[str, Row]]) -> list[LeagueEntry]:
        mappers = [entry.text for entry in self.mappers if self.plays(entry, suite)]
        entries = [self._entry(mapper, suite, counted[mapper]) for mapper in mappers]
        means = {entry.mapper: entry.ratio.mean for entry in entries if entry.ratio is not None}
        ranked = sorted(
            (entry for entry in entries if entry.ratio is not None),
            key=lambda entry: means[entry.mapper],
        )
        placed: list[LeagueEntry] = []
        place = 1
        for number, entry in enumerate(ranked, 1):
            low = self._difference(entry, ranked[place - 1], suite).low
            if low is not None and low > 0:
                place = number
            placed.append(self._placed(entry, place, ranked[0], suite))
        others = [entry for entry in entries if entry.ratio is None]
        others.sort(key=lambda entry: entry.counterexample is not None)
        return placed + others + [self._unloaded(mapper, suite) for mapper in self.broken]

    def _unloaded(self, mapper: str, suite: Suite) -> LeagueEntry:
        why = "", "", 0, "not-loaded", "cannot be loaded", self.broken[mapper], ""
        broken = LeagueCounterexample(*why, over_budget=False)
        return msgspec.structs.replace(self._entry(mapper, suite, {}), counterexample=broken)

    def _entry(self, mapper: str, suite: Suite, rows: Mapping[str, Row]) -> LeagueEntry:
        failure = next((row for row in rows.values() if row.failed), None)
        runs = [rows[world] for world in suite.worlds(self.seed) if world in rows]
        decided = [run for run in runs if run.undecided is None]
        whole = failure is None and len(decided) == suite.size
        moves, seconds = sum(run.cost for run in decided), sum(run.seconds for run in decided)
        counts = Counts()
        for run in decided:
            counts.enter([run])
        judgements = counts.tally().judgements()
        return LeagueEntry(
            mapper=mapper,
            name=self.name(mapper),
            suite=suite.name,
            worlds=len(decided),
            total=suite.size,
            undecided=len(runs) - len(decided),
            why=tuple(f"{r.world}: {_placeless(r.undecided)}" for r in runs if r.undecided)[
                :KEPT_REASONS
            ],
            place=None,
            ratio=_interval(suite, [run.ratio for run in decided]) if whole else None,
            behind=None,
            families=tuple(_costs(*part) for part in split(suite, decided)) if whole else (),
            rejected_free=sum(run.free for run in decided),
            rejected_moving=sum(run.moving for run in decided),
            ms_per_move=round(1000 * seconds / moves, 4) if moves else None,
            claims={judgement.claim: judgement.status for judgement in judgements},
            judgements=judgements,
            dearest=_most_expensive(decided) if whole else None,
            counterexample=None if failure is None else self._counterexample(failure),
        )

    def _difference(self, entry: LeagueEntry, other: LeagueEntry, suite: Suite) -> MeanInterval:
        pairs = zip(self.runs(entry.mapper, suite), self.runs(other.mapper, suite), strict=True)
        return _interval(suite, [ours.ratio - theirs.ratio for ours, theirs in pairs])

    def _placed(
        self, entry: LeagueEntry, place: int, best: LeagueEntry, suite: Suite
    ) -> LeagueEntry:
        behind, losses = None, tuple[LostWorld, ...]()
        if entry is not best:
            difference = self._difference(entry, best, suite)
            behind = LeagueBehind(best.mapper, difference.mean, difference.low, difference.high)
            losses = tuple(self._losses(entry.mapper, best.mapper, suite))
        return msgspec.structs.replace(entry, place=place, behind=behind, losses=losses)

    def _losses(self, mapper: str, best: str, suite: Suite) -> Iterator[LostWorld]:
        pairs = zip(self.runs(mapper, suite), self.runs(best, suite), strict=True)
        lost = [(ours.ratio - theirs.ratio, ours, theirs) for ours, theirs in pairs]
        lost.sort(key=lambda pair: -pair[0])  # stable
        page = f"{file_name(mapper).lstrip('-')}-{suite.name}"
        for number, (excess, ours, theirs) in enumerate(lost[:KEPT_LOSSES], 1):
            if excess > 0:
                words = ["topo-verify", "play", ours.world, "--target", best, "--target", mapper]
                named = [text for text in (best, mapper) if text in self.names]
                words += [w for text in named for w in ("--name", f"{text}={self.names[text]}")]
                words += ["-o", f"{page}-{number}.html"]
                show = shlex.join([*words, *self.limits.options])
                costs = ours.least, ours.cost, theirs.cost
                yield LostWorld(ours.world, ours.edges, *costs, round(excess, 6), show)

    def limits_of_failure(self, failure: Row) -> Limits:
        """Limits under which a run shows the failing claim again, and soon ends."""
        event, budget = failure.findings[0].event, self.limits.budget
        if event is None or failure.cost <= (enough := event + MORE_MOVES):
            return self.limits
        return replace(self.limits, budget=enough if budget is None else min(budget, enough))

    def _counterexample(self, failure: Row) -> LeagueCounterexample:
        finding = failure.findings[0]
        replay = finding.replay
        limits = self.limits_of_failure(failure)
        if replay and limits is not self.limits:
            replay = replay_line(failure.world, failure.mapper, failure.policies, limits.options)
        suite = next(part.name for part in self.suites if failure.world in part.worlds(self.seed))
        return LeagueCounterexample(
            *(suite, failure.world, failure.edges, failure.ended),
            *(finding.claim, _placeless(finding.message), replay),
            over_budget=limits.budget is not None
            and failure.ended == "budget"
            and failure.failed == ("map-isomorphic",),
        )


def _placeless(words: str) -> str:
    return words.partition(WAS_AT)[0]


def split(suite: Suite, values: Sequence[T]) -> Iterator[tuple[SuiteFamily, Sequence[T]]]:
    """The values of a suite's worlds, family by family."""
    start = 0
    for family in suite.families:
        yield family, values[start : start + family.size]
        start += family.size


def _interval(suite: Suite, values: Sequence[float]) -> MeanInterval:
    return mean_interval(
        [FamilySample(part, family.exact) for family, part in split(suite, values)]
    )


def _costs(family: SuiteFamily, runs: Sequence[Row]) -> FamilyCosts:
    edges, least, cost = (
        round(fmean(values), 3)
        for values in ([r.edges for r in runs], [r.least for r in runs], [r.cost for r in runs])
    )
    sample = FamilySample([run.ratio for run in runs], family.exact)
    return FamilyCosts(family.name, len(runs), edges, least, cost, mean_interval([sample]))


def _most_expensive(runs: Sequence[Row]) -> MostExpensiveWorld:
    run = max(runs, key=attrgetter("ratio"))  # the first of equals
    return MostExpensiveWorld(run.world, run.edges, run.least, run.cost, round(run.ratio, 6))


# ---------------------------------------------------------------- intervals

LEVEL = 0.95


class MeanInterval(msgspec.Struct, frozen=True):
    """A mean and its confidence interval.

    Attributes:
        mean, low, high: the mean, and the ends of its interval, or null.
    """

    mean: float
    low: float | None
    high: float | None


class FamilySample(NamedTuple):
    """The values of one family; `exact`: of every world of a finite class."""

    values: Sequence[float]
    exact: bool


def mean_interval(families: Sequence[FamilySample]) -> MeanInterval:
    """The mean over nonempty families, and its interval."""
    mean = fmean(fmean(family.values) for family in families)
    sampled = [family.values for family in families if not family.exact]
    if any(len(values) < 2 for values in sampled):
        return MeanInterval(_rounded(mean), None, None)
    errors = [variance(values) / len(values) for values in sampled]
    total = sum(errors)
    if total == 0:
        return MeanInterval(_rounded(mean), _rounded(mean), _rounded(mean))
    shares = (e**2 / (len(v) - 1) for e, v in zip(errors, sampled, strict=True))
    reach = student(total**2 / sum(shares)) * sqrt(total) / len(families)
    return MeanInterval(_rounded(mean), _rounded(mean - reach), _rounded(mean + reach))


def _rounded(value: float) -> float:
    # The same digits on every machine.
    return round(value, 6) + 0.0


def student(freedom: float) -> float:
    """The 97.5 % quantile of Student's t distribution; fractions of a degree are dropped."""
    import scipy.special  # type: ignore[import-untyped]  # pyright: ignore[reportMissingTypeStubs]

    return float(scipy.special.stdtrit(int(freedom), (1 + LEVEL) / 2))
