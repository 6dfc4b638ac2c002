"""Worlds examined by several processes at once, outcomes in the order of the worlds.

Each worker is a process of its own with a program of its own; a thread a worker hands it one world
after the other. Whatever the number of workers, the outcomes are the same in the same order.

A worker that dies, or gives no answer beyond all limits (a Python mapper may do both; a program
behind a pipe cannot), is a finding for its world, and a fresh one takes its place.

    in      the job, then a world a line, each as JSON
    out     a line `null` once it is ready, then an outcome for each world; or a `Broken`
"""

from __future__ import annotations

import json
import os
import select
import shlex
import signal
import subprocess
import sys
from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from queue import SimpleQueue
from types import FrameType, TracebackType
from typing import BinaryIO, Self

import msgspec

from topo_verify.errors import InputError, InternalError
from topo_verify.harness.conform.examiner import Examiner, reference
from topo_verify.harness.conform.outcome import ConformJob, LevelState, WorldFinding, WorldResult
from topo_verify.harness.corpus import Named
from topo_verify.harness.run import explore
from topo_verify.robot.limits import Limits
from topo_verify.world.rooted_map import World

GRACE = 10.0
"""Seconds beyond all limits until a worker is given up."""

LOADING = 120.0
"""Seconds for a worker to load its mapper."""

AHEAD = 4
"""So many worlds a worker are handed out before the first of them is done."""

_START = (
    "import sys, json; sys.path[:] = json.loads(sys.argv[1]);"
    "from topo_verify.harness.conform.parallel import work; work()"
)
"""What a worker runs. It imports from where this process imports, and nothing by accident."""


class Task(msgspec.Struct, frozen=True):
    """A world for a worker."""

    name: str
    code: tuple[tuple[int, ...], tuple[int, ...]]
    group: str
    again: tuple[str, ...]


class Broken(msgspec.Struct, frozen=True, tag=True):
    """The worker cannot go on: bad input, or a bug of ours."""

    text: str
    bug: bool


class Answer(msgspec.Struct, frozen=True, tag=True):
    """What became of a world; None: the worker is ready for the first."""

    outcome: WorldResult | None


_answer: msgspec.json.Decoder[Answer | Broken] = msgspec.json.Decoder(Answer | Broken)


class Gone(Exception):
    """A worker has died or gives no answer; the text says how."""


