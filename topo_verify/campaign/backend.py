"""Examines shards in this process or in worker processes; extras have other backends.

A lost worker means the same in every study:

- A run that loses its worker twice is a finding, since it delivers no map. So is a run whose
  worker is silent for longer than any limit allows.
- A run that loses its worker once and passes later is a finding, too: a right mapper does not
  crash.
- If something else may have ended the worker (a signal from outside, or silence before a run that
  passed), the world is undecided.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from functools import partial, reduce
from itertools import pairwise
from typing import Protocol

import msgspec

from topo_verify.campaign import campaign as c
from topo_verify.campaign.attempt import Look, lost_row
from topo_verify.campaign.drawn_row import drawn_row, is_run_again
from topo_verify.campaign.identity import Identity, merged, require_equal, source_hash
from topo_verify.campaign.pool import Pool
from topo_verify.campaign.progress import Progress
from topo_verify.campaign.row import SECOND_TRY, Row
from topo_verify.campaign.run import on_engine
from topo_verify.campaign.tally import Counts, Tally, notable
from topo_verify.campaign.work import Division, Loss, Remote, Work
from topo_verify.campaign.worker import Beat, Handler, WorkerProcess
from topo_verify.errors import HelperLost, InputError
from topo_verify.programs import interruption
from topo_verify.programs.foreign import Unlisted
from topo_verify.programs.library import LIBRARY
from topo_verify.programs.loaded import Loaded, watch
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits

SILENCE_GRACE = 10.0
"""Seconds without a heartbeat, beyond all limits of a run, until a worker is given up."""

COMPILING = 1200.0
"""Seconds that a worker of the compiled engine has to get ready."""

PARTS = 16
"""Parts of a shard that lost whole machines."""

_LAST = sys.maxsize
"""Stands for the number of the last run of a shard."""

MAX_LOSSES = 8
"""Workers that a native mapper may cost in one shard, beside those of given-up worlds."""

MACHINES = "the Dask worker was lost, each time"

SHORT_OF_MEMORY = "the mapper raised MemoryError there, and here it did not"
"""Why a world is undecided in which a worker, but not the client, lacked memory."""

_MEMORY_ERROR = re.compile(r"the mapper raised \w*MemoryError\b")

Depends = Sequence[str] | None
"""Further files that mappers depend on; None: do not ask what they load."""


class CampaignJob(msgspec.Struct, frozen=True):
    """What a worker gets before its first shard; `sources` is a hash of the mappers' files."""

    campaign: c.Campaign
    sources: str
    depends: tuple[str, ...] | None = None


def here(
    mappers: Sequence[Target] | None = None, *, depends: Depends = None, look: Look | None = None
) -> c.Backend:
    """The backend that works in this process; it closes only mappers that it loads.

    `look` replaces the campaign's.
    """

    def run(
        campaign: c.Campaign, shards: Iterator[c.Shard], in_flight: c.InFlight
    ) -> c.ShardResults:
        targets = campaign.load() if mappers is None else mappers
        try:
            identity = None if depends is None else Identity(targets, depends)
            for shard in shards:
                yield shard, _examined(campaign, targets, identity, shard, in_flight, look)
        finally:
            if mappers is None:
                c.close(targets)

    return run


def pooled(
    workers: int, depends: Depends = None, note: Callable[[str], None] | None = None
) -> c.Backend:
    """The backend of worker processes; 0: this process.

    The compiled engine always calls native mappers in a worker. `note` receives a sentence on
    each world where a mapper may hang.
    """

    def run(
        campaign: c.Campaign, shards: Iterator[c.Shard], in_flight: c.InFlight
    ) -> c.ShardResults:
        native = calls_native(campaign)
        if not (workers or native):
            yield from here(depends=depends)(campaign, shards, in_flight)
            return
        work = work_of(job_of(campaign, depends))
        prepare(campaign)
        watched = None
        if note is not None and (native or (campaign.engine, campaign.ways) == ("reference", None)):
            watched = partial(_note_slow, campaign, note, set())
        with Pool(work, max(1, workers), in_flight=in_flight, watched=watched) as pool:
            for shard, result in pool.run(shards):
                yield shard, with_our_memory(work, shard, result)

    return run


MakeBackend = Callable[[Depends], c.Backend]
"""Makes a backend for a campaign whose mappers depend on these files."""


class Elsewhere(Protocol):
    """Where shards are examined if not in processes of this machine; an extra brings it."""

    def opened(self, workers: int | None = None) -> AbstractContextManager[MakeBackend]:
        """Make it ready while the block lasts; InputError if `workers` are asked for, too."""
        ...


