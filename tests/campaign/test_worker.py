"""A worker: no other program speaks for it, and none looks into it."""

from __future__ import annotations

import ctypes
import json
import os
import shutil
import sys
from pathlib import Path
from time import monotonic

import pytest

from tests.python import python
from topo_verify import InputError
from topo_verify.campaign.pool import Pool
from topo_verify.campaign.work import Work
from topo_verify.campaign.worker import Seal, WorkerProcess
from topo_verify.robot import stopwatch

LINUX = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere no process can be hidden")


def unprivileged() -> None:
    """Take from this process, once it executes a program, all that root may do."""
    for capability in range(64):
        ctypes.CDLL(None).prctl(24, *map(ctypes.c_ulong, (capability, 0, 0, 0)))


@pytest.mark.nightly
@LINUX
@pytest.mark.parametrize("privileged", [True, False])
def test_a_mapper_that_tries_from_its_first_line_on_gets_hold_of_no_worker(
    tmp_path: Path, *, privileged: bool
) -> None:
    """It must fail before any worker runs, while one does, and when one is replaced."""
    if privileged and os.geteuid():
        pytest.skip("only root can try it as root")
    shutil.copy(Path(__file__).parent / "intruder.py", tmp_path)
    line = (
        "search intruder.py:explore --edges 2 --workers 1 --format json"
        " --move-timeout 60 --world-timeout 120"  # each worker waits until it was tried
    )
    deed = None if privileged else unprivileged
    done = python("-m", "topo_verify", *line.split(), cwd=tmp_path, preexec_fn=deed)
    assert not (tmp_path / "opened").exists(), (tmp_path / "opened").read_text()
    refused = set((tmp_path / "refused").read_text().split())
    assert len(refused) >= 4, "the search, what starts workers, and both workers were tried"
    assert (tmp_path / "killed").exists(), done.stderr
    assert done.returncode == 1, done.stderr
    found = json.loads(done.stdout)["results"][0]
    assert (found["verdict"], found["by_edges"][0]["failing"]) == ("REFUTED", 1)


FORGES = """
import contextlib, os, stat
from topo_verify.campaign.worker import TaskDone
import msgspec

@contextlib.contextmanager
def serve(job):
    def handle(task, beat):
        forged = msgspec.json.encode(TaskDone(msgspec.Raw(b'"forged"'))) + b"\\n"
        for file in range(3, 20):
            with contextlib.suppress(OSError):
                kind = os.fstat(file).st_mode
                if stat.S_ISSOCK(kind) or stat.S_ISFIFO(kind):
                    os.write(file, forged)
        return "done"
    yield handle
"""


def test_a_message_without_the_seal_of_its_worker_ends_the_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "forges.py").write_text(FORGES)
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    work: Work[int, str] = Work(
        serve="forges:serve", job=None, result=str, lost=lambda _task, loss: str(loss), silence=60
    )
    with Pool(work, 1) as pool, pytest.raises(InputError, match="expected the seal of a worker"):
        list(pool.run([1]))


def test_a_time_in_which_the_pool_did_not_run_is_no_silence(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    worker = WorkerProcess("json:loads", None)
    try:
        began = worker.silence()
        for hours in (1, 2):
            monkeypatch.setattr(stopwatch, "monotonic", lambda: monotonic() + 3600 * hours)  # noqa: B023
            assert worker.silence() < began + 10 * hours
    finally:
        worker.kill()


def test_a_seal_is_good_for_one_message_at_its_place_alone() -> None:
    worker, parent = Seal("key", 7), Seal("key", 7)
    first, second = worker.sealed(b"one"), worker.sealed(b"two")
    assert parent.opened(first) == b"one"
    for line in (
        first,
        second[:-1] + b"0",
        Seal("other", 7).sealed(b"one"),
        Seal("key", 8).sealed(b"one"),
        b"one",
        b"",
    ):
        fresh = Seal("key", 7)
        fresh.opened(first)
        with pytest.raises(InputError, match="expected the seal of a worker"):
            fresh.opened(line)
    assert parent.opened(second) == b"two"
