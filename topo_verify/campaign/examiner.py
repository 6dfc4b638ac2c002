"""How the shards of a campaign are examined, and what a lost worker means for them.

A lost worker means the same in every study: loss.py has the table. An engine that calls code in its
own worker processes replaces some of this.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise

from topo_verify.campaign import campaign as c
from topo_verify.campaign.attempt import Look, lost_row
from topo_verify.campaign.drawn_row import drawn_row, is_run_again
from topo_verify.campaign.engine import engine_of
from topo_verify.campaign.loss import Loss
from topo_verify.campaign.row import SECOND_TRY, Row
from topo_verify.campaign.tally import Counts, Tally
from topo_verify.campaign.work import Work, WorkerLoss
from topo_verify.campaign.worker import Beat, WorkerProcess, function_at
from topo_verify.errors import HelperLost, InputError
from topo_verify.programs.loader import Target

PARTS = 16
"""Parts of a shard that lost whole machines."""

MACHINES = "the Dask worker was lost, each time"


def examiner_of(campaign: c.Campaign) -> Examiner:
    """What examines the shards of a campaign; the worlds of a list always the reference."""
    place = engine_of(campaign.engine).examiner
    if place is None or not isinstance(campaign.worlds, c.Ranks):
        return Examiner(campaign)
    examiner: Examiner = function_at(place)(campaign)
    return examiner


class Examiner:
    """Examines the shards of one campaign by the reference engine.

    Attributes:
        needs_worker: shards are examined in a worker process, even with `workers=0`.
        attempts, loading: as in `Work`.
        judged_by: what judged the worlds, in words.
        runs_ends_again: the first and the last row of a search are run again, too.
    """

    needs_worker = False
    attempts = Work.attempts
    loading = Work.loading
    judged_by = "the checkers"
    runs_ends_again = False

    def __init__(self, campaign: c.Campaign) -> None:
        self.campaign = campaign

    @property
    def tells_slow(self) -> bool:
        """Whether a world in which a mapper may hang is named while the campaign runs."""
        return self.campaign.ways is None

    def judged_by_checkers(self, tally: Tally) -> int:
        """The number of worlds that the checkers judged."""
        return tally.worlds

    def prepare(self) -> None:
        """Do once what each worker of this machine would have to do otherwise."""

    def examine(
        self, mappers: Sequence[Target], shard: c.Shard, beat: Beat, look: Look | None = None
    ) -> c.ShardResult:
        """The result of a shard; `look` replaces the campaign's."""
        drawn = drawn_row(self.campaign) if is_run_again(self.campaign, mappers) else ()
        return c.examine(self.campaign, mappers, shard, beat, look, drawn=drawn)

    # ------------------------------------------------------------ pieces of shards

    def is_last(self, parts: list[c.ShardResult], losses: int) -> bool:
        """Whether the campaign ends in these parts of a shard, which lost `losses` workers."""
        del losses
        return self.campaign.stop.reached(sum((part.tally for part in parts), Tally()))

    def cut(self, shard: c.Shard, items: int) -> list[c.Shard]:
        """Cut a shard around the world at which its worker was lost, after `items` runs."""
        places = [place for place, _, _ in self.campaign.worlds.worlds(shard)]
        if len(places) < 2:
            return []
        at = min(items // len(self.campaign.mappers), len(places) - 1)
        return split(shard, [shard.start, *places[max(at, 1) : at + 2], shard.stop])

    # ------------------------------------------------------------ lost workers

    def is_waiting(self, worker: WorkerProcess) -> bool:
        """Whether a silent worker is in a run, and not still on its way to the first."""
        return bool(worker.beats)

    def place_of(self, shard: c.Shard, items: int) -> tuple[c.Shard, int]:
        """Where a worker was after `items` items: in a shard, after this number of runs."""
        return shard, items

    def lost(self, shard: c.Shard, loss: WorkerLoss) -> c.ShardResult:
        """The result of a shard of at most one world that was lost with its last worker."""
        if loss.loading:
            raise (HelperLost if loss.how == "killed" else InputError)(
                f"target {self.campaign.mappers[0]!r}: a process that loads it ends ({loss.cause})"
            )
        return self._lost_in_run(shard, loss)

    def _lost_in_run(self, shard: c.Shard, loss: WorkerLoss) -> c.ShardResult:
        killed = loss.how == "killed"
        words = f"its worker was killed each time ({loss.status})" if killed else str(loss)
        row = self.row_at(shard, loss.items, words, Loss("worker", loss.how, "lost"))
        return counted([] if row is None else [[row]])

    def survived(
        self,
        result: c.ShardResult,
        losses: Sequence[tuple[c.Shard, WorkerLoss]],
        given_up: Sequence[c.Shard],
    ) -> c.ShardResult:
        """The result of a shard, with the losses in runs that passed later."""
        for shard, loss in losses:
            row = self._lost_once(shard, loss, given_up)
            failing = [known.place for known in result.rows if known.failed]
            if (
                row is None
                or any(
                    known.place == row.place and (known.failed or known.is_lost)
                    for known in result.rows
                )
                or any(part.start <= row.place < part.stop for part in given_up)
                # Another worker was ahead of the failing world at which the campaign ends.
                or (failing and self.campaign.stop.failing == 1 and row.place > min(failing))
            ):
                continue
            result = result.with_loss(row)
        return result

    def _lost_once(
        self, shard: c.Shard, loss: WorkerLoss, given_up: Sequence[c.Shard]
    ) -> Row | None:
        """The row of a run that lost its worker once, if the shard is not given up."""
        del given_up
        return self.row_at(
            shard, loss.items, once_in_words(loss), Loss("worker", loss.how, "right")
        )

    def lost_with_machines(self, shard: c.Shard) -> c.ShardResult:
        """The result of a shard that lost whole machines."""
        worlds = self.campaign.worlds.worlds(shard)
        mapper, limits = self.campaign.mappers[0], self.campaign.limits
        lost = Loss("machine", "silent", "lost")
        return counted(
            [lost_row(world, place, name, mapper, limits, MACHINES, lost)]
            for place, name, world in worlds
        )

    def row_at(self, shard: c.Shard, runs: int, cause: str, loss: Loss) -> Row | None:
        """The row of the run in which a worker was lost, after `runs` runs."""
        worlds, mappers = list(self.campaign.worlds.worlds(shard)), self.campaign.mappers
        if not worlds:
            return None
        at, which = divmod(min(runs, len(worlds) * len(mappers) - 1), len(mappers))
        place, name, world = worlds[at]
        limits = self.campaign.limits
        return lost_row(world, place, name, mappers[which], limits, cause, loss)


def once_in_words(loss: WorkerLoss) -> str:
    """How a worker was lost before a run that passed."""
    return f"{loss}{SECOND_TRY}" if loss.how == "crashed" else loss.cause


def parts_of(shard: c.Shard) -> list[c.Shard]:
    """A shard in `PARTS` parts."""
    width = -(-(shard.stop - shard.start) // PARTS)
    return split(shard, [*range(shard.start, shard.stop, width), shard.stop])


def split(shard: c.Shard, cuts: Sequence[int]) -> list[c.Shard]:
    """The parts of a shard between these places."""
    begin = shard.start
    return [
        c.Shard(shard.edges, start, stop, shard.listed[start - begin : stop - begin])
        for start, stop in pairwise(cuts)
    ]


def counted(worlds: Iterable[Sequence[Row]]) -> c.ShardResult:
    """The result of a shard that keeps all of these rows, grouped by world."""
    counts, rows = Counts(), list[Row]()
    for world in worlds:
        counts.enter(world)
        rows += world
    return c.ShardResult(counts.tally(), tuple(rows))