def _examined(
    campaign: c.Campaign,
    mappers: Sequence[Target],
    identity: Identity | None,
    shard: c.Shard,
    beat: Beat,
    look: Look | None = None,
) -> c.ShardResult:
    if campaign.engine == "compiled" and isinstance(campaign.worlds, c.Ranks):
        from topo_verify.campaign.compiled import examine_compiled

        result = examine_compiled(campaign, mappers, shard, beat)
    else:
        drawn = drawn_row(campaign) if is_run_again(campaign, mappers) else ()
        result = c.examine(campaign, mappers, shard, beat, look, drawn=drawn)
    if identity is None:
        return result
    try:
        return msgspec.structs.replace(result, loaded=identity.loaded())
    except Unlisted as why:
        cause = f"after the run: {why}"
        row = _row_at(campaign, shard, _LAST, cause, external=False)
        if row is None or result.tally.failing:
            return result
        (wrong,) = row.findings
        findings = (msgspec.structs.replace(wrong, message=cause),)
        return result.with_loss(msgspec.structs.replace(row, findings=findings))


def calls_native(campaign: c.Campaign) -> bool:
    """Whether the compiled engine calls a native mapper."""
    is_library = any(text.startswith(LIBRARY) for text in campaign.mappers)
    return is_library and campaign.engine == "compiled" and isinstance(campaign.worlds, c.Ranks)


def prepare(campaign: c.Campaign) -> None:
    """Do once what each worker of this machine would have to do otherwise."""
    if campaign.engine == "compiled" and isinstance(campaign.worlds, c.Ranks):
        from topo_verify.campaign.compiled import warm

        warm(campaign)


def job_of(campaign: c.Campaign, depends: Depends) -> CampaignJob:
    """The job of each worker; the mappers are loaded here for a moment."""
    mappers = campaign.load()
    try:
        sources = source_hash(mappers)
    finally:
        c.close(mappers)
    return CampaignJob(campaign, sources, None if depends is None else tuple(depends))


def remade(job: bytes) -> Work[c.Shard, c.ShardResult]:
    """The same work on another machine, from its job as JSON."""
    return work_of(msgspec.json.decode(job, type=CampaignJob))


def work_of(job: CampaignJob, ours: Loaded | None = None) -> Work[c.Shard, c.ShardResult]:
    """The work of a campaign's workers; `ours` is what the mappers have loaded here."""
    campaign = job.campaign

    def require_ours(result: c.ShardResult, worker: str) -> None:
        if ours is not None and result.loaded is not None:
            require_equal(ours, result.loaded, worker)

    # A failing mapper is run in a witness world, too, under the usual limits.
    silence = SILENCE_GRACE + campaign.limits.world_timeout + Limits().world_timeout
    return Work(
        serve=f"{__name__}:{serve.__name__}",
        job=job,
        result=c.ShardResult,
        lost=partial(_lost, campaign),
        survived=partial(_survived, campaign),
        silence=silence,
        attempts=1 if calls_native(campaign) else Work.attempts,
        loading=COMPILING if campaign.engine == "compiled" else Work.loading,
        division=Division(
            cut=partial(_cut, campaign),
            join=partial(_joined, campaign),
            last=partial(_is_last, campaign),
        ),
        remote=Remote(
            remade=f"{__name__}:{remade.__name__}",
            task=c.Shard,
            parts=_parts,
            lost=partial(_open, campaign),
            require_ours=require_ours,
        ),
    )


def _is_last(campaign: c.Campaign, parts: list[c.ShardResult], losses: int) -> bool:
    """Whether the campaign ends in these parts of a shard, which lost this number of workers."""
    if calls_native(campaign) and losses >= MAX_LOSSES:
        return True
    return campaign.stop.reached(sum((part.tally for part in parts), Tally()))


def with_our_memory(
    work: Work[c.Shard, c.ShardResult], shard: c.Shard, result: c.ShardResult
) -> c.ShardResult:
    """The result of a worker; if a mapper lacked memory there, the result of a process of ours.

    A worker may have less memory. So a MemoryError refutes only if the mapper fails here, too;
    otherwise the world is undecided. What else failed there stays a finding.
    """
    short = [
        row for row in result.rows if any(_MEMORY_ERROR.search(f.message) for f in row.findings)
    ]
    if not short:
        return result
    with Pool(work, 1) as pool:
        ((_, again),) = pool.run([shard])
    still = {(row.place, row.mapper) for row in again.rows if row.findings or row.undecided}
    for row in result.rows:
        if (row.place, row.mapper) in still or not row.failed:
            continue
        why = SHORT_OF_MEMORY if row in short else None
        findings = () if why else row.findings
        lost = msgspec.structs.replace(row, findings=findings, undecided=why, lost=why)
        again = again.with_loss(lost)
    return again


# ---------------------------------------------------------------- in a worker


