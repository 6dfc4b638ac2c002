"""Calls a function in worker processes, while this process does something else."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from math import inf
from typing import Any, Generic, Self, TypeVar

import msgspec

from topo_verify.campaign.pool import Pool
from topo_verify.campaign.work import Work, WorkerLoss
from topo_verify.campaign.worker import Handler, function_at
from topo_verify.errors import InternalError

R = TypeVar("R")


class CallsJob(msgspec.Struct, frozen=True):
    """What a worker gets before its first call."""

    function: str
    arguments: tuple[Any, ...]


@contextmanager
def serve_calls(job: bytes) -> Generator[Handler]:
    """Call the function of a `CallsJob` with one name after the other."""
    asked = msgspec.json.decode(job, type=CallsJob)
    function = function_at(asked.function)
    yield lambda name, _beat: function(msgspec.json.decode(name, type=str), *asked.arguments)


class Beside(Generic[R]):
    """Calls a module's function with each of some names: `with` it, then `result`.

    `arguments` follow the name; they and the result are JSON.
    """

    def __init__(
        self,
        function: Callable[..., R],
        names: Sequence[str],
        arguments: Sequence[object],
        *,
        result: type[R],
        workers: int,
    ) -> None:
        work = Work(
            serve=f"{__name__}:{serve_calls.__name__}",
            job=CallsJob(f"{function.__module__}:{function.__name__}", tuple(arguments)),
            result=result,
            lost=_lost,
            silence=inf,  # a call may take an hour
        )
        self._pool = Pool(work, workers)
        self._finished = self._pool.run(names)
        self._results: dict[str, R] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self._pool.__exit__()

    def result(self, name: str) -> R:
        """The result of the call with this name, once it is finished."""
        while name not in self._results:
            finished, result = next(self._finished)
            self._results[finished] = result
        return self._results[name]


def _lost(name: str, loss: WorkerLoss) -> Any:
    raise InternalError(f"in a worker, which was to do the task {name}: {loss}")
