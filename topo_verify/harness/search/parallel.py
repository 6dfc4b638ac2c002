"""Shards examined in other processes: what the pool's workers do for a search.

A world that kills its worker twice is a finding, for no map was delivered. So is a world in which a
worker gives no sign of life for longer than any limit allows: its mapper cannot be interrupted.

A world that kills its worker once, and is done when it is tried again, is a finding, too: a right
mapper does not crash. Unless a stranger may have done it (SIGKILL, as for lack of memory; or no
sign of life): then the world is named and the verdict open.
"""

from __future__ import annotations

import operator
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from functools import reduce
from itertools import pairwise

import msgspec

from topo_verify.checkers import Finding
from topo_verify.errors import InputError
from topo_verify.harness.judge import replay_line
from topo_verify.harness.search.compiled_shard import warm
from topo_verify.harness.search.identity import Identity, merged, source_hash
from topo_verify.harness.search.plan import Plan, Shard
from topo_verify.harness.search.shard import ShardResult, examine_shard
from topo_verify.harness.tally import Failing, Failure, LostWorker, Tally, with_failure
from topo_verify.harness.targets import targets
from topo_verify.harness.work import Division, Loss, Remote, Work
from topo_verify.harness.worker import Beat, Handler
from topo_verify.programs.loaded import Loaded, watch
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.world.enumeration.pruned import ranked_tables

GRACE = 5.0
"""Seconds without a heartbeat, beyond all limits of a run, until a worker is given up."""

COMPILING = 1200.0
"""Seconds that a worker of the compiled engine has to get ready: it compiles, or waits for one."""

MACHINES = "the Dask worker, each time"
"""What was lost with a world, if it was no process of its own."""


class SearchJob(msgspec.Struct, frozen=True):
    """What a worker is handed before its first shard.

    Attributes:
        sources: the hash of the mappers' files.
        depends: further files that they depend on; None: what they load is not asked for.
    """

    plan: Plan
    sources: str
    depends: tuple[str, ...] | None


def shard_work(
    plan: Plan, mappers: Sequence[Target], depends: Sequence[str] | None = None
) -> Work[Shard, ShardResult]:
    """What a pool is to do for a search.

    Args:
        mappers: the targets of the plan, as this process found them.
        depends: further files that they depend on; None: what they load is not asked for.
    """
    return _work_of(
        SearchJob(plan, source_hash(mappers), None if depends is None else tuple(depends))
    )


def remade(job: bytes) -> Work[Shard, ShardResult]:
    """The same work on another machine, made of its job as JSON."""
    return _work_of(msgspec.json.decode(job, type=SearchJob))


def _work_of(job: SearchJob) -> Work[Shard, ShardResult]:
    plan = job.plan

    def lost(shard: Shard, loss: Loss) -> ShardResult:
        """The shard has one world, which is to blame; or none, if it was cut behind the last."""
        if loss.loading:
            raise InputError(
                f"target {plan.targets[0]!r}: a process that loads it ends ({loss.cause})"
            )
        ranks = _ranks(plan, shard)
        return ShardResult(_convicted(plan, shard.edges, ranks[0], loss) if ranks else Tally())

    # A failing mapper is run in a witness world, too, under the usual limits.
    silence = GRACE + max(plan.limits.world_timeout, Limits().world_timeout)
    return Work(
        serve=f"{__name__}:serve_shards",
        job=job,
        result=ShardResult,
        lost=lost,
        survived=lambda result, losses, given_up: _survived(plan, result, losses, given_up),
        silence=silence,
        loading=COMPILING if plan.engine == "compiled" else Work.loading,
        division=Division(
            cut=lambda shard, worlds: _cut(plan, shard, worlds),
            join=_joined,
            last=lambda result: result.tally.failing > 0 and not plan.keep_going,
        ),
        remote=Remote(
            remade=f"{__name__}:{remade.__name__}",
            task=Shard,
            parts=_parts,
            lost=lambda shard: _open(plan, shard),
        ),
    )


def _joined(results: list[ShardResult]) -> ShardResult:
    tally = sum((result.tally for result in results), Tally())
    known = [result.loaded for result in results if result.loaded is not None]
    seconds = [result.seconds for result in results if result.seconds is not None]
    return ShardResult(
        tally,
        reduce(_merged, known) if known else None,
        reduce(operator.add, seconds) if seconds else None,
    )


def _merged(one: Loaded, other: Loaded) -> Loaded:
    return merged(one, other, "the search")