@contextmanager
def serve(job: bytes) -> Generator[Handler]:
    """Load the mappers of a `CampaignJob`, then examine shards.

    InputError: a mapper cannot be loaded, or its source has changed.
    """
    interruption.end_at_sigterm()
    given = msgspec.json.decode(job, type=CampaignJob)
    if given.depends is not None:
        watch()
    mappers = given.campaign.load()
    try:
        if source_hash(mappers) != given.sources:
            raise InputError(
                f"target {given.campaign.mappers[0]!r}: its source, or topo-verify's, has changed"
                " since this began, or is another one on this machine: start it again, with the"
                " same sources everywhere"
            )
        prepare(given.campaign)
        identity = None if given.depends is None else Identity(mappers, given.depends)

        def handle(task: bytes, beat: Beat) -> c.ShardResult:
            shard = msgspec.json.decode(task, type=c.Shard)
            return _examined(given.campaign, mappers, identity, shard, beat)

        yield handle
    finally:
        c.close(mappers)
        interruption.end_at_once()  # nothing is left to close


# ---------------------------------------------------------------- pieces of shards


def _joined(campaign: c.Campaign, parts: list[c.ShardResult]) -> c.ShardResult:
    known = [part.loaded for part in parts if part.loaded is not None]
    rows = [row for part in parts for row in part.rows]
    return c.ShardResult(
        sum((part.tally for part in parts), Tally()),
        tuple(rows) if campaign.keep == "all" else notable(rows, campaign.seed),
        reduce(partial(merged, where="the campaign"), known) if known else None,
        sum((part.seconds for part in parts), c.EngineSeconds()),
    )


