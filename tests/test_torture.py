"""The torture (benchmarks/torture) still runs; what it finds, `make torture` says."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.python import python


@pytest.mark.nightly
def test_the_torture_sees_its_planted_faults_and_finds_nothing_in_a_few_trials() -> None:
    torture = Path(__file__).resolve().parent.parent / "benchmarks" / "torture"
    done = python(torture, "--scale", "0.05", "--only", "readers")
    assert done.returncode == 0, done.stdout + done.stderr
