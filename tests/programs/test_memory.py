"""Ten thousand worlds in one run take no more memory than a few."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.programs.programs import served
from tests.python import python as ran

SCRIPT = """
import resource, sys
from tests.programs.programs import conforming
from topo_verify.campaign.backend import here
from topo_verify.campaign.campaign import results
from topo_verify.studies.corpus import CorpusWorlds, corpus_from

def size():
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * resource.getpagesize()

corpus = corpus_from(["edges<=5", "generated:1046"])
study = conforming(sys.argv[1], corpus, like="basic")
for _, result in results(study.campaign, here(), CorpusWorlds(corpus)):
    study.enter(*result.rows)
    if study.tried == 2000:
        before = size()
print(study.tried, size() - before)
"""

LEEWAY = 10 * 2**20
"""Bytes; the costs that are kept world by world take two or three million."""


@pytest.mark.nightly
@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="no /proc here")
def test_the_memory_of_a_run_of_ten_thousand_worlds_is_flat() -> None:
    done = ran("-c", SCRIPT, served("basic"))
    assert done.returncode == 0, done.stderr
    tried, grown = map(int, done.stdout.split())
    assert tried == 10_000
    assert grown < LEEWAY, f"{grown} bytes"