def _cut(plan: Plan, shard: Shard, worlds: int) -> list[Shard]:
    """Cut a shard around the world where its worker was last seen, after so many worlds."""
    ranks = _ranks(plan, shard)
    if len(ranks) < 2:
        return []
    at = min(worlds, len(ranks) - 1)
    cuts = [shard.start, *ranks[max(at, 1) : at + 2], shard.stop]
    return [Shard(shard.edges, start, stop) for start, stop in pairwise(cuts)]


PARTS = 16
"""A shard with which machines were lost is cut into so many parts."""


def _parts(shard: Shard) -> list[Shard]:
    """Parts of a shard, about equal."""
    width = -(-(shard.stop - shard.start) // PARTS)
    starts = range(shard.start, shard.stop, width)
    return [Shard(shard.edges, start, min(start + width, shard.stop)) for start in starts]


def _open(plan: Plan, shard: Shard) -> ShardResult:
    """The result of a shard of one rank with which machines were lost: its world is undecided."""
    lost = tuple(LostWorker(shard.edges, rank, MACHINES) for rank in _ranks(plan, shard))
    return ShardResult(Tally(worlds=len(lost), undecided=len(lost), lost=lost))


def _ranks(plan: Plan, shard: Shard) -> list[int]:
    """The ranks of the worlds in a shard."""
    listed = ranked_tables(shard.edges, plan.world_class, shard.start, shard.stop)
    return [rank for rank, _ in listed]


def _convicted(plan: Plan, edges: int, rank: int, loss: Loss) -> Tally:
    """The tally of one world, in which the mapper took its process with it."""
    tally = _crash(plan, edges, rank, f"no map was delivered: {loss}")
    claim = tally.failures[0].claim
    return msgspec.structs.replace(tally, worlds=1, statuses={claim: {"failed": 1}})


def _crash(plan: Plan, edges: int, rank: int, message: str) -> Tally:
    """The tally of a failure in a world that is counted elsewhere."""
    target, world, claim = plan.targets[0], f"m{edges}/{rank}", "map-isomorphic"
    replay = replay_line(world, target, None, plan.limits.options)
    finding = Finding(claim, None, "a map", None, message, None, world, replay)
    failure = Failure(edges, rank, target, (finding,))
    return Tally(failing=1, claims={claim: Failing(1, failure)}, failures=(failure,))


def _survived(
    plan: Plan,
    result: ShardResult,
    losses: Sequence[tuple[Shard, Loss]],
    given_up: Sequence[Shard],
) -> ShardResult:
    """The result of a shard, with the losses in worlds that were done when tried again."""
    tally = result.tally
    seen: set[int] = set()
    for shard, loss in losses:
        ranks = _ranks(plan, shard)
        rank = ranks[min(loss.items, len(ranks) - 1)] if ranks else shard.start
        failing = {failure.rank for failure in tally.failures}
        if rank in seen | failing or any(one.start <= rank < one.stop for one in given_up):
            continue
        if failing and rank > min(failing) and not plan.keep_going:
            continue  # another worker was ahead: the search ends at the first failing world
        seen.add(rank)
        if loss.stranger:
            lost = LostWorker(shard.edges, rank, loss.cause)
            tally = msgspec.structs.replace(tally, lost=(*tally.lost, lost))
        else:
            message = f"no map was delivered: {loss}; at the second try it delivered one"
            tally = with_failure(tally, _crash(plan, shard.edges, rank, message))
    return msgspec.structs.replace(result, tally=tally)


# ---------------------------------------------------------------- in a worker


@contextmanager
def serve_shards(job: bytes) -> Generator[Handler]:
    """Load the mappers of a `SearchJob`, then examine shards.

    Raises:
        InputError: a mapper cannot be loaded, or its source is another than when the search began.
    """
    search = msgspec.json.decode(job, type=SearchJob)
    plan = search.plan
    if search.depends is not None:
        watch()
    mappers = [
        target for text in plan.targets for target in targets(text, in_process=plan.in_process)
    ]
    if source_hash(mappers) != search.sources:
        raise InputError(
            f"target {plan.targets[0]!r}: its source, or topo-verify's, has changed since the"
            " search began, or is another one on this machine: start it again, with the same"
            " sources everywhere"
        )

    if plan.engine == "compiled":
        warm(plan)
    identity = None if search.depends is None else Identity(mappers, search.depends)

    def examine(shard: bytes, beat: Beat) -> ShardResult:
        found = examine_shard(plan, mappers, msgspec.json.decode(shard, type=Shard), beat)
        if identity is None:
            return found
        return msgspec.structs.replace(found, loaded=identity.loaded())

    yield examine
