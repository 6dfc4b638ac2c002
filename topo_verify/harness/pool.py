"""The pool of worker processes: tasks in, results out, whatever a task does to its process.

A mapper under test may end its process, crash it, or hold it for ever. So the pool expects to lose
workers, and finds out over what:

- Each worker writes heartbeats while it works. One that ends, or that writes no heartbeat for
  longer than any limit allows, is lost; what is left of its process group is killed.
- A task that loses its worker is tried again, as often as `Work.attempts` says: a stranger may have
  killed the worker. After that it is cut around the item where the worker was last seen, and the
  pieces are tried, down to the one item that kills. A task that cannot be cut is given to
  `Work.lost`, which says what its result is.
- No loss is forgotten: what comes of a task whose worker was lost in an item that was done when it
  was tried again is given to `Work.survived`, which says what that means for the result.
- Workers are started afresh, never forked, import from where this process imports, sit in process
  groups of their own, and end with this process, even if that is killed (`worker.py`).

Results come in the order in which tasks are finished; `in_order` puts them into that of the tasks.
A job, a task and a result are data (JSON); a pool knows nothing of what they mean.

**Why not a library?** `concurrent.futures` gives the whole pool up (`BrokenProcessPool`) when one
worker dies, does not say which task was to blame, and cannot end a worker that hangs. `pebble`
replaces a dead worker and names its task, but its timeout is one for the whole task, however far it
came: no heartbeat, so no bisection, and a task of many worlds has no useful limit. The workers of
both keep standard output where a mapper can write to it, ignore how their parent was killed until
they next read its pipe, and fetch tasks under a lock that they share, with which one of them may
die.

Life cycle of a `Pool`: `with` it, `run` once. On leaving, idle workers end by themselves, busy ones
are told to (SIGTERM), and what is still there after that is killed.
"""

from __future__ import annotations

import os
import selectors
import signal
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from types import TracebackType
from typing import Any, Generic, Protocol, Self, TypeVar

import msgspec

from topo_verify.errors import InputError, InternalError
from topo_verify.harness.worker import TaskDone, WorkerFailed, WorkerProcess, WorkerReady

LOADING = 120.0
"""Seconds that a worker has to get ready."""

TURN = 0.2
"""Seconds between two looks at the heartbeats."""

TaskT = TypeVar("TaskT")
ResultT = TypeVar("ResultT")
ResultT_co = TypeVar("ResultT_co", covariant=True)


