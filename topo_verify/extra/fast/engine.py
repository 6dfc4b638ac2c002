"""The compiled engine: which mappers it accepts, and how it examines the shards of a campaign.

It runs catalogue algorithms about a hundred times as fast as the reference, and calls a native
mapper, a function of machine code, in its own worker.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import msgspec

from topo_verify import extras
from topo_verify.algorithms import CATALOGUE, REFERENCE, Algorithm, Steered
from topo_verify.campaign import campaign as c
from topo_verify.campaign.attempt import Look
from topo_verify.campaign.drawn_row import drawn_row, is_run_again
from topo_verify.campaign.engine import Checks, Engine
from topo_verify.campaign.examiner import Examiner, once_in_words, split
from topo_verify.campaign.loss import Loss
from topo_verify.campaign.row import Row
from topo_verify.campaign.run import EngineMapper, Exploration
from topo_verify.campaign.tally import Tally
from topo_verify.campaign.work import WorkerLoss
from topo_verify.campaign.worker import Beat, WorkerProcess
from topo_verify.checkers.claims import LARGE
from topo_verify.errors import InputError
from topo_verify.programs.library import LIBRARY
from topo_verify.programs.loader import Target, is_library
from topo_verify.programs.program import OPTIONS
from topo_verify.robot.events import Policies, Start
from topo_verify.robot.limits import Limits
from topo_verify.world.rooted_map import World

if TYPE_CHECKING:
    from topo_verify.extra.fast.checks import CompiledChecks

SHARD = 100_000
"""Worlds in a shard, about half a second of work."""

COMPILING = 1200.0
"""Seconds that a worker has to get ready."""

MAX_LOSSES = 8
"""Workers that a native mapper may cost in one shard, beside those of given-up worlds."""

JUDGED_BY = (
    "the compiled engine; every counterexample, the worst worlds and a seeded sample of 1 in 1,000"
    " by the checkers"
)

JUDGED_BY_JUDGE = (
    "the compiled judge; every finding, the most expensive worlds and a seeded sample of 1 in 1,000"
    " by the checkers"
)

ENOUGH = 50_000
"""Worlds from which on it is faster to load the judge for a mapper in Python."""


# ---------------------------------------------------------------- single worlds


@dataclass(frozen=True, slots=True)
class CompiledAlgorithm(EngineMapper):
    """A catalogue algorithm for the compiled engine; `fault`: a mistake that is planted in it."""

    fault: str = ""

    @property
    def policies(self) -> Policies:
        """The reference policies; the kernels have no others."""
        return REFERENCE

    def explore(self, world: World, start: Start, limits: Limits) -> Exploration:
        """Run in a world; `start` becomes the first event."""
        from topo_verify.extra.fast.kernels.explore import run_world

        run = run_world(world, self.name, trace=self.trace, budget=limits.budget, fault=self.fault)
        return Exploration(
            world,
            self.name,
            self.policies,
            run.events_after(start),
            run.map,
            run.stopped,
            cost=run.cost,
            limit=None if run.map is not None else "budget",
            mapper=self,
            limits=limits,
        )

    def judges(self, world: World, *, strict: bool) -> bool:
        """Whether the compiled judge judges: in worlds with more than 2,000 edges."""
        return len(world.edges) > LARGE and not strict

    def checks(self) -> Checks:
        """The compiled judge for long traces."""
        from topo_verify.extra.fast.checks import CompiledChecks

        return CompiledChecks(is_long=True)


class CompiledEngine(Engine):
    """Runs catalogue algorithms with the reference policies, and searches for native mappers."""

    name = "compiled"
    examiner = f"{__name__}:examiner"

    def is_usual(self, mappers: Sequence[Target], worlds: int) -> bool:
        """Whether it is a native mapper, or one in Python and enough worlds."""
        (first, *others) = mappers
        in_python = not others and _is_in_python(first) and worlds >= ENOUGH
        return any(map(is_library, mappers)) or in_python

    def shard(self, mappers: Sequence[Target]) -> int | None:
        """Average number of worlds in a shard of a search; None: as its policies need."""
        return None if _is_judged(mappers) else SHARD

    def require(self, mappers: Sequence[Target], limits: Limits) -> None:
        """Raise an InputError unless it runs these mappers in single worlds under these limits."""
        _require(mappers, limits)

    def require_search(self, mappers: Sequence[Target], limits: Limits, choices: str) -> None:
        """Raise an InputError unless it searches for these mappers with these policies."""
        if choices != "reference":
            raise InputError(
                f"--engine compiled with --policies {choices}: it knows the reference policies"
                " only; leave one of the two out"
            )
        if _is_judged(mappers):
            extras.require("fast", instead="--engine reference")
            return
        _require(mappers, limits, libraries=True)
        if limits.budget is not None:
            raise InputError(
                f"--engine compiled searches with the bound of claim 7 as its budget, got"
                f" --budget {limits.budget}: leave out --budget, or --engine"
            )

    def mapper(self, target: Target) -> Target:
        """The same algorithm, compiled."""
        return Target(target.text, CompiledAlgorithm(target.text))

    def checks(self) -> Checks:
        """The compiled judge for worlds of up to 12 edges."""
        from topo_verify.extra.fast.checks import CompiledChecks

        return CompiledChecks()


COMPILED = CompiledEngine()


def examiner(campaign: c.Campaign) -> Examiner:
    """What examines a campaign: kernels, calls of a native mapper, or the compiled judge."""
    if any(text.startswith(LIBRARY) for text in campaign.mappers):
        return NativeExaminer(campaign)
    if all(text in CATALOGUE for text in campaign.mappers):
        return CompiledExaminer(campaign)
    return JudgedExaminer(campaign)


def _is_judged(mappers: Sequence[Target]) -> bool:
    """Whether the mapper runs as by the reference, and the compiled judge judges its traces."""
    return len(mappers) == 1 and not (is_library(mappers[0]) or mappers[0].text in CATALOGUE)


def _is_in_python(target: Target) -> bool:
    is_ours = isinstance(target.mapper, Algorithm | Steered)
    return not (is_ours or target.text.startswith(OPTIONS))


def _require(mappers: Sequence[Target], limits: Limits, *, libraries: bool = False) -> None:
    """Raise an InputError unless the engine can run these mappers under these limits.

    `libraries` allows native mappers, too: they beat at every move, so a limit between two moves
    holds for them.
    """
    extras.require("fast", instead="--engine reference")
    native = libraries and any(map(is_library, mappers))
    for target in mappers:
        if libraries and is_library(target):
            continue
        if not isinstance(target.mapper, Algorithm):
            raise InputError(
                f"--engine compiled runs the algorithms of the catalogue, {', '.join(CATALOGUE)},"
                f" and {target.text} is none of them: leave --engine out"
            )
        if target.mapper != CATALOGUE.get(target.text):
            chosen = target.mapper.policies
            raise InputError(
                f"--engine compiled runs {target.text} with the policies {REFERENCE.pick} and"
                f" {REFERENCE.order}, got {chosen.pick} and {chosen.order}: leave out --pick and"
                " --order, or --engine"
            )
    usual = Limits()
    between = usual.move_timeout if native else limits.move_timeout
    if replace(limits, budget=None, move_timeout=between) != usual:
        options = "--world-timeout" if native else "--move-timeout and --world-timeout"
        raise InputError(
            "--engine compiled cannot stop a run after some seconds, and its runs are bounded by"
            f" the number of moves: leave out {options}, or add --engine reference"
        )


# ---------------------------------------------------------------- the shards of a search


class CompiledExaminer(Examiner):
    """Examines the shards of catalogue algorithms by kernels, and a part again by the checkers."""

    loading = COMPILING
    judged_by = JUDGED_BY

    @property
    def tells_slow(self) -> bool:
        """No: between two heartbeats there are thousands of worlds."""
        return False

    def judged_by_checkers(self, tally: Tally) -> int:
        """The number of worlds that the checkers judged again."""
        return tally.by_checkers

    def prepare(self) -> None:
        """Compile the kernels, or load them from the cache."""
        from topo_verify.extra.fast.shard import warm

        warm(self.campaign)

    def examine(
        self, mappers: Sequence[Target], shard: c.Shard, beat: Beat, look: Look | None = None
    ) -> c.ShardResult:
        """The result of a shard; nothing is noted about its runs."""
        from topo_verify.extra.fast.shard import examine_compiled

        del look
        return examine_compiled(self.campaign, mappers, shard, beat)


class JudgedExaminer(Examiner):
    """Runs any mapper as the reference does; the compiled judge judges what it can."""

    loading = COMPILING
    judged_by = JUDGED_BY_JUDGE

    def judged_by_checkers(self, tally: Tally) -> int:
        """The number of worlds that the checkers judged."""
        return tally.by_checkers

    def prepare(self) -> None:
        """Compile the judge, or load it from the cache."""
        _ = self._judge

    @cached_property
    def _judge(self) -> CompiledChecks:
        from topo_verify.extra.fast.checks import CompiledChecks

        return CompiledChecks()

    def examine(
        self, mappers: Sequence[Target], shard: c.Shard, beat: Beat, look: Look | None = None
    ) -> c.ShardResult:
        """The result of a shard; `look` replaces the campaign's."""
        from topo_verify.extra.fast.checks import SampledChecks

        checks = SampledChecks(self._judge, self.campaign.seed)
        drawn = drawn_row(self.campaign) if is_run_again(self.campaign, mappers) else ()

        def counted(result: c.ShardResult) -> c.ShardResult:
            tally = msgspec.structs.replace(result.tally, by_checkers=checks.worlds)
            return msgspec.structs.replace(result, tally=tally)

        try:
            return counted(c.examine(self.campaign, mappers, shard, beat, look, checks, drawn))
        except c.Interrupted as cut:
            raise c.Interrupted(shard, counted(cut.result)) from None


