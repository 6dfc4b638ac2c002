"""The parts that run mappers in worlds and have every claim judged.

A part goes on after a counterexample, to count the failing worlds. Where a faster engine is
installed, `small-worlds` goes one size further for catalogue algorithms; in the smaller sizes that
engine must count what the checkers counted.

Catalogue algorithms run in worker processes: the small worlds in one campaign, the worlds of all
later parts in another (`Together`), so that no processor idles at the end of a part.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from itertools import chain, repeat
from typing import Self, get_args

import msgspec

from topo_verify.algorithms import CATALOGUE, Algorithm
from topo_verify.campaign import campaign as c
from topo_verify.campaign.attempt import KEPT_FINDINGS, Look
from topo_verify.campaign.backend import here, pooled
from topo_verify.campaign.engine import engine_of
from topo_verify.campaign.judge import in_words, world_argument
from topo_verify.campaign.progress import Progress
from topo_verify.campaign.row import Row
from topo_verify.campaign.run import explore
from topo_verify.campaign.tally import KEPT_FAILING, Tally, joint_status, notable
from topo_verify.campaign.work import processors
from topo_verify.checkers import CLAIMS, Finding
from topo_verify.checkers.findings import Status, Verdict
from topo_verify.errors import InternalError, map_size, plural
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.studies.verify.parts import MapperCost, Part
from topo_verify.world.rooted_map import World


@dataclass
class Trials:
    """Runs every mapper in some worlds and judges every claim. A `PartJob`.

    Attributes:
        about: which worlds these are, in words that follow "792 worlds".
        total: the number of worlds, counted apart from them.
        worlds: each with its name, smallest first.
        together: runs the mappers, in the worlds of other parts as well; None: they run here.
    """

    name: str
    about: str
    total: int
    worlds: c.NamedWorlds
    targets: Sequence[Target]
    limits: Limits
    finite: bool = False
    max_failing: int | None = None
    look: Look | None = None
    together: Together | None = None

    tally: Tally = field(default_factory=Tally)
    failing: list[Row] = field(default_factory=list[Row])
    rows: list[Row] = field(default_factory=list[Row])

    @property
    def stop(self) -> c.Stop:
        """When the part ends before its last world."""
        return c.Stop(self.max_failing, c.MAX_TIMEOUTS)

    def work(self, tell: Progress) -> None:
        """Run the mappers until too many worlds time out or fail."""
        if self.together is not None:
            self.together.work(self, tell)
            return
        campaign = _campaign(c.ListedWorlds(self.total), self.targets, self.limits, self.stop)
        backend = here(self.targets, look=self.look)
        tell_part = _naming(self.name, tell)
        for _, result in c.results(campaign, backend, self.worlds, tell=tell_part):
            self.enter(result.tally, result.rows)

    def enter(self, tally: Tally, rows: Sequence[Row]) -> None:
        """Count the worlds of a shard."""
        self.tally += tally
        self.rows = [*rows]
        self.failing += [row for row in rows if row.failed]

    # ------------------------------------------------------------ what was found

    @property
    def findings(self) -> tuple[Finding, ...]:
        """The findings of the first failing runs."""
        first: dict[tuple[str, str], Row] = {}  # a drawn world may come twice
        for row in self.failing:
            first.setdefault((row.world, row.mapper), row)
        kept = list(first.values())[:KEPT_FAILING]
        return tuple(finding for row in kept for finding in row.findings[:KEPT_FINDINGS])

    @property
    def checked(self) -> int:
        """The number of decided worlds."""
        return self.tally.worlds - self.tally.undecided

    def part(self, *, interrupted: bool = False) -> Part:
        """The part's result so far."""
        tally = self.tally
        whole = tally.worlds == self.total and not tally.undecided and not interrupted
        verdict: Verdict = "UNKNOWN"
        if tally.failing:
            verdict = "REFUTED"
        elif whole:
            verdict = "EXHAUSTED" if self.finite else "SAMPLED"
        claims = part_claims(tally.statuses)
        return Part(
            part=self.name,
            verdict=verdict,
            ok=whole and verdict != "REFUTED",
            checked=self.checked,
            total=self.total,
            summary=self._summary(claims, interrupted=interrupted),
            failing=tally.failing,
            claims=claims,
            judgements=tally.judgements(self.findings),
            findings=self.findings,
        )

    def _summary(self, claims: dict[str, dict[str, int]], *, interrupted: bool) -> str:
        tally = self.tally
        mappers = f" × {len(self.targets)} mappers" if len(self.targets) > 1 else ""
        words = f"{self.checked} of {plural(self.total, 'world')}{self.about}{mappers}: "
        words += self._failures() if tally.failing else claims_in_words(claims)
        words += self._cut_off()
        if interrupted:
            words += "; interrupted"
        elif tally.timeouts >= c.MAX_TIMEOUTS and tally.worlds < self.total:
            words += f"; stopped after {tally.timeouts} time-outs"
        elif tally.worlds < self.total:
            words += f"; stopped after {tally.failing} failing worlds"
        return words

    def _cut_off(self) -> str:
        late = self.tally.late
        return f"; {plural(late, 'run')} out of time" if late else ""

    def _failures(self) -> str:
        first: dict[str, str] = {}  # the first failing world of each claim
        for row in self.failing:
            for claim in row.failed:
                first.setdefault(claim, row.world)
        claims = [claim for claim in CLAIMS if claim in first]
        words = f"{plural(self.tally.failing, 'of them', 'of them')} refute "
        if len({*first.values()}) == 1:
            words += f"{', '.join(claims)}, first {first[claims[0]]}"
        else:
            words += ", ".join(f"{claim} (first {first[claim]})" for claim in claims)
        mappers = ", ".join(dict.fromkeys(row.mapper for row in self.failing))
        return words + (f" ({mappers})" if len(self.targets) > 1 else "")


