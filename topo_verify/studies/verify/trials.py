"""The parts that run mappers in worlds and have every claim judged.

A part that meets a counterexample goes on, so as to say how many worlds fail, and keeps the
findings of the first few runs. Worlds come smallest first, so these are in the smallest worlds. It
stops early after a few time-outs, for each may cost a whole time limit, and, if asked to, after a
few failing worlds.

Where the compiled engine is installed, the part `small-worlds` goes one size further for algorithms
of the catalogue. The engine also does the sizes that the checkers judged, and must count there what
they counted. A difference is a bug of ours.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import get_args

import msgspec

from topo_verify.algorithms import CATALOGUE, Algorithm
from topo_verify.campaign.attempt import KEPT_FINDINGS, Look
from topo_verify.campaign.backend import here, pooled
from topo_verify.campaign.campaign import (
    ENGINE_SHARD,
    Campaign,
    ListedWorlds,
    NamedWorlds,
    Ranks,
    Stop,
    results,
)
from topo_verify.campaign.judge import in_words, world_argument
from topo_verify.campaign.progress import Progress
from topo_verify.campaign.row import Row
from topo_verify.campaign.run import explore
from topo_verify.campaign.tally import KEPT_FAILING, Tally, joint_status, notable
from topo_verify.campaign.work import processors
from topo_verify.checkers import CLAIMS, Finding
from topo_verify.checkers.findings import Status, Verdict
from topo_verify.compiled import available
from topo_verify.errors import InternalError, plural
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.studies.verify.parts import MapperCost, Part
from topo_verify.world.rooted_map import World

MAX_TIMEOUTS = 3
"""Number of time-outs after which a part stops; of failing worlds, too, where that is asked."""

WORTH = 4
"""From this many edges on workers are used: smaller worlds take less time than to start one."""


@dataclass
class Trials:
    """Runs every mapper in every one of some worlds and judges every claim. A `PartJob`.

    Attributes:
        name: of the part.
        about: which worlds these are, in words that follow "792 worlds".
        total: how many worlds there are; counted apart from the worlds themselves.
        worlds: each with its name, smallest first.
        finite: the worlds are all of a finite class.
        max_failing: stop after this many failing worlds; None: never.
        look: called for every run.
    """

    name: str
    about: str
    total: int
    worlds: NamedWorlds
    targets: Sequence[Target]
    limits: Limits
    finite: bool = False
    max_failing: int | None = None
    look: Look | None = None

    tally: Tally = field(default_factory=Tally)
    failing: list[Row] = field(default_factory=list[Row])
    rows: list[Row] = field(default_factory=list[Row])

    def work(self, tell: Progress) -> None:
        """Run the mappers in one world after the other, until too many time out or fail."""
        campaign = Campaign(
            worlds=ListedWorlds(self.total),
            mappers=tuple(target.text for target in self.targets),
            limits=self.limits,
            stop=Stop(self.max_failing, MAX_TIMEOUTS),
        )
        backend = here(self.targets, look=self.look)
        told = _naming(self.name, tell)
        for _, result in results(campaign, backend, self.worlds, tell=told):
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
        """The number of worlds that were decided."""
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
        words += self._failures(claims) if tally.failing else claims_in_words(claims)
        words += self._cut_off()
        if interrupted:
            words += "; interrupted"
        elif tally.timeouts >= MAX_TIMEOUTS and tally.worlds < self.total:
            words += f"; stopped after {tally.timeouts} time-outs"
        elif tally.worlds < self.total:
            words += f"; stopped after {tally.failing} failing worlds"
        return words

    def _cut_off(self) -> str:
        late = self.tally.late
        return f"; {plural(late, 'run')} out of time" if late else ""

    def _failures(self, claims: dict[str, dict[str, int]]) -> str:
        failed = ", ".join(name for name, runs in claims.items() if runs["failed"])
        worlds = plural(self.tally.failing, "of them", "of them")
        words = f"{worlds} refute {failed}, first {self.failing[0].world}"
        mappers = ", ".join(dict.fromkeys(row.mapper for row in self.failing))
        return words + (f" ({mappers})" if len(self.targets) > 1 else "")


def _naming(name: str, tell: Progress) -> Progress:
    return lambda _what, done, total: tell(name, done, total)


def with_ids(worlds: Iterable[World]) -> list[tuple[str, World]]:
    """Worlds with the names by which the command line finds them again."""
    return [(world_argument(world), world) for world in worlds]


def part_claims(statuses: dict[str, dict[str, int]]) -> dict[str, dict[str, int]]:
    """For each claim, in how many runs it has which of the statuses that a part reports."""
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


class SmallWorlds(Trials):
    """Runs every mapper in every world of 1 to `edges` edges. A `PartJob`.

    Only algorithms of the catalogue run in workers. A user's mapper runs in this process, so that
    Ctrl-C reaches it; its few thousand runs take seconds.

    Args:
        further: one size more by the compiled engine, where it is installed.
    """

    def __init__(
        self, edges: int, targets: Sequence[Target], limits: Limits, *, further: bool = False
    ) -> None:
        ours = all(CATALOGUE.get(target.text) == target.mapper for target in targets)
        super().__init__("small-worlds", "", 0, (), targets, limits, finite=True)
        self._workers = processors() if ours and edges >= WORTH else 0
        self._further = ours and further and available() and limits == Limits()
        self._tallies: dict[int, Tally] = {}
        self._extend(edges)

    def _extend(self, edges: int) -> None:
        self._edges, self.about = edges, f" of 1 to {plural(edges, 'edge')}"
        self.total = sum(Ranks(edges).totals().values())

    def work(self, tell: Progress) -> None:
        """Search every world of each size.

        Raises:
            InternalError: the compiled engine counts something else than the checkers.
        """
        campaign = Campaign(
            worlds=Ranks(self._edges),
            mappers=tuple(target.text for target in self.targets),
            limits=self.limits,
            stop=Stop(timeouts=MAX_TIMEOUTS),
            keep="notable",
        )
        self._tallies = self._searched(campaign, tell)
        if self._further and self.part().verdict == "EXHAUSTED":
            before = self._tallies
            self._extend(self._edges + 1)
            self.tally, self.failing, self.rows = Tally(), [], []
            campaign = msgspec.structs.replace(
                campaign,
                worlds=Ranks(self._edges, shard=ENGINE_SHARD),
                engine="compiled",
                stop=Stop(),
            )
            self._require_same(before, self._searched(campaign, tell))

    def _searched(self, campaign: Campaign, tell: Progress) -> dict[int, Tally]:
        """The tallies by size."""
        tallies: dict[int, Tally] = {}
        backend = pooled(self._workers) if self._workers else here(self.targets)
        for shard, result in results(campaign, backend, tell=_naming(self.name, tell)):
            tallies[shard.edges] = tallies.get(shard.edges, Tally()) + result.tally
            self.tally += result.tally
            self.rows = [*notable((*self.rows, *result.rows))]
            self.failing = [row for row in self.rows if row.failed]
        return tallies

    def _require_same(self, before: dict[int, Tally], after: dict[int, Tally]) -> None:
        for edges, tally in before.items():
            for name in ("worlds", "failing", "undecided", "statuses", "shares", "costs"):
                ours, theirs = getattr(tally, name), getattr(after[edges], name)
                if ours != theirs:
                    raise InternalError(
                        f"in the worlds of {plural(edges, 'edge')} the engines disagree on {name}:"
                        f" {ours} by the checkers, {theirs} by the compiled engine"
                    )

    def _cut_off(self) -> str:
        undecided = self.tally.undecided
        words = f"; {plural(undecided, 'run')} not decided" if undecided else ""
        if self.tally.by_checkers:
            words += (
                f"; those of {plural(self._edges, 'edge')} by the compiled engine, and"
                f" {plural(self.tally.by_checkers, 'world')} by both"
            )
        return words


# ---------------------------------------------------------------- one world, and what it costs


class CostTrial(Trials):
    """Runs every mapper in one world and reports what each pays there. A `PartJob`.

    A mapper of the user's is shown beside the catalogue. The verdict is SAMPLED at best: it is one
    world.

    Args:
        where: how the command line names the world.
    """

    def __init__(
        self, name: str, where: str, world: World, targets: Sequence[Target], limits: Limits
    ) -> None:
        size = f", {where} ({len(world.vertices)} vertices, {len(world.edges)} edges)"
        super().__init__(name, size, 1, [(where, world)], targets, limits)
        self.world, self.basic = world, 0
        foreign = any(not isinstance(target.mapper, Algorithm) for target in targets)
        self.references = list(CATALOGUE.values()) if foreign else []
        self.costs: list[MapperCost] = []

    def work(self, tell: Progress) -> None:
        """Run the mappers, then the algorithms that they are compared with."""
        self.basic = explore(self.world, "basic").cost
        super().work(tell)
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
