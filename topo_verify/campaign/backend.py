"""Examines shards in this process or in worker processes; extras have other backends."""

from __future__ import annotations

import sys
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass
from functools import partial, reduce
from typing import Protocol

import msgspec

from topo_verify.campaign import campaign as c
from topo_verify.campaign.attempt import Look
from topo_verify.campaign.engine import EngineSeconds, on_engine
from topo_verify.campaign.examiner import Examiner, examiner_of, parts_of
from topo_verify.campaign.identity import Identity, merged, require_equal, source_hash
from topo_verify.campaign.loss import Loss
from topo_verify.campaign.pool import Pool
from topo_verify.campaign.progress import Progress
from topo_verify.campaign.row import Row
from topo_verify.campaign.tally import Tally, notable
from topo_verify.campaign.targets import start
from topo_verify.campaign.work import Division, Remote, Work
from topo_verify.campaign.worker import Beat, Handler, WorkerProcess
from topo_verify.errors import InputError
from topo_verify.programs import interruption, launcher
from topo_verify.programs.foreign import Unlisted
from topo_verify.programs.loaded import Loaded, watch
from topo_verify.programs.loader import Target
from topo_verify.programs.program import Program
from topo_verify.robot.limits import Limits

SILENCE_GRACE = 10.0
"""Seconds without a heartbeat, beyond all limits of a run, until a worker is given up."""

_LAST = sys.maxsize
"""Stands for the number of the last run of a shard."""

SHORT_OF_MEMORY = "the mapper raised MemoryError there, and here it did not"
"""Why a world is undecided in which a worker, but not the client, lacked memory."""

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
        examiner = examiner_of(campaign)
        try:
            identity = None if depends is None else Identity(targets, depends)
            for shard in shards:
                yield shard, _examined(examiner, targets, identity, shard, in_flight, look)
        finally:
            if mappers is None:
                c.close(targets)

    return run


def pooled(
    workers: int, depends: Depends = None, note: Callable[[str], None] | None = None
) -> c.Backend:
    """The backend of worker processes; 0: this process.

    An engine may need a worker in any case. `note` receives a sentence on each world where a
    mapper may hang.
    """

    def run(
        campaign: c.Campaign, shards: Iterator[c.Shard], in_flight: c.InFlight
    ) -> c.ShardResults:
        examiner = examiner_of(campaign)
        if not (workers or examiner.needs_worker):
            yield from here(depends=depends)(campaign, shards, in_flight)
            return
        launcher.warm_up(__name__)
        work = work_of(job_of(campaign, depends))
        examiner.prepare()
        watched = None
        if note is not None and examiner.tells_slow:
            watched = partial(_note_slow, examiner, note, set())
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
    examiner: Examiner,
    mappers: Sequence[Target],
    identity: Identity | None,
    shard: c.Shard,
    beat: Beat,
    look: Look | None = None,
) -> c.ShardResult:
    result = examiner.examine(mappers, shard, beat, look)
    if identity is None:
        return result
    try:
        return msgspec.structs.replace(result, loaded=identity.loaded())
    except Unlisted as why:
        cause = f"after the run: {why}"
        row = examiner.row_at(shard, _LAST, cause, Loss("process", "crashed", "wrong"))
        if row is None or result.tally.failing:
            return result
        (wrong,) = row.findings
        findings = (msgspec.structs.replace(wrong, message=cause),)
        return result.with_loss(msgspec.structs.replace(row, findings=findings))


def job_of(campaign: c.Campaign, depends: Depends) -> CampaignJob:
    """The job of each worker."""
    mappers = campaign.load()
    if any(isinstance(target.mapper, Program) for target in mappers):
        launcher.prepare()  # a worker starts foreign programs, so no later launcher can be shielded
    sources = source_hash(mappers)
    return CampaignJob(campaign, sources, None if depends is None else tuple(depends))


def remade(job: bytes) -> Work[c.Shard, c.ShardResult]:
    """The same work on another machine, from its job as JSON."""
    return work_of(msgspec.json.decode(job, type=CampaignJob))


