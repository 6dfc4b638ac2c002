"""Runs in the arena: each judged by every claim, here or by the workers of the pool.

A run is timed and judged as in `conform`: a mapper that is not of the catalogue has a process of
its own, limits end what hangs, and a run whose process was killed is tried again (second_try.py).
Memory is measured apart, since the process of a worker also keeps the trace and judges it: the
mapper plays one world in a fresh process of its own, an algorithm of the catalogue too, and the
system says what its resident set was at most. What this does not show: memory of processes that a
program starts.
"""

from __future__ import annotations

import re
import signal
import sys
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from types import FrameType, TracebackType
from typing import Self

import msgspec

from topo_verify.algorithms import NAMED
from topo_verify.checkers import Finding
from topo_verify.errors import InputError
from topo_verify.harness.arena.rows import (
    KEPT_OF_RUN,
    ArenaJob,
    ArenaResult,
    ArenaRun,
    ArenaTask,
    ClaimCount,
    MemoryRun,
)
from topo_verify.harness.judge import Report, judge, replay_line, undecided
from topo_verify.harness.pool import Pool
from topo_verify.harness.run import Exploration, explore
from topo_verify.harness.search.identity import Identity, source_hash
from topo_verify.harness.second_try import tried
from topo_verify.harness.targets import one_target
from topo_verify.harness.work import Loss, Work
from topo_verify.harness.worker import Beat, Handler
from topo_verify.programs import serve
from topo_verify.programs.foreign import Foreign
from topo_verify.programs.loaded import watch
from topo_verify.programs.loader import Target
from topo_verify.programs.program import PREFIX, Program
from topo_verify.robot.limits import Limits
from topo_verify.robot.stopwatch import Stopwatch
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import World

GRACE = 10.0
"""Seconds beyond all limits of a run until a worker is given up."""


class ArenaPlayer:
    """Makes runs in this process. Life cycle: `with` it; programs run from their first world on.

    Args:
        job: the mappers; each is loaded when it has its first run.
    """

    def __init__(self, job: ArenaJob) -> None:
        self.job = job
        self._targets: dict[str, Target] = {}
        self._identities: dict[str, Identity] = {}
        if job.identify:
            watch()  # before any mapper is loaded

    def play(self, task: ArenaTask) -> ArenaResult:
        """The run, judged, or the measurement of its memory.

        Raises:
            InputError: there is no such mapper, or its files have changed since the call began.
        """
        if task.memory:
            kibibytes = peak_memory(task.mapper, _world(task.world), self.job.limits)
            return ArenaResult(MemoryRun(task.mapper, task.world, kibibytes))
        made = arena_run(self._target(task.mapper), task, self.job.limits)
        identity = self._identities.get(task.mapper)
        return ArenaResult(made, None if identity is None else identity.loaded())

    def _target(self, text: str) -> Target:
        if text not in self._targets:
            found = one_target(text, in_process=self.job.in_process)
            if source_hash([found]) != self.job.sources[text]:
                raise InputError(
                    f"target {text!r}: its source, or topo-verify's, has changed since this began:"
                    " start it again"
                )
            self._targets[text] = found
            if self.job.identify:
                self._identities[text] = Identity([found])
        return self._targets[text]

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for target in self._targets.values():
            if isinstance(target.mapper, Program):
                target.mapper.close()


def arena_run(target: Target, task: ArenaTask, limits: Limits) -> ArenaRun:
    """Run a mapper in a world and judge the run."""
    world = _world(task.world)
    program = target.mapper if isinstance(target.mapper, Program) else None
    if program is not None:
        program.start()  # the time of the first run is not that of a start
    watch_of_run, seconds = Stopwatch(), list[float]()

    def judged(run: Exploration) -> Report:
        seconds.append(watch_of_run.seconds())
        report = judge(run, where=task.world, options=limits.options)
        if program is not None:
            program.settle()  # it may have been run in a witness world, too
        return report

    run, report, killed = tried(world, target, limits, judged)
    why = None if killed is None else f"its process was ended by {killed}, perhaps by a stranger"
    if undecided(run, report):
        open_claims = [name for name, status in report.claims.items() if status == "undecided"]
        why = run.stopped or f"undecided: {', '.join(open_claims)}"
    made = ArenaRun(
        mapper=task.mapper,
        world=task.world,
        edges=len(world.edges),
        least=world.least_cost(),
        cost=run.cost,
        rejected_free=run.rejected_free,
        rejected_moving=run.rejected_moving,
        claims=tuple(ClaimCount(j.status, j.judged, j.of) for j in report.judgements),
        findings=() if why else report.findings[:KEPT_OF_RUN],
        undecided=why,
        seconds=seconds[0],
    )
    # As another process would send it, so that it holds no object of the mapper's.
    return _decoder.decode(msgspec.json.encode(made, enc_hook=repr))


