"""The work of a pool: tasks, results, and what a lost worker means for its task.

Jobs, tasks and results are JSON data, opaque to this file.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from itertools import chain
from typing import Any, Generic, TypeVar

from topo_verify.campaign.loss import How
from topo_verify.programs.foreign import LOADING
from topo_verify.programs.interruption import FROM_OUTSIDE

TaskT = TypeVar("TaskT")
ResultT = TypeVar("ResultT")


def processors() -> int:
    """The processors that this process may use: a good number of workers."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity is not None else os.cpu_count() or 1


@dataclass(frozen=True)
class WorkerLoss:
    """How a worker was lost.

    Attributes:
        code: its exit code; below 0: the signal that ended it.
        silence: seconds without a heartbeat until it was killed; None: it ended by itself.
        loading: it was not ready for its first task yet.
        items: finished items of its task.
        said: the exception of a worker that native code may have damaged, or "".
    """

    code: int
    silence: float | None
    loading: bool
    items: int = 0
    said: str = ""

    @property
    def how(self) -> How:
        """How it ended; a signal that others send may be the out-of-memory killer's."""
        if self.silence is not None:
            return "silent"
        return "killed" if -self.code in FROM_OUTSIDE and not self.said else "crashed"

    @property
    def status(self) -> str:
        """Its exit status in words, `exit code 3` or `signal 9`; or what it said."""
        signal_or_code = f"signal {-self.code}" if self.code < 0 else f"exit code {self.code}"
        return self.said or signal_or_code

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
    """How a task is cut into smaller tasks.

    Attributes:
        cut: the pieces, given the number of items finished before the loss; fewer than two: none.
        join: one result from those of the pieces, in order.
        last: whether the pieces behind those with these results are dropped, given the number of
            workers that were lost with the task, without the last two of each given-up piece.
    """

    cut: Callable[[TaskT, int], Sequence[TaskT]]
    join: Callable[[list[ResultT]], ResultT]
    last: Callable[[list[ResultT], int], bool]


@dataclass(frozen=True)
class Remote(Generic[TaskT, ResultT]):
    """What other machines need to do a task.

    Attributes:
        remade: `module:function` that makes the same `Work` from its job, as JSON.
        parts: a task cut without reading its items; fewer than two parts: it cannot be cut.
        lost: the result of an uncuttable task that lost its machines; it convicts no mapper.
        require_ours: raises an InputError if a result of the named worker used other files.
    """

    remade: str
    task: type[TaskT]
    parts: Callable[[TaskT], Sequence[TaskT]]
    lost: Callable[[TaskT], ResultT]
    require_ours: Callable[[ResultT, str], None] = lambda _result, _worker: None


@dataclass(frozen=True, kw_only=True)
class Work(Generic[TaskT, ResultT]):
    """What workers do, and what becomes of a task that loses them.

    Attributes:
        serve: `module:function` of a `worker.Serve`.
        job: what each worker gets before its first task.
        lost: the result of a task that was lost with its last worker; it may raise.
        survived: the result of a task that lost workers, given its last result, the losses by
            piece, and the pieces that were given up.
        silence, loading: seconds without a heartbeat, and to get ready, until a worker is lost.
        attempts: the most workers that may be lost with a task.
    """

    serve: str
    job: Any
    result: type[ResultT]
    lost: Callable[[TaskT, WorkerLoss], ResultT]
    survived: Callable[[ResultT, Sequence[tuple[TaskT, WorkerLoss]], Sequence[TaskT]], ResultT] = (
        lambda result, _losses, _given_up: result
    )
    silence: float
    loading: float = LOADING + 10.0  # whoever loads a mapper says first that it takes too long
    attempts: int = 2
    division: Division[TaskT, ResultT] | None = None
    remote: Remote[TaskT, ResultT] | None = None


# ---------------------------------------------------------------- tasks and their pieces


@dataclass(eq=False)
class WholeTask(Generic[TaskT, ResultT]):
    """A task and its pieces in order; at first, it is its only piece.

    Attributes:
        turn: how many tasks were taken before it.
        losses: each with its piece.
        given_up: the pieces that were lost with their last worker.
    """

    task: TaskT
    turn: int
    pieces: list[Piece[TaskT, ResultT]] = field(default_factory=list["Piece[TaskT, ResultT]"])
    losses: list[tuple[TaskT, WorkerLoss]] = field(default_factory=list[tuple[TaskT, WorkerLoss]])
    given_up: list[TaskT] = field(default_factory=list[TaskT])


@dataclass(eq=False)
class Piece(Generic[TaskT, ResultT]):
    """A task or a part of one; `results` holds at most one."""

    task: TaskT
    whole: WholeTask[TaskT, ResultT]
    deaths: int = 0
    results: list[ResultT] = field(default_factory=list[ResultT])


class Pieces(Generic[TaskT, ResultT]):
    """The pieces of a pool's tasks: `queue` before new tasks, and `finished` ones."""

    def __init__(self, work: Work[TaskT, ResultT]) -> None:
        self._work, self._taken = work, 0
        self.queue: deque[Piece[TaskT, ResultT]] = deque()
        self.finished: deque[tuple[TaskT, ResultT]] = deque()

    def next(self, todo: Iterator[TaskT]) -> Piece[TaskT, ResultT] | None:
        """The next piece to be done, of the earliest task that has one; or None."""
        if self.queue:
            piece = min(self.queue, key=lambda waiting: waiting.whole.turn)
            self.queue.remove(piece)
            return piece
        for task in todo:
            whole: WholeTask[TaskT, ResultT] = WholeTask(task, self._taken)
            self._taken += 1
            whole.pieces.append(Piece(task, whole))
            return whole.pieces[0]
        return None

    def finish(self, piece: Piece[TaskT, ResultT], result: ResultT) -> None:
        """Record the result of a piece, and queue the next; the last one finishes a task."""
        piece.results.append(result)
        whole, division = piece.whole, self._work.division
        if division is not None:
            unfinished = [other for other in whole.pieces if not other.results]
            results = [*chain(*(other.results for other in whole.pieces))]
            losses = len(whole.losses) - 2 * len(whole.given_up)
            if unfinished and not division.last(results, losses):
                self.queue.append(unfinished[0])
                return
            result = division.join(results)
        if whole.losses:
            result = self._work.survived(result, whole.losses, whole.given_up)
        self.finished.append((whole.task, result))

    def replace(self, piece: Piece[TaskT, ResultT], tasks: Sequence[TaskT]) -> bool:
        """Put parts in the place of a piece; False if there are fewer than two.

        They are done in order: where one piece hangs, the next one may, too.
        """
        if len(tasks) < 2:
            return False
        whole = piece.whole
        parts = [Piece(task, whole) for task in tasks]
        place = whole.pieces.index(piece)
        whole.pieces[place : place + 1] = parts
        self.queue.append(parts[0])
        return True