def processors() -> int:
    """How many processors this process may use: a good number of workers."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity is not None else os.cpu_count() or 1


# ---------------------------------------------------------------- what a pool works at


@dataclass(frozen=True)
class Loss:
    """How a worker was lost.

    Attributes:
        status: its exit status in words, `exit code 3` or `signal 9`.
        silence: after how many seconds without a heartbeat it was killed; None: it ended itself.
        loading: it was not ready for its first task yet.
        items: so many items of its task were finished.
    """

    status: str
    silence: float | None
    loading: bool
    items: int = 0

    @property
    def stranger(self) -> bool:
        """Whether it may have been lost by nothing that its task did, as by a lack of memory."""
        return self.silence is not None or self.status == f"signal {signal.SIGKILL.value}"

    @property
    def cause(self) -> str:
        """What happened, in brief."""
        if self.silence is None:
            return self.status
        return f"it gave no sign of life for {self.silence:.0f} s"

    def __str__(self) -> str:
        if self.silence is None:
            return f"it ended its process ({self.status})"
        return f"its process was ended, for {self.cause}"


@dataclass(frozen=True)
class Division(Generic[TaskT, ResultT]):
    """How a task is cut into pieces, which are tasks, too.

    Attributes:
        cut: the pieces in their order, given how many items were finished when the worker was lost;
            fewer than two: the task cannot be cut.
        join: one result from those of the pieces, in their order.
        last: no piece behind one with such a result is wanted, and none is joined.
    """

    cut: Callable[[TaskT, int], Sequence[TaskT]]
    join: Callable[[list[ResultT]], ResultT]
    last: Callable[[ResultT], bool]


@dataclass(frozen=True, kw_only=True)
class Work(Generic[TaskT, ResultT]):
    """What the workers of a pool do, and what becomes of a task that loses them.

    Attributes:
        serve: the function that a worker runs, `module:function`; a `worker.Serve`.
        job: what each worker is handed once, before its first task.
        result: the type of a result, to read it from JSON.
        lost: the result of a task that was lost with its last worker; it may raise.
        survived: the result of a task that lost workers, given what it came to in the end, how they
            were lost, each with the piece that it was at, and the pieces that were given up;
            default: what it came to.
        silence: a worker that writes no heartbeat for so many seconds is lost.
        attempts: so many workers may be lost with a task.
        division: how a task is cut; None: it cannot be.
    """

    serve: str
    job: Any
    result: type[ResultT]
    lost: Callable[[TaskT, Loss], ResultT]
    survived: Callable[[ResultT, Sequence[tuple[TaskT, Loss]], Sequence[TaskT]], ResultT] = (
        lambda result, _losses, _given_up: result
    )
    silence: float
    attempts: int = 2
    division: Division[TaskT, ResultT] | None = None


class Backend(Protocol[TaskT, ResultT_co]):
    """Whoever does tasks: the pool here; another one may do them on other machines."""

    def run(
        self, tasks: Iterable[TaskT], *, room: Callable[[], bool] = ...
    ) -> Iterator[tuple[TaskT, ResultT_co]]:
        """Each task, the very object, and its result, in the order in which tasks are finished.

        Args:
            room: asked before a task is taken; while it says no, none is.
        """
        ...


def in_order(
    backend: Backend[TaskT, ResultT], tasks: Iterable[TaskT], *, ahead: int
) -> Iterator[ResultT]:
    """The results in the order of the tasks.

    Args:
        tasks: each an object of its own.
        ahead: at most so many tasks are taken before the first of them is finished: a slow one must
            not fill the memory with results that wait for it.
    """
    taken: deque[TaskT] = deque()
    results: dict[int, ResultT] = {}  # by the identity of the task, which `taken` keeps alive

    def take() -> Iterator[TaskT]:
        for task in tasks:
            taken.append(task)
            yield task

    for finished, result in backend.run(take(), room=lambda: len(taken) < ahead):
        results[id(finished)] = result
        while taken and id(taken[0]) in results:
            yield results.pop(id(taken.popleft()))


# ---------------------------------------------------------------- the pool


@dataclass(eq=False)
class _Whole(Generic[TaskT, ResultT]):
    """A task as it was taken, and its pieces in their order; at first, it is its only piece.

    Attributes:
        losses: how workers were lost with it, each with what it was at.
        given_up: the pieces that were lost with their last worker.
    """

    task: TaskT
    pieces: list[_Piece[TaskT, ResultT]] = field(default_factory=list["_Piece[TaskT, ResultT]"])
    losses: list[tuple[TaskT, Loss]] = field(default_factory=list[tuple[TaskT, Loss]])
    given_up: list[TaskT] = field(default_factory=list[TaskT])


@dataclass(eq=False)
class _Piece(Generic[TaskT, ResultT]):
    """A task or a part of one, done in one go.

    Attributes:
        deaths: how many workers were lost with it.
        results: its result, once it is there.
    """

    task: TaskT
    whole: _Whole[TaskT, ResultT]
    deaths: int = 0
    results: list[ResultT] = field(default_factory=list[ResultT])


class Pool(Generic[TaskT, ResultT]):
    """Workers on this machine. A `Backend`; see above.

    Args:
        size: how many workers at most. Each is started when there is a task for it.
        in_flight: told now and then how many items are finished in tasks that are not.
    Raises (by `run`):
        InputError: a worker says that the input is bad.
        InternalError: there is a bug of ours in a worker.
    """

    def __init__(
        self,
        work: Work[TaskT, ResultT],
        size: int,
        *,
        in_flight: Callable[[int], None] | None = None,
    ) -> None:
        self._work, self._size, self._in_flight = work, size, in_flight
        self._workers: list[WorkerProcess] = []
        self._at: dict[WorkerProcess, _Piece[TaskT, ResultT]] = {}  # what the busy ones are at
        self._queue: deque[_Piece[TaskT, ResultT]] = deque()  # pieces that go before new tasks
        self._finished: deque[tuple[TaskT, ResultT]] = deque()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for worker in self._workers:  # all of them first, so that they end at the same time
            worker.dismiss(busy=worker in self._at)
        for worker in self._workers:
            worker.await_end()
            worker.kill()

    def run(
        self, tasks: Iterable[TaskT], *, room: Callable[[], bool] = lambda: True
    ) -> Generator[tuple[TaskT, ResultT]]:
        """Each task and its result, in the order in which tasks are finished; see `Backend`."""
        todo = iter(tasks)
        self._hand_out(todo, room)
        while self._at:
            self._listen()
            self._hand_out(todo, room)  # first: workers are busy while a result is looked at
            while self._finished:
                yield self._finished.popleft()
            self._hand_out(todo, room)  # again: results that were looked at make room

    def _hand_out(self, todo: Iterator[TaskT], room: Callable[[], bool]) -> None:
        """Give every idle worker a piece, as long as there are any."""
        idle = [worker for worker in self._workers if worker not in self._at]
        while len(self._at) < self._size:
            piece = self._next_piece(todo, room)
            if piece is None:
                return
            if not idle:
                idle = [WorkerProcess(self._work.serve, self._work.job)]
                self._workers += idle
            worker = idle.pop()
            self._at[worker] = piece
            worker.start(piece.task)

    def _next_piece(
        self, todo: Iterator[TaskT], room: Callable[[], bool]
    ) -> _Piece[TaskT, ResultT] | None:
        if self._queue:
            return self._queue.popleft()
        if not room():
            return None
        for task in todo:
            whole: _Whole[TaskT, ResultT] = _Whole(task)
            whole.pieces.append(_Piece(task, whole))
            return whole.pieces[0]
        return None

    def _listen(self) -> None:
        """Take what the workers say, and wait for it, but not for long; give up those that hang."""
        with selectors.DefaultSelector() as selector:
            for worker in self._workers:
                selector.register(worker.out, selectors.EVENT_READ, worker)
            for key, _ in selector.select(TURN):
                self._hear(key.data)
        for worker in tuple(self._at):
            silence = worker.silence()
            if silence > (self._work.silence if worker.ready else LOADING):
                self._lose(worker, silence)
        if self._in_flight is not None:
            self._in_flight(sum(worker.items for worker in self._at))

    def _hear(self, worker: WorkerProcess) -> None:
        """Take what one worker says."""
        messages = worker.hear()
        if messages is None:
            self._lose(worker, None)
            return
        for message in messages:
            match message:
                case WorkerReady():
                    worker.ready = True
                case TaskDone(result):
                    piece = self._at.pop(worker)
                    self._finish(piece, msgspec.json.decode(result, type=self._work.result))
                case WorkerFailed(text, bug):
                    raise InternalError(f"in a worker: {text}") if bug else InputError(text)

    # ------------------------------------------------------------ pieces

    def _finish(self, piece: _Piece[TaskT, ResultT], result: ResultT) -> None:
        """Note the result of a piece; with the last of its pieces a task is finished."""
        piece.results.append(result)
        whole, division = piece.whole, self._work.division
        if division is None:
            self._finish_whole(whole, result)
            return
        if division.last(result):
            behind = whole.pieces[whole.pieces.index(piece) + 1 :]
            dropped = [other for other in behind if other in self._queue]
            self._queue = deque(other for other in self._queue if other not in dropped)
            whole.pieces = [other for other in whole.pieces if other not in dropped]
        if all(other.results for other in whole.pieces):
            results: list[ResultT] = []
            for other in whole.pieces:
                results += other.results
                if division.last(results[-1]):  # a worker may have been at what lies behind
                    break
            self._finish_whole(whole, division.join(results))

    def _finish_whole(self, whole: _Whole[TaskT, ResultT], result: ResultT) -> None:
        if whole.losses:
            result = self._work.survived(result, whole.losses, whole.given_up)
        self._finished.append((whole.task, result))

    def _lose(self, worker: WorkerProcess, silence: float | None) -> None:
        """The worker died or hung: try its piece again, then cut it, then give it up."""
        self._workers.remove(worker)
        status = worker.kill()
        piece = self._at.pop(worker, None)
        if piece is None:  # it was idle: whoever killed it, no task is to blame
            return
        loss = Loss(status, silence, loading=not worker.ready, items=worker.items)
        if worker.ready:  # one that dies while it loads would do so over any piece
            piece.whole.losses.append((piece.task, loss))
            piece.deaths += 1
            if piece.deaths < self._work.attempts:
                self._queue.appendleft(piece)
                return
            if self._cut(piece, worker.items):
                return
        piece.whole.given_up.append(piece.task)
        self._finish(piece, self._work.lost(piece.task, loss))

    def _cut(self, piece: _Piece[TaskT, ResultT], items: int) -> bool:
        """Replace a piece by its parts; False if it has none."""
        division, whole = self._work.division, piece.whole
        tasks = division.cut(piece.task, items) if division is not None else ()
        if len(tasks) < 2:
            return False
        parts = [_Piece(task, whole) for task in tasks]
        place = whole.pieces.index(piece)
        whole.pieces[place : place + 1] = parts
        self._queue.extendleft(reversed(parts))
        return True
