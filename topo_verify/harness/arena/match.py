"""The runs of a league, made by the pool and kept as they are finished."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence

from topo_verify.harness.arena.league import League
from topo_verify.harness.arena.playing import arena_backend
from topo_verify.harness.arena.rows import ArenaJob, ArenaResult, ArenaRun, ArenaTask
from topo_verify.harness.progress import Progress
from topo_verify.harness.search.identity import source_hash
from topo_verify.programs.loader import Target
from topo_verify.programs.program import Program
from topo_verify.robot.limits import Limits

Keep = Callable[[ArenaResult], None]
"""Keeps a result: in a store, or in memory alone; from then on the league's `made` has it."""


def arena_job(
    mappers: Sequence[Target], limits: Limits, *, in_process: bool, identify: bool
) -> ArenaJob:
    """What workers are handed, given the mappers as this process found them."""
    sources = {mapper.text: source_hash([mapper]) for mapper in mappers}
    return ArenaJob(sources=sources, limits=limits, in_process=in_process, identify=identify)


def close(mappers: Iterable[Target]) -> None:
    """End the processes of mappers that were loaded to be looked at."""
    for mapper in mappers:
        if isinstance(mapper.mapper, Program):
            mapper.mapper.close()


def play(league: League, job: ArenaJob, keep: Keep, *, workers: int, tell: Progress) -> None:
    """Make the runs that the league lacks, then measure the memory of those that have a place.

    Of a mapper that breaks a claim no later run is made; all before are, so that its counterexample
    is the first one whatever the number of workers.

    Args:
        workers: so many processes; 0: this one alone.
    """
    first = league.first_failures()

    def wanted() -> Iterator[ArenaTask]:
        for place, task in enumerate(league.planned):
            if task not in league.made and place <= first.get(task.mapper, place):
                yield task

    with arena_backend(job, min(workers, len(league.planned))) as made:
        total = len(league.planned)
        for number, result in enumerate(made(wanted()), 1):
            keep(result)
            run = result.made
            if isinstance(run, ArenaRun) and run.findings:
                place = league.place_of[run.task]
                first[run.mapper] = min(place, first.get(run.mapper, place))
            tell(f"{run.mapper} in {run.world}", number, total)
        measured = [task for task in league.to_measure() if task not in league.made]
        for number, result in enumerate(made(measured), 1):
            keep(result)
            tell("memory", number, len(measured))
