"""Examines one shard by the compiled engine, and has the checkers judge a part of it again.

The engine is not trusted. From runs of the reference algorithms the checkers judge again:

- every world that the counts name: the first failing ones, of each claim too, so that each
  finding comes from the checkers; the most expensive ones; those in which the first of two
  algorithms costs more. Verdicts and costs must equal the counts'.
- a sample: the first worlds of each slice and, drawn by the campaign's seed, about one world in
  `SAMPLE` with the next one. The counts before such a step plus the reference's of the step must
  equal the counts after it, with the digest, which covers every door.

In these worlds both engines must agree on every event; otherwise topo-verify has a bug, and the
campaign ends.

The engine calls a **native mapper** (`--library`) in place of an algorithm; for the checkers it
runs in its own process. A slice with an undecided world is bisected and run again down to that
world, which runs behind the pipe; the counts of both passes must be equal. If two runs disagree,
the mapper may behave differently each time: all worlds of the slice are undecided, except the one
where they disagree if a claim fails there by the checkers.

What this does not show: the engine alone judged the other worlds. If it is wrong in a share p of
all worlds, n steps show it with a probability of at least 1 - (1 - p)^n.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from functools import cache
from random import Random
from time import process_time
from typing import TYPE_CHECKING, NamedTuple, cast

import msgspec

from topo_verify.campaign import campaign as c
from topo_verify.campaign.attempt import attempt, lost_row, row_of
from topo_verify.campaign.engine import EngineSeconds
from topo_verify.campaign.loss import Loss
from topo_verify.campaign.row import Row
from topo_verify.campaign.run import Exploration, explore
from topo_verify.campaign.tally import KEPT_FAILING, Costs, Counts, Tally, notable
from topo_verify.campaign.worker import Beat, Heartbeat
from topo_verify.checkers import CLAIMS
from topo_verify.errors import InternalError
from topo_verify.programs.library import LIBRARY
from topo_verify.programs.loader import Target, is_library, native_function
from topo_verify.robot.events import Event, Finish, Trace
from topo_verify.world.rooted_map import World

if TYPE_CHECKING:
    from topo_verify.extra.fast.kernels.native_run import NativeCalls
    from topo_verify.extra.fast.snapshots import Snapshot

SAMPLE = 1000
"""Average number of worlds between two steps that the checkers judge as well."""

STEP = (1, 1, 1, 2)
"""Worlds in such a step. A second world is not the first after a pause."""

DECLINED_ONCE = "it was undecided when the engine called it, and delivered a map behind the pipe"
"""The reason why a world is undecided: the mapper declined it in one of two runs."""

DIFFERS = Loss("engine", "differs", "right")
"""Two runs end differently."""

SLICE = 50_000
"""Ranks examined between two heartbeats. The counts of each slice begin empty."""


def warm(campaign: c.Campaign) -> None:
    """Compile the kernels that a campaign needs, or load them from the cache."""
    if campaign.mappers[0].startswith(LIBRARY):
        from topo_verify.extra.fast.kernels.native_run import warm as warm_native

        warm_native()
        return
    from topo_verify.extra.fast.kernels.explore import run_world

    _snapshots(campaign, c.Shard(1, 0, 2))
    run_world(World.from_id("m1/0"), campaign.mappers[0], trace=True)


@cache
def _native(text: str, beats: int) -> NativeCalls:
    from topo_verify.extra.fast.kernels.native_run import NativeCalls

    return NativeCalls(native_function(text), beats)


def examine_compiled(
    campaign: c.Campaign, mappers: Sequence[Target], shard: c.Shard, beat: Beat
) -> c.ShardResult:
    """Run catalogue algorithms in every world of a shard; see `campaign.examine`.

    InternalError: the engine and the checkers disagree.
    """
    calls = None
    if is_library(mappers[0]):
        assert isinstance(beat, Heartbeat), "only a worker process calls native code"
        calls = _native(mappers[0].text, beat.address)
        calls.first, calls.worlds = shard.start, shard.stop - shard.start
    work = _CompiledShard(campaign, mappers, shard, calls, beat)
    try:
        work.examine()
    except KeyboardInterrupt:
        raise c.Interrupted(shard, work.result()) from None
    return work.result()


class _Judged(NamedTuple):
    row: Row
    digest: int


class _CompiledShard:
    """The examination of one shard: `examine`, once; `result` at any time."""

    def __init__(
        self,
        campaign: c.Campaign,
        mappers: Sequence[Target],
        shard: c.Shard,
        calls: NativeCalls | None,
        beat: Beat,
    ) -> None:
        assert isinstance(campaign.worlds, c.Ranks)
        self._campaign, self._worlds = campaign, campaign.worlds
        self._mappers, self._shard, self._calls, self._beat = mappers, shard, calls, beat
        self._tally, self._seconds = Tally(), EngineSeconds()
        self._rows: dict[tuple[int, int], Row] = {}
        self._checked: set[int] = set()
        self._known: dict[tuple[int, int], _Judged] = {}
        self._alone: set[int] = set()

    @property
    def _done(self) -> int:
        """Number of finished runs; a native mapper has finished all worlds of the shard."""
        if self._calls is not None:
            return self._calls.worlds
        return self._tally.worlds * len(self._mappers)

    def _beats(self) -> None:
        self._beat(self._done)

    def result(self) -> c.ShardResult:
        tally = msgspec.structs.replace(self._tally, by_checkers=len(self._checked))
        rows = notable(self._rows.values(), self._campaign.seed)
        return c.ShardResult(tally, rows, None, self._seconds)

    def examine(self) -> None:
        for start in range(self._shard.start, self._shard.stop, SLICE):
            self._beats()
            ranks = self._ranks(start, min(start + SLICE, self._shard.stop))
            self._tally += self._slice(ranks)[1]
            self._known, self._alone = {}, set()
            if self._campaign.stop.reached(self._tally):
                break

    def _ranks(self, start: int, stop: int) -> c.Shard:
        return c.Shard(self._shard.edges, start, stop)

    def _slice(self, ranks: c.Shard) -> tuple[Snapshot, Tally]:
        """The counts of the engine, and the tally that stands."""
        begin = process_time()
        with self._watched():
            *snapshots, end = _snapshots(self._campaign, ranks, self._calls)
        self._beats()
        self._seconds += EngineSeconds(engine=process_time() - begin)
        if end.tally.undecided and ranks.stop == ranks.start + 1:
            return end, self._undecided_world(ranks, end)
        try:
            if end.tally.undecided:
                return end, self._bisected(ranks, end)
            self._check(ranks, snapshots, end)
        except _Disagreement as wrong:
            if self._calls is None:
                raise
            return end, self._unlike(ranks, wrong)
        return end, end.tally

    def _watched(self) -> AbstractContextManager[None]:
        if not isinstance(self._beat, Heartbeat) or self._calls is None:
            return nullcontext()
        return self._beat.within(self._campaign.limits.move_timeout)

    def _check(self, ranks: c.Shard, snapshots: list[Snapshot], end: Snapshot) -> None:
        """Have the checkers judge the worlds that the counts name, and the sample."""
        begin = process_time()
        try:
            self._check_steps(ranks, snapshots, end)
            for which in range(len(self._mappers)):
                self._beats()
                self._require_named(which, end)
            if self._calls is not None and end.rank >= 0:
                self._judged(0, end.rank)  # the last world of the class is among these
        finally:
            self._seconds += EngineSeconds(checkers=process_time() - begin)

    def _check_steps(self, ranks: c.Shard, snapshots: list[Snapshot], end: Snapshot) -> None:
        if not snapshots and end.tally.worlds > max(STEP):
            why = "the engine made no pause"
            raise _Disagreement(f"m{ranks.edges}/{ranks.start}", why, end.rank)
        for before, behind in [*zip([None, *snapshots], snapshots, strict=False)][::2]:
            self._beats()
            first = ranks.start if before is None else before.rank + 1
            self._require_same(before, behind, self._ranks(first, behind.rank + 1))

    def _unlike(self, ranks: c.Shard, wrong: _Disagreement) -> Tally:
        """The tally of a slice in which engine and checkers disagree."""
        alone = self._ranks(wrong.rank, wrong.rank + 1)
        result = c.examine(self._campaign, self._mappers, alone)
        others = sum(1 for _ in self._worlds.worlds(ranks)) - result.tally.worlds
        tally = result.tally + Tally(worlds=others, undecided=others)
        ((place, name, world),) = self._worlds.worlds(alone)
        for row in result.rows:
            self._rows[place, row.turn] = row
        if not (result.tally.failing or result.tally.undecided):
            text, limits = self._mappers[0].text, self._campaign.limits
            row = lost_row(world, place, name, text, limits, wrong.how, DIFFERS)
            self._rows[place, 0] = row
            tally += Tally(undecided=1, lost=1)
        return tally

    def _bisected(self, ranks: c.Shard, end: Snapshot) -> Tally:
        """The tally of a slice with a world that the checkers must decide.

        Raises a _Disagreement if a second pass by the engine counts anything else.
        """
        middle = (ranks.start + ranks.stop) // 2
        first_end, first = self._slice(self._ranks(ranks.start, middle))
        if self._campaign.stop.reached(first):
            return first
        second_end, second = self._slice(self._ranks(middle, ranks.stop))
        again = first_end.tally
        if end.rank >= middle:  # else the first pass stopped before
            again += second_end.tally
        self._require_equal(ranks, end, _fields(again))
        return first + second

    def _require_equal(self, ranks: c.Shard, end: Snapshot, again: dict[str, object]) -> None:
        known = _fields(end.tally)
        for name in {**known, **again}:
            if known.get(name) != again.get(name):
                where = f"m{ranks.edges}/{ranks.start} … {ranks.stop - 1}"
                difference = f"{name}: {known.get(name)} at first, {again.get(name)} run again"
                rank = min((*end.named[0].failing, max(end.rank, ranks.start)))
                raise _Disagreement(f"{where}, {self._campaign.mappers[0]}", difference, rank)

    def _undecided_world(self, alone: c.Shard, end: Snapshot) -> Tally:
        """The tally of a world that the engine leaves open, by a run behind the pipe.

        That run decides only if the engine had no room. Else both count: no machine declines a
        world, so a mapper that now delivers a map does not do the same each time.
        """
        self._checked.add(alone.start)
        result = c.examine(self._campaign, self._mappers, alone)
        is_decided = not (result.tally.failing or result.tally.undecided)
        if self._calls is not None and is_decided and not end.without_room:
            ((place, name, world),) = self._worlds.worlds(alone)
            text, limits = self._mappers[0].text, self._campaign.limits
            row = lost_row(world, place, name, text, limits, DECLINED_ONCE, DIFFERS)
            result = result.with_loss(row)
        self._rows |= {(row.place, row.turn): row for row in result.rows}
        return result.tally

    # ------------------------------------------------------------ by the checkers

    def _require_same(self, before: Snapshot | None, behind: Snapshot, step: c.Shard) -> None:
        """Raise an InternalError unless a step adds to the counts what the reference adds."""
        from topo_verify.extra.fast.snapshots import as_digest

        numbers, digest, met = Counts(), 0, list[list[Row]]()
        for rank, _, _ in self._worlds.worlds(step):
            judged = [self._judged(which, rank) for which in range(len(self._mappers))]
            met.append([run.row for run in judged])
            numbers.enter(met[-1])
            digest += sum(run.digest for run in judged)
        added = msgspec.structs.replace(numbers.tally(), digest=as_digest(digest))
        known = Tally() if before is None else before.tally
        ours, theirs = _fields(known + added), _fields(behind.tally)
        for which in range(len(self._mappers)):
            ours |= self._names(which, before, met)
            theirs |= self._names(which, behind, ())
        for name in {**ours, **theirs}:
            if ours.get(name) != theirs.get(name):
                ranks = f"m{step.edges}/{step.start}"
                if step.stop > step.start + 1:
                    ranks += f" … m{step.edges}/{step.stop - 1}"
                difference = (
                    f"{name}: {ours.get(name)} by the reference, {theirs.get(name)} in the tally"
                )
                where = f"{ranks}, {', '.join(self._campaign.mappers)}"
                raise _Disagreement(where, difference, behind.rank)

    def _names(
        self, which: int, counted: Snapshot | None, met: Sequence[Sequence[Row]]
    ) -> dict[str, object]:
        """The worlds that a mapper's counts name, after more worlds are counted."""
        from topo_verify.extra.fast.kernels.tally import KEPT_RANKS
        from topo_verify.extra.fast.snapshots import DearerWorld

        failing, worst, dearer, most = list[int](), list[int](), list[DearerWorld](), 0
        if counted is not None:
            named, most = counted.named[which], self._most(which, counted)
            failing, worst, dearer = [*named.failing], [*named.worst], [*named.dearer]
        for rows in met:
            row = rows[which]
            if not row.right:
                failing.append(row.place)
                continue
            if row.cost > most:
                most, worst = row.cost, []
            if row.cost == most:
                worst.append(row.place)
            if which == 0 and len(rows) == 2 and rows[1].right and row.cost > rows[1].cost:
                dearer.append(DearerWorld(row.place, row.cost, rows[1].cost))
        return {
            f"failing worlds of mapper {which}": failing[:KEPT_RANKS],
            f"most expensive worlds of mapper {which}": worst[:KEPT_RANKS],
            f"worlds in which mapper {which} costs more": dearer[:KEPT_RANKS],
        }

    def _most(self, which: int, counted: Snapshot) -> int:
        return counted.tally.costs.get(self._campaign.mappers[which], Costs()).most

    def _require_named(self, which: int, end: Snapshot) -> None:
        """Keep the rows of the worlds that a mapper's counts name, once they agree with these."""
        named = end.named[which]
        for rank in sorted({*named.first.values(), *named.failing[:KEPT_FAILING]}):
            row = self._agreed(which, rank)
            claims = [claim for claim, first in named.first.items() if first == rank] or ["a claim"]
            for claim in claims:
                if not row.failed or (claim in CLAIMS and claim not in row.failed):
                    difference = f"{claim} does not fail by the checkers, it does in the tally"
                    raise _Disagreement(f"{row.world}, {row.mapper}", difference, rank)
        costs = [(which, rank, self._most(which, end)) for rank in named.worst]
        for pair in named.dearer:
            costs += [(0, pair.rank, pair.cost), (1, pair.rank, pair.other)]
        for mapper, rank, cost in costs:
            row = self._agreed(mapper, rank)
            if (row.cost, row.right) != (cost, True):
                difference = f"cost {row.cost} by the reference, {cost} in the tally"
                raise _Disagreement(f"{row.world}, {row.mapper}", difference, rank)

    def _agreed(self, which: int, rank: int) -> Row:
        """The row of a run, once the engine says of this world alone what the checkers say."""
        row, _ = self._judged(which, rank)
        if rank not in self._alone:
            self._alone.add(rank)
            ranks = self._ranks(rank, rank + 1)
            with self._watched():
                *_, alone = _snapshots(self._campaign, ranks, self._calls)
            self._require_same(None, alone, ranks)
        self._rows[rank, which] = row
        return row

    def _judged(self, which: int, rank: int) -> _Judged:
        """The judged run of the reference, once its events are those of the engine."""
        if (rank, which) not in self._known:
            from topo_verify.extra.fast.snapshots import run_digest

            self._checked.add(rank)
            target, limits = self._mappers[which], self._campaign.limits
            name = f"m{self._shard.edges}/{rank}"
            world = World.from_id(name)
            judged = attempt(world, target, limits, where=name, beat=self._beats)
            difference = _run_difference(judged.run, *self._engine_run(judged.run))
            if difference is not None:
                raise _Disagreement(f"{name}, {target.text}", difference, rank)
            statuses = judged.report.claims.values()
            digest = run_digest(rank, judged.run.cost, statuses, judged.run.trace)
            self._known[rank, which] = _Judged(row_of(judged, name, rank, which), digest)
            if self._calls is not None:  # such worlds are run again, each in a fresh process
                self._rows[rank, which] = self._known[rank, which].row
        return self._known[rank, which]

    def _engine_run(self, run: Exploration) -> tuple[int, bool, Trace]:
        if self._calls is None:
            limits = self._campaign.limits
            twin = explore(run.world, run.algorithm, limits=limits, engine="compiled")
            return twin.cost, twin.map is not None, twin.trace
        with self._watched():
            native, _ = self._calls.run(run.world)
        return native.cost, native.map is not None, (run.trace[0], *native.events)