_decoder = msgspec.json.Decoder(ArenaRun)


@lru_cache(maxsize=64)  # mappers meet the same worlds
def _world(text: str) -> World:
    return resolve_world(text)


# ---------------------------------------------------------------- memory


def peak_memory(mapper: str, world: World, limits: Limits) -> int | None:
    """The kibibytes that a mapper's own process took at most, once it has played a world.

    None if the system does not tell, or the process ended.
    """
    with _alone(mapper) as program:
        explore(world, Target(mapper, program), limits=limits)
        return _peak_of(program.process)


def _alone(mapper: str) -> Program:
    """The mapper in a process of its own, whatever it is."""
    if mapper.startswith(PREFIX):
        return Program(mapper.removeprefix(PREFIX))
    return Foreign(serve.CATALOGUE.format(mapper) if mapper in NAMED else mapper)


def _peak_of(process: int | None) -> int | None:
    with suppress(OSError):
        status = Path(f"/proc/{process}/status").read_text(encoding="ascii", errors="replace")
        if (found := re.search(r"^VmHWM:\s+(\d+) kB$", status, re.MULTILINE)) is not None:
            return int(found[1])
    return None


# ---------------------------------------------------------------- many runs


@contextmanager
def arena_backend(
    job: ArenaJob, workers: int
) -> Generator[Callable[[Iterable[ArenaTask]], Iterator[ArenaResult]]]:
    """Makes runs in so many processes, 0: in this one; results come as they are finished."""
    if not workers:
        with ArenaPlayer(job) as player:
            yield lambda tasks: map(player.play, tasks)
        return
    with Pool(_work(job), workers) as pool:
        yield lambda tasks: (made for _, made in pool.run(tasks))


def _work(job: ArenaJob) -> Work[ArenaTask, ArenaResult]:
    return Work(
        serve=f"{__name__}:serve_arena",
        job=job,
        result=ArenaResult,
        lost=lambda task, loss: ArenaResult(_lost(task, job, loss)),
        # A failing mapper is run in a witness world, too, under the usual limits.
        silence=GRACE + job.limits.world_timeout + Limits().world_timeout,
    )


def _lost(task: ArenaTask, job: ArenaJob, loss: Loss) -> ArenaRun | MemoryRun:
    """The run with which a worker was lost each time: the mapper's deed, or a stranger's."""
    if loss.loading:
        raise InputError(f"target {task.mapper!r}: a process that loads it ends ({loss.cause})")
    if task.memory:
        return MemoryRun(task.mapper, task.world, None)
    world = _world(task.world)
    made = ArenaRun(
        mapper=task.mapper, world=task.world, edges=len(world.edges), least=world.least_cost()
    )
    if loss.stranger and loss.silence is None:
        why = f"its worker was killed each time ({loss.status})"
        return msgspec.structs.replace(made, undecided=why)
    found = Finding(
        claim="map-isomorphic",
        event=None,
        expected="a map",
        seen=None,
        message=f"no map was delivered: {loss}",
        world=task.world,
        replay=replay_line(task.world, task.mapper, None, job.limits.options),
    )
    return msgspec.structs.replace(made, findings=(found,))


@contextmanager
def serve_arena(job: bytes) -> Generator[Handler]:
    """Make the runs that come; see `topo_verify.harness.worker`."""
    signal.signal(signal.SIGTERM, _leave)
    with ArenaPlayer(msgspec.json.decode(job, type=ArenaJob)) as player:

        def handle(task: bytes, _beat: Beat) -> ArenaResult:
            return player.play(msgspec.json.decode(task, type=ArenaTask))

        yield handle


def _leave(_signal: int, _frame: FrameType | None) -> None:
    sys.exit(1)  # through the context of the player, which ends programs
