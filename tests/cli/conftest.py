"""The command line as tests call it: in a folder of their own, with some mappers of a user's."""

from __future__ import annotations

import json
import os
import shlex
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from tests.proofs.mechanised.conftest import library
from topo_verify.cli import main

__all__ = ["library"]
"""A fixture of another room, for the tests of this one."""

Call = Callable[..., Result]
Results = Callable[..., dict[str, Any]]
Program = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture(autouse=True)
def few_worlds_run_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """A search runs many worlds again; tests/studies/search/test_again.py tries that."""
    monkeypatch.setattr("topo_verify.studies.search.again.MOST", 2)
    monkeypatch.setattr("topo_verify.studies.search.again.ROW", 2)


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
def program(folder: Path) -> Program:
    """Run a command line in a process of its own."""

    def program(line: str, **environment: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [sys.executable, "-m", "topo_verify", *shlex.split(line)],
            cwd=folder,
            env={**os.environ, **environment},
            capture_output=True,
            text=True,
            check=False,
        )

    return program
