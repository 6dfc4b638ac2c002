"""Worlds examined in other processes: what the pool's workers do for `conform`.

Each worker has an `Examiner`, and so a program, of its own. A worker that dies over a world, or
hangs in it, is lost; the world is tried again. What a mapper did is a finding: that its process
ended with an exit code, crashed, or hung twice. A worker that was killed (SIGKILL) may be the deed
of a stranger, as of a system without memory: then the world is undecided, whatever came after. A
program behind a pipe can do none of it; it is ended with its worker.
"""

from __future__ import annotations

import shlex
import signal
import sys
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager
from types import FrameType

import msgspec

from topo_verify.harness.conform.examiner import Examiner, reference
from topo_verify.harness.conform.order import Examine, Placed
from topo_verify.harness.conform.outcome import (
    LEVELS,
    ConformJob,
    Level,
    LevelState,
    WorldFinding,
    WorldResult,
    undecided_by_a_stranger,
)
from topo_verify.harness.corpus import Named
from topo_verify.harness.pool import Pool
from topo_verify.harness.run import explore
from topo_verify.harness.work import Loss, Work
from topo_verify.harness.worker import Beat, Handler
from topo_verify.robot.limits import Limits
from topo_verify.world.rooted_map import World

GRACE = 10.0
"""Seconds beyond all limits of a run until a worker is given up."""


class ConformTask(msgspec.Struct, frozen=True):
    """A world of the corpus as data: a `Placed`."""

    place: int
    name: str
    code: tuple[tuple[int, ...], tuple[int, ...]]
    group: str
    replay_arguments: tuple[str, ...]

    @property
    def world(self) -> Named:
        """The world of the corpus."""
        return Named(self.name, World.from_code(self.code), self.group, self.replay_arguments)


@contextmanager
def parallel_examine(job: ConformJob, workers: int) -> Generator[Examine]:
    """Examines worlds in so many processes.

    Raises:
        InputError: the job names no mapper, or its mapper cannot be loaded.
    """
    with Examiner(job):  # before any worker is started: the message is then the first
        pass
    with Pool(_work(job), workers) as pool:

        def examine(
            worlds: Iterator[Placed], room: Callable[[], bool]
        ) -> Iterator[tuple[int, WorldResult]]:
            tasks = (
                ConformTask(place, at.name, at.world.code, at.group, at.replay_arguments)
                for place, at in worlds
            )
            for task, made in pool.run(tasks, room=room):
                yield task.place, made

        yield examine


def _work(job: ConformJob) -> Work[ConformTask, WorldResult]:
    # A failing mapper is run in a witness world, too, under the usual limits.
    silence = GRACE + job.limits.world_timeout + Limits().world_timeout
    return Work(
        serve=f"{__name__}:serve_worlds",
        job=job,
        result=WorldResult,
        lost=lambda task, loss: _lost(task.world, job, loss),
        survived=lambda result, losses, given_up: (
            result if given_up else _survived(result, job, losses)
        ),
        silence=silence,
    )


def _lost(at: Named, job: ConformJob, loss: Loss) -> WorldResult:
    """The outcome of a world in which a worker was lost each time."""
    states: dict[str, LevelState] = dict.fromkeys(_levels(job), "undecided")
    made = WorldResult(
        world=at.name,
        group=at.group,
        edges=len(at.world.edges),
        states=states,
        findings={},
        timeout=True,
        reference=explore(at.world, reference(job)).cost,
    )
    if loss.stranger and loss.silence is None:
        return msgspec.structs.replace(made, why=f"its worker was killed each time ({loss.status})")
    return _convicted(made, job, at, f"no map was delivered: {loss}")


def _survived(
    made: WorldResult, job: ConformJob, losses: Sequence[tuple[ConformTask, Loss]]
) -> WorldResult:
    """The outcome of a world in which a worker was lost, and which was done when tried again."""
    task, loss = losses[0]
    if not loss.stranger:
        message = f"no map was delivered: {loss}; at the second try it delivered one"
        return _convicted(made, job, task.world, message)
    return undecided_by_a_stranger(made, f"its worker was lost ({loss.cause})")


def _convicted(made: WorldResult, job: ConformJob, at: Named, message: str) -> WorldResult:
    """The outcome of a world in which the mapper took its process with it."""
    found = WorldFinding(
        claim="map-isomorphic",
        kind="worker-lost",
        world=at.name,
        event=None,
        expected="a map",
        seen=None,
        message=message,
        replay=shlex.join([*job.replay_arguments, *at.replay_arguments]),
    )
    return msgspec.structs.replace(
        made,
        states={**made.states, "result": "failed"},
        findings={**made.findings, "result": (found,)},
    )


def _levels(job: ConformJob) -> list[Level]:
    return [level for level in LEVELS if job.like is not None or level != "decisions"]


# ---------------------------------------------------------------- in a worker


@contextmanager
def serve_worlds(job: bytes) -> Generator[Handler]:
    """Load the mapper of a `ConformJob`, or start its program, then examine worlds.

    Raises:
        InputError: there is no such mapper, program, algorithm or policy.
    """
    signal.signal(signal.SIGTERM, _leave)
    with Examiner(msgspec.json.decode(job, type=ConformJob)) as examiner:

        def examine(task: bytes, _beat: Beat) -> WorldResult:
            return examiner.examine(msgspec.json.decode(task, type=ConformTask).world)

        yield examine


def _leave(_signal: int, _frame: FrameType | None) -> None:
    sys.exit(1)  # through the context of the examiner, which ends the program
