"""Tasks and their pieces: what waits, what is finished, and how pieces are joined again.

A task that loses its workers is cut into pieces, which are done like tasks. Whoever does them, on
this machine or on others, keeps its books here.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Generic

from topo_verify.campaign.work import Loss, ResultT, TaskT, Work


@dataclass(eq=False)
class WholeTask(Generic[TaskT, ResultT]):
    """A task as it was taken, and its pieces in their order; at first, it is its only piece.

    Attributes:
        losses: how workers were lost with it, each with what it was at.
        given_up: the pieces that were lost with their last worker.
    """

    task: TaskT
    pieces: list[Piece[TaskT, ResultT]] = field(default_factory=list["Piece[TaskT, ResultT]"])
    losses: list[tuple[TaskT, Loss]] = field(default_factory=list[tuple[TaskT, Loss]])
    given_up: list[TaskT] = field(default_factory=list[TaskT])


@dataclass(eq=False)
class Piece(Generic[TaskT, ResultT]):
    """A task or a part of one, done in one go.

    Attributes:
        deaths: how many workers were lost with it.
        results: its result, once it is there.
    """

    task: TaskT
    whole: WholeTask[TaskT, ResultT]
    deaths: int = 0
    results: list[ResultT] = field(default_factory=list[ResultT])


class Pieces(Generic[TaskT, ResultT]):
    """The pieces of the tasks of some work. It lives as long as a pool.

    Attributes:
        queue: pieces that go before new tasks.
        finished: tasks that are finished, each with its result, until somebody takes them.
    """

    def __init__(self, work: Work[TaskT, ResultT]) -> None:
        self._work = work
        self.queue: deque[Piece[TaskT, ResultT]] = deque()
        self.finished: deque[tuple[TaskT, ResultT]] = deque()

    def next(self, todo: Iterator[TaskT], room: Callable[[], bool]) -> Piece[TaskT, ResultT] | None:
        """The piece that is done next; None if there is none, or no room for a new task."""
        if self.queue:
            return self.queue.popleft()
        if not room():
            return None
        for task in todo:
            whole: WholeTask[TaskT, ResultT] = WholeTask(task)
            whole.pieces.append(Piece(task, whole))
            return whole.pieces[0]
        return None

    def finish(self, piece: Piece[TaskT, ResultT], result: ResultT) -> None:
        """Note the result of a piece; with the last of its pieces a task is finished."""
        piece.results.append(result)
        whole, division = piece.whole, self._work.division
        if division is None:
            self._finish_whole(whole, result)
            return
        if division.last(result):
            behind = whole.pieces[whole.pieces.index(piece) + 1 :]
            dropped = [other for other in behind if other in self.queue]
            self.queue = deque(other for other in self.queue if other not in dropped)
            whole.pieces = [other for other in whole.pieces if other not in dropped]
        if all(other.results for other in whole.pieces):
            results: list[ResultT] = []
            for other in whole.pieces:
                results += other.results
                if division.last(results[-1]):  # a worker may have been at what lies behind
                    break
            self._finish_whole(whole, division.join(results))

    def _finish_whole(self, whole: WholeTask[TaskT, ResultT], result: ResultT) -> None:
        if whole.losses:
            result = self._work.survived(result, whole.losses, whole.given_up)
        self.finished.append((whole.task, result))

    def replace(self, piece: Piece[TaskT, ResultT], tasks: Sequence[TaskT]) -> bool:
        """Put parts in the place of a piece; False if there are fewer than two."""
        if len(tasks) < 2:
            return False
        whole = piece.whole
        parts = [Piece(task, whole) for task in tasks]
        place = whole.pieces.index(piece)
        whole.pieces[place : place + 1] = parts
        self.queue.extendleft(reversed(parts))
        return True
