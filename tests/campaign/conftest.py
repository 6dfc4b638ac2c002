"""A folder of its own for each test of the search, with the mappers in it."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest

from topo_verify.studies.search.choices import SHARD

collect_ignore = ["intruder.py"]
"""Modules with no doctest that pytest must not import: this one attacks from its first line on."""


@pytest.fixture(autouse=True)
def few_worlds_run_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """A search runs many worlds again; tests/studies/search/test_again.py tries that."""
    monkeypatch.setattr("topo_verify.studies.search.again.MOST", 2)
    monkeypatch.setattr("topo_verify.studies.search.again.ROW", 2)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder of the test; it holds mappers.py and misdeeds.py."""
    for name in ("mappers.py", "misdeeds.py"):
        shutil.copy(Path(__file__).parent / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])  # a mapper's folder is put there
    return tmp_path


@pytest.fixture
def small_shards(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Several shards a size, so that workers are at different ones."""
    monkeypatch.setitem(SHARD, "reference", 20)
    return folder