class Together:
    """Runs catalogue algorithms in the worlds of several parts, in worker processes.

    `with` it, call `work` of each part, in any order.
    """

    def __init__(self, parts: Sequence[Trials]) -> None:
        first, total = parts[0], sum(part.total for part in parts)
        campaign = _campaign(c.ListedWorlds(total), first.targets, first.limits)
        named = [world for part in parts for world in part.worlds]
        owners = chain.from_iterable(repeat(part, part.total) for part in parts)
        self._results = c.results(campaign, pooled(processors()), named)
        self._finished = zip(owners, self._results, strict=True)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self._results.close()

    def work(self, part: Trials, tell: Progress) -> None:
        """Count the worlds of a part, and those of the parts before it."""
        while part.tally.worlds < part.total and not part.stop.reached(part.tally):
            owner, (_, result) = next(self._finished)
            if not owner.stop.reached(owner.tally):
                owner.enter(result.tally, result.rows)
            tell(part.name, part.tally.worlds, part.total)


def _campaign(
    worlds: c.Ranks | c.ListedWorlds,
    targets: Sequence[Target],
    limits: Limits,
    stop: c.Stop | None = None,
) -> c.Campaign:
    texts = tuple(target.text for target in targets)
    return c.Campaign(worlds=worlds, mappers=texts, limits=limits, stop=stop or c.Stop())


def _naming(name: str, tell: Progress) -> Progress:
    return lambda _what, done, total: tell(name, done, total)


def with_ids(worlds: Iterable[World]) -> list[tuple[str, World]]:
    """Worlds with their names on the command line."""
    return [(world_argument(world), world) for world in worlds]


def part_claims(statuses: dict[str, dict[str, int]]) -> dict[str, dict[str, int]]:
    """For each claim, the number of runs with each status."""
    return {
        claim: {status: statuses.get(claim, {}).get(status, 0) for status in get_args(Status)}
        for claim in CLAIMS
    }


def claims_in_words(claims: dict[str, dict[str, int]]) -> str:
    """How many claims hold in all runs, and how many have each other status."""
    joint: dict[str, Status] = {
        claim: joint_status(runs) for claim, runs in claims.items() if any(runs.values())
    }
    return in_words(joint, "claims hold") if joint else "no run was judged"


# ---------------------------------------------------------------- all small worlds


class EngineCounts(msgspec.Struct, frozen=True):
    """The tally of each size of small worlds by an engine of this name, and notable rows."""

    engine: str
    tallies: dict[int, Tally]
    rows: tuple[Row, ...]


def engine_counts(engine: str, edges: int, targets: Sequence[Target]) -> EngineCounts:
    """An engine's counts in every world of 1 to `edges` edges."""
    worlds = c.Ranks(edges)
    worlds = msgspec.structs.replace(worlds, shard=engine_of(engine).shard(targets) or worlds.shard)
    campaign = _campaign(worlds, targets, Limits())
    campaign = msgspec.structs.replace(campaign, engine=engine, keep="notable")
    tallies: dict[int, Tally] = {}
    rows: tuple[Row, ...] = ()
    for shard, result in c.results(campaign, here(targets)):
        tallies[shard.edges] = tallies.get(shard.edges, Tally()) + result.tally
        rows = notable((*rows, *result.rows))
    return EngineCounts(engine, tallies, rows)


