"""Does a client's tasks in a Dask worker, each in a process that may die or hang.

Each thread of the worker has a `Pool` of one process, kept for the next task of the same job. So
a lost Dask worker is no mapper's fault.

What this does not show: that the results are the workers'. The scheduler believes whatever
reaches it, and a Dask worker is hidden from other programs only from its first task on.
"""

from __future__ import annotations

import signal
import threading
import traceback
from importlib import metadata
from pathlib import Path
from typing import Any

import msgspec

from topo_verify.campaign.identity import own_hash
from topo_verify.campaign.pool import Pool
from topo_verify.campaign.work import Work
from topo_verify.campaign.worker import WorkerFailed, function_at
from topo_verify.errors import InputError
from topo_verify.programs.launcher import prepare

IDLE = 30.0
"""Seconds without a task after which a kept process ends."""

VERSION = 2
"""The version of an assignment."""


class ClusterTask(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """One task, as a client sends it.

    Attributes:
        tool, own: the client's version of topo-verify, and the hash of its sources.
        remade: as in `work.Remote`.
        folder: the client's current folder, for relative paths, if the worker has it.
    """

    version: int
    tool: str
    own: str
    remade: str
    job: msgspec.Raw
    task: msgspec.Raw
    folder: str


class ClusterTaskDone(msgspec.Struct, frozen=True, tag=True):
    """A task is finished; `place` names the worker in a sentence."""

    place: str
    result: msgspec.Raw


def do(assignment: bytes) -> bytes:
    """Do a `ClusterTask`, given and answered as JSON: a `ClusterTaskDone` or `WorkerFailed`."""
    try:
        kept: _Kept = vars(_threads).setdefault("kept", _Kept())
        result = kept.do(_require_ours(assignment))
    except InputError as error:
        return msgspec.json.encode(WorkerFailed(f"{_place()}: {error}", bug=False))
    except Exception:  # noqa: BLE001  the client gets it
        return msgspec.json.encode(WorkerFailed(f"{_place()}: {traceback.format_exc()}", bug=True))
    return msgspec.json.encode(ClusterTaskDone(_place(), msgspec.Raw(result)))


def _require_ours(assignment: bytes) -> ClusterTask:
    here = metadata.version("topo-verify")
    try:
        wanted = msgspec.json.decode(assignment, type=ClusterTask)
    except msgspec.MsgspecError:
        wanted = None
    if wanted is None or wanted.version != VERSION or wanted.own != own_hash():
        tool = "another version" if wanted is None else f"version {wanted.tool}"
        raise InputError(
            f"it has topo-verify {here} with other sources than the client, which has {tool}:"
            " install the same topo-verify on every machine, and restart the workers"
        )
    return wanted


def _place() -> str:
    from distributed import get_worker

    try:
        worker: Any = get_worker()
    except ValueError:
        return "a worker of the cluster"
    return f"worker {worker.address} of the cluster"


def dask_setup(_worker: object) -> None:
    """Leave Ctrl-C to the client, and shield this process; Dask calls this for `--dask local`."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    prepare()


# ---------------------------------------------------------------- the process that is kept


class _Kept:
    """The pool of one thread, with one process, which ends when it is idle."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._pool: Pool[Any, Any] | None = None
        self._work: Work[Any, Any] | None = None
        self._of: tuple[str, bytes, str] = ("", b"", "")
        self._alarm: threading.Timer | None = None

    def do(self, wanted: ClusterTask) -> bytes:
        with self._lock:
            if self._alarm is not None:
                self._alarm.cancel()
            pool, work = self._ready(wanted)
            remote = work.remote
            assert remote is not None, "it was made by `remade`"
            try:
                task = msgspec.json.decode(wanted.task, type=remote.task)
                ((_, result),) = pool.run([task])
            except BaseException:
                self._close()
                raise
            self._alarm = threading.Timer(IDLE, self._end)
            self._alarm.daemon = True
            self._alarm.start()
            return msgspec.json.encode(result)

    def _ready(self, wanted: ClusterTask) -> tuple[Pool[Any, Any], Work[Any, Any]]:
        of = (wanted.remade, bytes(wanted.job), wanted.folder)
        if self._pool is None or self._work is None or self._of != of:
            self._close()
            work: Work[Any, Any] = function_at(wanted.remade)(wanted.job)
            folder = wanted.folder if Path(wanted.folder).is_dir() else None
            self._pool, self._work, self._of = Pool(work, 1, folder=folder), work, of
        return self._pool, self._work

    def _end(self) -> None:
        with self._lock:
            self._close()

    def _close(self) -> None:
        if self._pool is not None:
            self._pool.__exit__()
        self._pool = self._work = None


_threads = threading.local()