def work_of(job: CampaignJob, ours: Loaded | None = None) -> Work[c.Shard, c.ShardResult]:
    """The work of a campaign's workers; `ours` is what the mappers have loaded here."""
    campaign = job.campaign
    examiner = examiner_of(campaign)

    def require_ours(result: c.ShardResult, worker: str) -> None:
        if ours is not None and result.loaded is not None:
            require_equal(ours, result.loaded, worker)

    # A failing mapper is run in a witness world, too, under the usual limits.
    silence = SILENCE_GRACE + campaign.limits.world_timeout + Limits().world_timeout
    return Work(
        serve=f"{__name__}:{serve.__name__}",
        job=job,
        result=c.ShardResult,
        lost=examiner.lost,
        survived=examiner.survived,
        silence=silence,
        attempts=examiner.attempts,
        loading=examiner.loading,
        division=Division(cut=examiner.cut, join=partial(_joined, campaign), last=examiner.is_last),
        remote=Remote(
            remade=f"{__name__}:{remade.__name__}",
            task=c.Shard,
            parts=parts_of,
            lost=examiner.lost_with_machines,
            require_ours=require_ours,
        ),
    )


def with_our_memory(
    work: Work[c.Shard, c.ShardResult], shard: c.Shard, result: c.ShardResult
) -> c.ShardResult:
    """The result of a worker; if a mapper lacked memory there, the result of a process of ours.

    A worker may have less memory. So a MemoryError refutes only if the mapper fails here, too;
    otherwise the world is undecided. What else failed there stays a finding.
    """
    short = [row for row in result.rows if row.ended == "out-of-memory"]
    if not short:
        return result
    with Pool(work, 1) as pool:
        ((_, again),) = pool.run([shard])
    still = {(row.place, row.mapper) for row in again.rows if row.findings or row.undecided}
    for row in result.rows:
        if (row.place, row.mapper) in still or not row.failed:
            continue
        lost = row
        if row in short:
            lost = msgspec.structs.replace(
                row,
                findings=(),
                undecided=SHORT_OF_MEMORY,
                lost=SHORT_OF_MEMORY,
                loss=Loss("worker", "memory", "right"),
            )
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
        start(mappers)
        if source_hash(mappers) != given.sources:
            raise InputError(
                f"target {given.campaign.mappers[0]!r}: its source, or topo-verify's, has changed"
                " since this began, or is another one on this machine: start it again, with the"
                " same sources everywhere"
            )
        examiner = examiner_of(given.campaign)
        examiner.prepare()
        identity = None if given.depends is None else Identity(mappers, given.depends)

        def handle(task: bytes, beat: Beat) -> c.ShardResult:
            shard = msgspec.json.decode(task, type=c.Shard)
            return _examined(examiner, mappers, identity, shard, beat)

        yield handle
    finally:
        c.close(mappers)
        interruption.end_at_once()  # nothing is left to close


def _joined(campaign: c.Campaign, parts: list[c.ShardResult]) -> c.ShardResult:
    known = [part.loaded for part in parts if part.loaded is not None]
    rows = [row for part in parts for row in part.rows]
    return c.ShardResult(
        sum((part.tally for part in parts), Tally()),
        tuple(rows) if campaign.keep == "all" else notable(rows, campaign.seed),
        reduce(partial(merged, where="the campaign"), known) if known else None,
        sum((part.seconds for part in parts), EngineSeconds()),
    )


def _note_slow(
    examiner: Examiner,
    note: Callable[[str], None],
    noted: set[tuple[int, int]],
    shard: c.Shard,
    worker: WorkerProcess,
    silence: float,
) -> None:
    """Name each world, once, in which a mapper takes half as long as it may without a move."""
    limit = examiner.campaign.limits.move_timeout
    place = shard.edges, shard.start + worker.items
    if place in noted or not examiner.is_waiting(worker) or silence < limit / 2:
        return
    noted.add(place)
    silent = Loss("worker", "silent", "lost")
    row = examiner.row_at(*examiner.place_of(shard, worker.items), "", silent)
    if row is not None:
        less = " (--move-timeout 1 waits less)" if limit > 1 else ""
        note(
            f"{row.world}: no result of the mapper for {silence:.1f} s; if it hangs, it is run"
            f" there again, more than once, before the verdict{less}"
        )


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
