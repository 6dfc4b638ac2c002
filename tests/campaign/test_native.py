"""Native mappers called by the compiled engine: the same numbers as the twin, and lost workers."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.programs.natives import built, hostile
from topo_verify.campaign.campaign import Shard
from topo_verify.campaign.compiled import examine_compiled
from topo_verify.campaign.targets import one_target
from topo_verify.compiled import available
from topo_verify.errors import InputError
from topo_verify.studies.search.search import SearchEntry, search, search_campaign

pytestmark = pytest.mark.skipif(
    not available() or shutil.which("cc") is None, reason="numba or cc is not installed"
)

MISDEEDS = {
    "crash": "SIGSEGV",
    "leave": "exit code 0",
    "loop": "did not move",
    "look": "did not move",
    "walk": "more than 2 moves",
    "overflow": "SIGSEGV",
    "write_world": "SIGSEGV",
    "write_on": "SIGSEGV",
    "write_before": "SIGSEGV",
    "write_robot": "SIGSEGV",
    "double_itself": "SIGABRT",
    "close_all": "exit code 1",
}
"""Each misdeed of hostile.c, and what is said of it by the world where it was done alone."""


def numbers(entry: SearchEntry) -> list[tuple[int, ...]]:
    return [
        (one.edges, one.checked, one.total, one.failing, one.max_cost, one.total_cost)
        for one in entry.by_edges
    ]


def firsts(entry: SearchEntry) -> list[tuple[str, int, str]]:
    return [(one.claim, one.failing, one.smallest.world) for one in entry.claims]


def test_the_example_comes_to_what_basic_comes_to(tmp_path: Path) -> None:
    ours = search(built(tmp_path), edges=4)
    theirs = search("basic", edges=4, engine="compiled")
    assert ours.verdict == theirs.verdict == "EXHAUSTED"
    assert (ours.engine, ours.judged_by) == ("compiled", theirs.judged_by)
    assert numbers(ours) == numbers(theirs)
    assert ours.judgements == theirs.judgements
    assert [one.worst for one in ours.by_edges] == [one.worst for one in theirs.by_edges]


@pytest.mark.parametrize("option", ["-DWRONG", "-DUNDIRECTED"])
def test_the_wrong_example_fails_where_it_fails_behind_the_pipe(
    option: str, tmp_path: Path
) -> None:
    target = built(tmp_path, option)
    ours = search(target, edges=3, keep_going=True)
    theirs = search(target, edges=3, keep_going=True, engine="reference")
    assert ours.counterexample == theirs.counterexample
    assert numbers(ours) == numbers(theirs)
    assert sorted(firsts(ours)) == sorted(firsts(theirs))


@pytest.mark.parametrize("deed", MISDEEDS)
def test_a_misdeed_convicts_the_mapper_in_its_world(deed: str, tmp_path: Path) -> None:
    # It skips worlds of several vertices, so nothing is EXHAUSTED; m2/7 is the first of degree 4.
    entry = search(hostile(tmp_path, deed), edges=2)
    assert entry.verdict == "REFUTED"
    assert entry.counterexample is not None
    assert entry.counterexample.world == "m2/7"
    assert MISDEEDS[deed] in entry.counterexample.message


def test_all_other_worlds_are_judged(tmp_path: Path) -> None:
    entry = search(hostile(tmp_path, "crash"), edges=2, keep_going=True)
    by_edges = entry.by_edges[-1]
    assert (by_edges.checked, by_edges.failing, by_edges.undecided) == (3, 3, 7)


def test_a_crash_that_does_not_recur_leaves_its_world_undecided(tmp_path: Path) -> None:
    entry = search(hostile(tmp_path, "once"), edges=2)
    assert entry.verdict == "UNKNOWN"
    assert entry.lost


def test_a_library_is_called_in_workers_of_this_machine_alone(tmp_path: Path) -> None:
    mapper = one_target(built(tmp_path))
    campaign = search_campaign([mapper], edges=2)
    with pytest.raises(InputError, match="leave out --dask"):
        examine_compiled(campaign, [mapper], Shard(2, 0, 10), lambda _runs: None)