class Worker:
    """One worker process. Life cycle: made (it loads its mapper), `ask` at will, `end`."""

    def __init__(self, job: ConformJob) -> None:
        self._process = subprocess.Popen(  # noqa: S603  our own module
            [sys.executable, "-c", _START, json.dumps(sys.path)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            bufsize=0,
        )
        usual = Limits().world_timeout  # a failing mapper is run in a witness world, too
        self._patience = GRACE + job.limits.world_timeout + usual
        self._rest = b""
        self._write(msgspec.json.encode(job))
        self._loaded = False

    def ask(self, task: Task) -> WorldResult:
        """What becomes of a world.

        Raises:
            Gone: the worker has died over it, or gives no answer.
            InputError, InternalError: the worker says that it cannot go on.
        """
        if not self._loaded:
            self._read(LOADING)
            self._loaded = True
        self._write(msgspec.json.encode(task))
        made = self._read(self._patience)
        assert made is not None, "an answer to a world is its outcome"
        return made

    def end(self, *, now: bool = False) -> None:
        """No more worlds; `now`: not even the one that it is at."""
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                with suppress(OSError):
                    stream.close()
        if now:
            self._process.send_signal(signal.SIGTERM)
        try:
            self._process.wait(GRACE if not now else 2)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _write(self, line: bytes) -> None:
        assert self._process.stdin is not None
        with suppress(OSError):  # if it is gone, reading will tell
            self._process.stdin.write(line + b"\n")

    def _read(self, seconds: float) -> WorldResult | None:
        assert self._process.stdout is not None
        stream = self._process.stdout.fileno()
        looker = select.poll()
        looker.register(stream, select.POLLIN)
        parts = [self._rest]
        while b"\n" not in parts[-1]:
            if not looker.poll(int(1000 * seconds)):
                raise Gone(f"it gave no sign of life for {seconds:g} s and was ended")
            chunk = os.read(stream, 2**16)
            if not chunk:
                raise Gone(f"it ended its process (exit code {self._process.wait()})")
            parts.append(chunk)
        line, _, self._rest = b"".join(parts).partition(b"\n")
        answer = _answer.decode(line)
        if isinstance(answer, Answer):
            return answer.outcome
        raise (InternalError if answer.bug else InputError)(answer.text)


class Crew:
    """Workers at work. Life cycle: `with` it, `examine` once.

    Raises:
        InputError: the job names no mapper, or its mapper cannot be loaded.
    """

    def __init__(self, job: ConformJob, size: int) -> None:
        reference(job)  # what is wrong with it is told at once
        self._job = job
        self._idle: SimpleQueue[Worker] = SimpleQueue()
        self._workers = [Worker(job) for _ in range(size)]
        for worker in self._workers:
            self._idle.put(worker)
        self._threads = ThreadPoolExecutor(size)

    def examine(self, worlds: Iterable[Named]) -> Iterator[WorldResult]:
        """What becomes of the worlds, in their order."""
        under_way: deque[Future[WorldResult]] = deque()
        for at in worlds:
            under_way.append(self._threads.submit(self._ask, at))
            if len(under_way) >= AHEAD * len(self._workers):
                yield under_way.popleft().result()
        while under_way:
            yield under_way.popleft().result()

    def _ask(self, at: Named) -> WorldResult:
        worker = self._idle.get()
        try:
            return worker.ask(Task(at.name, at.world.code, at.group, at.replay_arguments))
        except Gone as gone:
            worker.end(now=True)
            self._workers.remove(worker)
            worker = Worker(self._job)
            self._workers.append(worker)
            return _lost(at, self._job, str(gone))
        finally:
            self._idle.put(worker)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._threads.shutdown(wait=kind is None, cancel_futures=True)
        for worker in list(self._workers):
            worker.end(now=kind is not None)


def _lost(at: Named, job: ConformJob, told: str) -> WorldResult:
    """A world in which the mapper took its process with it."""
    again = shlex.join([*job.replay_arguments, *at.replay_arguments])
    found = WorldFinding(
        claim="map-isomorphic",
        kind="worker-lost",
        world=at.name,
        event=None,
        expected="a map",
        seen=None,
        message=f"no map was delivered: {told}",
        replay=again,
    )
    states: dict[str, LevelState] = {"result": "failed", "claims": "undecided", "cost": "undecided"}
    if job.like is not None:
        states["decisions"] = "undecided"
    return WorldResult(
        world=at.name,
        group=at.group,
        edges=len(at.world.edges),
        states=states,
        findings={"result": (found,)},
        timeout=True,
        reference=explore(at.world, reference(job)).cost,
    )


# ---------------------------------------------------------------- in the worker


def work() -> None:
    """Examine worlds for the parent until it has no more, or is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent hears it, and decides
    signal.signal(signal.SIGTERM, _leave)
    commands, out = _pipes()
    try:
        job = msgspec.json.decode(commands.readline(), type=ConformJob)
        with Examiner(job) as examiner:
            _send(out, Answer(None))
            for line in commands:
                task = msgspec.json.decode(line, type=Task)
                at = Named(task.name, World.from_code(task.code), task.group, task.again)
                _send(out, Answer(examiner.examine(at)))
    except BrokenPipeError:
        pass  # nobody is there any more
    except InputError as error:
        _send(out, Broken(str(error), bug=False))


def _leave(_signal: int, _frame: FrameType | None) -> None:
    sys.exit(1)  # and end the program on the way out


def _send(out: BinaryIO, message: Answer | Broken) -> None:
    out.write(msgspec.json.encode(message) + b"\n")
    out.flush()


def _pipes() -> tuple[BinaryIO, BinaryIO]:
    """The pipes, moved to where a mapper does not find them."""
    commands, out = os.dup(0), os.dup(1)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.dup2(2, 1)
    return os.fdopen(commands, "rb"), os.fdopen(out, "wb")
