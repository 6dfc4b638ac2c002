"""The command line as tests call it: in a folder of their own, with some mappers of a user's."""

from __future__ import annotations

import json
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from tests.campaign.conftest import few_worlds_run_again
from tests.proofs.mechanised.conftest import library, linked
from tests.python import python
from topo_verify.campaign.campaign import Shard, ShardResult
from topo_verify.campaign.store import StoredCampaign
from topo_verify.cli import main

__all__ = ["few_worlds_run_again", "library", "linked"]
"""Fixtures of other rooms, for the tests of this one."""

Call = Callable[..., Result]
Results = Callable[..., dict[str, Any]]
Refused = Callable[..., None]
Program = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder of the test; it holds mappers.py."""
    shutil.copy(Path(__file__).parent / "mappers.py", tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])  # a mapper's folder is put there
    for name in ("FORCE_COLOR", "COLUMNS", "TOPO_VERIFY_TRACEBACK"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


@pytest.fixture
def call(folder: Path) -> Call:
    """Call a command line, given as one text, in this process."""
    assert folder.is_dir()

    def call(line: str, stdin: str | None = None) -> Result:
        return CliRunner().invoke(main, shlex.split(line), input=stdin)

    return call


@pytest.fixture
def results(call: Call) -> Callable[..., dict[str, Any]]:
    """Call a command line with --format json: the one object on stdout."""

    def results(line: str, stdin: str | None = None, *, code: int = 0) -> dict[str, Any]:
        done = call(f"{line} --format json", stdin)
        assert done.exit_code == code, done.output
        envelope: dict[str, Any] = json.loads(done.stdout)
        assert envelope["exit"] == code
        return envelope

    return results


@pytest.fixture
def refused(call: Call) -> Refused:
    """Require that a command line exits 2 and says nothing but one sentence, with these words.

    `prove` prints a head before it begins.
    """

    def refused(line: str, *words: str) -> None:
        done = call(line)
        assert done.exit_code == 2, done.output
        assert done.stdout == "" or line.startswith("prove"), done.output
        remarks = re.compile(r"topo-verify: seed [0-9:]+(: .*)?\n")
        (sentence,) = (s for s in done.stderr.splitlines(keepends=True) if not remarks.fullmatch(s))
        assert [one for one in words if one not in sentence] == [], sentence

    return refused


@pytest.fixture
def program(folder: Path) -> Program:
    """Run a command line in a process of its own."""

    def program(line: str, **environment: str) -> subprocess.CompletedProcess[str]:
        words = ("-m", "topo_verify", *shlex.split(line))
        return python(*words, cwd=folder, environment=environment)

    return program


def interrupted(
    folder: Path, *words: str, by: signal.Signals = signal.SIGINT
) -> tuple[int, str, str]:
    """What comes of a command that gets Ctrl-C as soon as its mapper says that it is at work."""
    running = subprocess.Popen(
        [sys.executable, "-m", "topo_verify", *words],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # Whoever started the tests may ignore Ctrl-C, and children inherit that.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # noqa: PLW1509  no threads here
    )
    while not (folder / "at-work").exists():
        assert running.poll() is None, running.communicate()
        time.sleep(0.02)
    running.send_signal(by)
    out, error = running.communicate(timeout=30)
    return running.returncode, out, error


@pytest.fixture
def cut_off(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let Ctrl-C come once, when three shards are kept."""
    real, calls = StoredCampaign.put, count()

    def put(store: StoredCampaign, shard: Shard, result: ShardResult) -> None:
        if next(calls) == 3:
            raise KeyboardInterrupt
        real(store, shard, result)

    monkeypatch.setattr(StoredCampaign, "put", put)


def require_same_bytes(call: Call, line: str, total: int, files: Callable[[str], object]) -> None:
    """Require that runs leave the same files with other workers, and cut off and taken up again.

    Args:
        line: up to the number of workers.
        total: the number of runs. A fixture cuts the first three calls off.
    """
    done = call(f"{line} 1 --out parts")
    assert done.exit_code == 3
    kept = f"3 of {total} runs are kept in parts/runs.db; the same command goes on"
    assert kept in done.stderr
    done = call(f"{line} 1 --out parts")
    assert done.exit_code == 0
    assert f"3 of {total} runs are in parts/runs.db" in done.stderr
    assert call(f"{line} 1 --out whole").exit_code == 0
    assert call(f"{line} 2 --out two").exit_code == 0
    assert files("whole") == files("two") == files("parts")
