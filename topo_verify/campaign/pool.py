"""A pool of worker processes that survives whatever a task does to its process.

- A worker that ends, or writes no heartbeat for longer than any limit allows, is lost; the rest
  of its process group is killed.
- A task that loses its worker is retried, `Work.attempts` times in all, since something else may
  have killed the worker. Then it is bisected around the item where the worker was last seen.
  `Work.lost` gives the result of a task that cannot be cut.
- No loss is forgotten: `Work.survived` gives the result of a task that passed after a loss.
- Workers are forks that no other program can look into (programs/launcher.py), in their own
  process groups, which end with this process (worker.py).

**Why not a library?** If one worker dies, `concurrent.futures` gives up the whole pool
(`BrokenProcessPool`) and does not say which task was to blame; it cannot end a worker that
hangs. `pebble` replaces a dead worker and names its task, but its timeout covers the whole task:
without a heartbeat it cannot bisect. Workers of both keep standard output where a mapper can
write to it, and fetch tasks under a shared lock, which a dying worker may hold.
"""

from __future__ import annotations

import selectors
from collections.abc import Callable, Generator, Iterable, Iterator
from typing import Generic, Self

import msgspec

from topo_verify.campaign.work import Piece, Pieces, ResultT, TaskT, Work, WorkerLoss
from topo_verify.campaign.worker import (
    Beat,
    TaskDone,
    WorkerDamaged,
    WorkerFailed,
    WorkerProcess,
    WorkerReady,
)
from topo_verify.errors import HelperLost, InputError, InternalError
from topo_verify.programs.launcher import require_launcher

TURN = 0.2
"""Seconds between two looks at the heartbeats."""


class Pool(Generic[TaskT, ResultT]):
    """At most `size` workers on this machine, each started when there is a task for it.

    The second is started after the first result, or if that takes a while: many a search ends with
    its first task.

    On leaving, idle workers end by themselves; busy ones get SIGTERM, then SIGKILL.

    Args:
        in_flight: receives, from time to time, the number of items done in unfinished tasks, and
            the name and the moves of the item that takes longest.
        watched: receives, several times a second, each task with its worker and the seconds since
            the worker's last heartbeat.
        folder: where workers are started; default: the current folder.
    Raises (by `run`):
        InputError: a worker refuses its input, or another process speaks for it.
        InternalError: there is a bug of ours in a worker.
        HelperLost: a signal ended the process that starts workers, or one that a worker needs.
    """

    def __init__(
        self,
        work: Work[TaskT, ResultT],
        size: int,
        *,
        in_flight: Beat | None = None,
        watched: Callable[[TaskT, WorkerProcess, float], None] | None = None,
        folder: str | None = None,
    ) -> None:
        self._work, self._size, self._in_flight, self._folder = work, size, in_flight, folder
        self._watched = watched
        self._workers: list[WorkerProcess] = []
        self._at: dict[WorkerProcess, Piece[TaskT, ResultT]] = {}
        self._pieces = Pieces(work)
        self._goes_on = False

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        for worker in self._workers:
            worker.dismiss(busy=worker in self._at)
        for worker in self._workers:
            worker.await_end()
            worker.kill()

    def run(self, tasks: Iterable[TaskT]) -> Generator[tuple[TaskT, ResultT]]:
        """Yield each task, the same object, and its result, as tasks finish.

        The first tasks are handed out at once.
        """
        todo = iter(tasks)
        self._hand_out(todo)
        return self._results(todo)

    def _results(self, todo: Iterator[TaskT]) -> Generator[tuple[TaskT, ResultT]]:
        while self._at:
            self._listen()
            if self._goes_on:
                self._hand_out(todo)  # first: keeps workers busy while the caller reads a result
            while self._pieces.finished:
                yield self._pieces.finished.popleft()
                self._goes_on = True
            self._hand_out(todo)

    def _hand_out(self, todo: Iterator[TaskT]) -> None:
        idle = [worker for worker in self._workers if worker not in self._at]
        while len(self._at) < (self._size if self._goes_on else 1):
            piece = self._pieces.next(todo)
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
            heard = selector.select(TURN)
            for key, _ in heard:
                self._hear(key.data)
        self._goes_on |= not heard and any(worker.ready for worker in self._workers)
        for worker in tuple(self._at):
            silence = worker.silence()
            if self._watched is not None:
                self._watched(self._at[worker].task, worker, silence)
            limit = self._work.silence if worker.ready else self._work.loading
            if silence > (worker.due or limit):
                self._lose(worker, silence)
                break  # it takes long, and may end the work
        if self._in_flight is not None:
            slowest = max(self._at, key=WorkerProcess.silence, default=None)
            items = sum(worker.items for worker in self._at)
            name, moves = ("", 0) if slowest is None else slowest.heartbeat.at_work()
            if name:
                self._in_flight(items, name, moves)
            else:
                self._in_flight(items)

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
                case WorkerDamaged(text):
                    self._lose(worker, None, text)
                    return
                case WorkerFailed(text, bug, lost):
                    if bug:
                        raise InternalError(f"in a worker: {text}")
                    raise HelperLost(text) if lost else InputError(text)

    def _lose(self, worker: WorkerProcess, silence: float | None, said: str = "") -> None:
        """The worker died or hung: retry its piece, then cut it, then give it up.

        `said`: the exception of a worker that native code may have damaged.
        """
        self._workers.remove(worker)
        code = worker.kill()
        require_launcher()
        piece = self._at.pop(worker, None)
        if piece is None:  # it was idle, so no task is to blame
            return
        loss = WorkerLoss(code, silence, loading=not worker.ready, items=worker.items, said=said)
        piece.deaths += 1
        if worker.ready:
            piece.whole.losses.append((piece.task, loss))
        # one that dies while it loads would die with any piece, unless something else killed it
        if (worker.ready or loss.how == "killed") and piece.deaths < self._work.attempts:
            self._pieces.queue.appendleft(piece)
            return
        if worker.ready:
            division = self._work.division
            if division is not None and self._pieces.replace(
                piece, division.cut(piece.task, worker.items)
            ):
                return
        piece.whole.given_up.append(piece.task)
        self._pieces.finish(piece, self._work.lost(piece.task, loss))