def _cut(campaign: c.Campaign, shard: c.Shard, runs: int) -> list[c.Shard]:
    """Cut a shard around the world at which its worker was lost, after `runs` runs."""
    if calls_native(campaign):
        return _cut_at_rank(shard, runs)
    places = [place for place, _, _ in campaign.worlds.worlds(shard)]
    if len(places) < 2:
        return []
    at = min(runs // len(campaign.mappers), len(places) - 1)
    return _split(shard, [shard.start, *places[max(at, 1) : at + 2], shard.stop])


def _cut_at_rank(shard: c.Shard, ranks: int) -> list[c.Shard]:
    """Cut a shard around the rank at which native code was lost.

    After the last rank, any of its worlds may have damaged the process: then halve it.
    """
    worlds = shard.stop - shard.start
    if worlds < 2:
        return []
    at = shard.start + ranks
    cuts = [at, at + 1] if 0 <= ranks < worlds else [shard.start + worlds // 2]
    return _split(shard, sorted({shard.start, *cuts, shard.stop}))


def _parts(shard: c.Shard) -> list[c.Shard]:
    width = -(-(shard.stop - shard.start) // PARTS)
    return _split(shard, [*range(shard.start, shard.stop, width), shard.stop])


def _split(shard: c.Shard, cuts: Sequence[int]) -> list[c.Shard]:
    begin = shard.start
    return [
        c.Shard(shard.edges, start, stop, shard.listed[start - begin : stop - begin])
        for start, stop in pairwise(cuts)
    ]


# ---------------------------------------------------------------- lost workers


def _lost(campaign: c.Campaign, shard: c.Shard, loss: Loss) -> c.ShardResult:
    """The result of a shard of at most one world that was lost with its last worker."""
    if loss.loading:
        was_ended = loss.maybe_external and loss.silence is None
        raise (HelperLost if was_ended else InputError)(
            f"target {campaign.mappers[0]!r}: a process that loads it ends ({loss.cause})"
        )
    if calls_native(campaign):
        return _lost_in_native_code(campaign, shard, loss)
    external = loss.maybe_external and loss.silence is None
    row = _row_at(campaign, shard, loss.items, str(loss), external=external)
    if row is not None and external:
        why = f"its worker was killed each time ({loss.status})"
        row = msgspec.structs.replace(row, undecided=why, lost=why)
    return counted([] if row is None else [[row]])


def _lost_in_native_code(campaign: c.Campaign, shard: c.Shard, loss: Loss) -> c.ShardResult:
    """The result of a world that native code did not survive: a run in a fresh process.

    If it delivers a map there, the world is undecided.
    """
    mappers = campaign.load()
    try:
        result = c.examine(campaign, mappers, shard)
    finally:
        c.close(mappers)
    row = _row_at(campaign, shard, 0, str(loss), external=True)
    if row is None or result.tally.failing or result.tally.undecided:
        return result
    return result.with_loss(row)


def _open(campaign: c.Campaign, shard: c.Shard) -> c.ShardResult:
    """The result of a shard that lost whole machines."""
    worlds = campaign.worlds.worlds(shard)
    mapper, limits = campaign.mappers[0], campaign.limits
    return counted(
        [lost_row(world, place, name, mapper, limits, MACHINES, external=True)]
        for place, name, world in worlds
    )


def counted(worlds: Iterable[Sequence[Row]]) -> c.ShardResult:
    """The result of a shard that keeps all of these rows, grouped by world."""
    counts, rows = Counts(), list[Row]()
    for world in worlds:
        counts.enter(world)
        rows += world
    return c.ShardResult(counts.tally(), tuple(rows))


def _row_at(
    campaign: c.Campaign, shard: c.Shard, runs: int, cause: str, *, external: bool
) -> Row | None:
    """The row of the run in which a worker was lost, after `runs` runs."""
    worlds = list(campaign.worlds.worlds(shard))
    if not worlds:
        return None
    at, which = divmod(min(runs, len(worlds) * len(campaign.mappers) - 1), len(campaign.mappers))
    place, name, world = worlds[at]
    mapper = campaign.mappers[which]
    return lost_row(world, place, name, mapper, campaign.limits, cause, external=external)


def _lost_at(campaign: c.Campaign, shard: c.Shard, items: int) -> tuple[c.Shard, int]:
    """Where a worker was after `items` items: native code counts ranks, not runs."""
    if not calls_native(campaign):
        return shard, items
    rank = shard.start + max(0, min(items, shard.stop - shard.start - 1))
    return c.Shard(shard.edges, rank, rank + 1), 0


def _note_slow(
    campaign: c.Campaign,
    note: Callable[[str], None],
    noted: set[tuple[int, int]],
    shard: c.Shard,
    worker: WorkerProcess,
    silence: float,
) -> None:
    """Name each world, once, in which a mapper takes half as long as it may without a move."""
    limit, place = campaign.limits.move_timeout, (shard.edges, shard.start + worker.items)
    waits = worker.due if calls_native(campaign) else worker.beats
    if place in noted or not waits or silence < limit / 2:
        return
    noted.add(place)
    row = _row_at(campaign, *_lost_at(campaign, shard, worker.items), "", external=True)
    if row is not None:
        less = " (--move-timeout 1 waits less)" if limit > 1 else ""
        note(
            f"{row.world}: no result of the mapper for {silence:.1f} s; if it hangs, it is run"
            f" there again, more than once, before the verdict{less}"
        )


def _survived(
    campaign: c.Campaign,
    result: c.ShardResult,
    losses: Sequence[tuple[c.Shard, Loss]],
    given_up: Sequence[c.Shard],
) -> c.ShardResult:
    """The result of a shard, with the losses in runs that passed later."""
    for shard, loss in losses:
        cause = loss.cause if loss.maybe_external else f"{loss}{SECOND_TRY}"
        native = calls_native(campaign)
        if native and any(shard.start <= part.start < shard.stop for part in given_up):
            continue
        at, external = _lost_at(campaign, shard, loss.items), native or loss.maybe_external
        row = _row_at(campaign, *at, cause, external=external)
        failing = [known.place for known in result.rows if known.failed]
        if (
            row is None
            or any(
                known.place == row.place and (known.failed or known.lost) for known in result.rows
            )
            or any(part.start <= row.place < part.stop for part in given_up)
            # Another worker was ahead of the failing world at which the campaign ends.
            or (failing and campaign.stop.failing == 1 and row.place > min(failing))
        ):
            continue
        result = result.with_loss(row)
    # The campaign ends here.
    if calls_native(campaign) and len(losses) - 2 * len(given_up) >= MAX_LOSSES:
        tally = result.tally + Tally(lost=c.MAX_LOST)
        result = msgspec.structs.replace(result, tally=tally)
    return result


# ---------------------------------------------------------------- one campaign a mapper


@dataclass(frozen=True)
class MapperCampaign:
    """The runs of one mapper in a list of worlds.

    Unlike in a campaign of several mappers, another one can join later, and each stops at its
    first failing world. The store finds a world by name and code, not by its place in the list.
    """

    campaign: c.Campaign
    worlds: c.NamedWorlds
    store: c.ShardMemory | None = None
    mapper: Target | None = None

    @property
    def total(self) -> int:
        """The number of worlds."""
        return sum(self.campaign.worlds.totals().values())

    @property
    def stored(self) -> int:
        """The number of these worlds in the store."""
        if self.store is None:
            return 0
        return sum(self.store.get(shard) is not None for shard in c.listed_shards(self.worlds))

    def rows(self, workers: int, tell: Progress | None = None) -> Iterator[Row]:
        """The rows in the order of the worlds; those that the store lacks are made."""
        depends = None if self.store is None else ()
        backend = pooled(min(workers, self.total), depends)
        if self.mapper is not None and not workers:
            mappers = on_engine(self.campaign.engine, (self.mapper,), self.campaign.limits)
            backend = here(mappers, depends=depends)
        for shard, result in c.results(
            self.campaign, backend, self.worlds, store=self.store, tell=tell
        ):
            # A store may know the world from a place of another list.
            yield from (msgspec.structs.replace(row, place=shard.start) for row in result.rows)
