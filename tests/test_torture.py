"""The torture (benchmarks/torture) still runs; what it finds, `make torture` says."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest


@pytest.mark.nightly
def test_the_torture_sees_its_planted_faults_and_finds_nothing_in_a_few_trials() -> None:
    torture = Path(__file__).resolve().parent.parent / "benchmarks" / "torture"
    done = subprocess.run(
        [sys.executable, str(torture), "--scale", "0.05", "--only", "readers"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
