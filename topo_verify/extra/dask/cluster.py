"""Does tasks on a Dask cluster, and requeues those of lost workers.

A pool on the worker's machine (worker.py) settles what a task does to its process. So a
loss here means that a whole Dask worker went:

- The scheduler gives its tasks to others, as often as the setting `allowed-failures` says (3).
  Most losses end here, and change no result.
- A task lost more often is done again while no other task runs, and then cut. `Remote.lost`
  gives the result of a task that cannot be cut, and convicts no mapper.
- If the scheduler is lost, or no worker is left for `PATIENCE` seconds, an InputError says so.

Workers with another topo-verify or another mapper refuse every task. The client refuses results
of a worker that loaded a file that differs here.
"""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from importlib import import_module, metadata
from queue import Empty, SimpleQueue
from time import monotonic
from typing import Any, Generic, Protocol, Self, cast

import msgspec

from topo_verify import extras
from topo_verify.campaign.identity import own_hash
from topo_verify.campaign.work import Piece, Pieces, ResultT, TaskT, Work, processors
from topo_verify.campaign.worker import WorkerFailed
from topo_verify.errors import InputError, InternalError
from topo_verify.extra.dask import worker
from topo_verify.extra.dask.worker import ClusterTask, ClusterTaskDone

LOCAL = "local"
"""The address that means workers on this machine."""

ANSWER = 10.0
"""Seconds that a scheduler has to answer."""

PATIENCE = 60.0
"""Seconds for which a cluster may be without a worker."""

LOOK = 2.0
"""Seconds between two looks at the number of workers."""

AHEAD = 2
"""Tasks handed out for each thread, so that none waits for the client."""


_DO = f"__import__({worker.__name__!r}, fromlist=['do']).do(assignment)"
"""What a worker evaluates. Dask would read a pickled function before it knows the task, so a
worker that lacks topo_verify would end without a useful error.
"""


class _Future(Protocol):
    """The used part of a Dask future."""

    @property
    def status(self) -> str: ...
    def result(self) -> bytes: ...
    def exception(self) -> BaseException: ...
    def add_done_callback(self, call: Callable[[_Future], None], /) -> None: ...


class _Client(Protocol):
    """The used part of a Dask client."""

    def submit(self, function: Callable[..., Any], *args: Any, pure: bool) -> _Future: ...
    def nthreads(self) -> Mapping[str, int]: ...
    def cancel(self, futures: list[_Future], *, force: bool) -> None: ...
    def wait_for_workers(self, n_workers: int, timeout: float) -> None: ...


class Cluster:
    """A connected cluster with a worker; `connected` makes it."""

    def __init__(self, address: str, client: _Client) -> None:
        self.address, self.client = address, client

    @property
    def is_local(self) -> bool:
        """Whether its workers are on this machine."""
        return self.address == LOCAL

    def threads(self) -> int:
        """Number of tasks that it can do at the same time; InputError if it does not answer."""
        try:
            return sum(self.client.nthreads().values())
        except (OSError, RuntimeError) as error:
            raise self.lost() from error

    def lost(self) -> InputError:
        """The error for a lost scheduler."""
        return InputError(
            f"--dask {self.address}: the scheduler was lost in the course of the work: start it and"
            " its workers again, and then the same command, which resumes from its --ledger"
        )


@contextmanager
def connected(address: str) -> Generator[Cluster]:
    """Connect to the Dask scheduler at `tcp://host:8786`, or `local`, while the block lasts.

    Raises:
        InputError: dask is not installed; no scheduler answers there; it has no worker.
    """
    extras.require("dask")
    dask: Any = import_module("dask")
    # Its loggers would repeat what is handled or reported here.
    names = ("distributed", "distributed.client", "distributed.worker", "tornado", "bokeh")
    with ExitStack() as stack:
        stack.enter_context(dask.config.set({"logging": dict.fromkeys(names, "critical")}))
        distributed: Any = import_module("distributed")  # its types are not all written
        scheduler: Any = address
        if address == LOCAL:
            scheduler = distributed.LocalCluster(
                n_workers=processors(),
                threads_per_worker=1,
                processes=True,
                dashboard_address=":0",
                silence_logs="CRITICAL",
                preload=[worker.__name__],
            )
            stack.callback(scheduler.close, timeout=ANSWER)
        try:
            if address != LOCAL:
                distributed.comm.resolve_address(address)  # fail at once on a bad address
            connection = distributed.Client(scheduler, timeout=ANSWER, set_as_default=False)
        except (OSError, ValueError, RuntimeError) as error:
            raise InputError(
                f"--dask {address}: expected the address of a Dask scheduler, as tcp://host:8786,"
                f" and none answers there within {ANSWER:.0f} s: start one with `dask scheduler`"
            ) from error
        stack.callback(_close, connection)
        client = cast("_Client", connection)
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except OSError as error:
            raise _no_worker(address) from error
        yield Cluster(address, client)