class _Disagreement(InternalError):
    """The engine and the checkers disagree; `rank` is of the world, or the last of a step."""

    def __init__(self, where: str, difference: str, rank: int) -> None:
        super().__init__(f"{where}: the engines disagree: {difference}")
        self.rank, self.how = rank, f"the engines disagree: {difference}"


def _snapshots(
    campaign: c.Campaign, ranks: c.Shard, calls: NativeCalls | None = None
) -> list[Snapshot]:
    from topo_verify.extra.fast.snapshots import CompiledRange

    assert isinstance(campaign.worlds, c.Ranks)
    examined = CompiledRange(
        campaign.mappers,
        ranks.edges,
        campaign.worlds.kind,
        ranks.start,
        ranks.stop,
        stop_at_first=campaign.stop.failing is not None,
        calls=calls,
    )
    return list(examined.examine(_steps(campaign, ranks)))


def _steps(campaign: c.Campaign, ranks: c.Shard) -> Iterator[int]:
    """The numbers of worlds in the steps; every other one, from the first on, is judged again."""
    draw = Random(f"{campaign.seed} m{ranks.edges}/{ranks.start}")
    while True:
        yield draw.choice(STEP)
        yield 1 + int(draw.expovariate(1 / SAMPLE))


def _run_difference(run: Exploration, cost: int, has_map: bool, trace: Trace) -> str | None:  # noqa: FBT001  of `_engine_run`
    if (run.cost, run.map is not None) != (cost, has_map):
        return f"cost {run.cost} by the reference, {cost} by the compiled engine"
    for at, (ours, theirs) in enumerate(zip(run.trace, trace, strict=False)):
        if _without_map(ours) != _without_map(theirs):
            return f"event {at} is {ours} by the reference, {theirs} by the compiled engine"
    if len(run.trace) != len(trace):
        return f"{len(run.trace)} events by the reference, {len(trace)} by the compiled engine"
    return None


def _without_map(event: Event) -> Event | int | None:
    return event.cost if isinstance(event, Finish) else event


# ---------------------------------------------------------------- tallies compared


def _fields(tally: Tally) -> dict[str, object]:
    fields: dict[str, object] = {}
    for name in tally.__struct_fields__:
        value: object = getattr(tally, name)
        if isinstance(value, dict):
            entries = cast("dict[str, object]", value)
            fields |= {f"{name} of {key}": entry for key, entry in entries.items()}
        else:
            fields[name] = value
    return fields
