"""Ten thousand worlds in one run take no more memory than a few."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from tests.programs.programs import served

SCRIPT = """
import resource, sys
from topo_verify.harness.conform.conform import ConformTally
from topo_verify.harness.corpus import corpus_from
from topo_verify.harness.conform.examiner import Examiner
from topo_verify.harness.conform.outcome import ConformJob

def size():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * resource.getpagesize()

corpus = corpus_from(["edges<=5", "generated:1046"])
job = ConformJob(target=sys.argv[1], like="basic")
books = ConformTally(job, corpus)
with Examiner(job) as examiner:
    for at in corpus:
        books.enter(examiner.examine(at))
        if books.tried == 2000:
            before = size()
print(books.tried, size() - before)
"""

LEEWAY = 10 * 2**20
"""Bytes; the costs that are kept world by world take two or three million."""


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="no /proc here")
def test_the_memory_of_a_run_of_ten_thousand_worlds_is_flat() -> None:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, served("basic")], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    tried, grown = map(int, done.stdout.split())
    assert tried == 10_000
    assert grown < LEEWAY, f"{grown} bytes"
