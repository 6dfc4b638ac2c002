"""Examines one shard: every mapper in every world of it, by the engine of the plan."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from topo_verify.harness.search.by_checkers import Interrupted, examine_by_checkers, plain
from topo_verify.harness.search.compiled_shard import CompiledShard, EngineSeconds
from topo_verify.harness.search.plan import Plan, Shard
from topo_verify.harness.tally import Tally
from topo_verify.harness.worker import Beat
from topo_verify.programs.loaded import Loaded
from topo_verify.programs.loader import Target


class ShardResult(msgspec.Struct, frozen=True):
    """What came of one shard.

    Attributes:
        tally: of its worlds.
        loaded: what the mappers had loaded then; None: nobody asked.
        seconds: what the compiled engine and the checkers took; None: the checkers did all.
    """

    tally: Tally
    loaded: Loaded | None = None
    seconds: EngineSeconds | None = None


def examine_shard(
    plan: Plan, mappers: Sequence[Target], shard: Shard, beat: Beat | None = None
) -> ShardResult:
    """What every mapper did in every world of a shard.

    Args:
        beat: called before anything that may take long: (worlds of the shard that are finished).
    Raises:
        Interrupted: Ctrl-C.
        InternalError: the compiled engine and the checkers disagree.
    """
    if plan.engine == "reference":
        return ShardResult(examine_by_checkers(plan, mappers, shard, beat))
    made = CompiledShard(plan, mappers, shard)
    try:
        made.examine(beat or (lambda _worlds: None))
    except KeyboardInterrupt:
        raise Interrupted(plain(made.tally())) from None
    return ShardResult(plain(made.tally()), seconds=made.seconds)