class SmallWorlds(Trials):
    """Runs every mapper in every world of 1 to `edges` edges. A `PartJob`.

    `further` counts one size more by a faster engine. With 0 workers mappers run in this process,
    so that Ctrl-C reaches a user's mapper.
    """

    def __init__(
        self,
        edges: int,
        targets: Sequence[Target],
        limits: Limits,
        *,
        further: Callable[[], EngineCounts] | None = None,
        workers: int = 0,
    ) -> None:
        super().__init__("small-worlds", "", 0, (), targets, limits, finite=True)
        self._workers, self._further, self._engine = workers, further, ""
        self._extend(edges)

    def _extend(self, edges: int) -> None:
        self._edges, self.about = edges, f" of 1 to {plural(edges, 'edge')}"
        self.total = sum(c.Ranks(edges).totals().values())

    def work(self, tell: Progress) -> None:
        """Search every world of each size; InternalError if that engine differs."""
        stop = c.Stop(timeouts=c.MAX_TIMEOUTS)
        campaign = _campaign(c.Ranks(self._edges), self.targets, self.limits, stop)
        campaign = msgspec.structs.replace(campaign, keep="notable")
        backend = pooled(self._workers) if self._workers else here(self.targets)
        tallies: dict[int, Tally] = {}
        for shard, result in c.results(campaign, backend, tell=_naming(self.name, tell)):
            tallies[shard.edges] = tallies.get(shard.edges, Tally()) + result.tally
            self.tally += result.tally
            self._keep((*self.rows, *result.rows))
        if self._further is not None and self.part().verdict == "EXHAUSTED":
            counts = self._further()
            self._require_same(tallies, counts)
            self._engine = counts.engine
            self._extend(self._edges + 1)
            self.tally = sum(counts.tallies.values(), Tally())
            self._keep(counts.rows)

    def _keep(self, rows: Iterable[Row]) -> None:
        self.rows = [*notable(rows)]
        self.failing = [row for row in self.rows if row.failed]

    def _require_same(self, before: dict[int, Tally], after: EngineCounts) -> None:
        for edges, tally in before.items():
            for name in ("worlds", "failing", "undecided", "statuses", "shares", "costs"):
                ours, theirs = getattr(tally, name), getattr(after.tallies[edges], name)
                if ours != theirs:
                    raise InternalError(
                        f"in the worlds of {plural(edges, 'edge')} the engines disagree on {name}:"
                        f" {ours} by the checkers, {theirs} by the {after.engine} engine"
                    )

    def _cut_off(self) -> str:
        undecided = self.tally.undecided
        words = f"; {plural(undecided, 'run')} not decided" if undecided else ""
        if self.tally.by_checkers:
            words += (
                f"; those of {plural(self._edges, 'edge')} by the {self._engine} engine, and"
                f" {plural(self.tally.by_checkers, 'world')} by both"
            )
        return words


# ---------------------------------------------------------------- one world, and what it costs


class CostTrial(Trials):
    """Runs every mapper in one world and reports what each pays there. A `PartJob`.

    A user's mapper is shown beside the catalogue.
    """

    def __init__(
        self, name: str, where: str, world: World, targets: Sequence[Target], limits: Limits
    ) -> None:
        size = f", {where} ({map_size(len(world.vertices), len(world.edges))})"
        super().__init__(name, size, 1, [(where, world)], targets, limits)
        self.world, self.basic = world, 0
        foreign = any(not isinstance(target.mapper, Algorithm) for target in targets)
        self.references = list(CATALOGUE.values()) if foreign else []
        self.costs: list[MapperCost] = []

    def work(self, tell: Progress) -> None:
        """Run the mappers, then the algorithms that they are compared with."""
        super().work(tell)
        ours = (row.cost for row in self.rows if row.mapper == "basic" and not row.findings)
        self.basic = next(ours, 0) or explore(self.world, "basic").cost
        for row in self.rows:
            rejected = row.free, row.moving, row.confirmed
            self._enter(row.mapper, row.cost, rejected, right=not row.findings)
        for algorithm in self.references:
            run = explore(self.world, algorithm)
            rejected = run.rejected_free, run.rejected_moving, run.confirmed
            self._enter(run.algorithm, run.cost, rejected, reference=True)

    def _enter(
        self,
        mapper: str,
        cost: int,
        rejected: tuple[int, int, int],
        *,
        right: bool = True,
        reference: bool = False,
    ) -> None:
        ratio = round(cost / self.basic, 3) if right else None
        least = round(cost / self.world.least_cost(), 4)
        self.costs.append(MapperCost(mapper, cost, ratio, least, *rejected, reference))

    def part(self, *, interrupted: bool = False) -> Part:
        """The part's result so far."""
        part = super().part(interrupted=interrupted)
        return msgspec.structs.replace(part, costs=tuple(self.costs))