class NativeExaminer(CompiledExaminer):
    """Examines the shards of a native mapper: it is called in a worker, which it may damage."""

    needs_worker = True
    attempts = 1
    runs_ends_again = True

    @property
    def tells_slow(self) -> bool:
        """Yes: native code beats at every move."""
        return True

    def is_last(self, parts: list[c.ShardResult], losses: int) -> bool:
        """Whether the campaign ends: a shard may cost `MAX_LOSSES` workers."""
        return losses >= MAX_LOSSES or super().is_last(parts, losses)

    def cut(self, shard: c.Shard, items: int) -> list[c.Shard]:
        """Cut a shard around the rank at which its worker was lost, after `items` ranks.

        After the last rank, any of its worlds may have damaged the process: then halve it.
        """
        worlds = shard.stop - shard.start
        if worlds < 2:
            return []
        at = shard.start + items
        cuts = [at, at + 1] if 0 <= items < worlds else [shard.start + worlds // 2]
        return split(shard, sorted({shard.start, *cuts, shard.stop}))

    def is_waiting(self, worker: WorkerProcess) -> bool:
        """Whether a heartbeat is due: native code beats at every move."""
        return bool(worker.due)

    def place_of(self, shard: c.Shard, items: int) -> tuple[c.Shard, int]:
        """The rank where a worker was: native code counts ranks, not runs."""
        rank = shard.start + max(0, min(items, shard.stop - shard.start - 1))
        return c.Shard(shard.edges, rank, rank + 1), 0

    def _lost_in_run(self, shard: c.Shard, loss: WorkerLoss) -> c.ShardResult:
        """The result of a world that native code did not survive: a run in a fresh process.

        If it delivers a map there, the world is undecided.
        """
        mappers = self.campaign.load()
        try:
            result = c.examine(self.campaign, mappers, shard)
        finally:
            c.close(mappers)
        row = self.row_at(shard, 0, str(loss), Loss("engine", loss.how, "right"))
        if row is None or result.tally.failing or result.tally.undecided:
            return result
        return result.with_loss(row)

    def survived(
        self,
        result: c.ShardResult,
        losses: Sequence[tuple[c.Shard, WorkerLoss]],
        given_up: Sequence[c.Shard],
    ) -> c.ShardResult:
        """The result of a shard, with the losses in runs that passed later."""
        result = super().survived(result, losses, given_up)
        if len(losses) - 2 * len(given_up) >= MAX_LOSSES:  # the campaign ends here
            tally = result.tally + Tally(lost=c.MAX_LOST)
            result = msgspec.structs.replace(result, tally=tally)
        return result

    def _lost_once(
        self, shard: c.Shard, loss: WorkerLoss, given_up: Sequence[c.Shard]
    ) -> Row | None:
        if any(shard.start <= part.start < shard.stop for part in given_up):
            return None
        place = self.place_of(shard, loss.items)
        return self.row_at(*place, once_in_words(loss), Loss("engine", loss.how, "right"))
