"""The pool of worker processes: tasks in, results out, whatever a task does to its process.

A mapper under test may end its process, crash it, or hold it for ever. So the pool expects to lose
workers, and finds out over what:

- Each worker writes heartbeats while it works. One that ends, or that writes no heartbeat for
  longer than any limit allows, is lost; what is left of its process group is killed.
- A task that loses its worker is tried again, as often as `Work.attempts` says: something else may
  have killed the worker. Then it is cut around the item where the worker was last seen, and the
  pieces are tried, down to the one item that kills. A task that cannot be cut is given to
  `Work.lost`, which returns its result.
- No loss is forgotten: what comes of a task whose worker was lost in an item that was done when it
  was tried again is given to `Work.survived`, which says what that means for the result.
- Workers are forks of a process that has loaded nothing and that no other program can look into
  (programs/launcher.py). They import from where this process imports, sit in process groups of
  their own, and end with this process, even if that is killed (`worker.py`).

Results come in the order in which tasks are finished; `in_order` puts them into that of the tasks.
What the workers do is a `Work` (work.py); it keeps the pieces of the tasks, too.

**Why not a library?** `concurrent.futures` gives the whole pool up (`BrokenProcessPool`) when one
worker dies, does not say which task was to blame, and cannot end a worker that hangs. `pebble`
replaces a dead worker and names its task, but its timeout is one for the whole task, however far it
came: no heartbeat, so no bisection, and a task of many worlds has no useful limit. The workers of
both keep standard output where a mapper can write to it, ignore how their parent was killed until
they next read its pipe, and fetch tasks under a lock that they share, with which one of them may
die.

Life cycle of a `Pool`: `with` it, `run`, once or more. On leaving, idle workers end by themselves,
busy ones are told to (SIGTERM), and what is still there after that is killed.
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
    """Workers on this machine. A `TaskBackend`; see above.

    Args:
        size: the most workers. Each is started when there is a task for it.
        in_flight: called now and then with the number of items done in unfinished tasks.
        folder: where workers are started; None: in the current folder.
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
        self._at: dict[WorkerProcess, Piece[TaskT, ResultT]] = {}  # what the busy ones are at
        self._pieces = Pieces(work)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        for worker in self._workers:  # all of them first, so that they end at the same time
            worker.dismiss(busy=worker in self._at)
        for worker in self._workers:
            worker.await_end()
            worker.kill()

    def run(
        self, tasks: Iterable[TaskT], *, room: Callable[[], bool] = lambda: True
    ) -> Generator[tuple[TaskT, ResultT]]:
        """Each task and its result, in the order in which tasks are finished; see `TaskBackend`.

        The first tasks are handed out at once, not only when the first result is asked for.
        """
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
            self._hand_out(todo, room)  # again: results that were looked at make room

    def _hand_out(self, todo: Iterator[TaskT], room: Callable[[], bool]) -> None:
        """Give every idle worker a piece, as long as there are any."""
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
        """Take what the workers say, and wait for it, but not for long; give up those that hang."""
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