def _close(client: Any) -> None:
    with suppress(OSError, RuntimeError):
        client.close(timeout=ANSWER)


def _no_worker(address: str) -> InputError:
    return InputError(
        f"--dask {address}: the scheduler has had no worker for {PATIENCE:.0f} s: start some with"
        f" `dask worker {address}`"
    )


class ClusterPool(Generic[TaskT, ResultT]):
    """A pool of a cluster's workers; see `Pool`. On leaving, it cancels what is not done."""

    def __init__(self, cluster: Cluster, work: Work[TaskT, ResultT]) -> None:
        if work.remote is None:
            raise InternalError(f"{work.serve} is not for other machines")
        self._cluster, self._work, self._remote = cluster, work, work.remote
        self._pieces = Pieces(work)
        self._at: dict[_Future, Piece[TaskT, ResultT]] = {}
        self._done: SimpleQueue[_Future] = SimpleQueue()
        self._suspects: deque[Piece[TaskT, ResultT]] = deque()  # each is done alone
        self._alone = False
        self._threads = 0
        self._looked = self._had_threads = monotonic()

    def __enter__(self) -> Self:
        self._look()
        return self

    def __exit__(self, *_error: object) -> None:
        if self._at:
            with suppress(OSError, RuntimeError):
                self._cluster.client.cancel(list(self._at), force=True)
            self._at.clear()

    def run(self, tasks: Iterable[TaskT]) -> Generator[tuple[TaskT, ResultT]]:
        """Yield each task, the same object, and its result, as tasks finish."""
        todo = iter(tasks)
        self._hand_out(todo)
        while self._at:
            self._listen()
            self._hand_out(todo)
            while self._pieces.finished:
                yield self._pieces.finished.popleft()
            self._hand_out(todo)

    def _hand_out(self, todo: Iterator[TaskT]) -> None:
        if self._suspects or self._alone:
            if not self._at and self._suspects:
                self._alone = True
                self._submit(self._suspects.popleft())
            return
        while len(self._at) < AHEAD * max(1, self._threads):
            piece = self._pieces.next(todo)
            if piece is None:
                return
            self._submit(piece)

    def _submit(self, piece: Piece[TaskT, ResultT]) -> None:
        assignment = ClusterTask(
            worker.VERSION,
            metadata.version("topo-verify"),
            own_hash(),
            self._remote.remade,
            msgspec.Raw(msgspec.json.encode(self._work.job)),
            msgspec.Raw(msgspec.json.encode(piece.task)),
            os.getcwd(),  # noqa: PTH109  a text
        )
        names = {"assignment": msgspec.json.encode(assignment)}
        future = self._cluster.client.submit(eval, _DO, names, pure=False)
        self._at[future] = piece
        future.add_done_callback(self._done.put)

    def _listen(self) -> None:
        with suppress(Empty):
            self._hear(self._done.get(timeout=LOOK))
        if monotonic() > self._looked + LOOK:
            self._look()

    def _look(self) -> None:
        self._threads = self._cluster.threads()
        self._looked = monotonic()
        if self._threads:
            self._had_threads = self._looked
        elif self._looked > self._had_threads + PATIENCE:
            raise _no_worker(self._cluster.address)

    def _hear(self, future: _Future) -> None:
        if future.status not in ("finished", "error"):  # Dask cancels on a lost link
            raise self._cluster.lost()
        piece, alone = self._at.pop(future), self._alone
        self._alone = False
        if future.status == "error":
            self._lose(piece, future.exception(), alone=alone)
            return
        answer: ClusterTaskDone | WorkerFailed = msgspec.json.decode(
            future.result(), type=ClusterTaskDone | WorkerFailed
        )
        match answer:
            case ClusterTaskDone(place, encoded):
                result = msgspec.json.decode(encoded, type=self._work.result)
                self._remote.require_ours(result, place)
                self._pieces.finish(piece, result)
            case WorkerFailed(text, bug, _):
                raise InternalError(text) if bug else InputError(text)

    def _lose(self, piece: Piece[TaskT, ResultT], error: BaseException, *, alone: bool) -> None:
        """Workers were lost with a piece: do it alone, then cut it, then give it up."""
        from distributed import KilledWorker

        if not isinstance(error, KilledWorker):
            raise InputError(
                f"--dask {self._cluster.address}: a worker cannot load topo-verify"
                f" ({type(error).__name__}: {error}): install the same version on every machine"
            ) from error
        if not alone:
            self._suspects.append(piece)
        elif not self._pieces.replace(piece, self._remote.parts(piece.task)):
            self._pieces.finish(piece, self._remote.lost(piece.task))
