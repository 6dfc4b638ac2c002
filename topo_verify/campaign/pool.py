"""The pool of worker processes: tasks in, results out, whatever a task does to its process.

A mapper under test may end its process, crash it, or hold it for ever. So:

- A worker that ends, or writes no heartbeat for longer than any limit allows, is lost; the rest of
  its process group is killed.
- A task that loses its worker is tried again, `Work.attempts` times in all: something else may have
  killed the worker. Then it is cut around the item where the worker was last seen, down to the one
  item that kills. `Work.lost` gives the result of a task that cannot be cut.
- No loss is forgotten: `Work.survived` gives the result of a task that lost a worker and passed
  later.
- Workers are forks that no other program can look into (programs/launcher.py), in process groups of
  their own, which end with this process (worker.py).

**Why not a library?** `concurrent.futures` gives the whole pool up (`BrokenProcessPool`) when one
worker dies, does not say which task was to blame, and cannot end a worker that hangs. `pebble`
replaces a dead worker and names its task, but its timeout is for the whole task: no heartbeat, so
    no
bisection. The workers of both keep standard output where a mapper can write to it, and fetch tasks
under a shared lock, with which one of them may die.
"""

from __future__ import annotations

import selectors
from collections.abc import Callable, Generator, Iterable, Iterator
from typing import Generic, Self

import msgspec

from topo_verify.campaign.work import Loss, Piece, Pieces, ResultT, TaskT, Work
from topo_verify.campaign.worker import TaskDone, WorkerFailed, WorkerProcess, WorkerReady
from topo_verify.errors import InputError, InternalError

TURN = 0.2
"""Seconds between two looks at the heartbeats."""


class Pool(Generic[TaskT, ResultT]):
    """Workers on this machine, a `TaskBackend`.

    On leaving, idle workers end by themselves, busy ones get SIGTERM, then SIGKILL.

    Args:
        size: the most workers; each is started when there is a task for it.
        in_flight: called now and then with the number of items done in unfinished tasks.
        folder: where workers are started; default: the current folder.
    Raises (by `run`):
        InputError: a worker says that the input is bad, or another process speaks for a worker.
        InternalError: there is a bug of ours in a worker.
    """

    def __init__(
        self,
        work: Work[TaskT, ResultT],
        size: int,
        *,
        in_flight: Callable[[int], None] | None = None,
        folder: str | None = None,
    ) -> None:
        self._work, self._size, self._in_flight, self._folder = work, size, in_flight, folder
        self._workers: list[WorkerProcess] = []
        self._at: dict[WorkerProcess, Piece[TaskT, ResultT]] = {}
        self._pieces = Pieces(work)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        for worker in self._workers:
            worker.dismiss(busy=worker in self._at)
        for worker in self._workers:
            worker.await_end()
            worker.kill()

    def run(
        self, tasks: Iterable[TaskT], *, room: Callable[[], bool] = lambda: True
    ) -> Generator[tuple[TaskT, ResultT]]:
        """As `TaskBackend.run`. The first tasks are handed out at once."""
        todo = iter(tasks)
        self._hand_out(todo, room)
        return self._results(todo, room)

    def _results(
        self, todo: Iterator[TaskT], room: Callable[[], bool]
    ) -> Generator[tuple[TaskT, ResultT]]:
        while self._at:
            self._listen()
            self._hand_out(todo, room)  # first: workers are busy while a result is looked at
            while self._pieces.finished:
                yield self._pieces.finished.popleft()
            self._hand_out(todo, room)

    def _hand_out(self, todo: Iterator[TaskT], room: Callable[[], bool]) -> None:
        idle = [worker for worker in self._workers if worker not in self._at]
        while len(self._at) < self._size:
            piece = self._pieces.next(todo, room)
            if piece is None:
                return
            if not idle:
                idle = [WorkerProcess(self._work.serve, self._work.job, self._folder)]
                self._workers += idle
            worker = idle.pop()
            self._at[worker] = piece
            worker.start(piece.task)

    def _listen(self) -> None:
        """Take messages of the workers, waiting briefly; give up those that hang."""
        with selectors.DefaultSelector() as selector:
            for worker in self._workers:
                selector.register(worker.out, selectors.EVENT_READ, worker)
            for key, _ in selector.select(TURN):
                self._hear(key.data)
        for worker in tuple(self._at):
            silence = worker.silence()
            limit = self._work.silence if worker.ready else self._work.loading
            if silence > (worker.due or limit):
                self._lose(worker, silence)
        if self._in_flight is not None:
            self._in_flight(sum(worker.items for worker in self._at))

    def _hear(self, worker: WorkerProcess) -> None:
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
                    self._pieces.finish(piece, msgspec.json.decode(result, type=self._work.result))
                case WorkerFailed(text, bug):
                    raise InternalError(f"in a worker: {text}") if bug else InputError(text)

    def _lose(self, worker: WorkerProcess, silence: float | None) -> None:
        """The worker died or hung: try its piece again, then cut it, then give it up."""
        self._workers.remove(worker)
        status = worker.kill()
        piece = self._at.pop(worker, None)
        if piece is None:  # it was idle, so no task is to blame
            return
        loss = Loss(status, silence, loading=not worker.ready, items=worker.items)
        if worker.ready:  # one that dies while it loads would do so over any piece
            piece.whole.losses.append((piece.task, loss))
            piece.deaths += 1
            if piece.deaths < self._work.attempts:
                self._pieces.queue.appendleft(piece)
                return
            division = self._work.division
            if division is not None and self._pieces.replace(
                piece, division.cut(piece.task, worker.items)
            ):
                return
        piece.whole.given_up.append(piece.task)
        self._pieces.finish(piece, self._work.lost(piece.task, loss))
