"""Examines one shard by the checkers: runs every mapper in every world, judges every claim."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import msgspec

from topo_verify.harness.search.choices import examinations
from topo_verify.harness.search.plan import Plan, Shard
from topo_verify.harness.search.tallier import Tallier
from topo_verify.harness.tally import Tally
from topo_verify.harness.worker import Beat
from topo_verify.programs.loader import Target
from topo_verify.world.enumeration.pruned import ranked_tables
from topo_verify.world.rooted_map import World


class Interrupted(KeyboardInterrupt):
    """Ctrl-C came in the middle of a shard.

    Attributes:
        tally: of the worlds of the shard that were finished.
    """

    def __init__(self, tally: Tally) -> None:
        super().__init__()
        self.tally = tally


def examine_by_checkers(
    plan: Plan, mappers: Sequence[Target], shard: Shard, beat: Beat | None = None
) -> Tally:
    """The tally of every mapper in every world of a shard, judged by the checkers.

    A plan that does not keep going has it end at the first world in which a claim fails.

    Args:
        beat: called before each run and each judgement: (worlds of the shard that are finished).
    Raises:
        Interrupted: Ctrl-C.
    """
    tallier = Tallier(shard.edges, tuple(target.text for target in mappers), plan.sampler)
    counts = tallier.counts

    def beats() -> None:
        if beat is not None:
            beat(counts.worlds)

    try:
        for rank, table in ranked_tables(shard.edges, plan.world_class, shard.start, shard.stop):
            world = World.from_code(table)
            tallier.open(rank)
            for target in mappers:
                note = partial(tallier.enter_range, target.text)
                for run, report, killed in examinations(target, plan, world, beats, note):
                    tallier.enter(run, report, killed)
            if tallier.close() and not plan.keep_going:
                break
            if counts.timeouts == plan.max_timeouts:
                break
    except KeyboardInterrupt:
        raise Interrupted(plain(tallier.tally())) from None
    return plain(tallier.tally())


def plain(tally: Tally) -> Tally:
    """The same tally as it comes out of a ledger or another process: data, no mapper's objects."""
    return msgspec.json.decode(msgspec.json.encode(tally), type=Tally)
