"""What a command leaves in the folder in which it was called: nothing that was not asked for."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest


@pytest.mark.parametrize(
    "line",
    [
        "world sample --strategy 'worlds(max_edges=9)' -n 40",
        "faults ignores-direction-if-walked --by properties --workers 1",
    ],
)
def test_worlds_are_drawn_and_hypothesis_leaves_no_folder(
    line: str, program: Callable[..., subprocess.CompletedProcess[str]], folder: Path
) -> None:
    before = sorted(folder.iterdir())
    done = program(line, PYTHONWARNINGS="error", PYTHONDONTWRITEBYTECODE="1")
    assert done.returncode == 0, done.stderr
    assert sorted(folder.iterdir()) == before
