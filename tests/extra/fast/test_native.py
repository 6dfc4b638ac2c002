"""Native mappers called by the compiled engine: the same numbers as the twin, and lost workers."""

from __future__ import annotations

import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import msgspec
import pytest

from tests.programs.natives import HOSTILE_NUMBA, ROOT, built, hostile, misdeeds
from topo_verify import extras
from topo_verify.campaign.backend import CampaignJob, pooled, remade
from topo_verify.campaign.campaign import MAX_LOST, Shard
from topo_verify.campaign.identity import source_hash
from topo_verify.campaign.pool import Pool
from topo_verify.campaign.targets import one_target
from topo_verify.campaign.worker import no_beat
from topo_verify.errors import InputError
from topo_verify.robot.limits import Limits
from topo_verify.studies.search.search import SearchEntry, search, search_campaign

pytestmark = pytest.mark.skipif(
    not extras.usable_engines() or shutil.which("cc") is None, reason="numba or cc is not installed"
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


@pytest.mark.nightly
def test_the_example_comes_to_what_basic_comes_to(tmp_path: Path) -> None:
    ours = search(built(tmp_path), edges=4)
    theirs = search("basic", edges=4, engine="compiled")
    assert ours.verdict == theirs.verdict == "EXHAUSTED"
    assert (ours.engine, ours.judged_by) == ("compiled", theirs.judged_by)
    assert numbers(ours) == numbers(theirs)
    assert ours.judgements == theirs.judgements
    assert [one.worst for one in ours.by_edges] == [one.worst for one in theirs.by_edges]


@pytest.mark.nightly
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


@pytest.mark.nightly
@pytest.mark.parametrize("deed", MISDEEDS)
def test_a_misdeed_convicts_the_mapper_in_its_world(deed: str, tmp_path: Path) -> None:
    # It skips worlds of several vertices, so nothing is EXHAUSTED; m2/7 is the first of degree 4.
    entry = search(hostile(tmp_path, deed), edges=2)
    assert entry.verdict == "REFUTED"
    assert entry.counterexample is not None
    assert entry.counterexample.world == "m2/7"
    assert MISDEEDS[deed] in entry.counterexample.message


def test_a_note_names_the_world_of_an_endless_loop_once(tmp_path: Path) -> None:
    mappers = [one_target(hostile(tmp_path, "loop"))]
    campaign = search_campaign(mappers, edges=2, limits=Limits(move_timeout=1.1))
    notes: list[str] = []
    run = pooled(1, note=notes.append)
    ((_, result),) = run(campaign, iter([Shard(2, 7, 8)]), no_beat)
    assert result.tally.timeouts == 1
    (note,) = notes
    assert note.startswith("m2/7: no result of the mapper for ")
    assert note.endswith(" before the verdict (--move-timeout 1 waits less)")


def test_a_limit_of_a_move_is_taken_and_one_of_a_whole_run_is_refused(tmp_path: Path) -> None:
    mappers = [one_target(hostile(tmp_path, "loop"))]
    assert search_campaign(mappers, edges=2, limits=Limits(move_timeout=1)).engine == "compiled"
    with pytest.raises(InputError, match="number of moves: leave out --world-timeout, or add"):
        search_campaign(mappers, edges=2, limits=Limits(world_timeout=1))


@pytest.mark.nightly
@pytest.mark.parametrize("deed", ["crash", "leave", "loop", "double_itself"])
def test_a_misdeed_of_a_numba_function_convicts_it_in_its_world(deed: str) -> None:
    entry = search(f"{HOSTILE_NUMBA}:{deed}", edges=2)
    assert (entry.engine, entry.verdict) == ("compiled", "REFUTED")
    assert entry.counterexample is not None
    assert entry.counterexample.world == "m2/7"
    assert MISDEEDS[deed] in entry.counterexample.message


@pytest.mark.nightly
def test_a_numba_function_that_starts_threads_comes_to_a_verdict(tmp_path: Path) -> None:
    mapper = tmp_path / "parallel.py"
    mapper.write_text(
        "import sys, numba, numpy as np\n"
        f"sys.path.insert(0, {str(ROOT / 'examples' / 'native_numba')!r})\n"
        "import mapper\n"
        "@numba.njit(parallel=True)\n"
        "def explore(robot):\n"
        "    row = np.zeros(100)\n"
        "    for i in numba.prange(100):\n"
        "        row[i] = i\n"
        "    mapper.explore(robot)\n"
    )
    assert search(f"{mapper}:explore", edges=3).verdict == "EXHAUSTED"


@pytest.mark.nightly
def test_a_numba_function_comes_to_what_basic_comes_to() -> None:
    ours = search(f"{ROOT}/examples/native_numba/mapper.py:explore", edges=4)
    theirs = search("basic", edges=4, engine="compiled")
    assert ours.verdict == "EXHAUSTED"
    assert numbers(ours) == numbers(theirs)
    assert ours.judgements == theirs.judgements


@pytest.mark.nightly
def test_all_other_worlds_are_judged(tmp_path: Path) -> None:
    entry = search(hostile(tmp_path, "crash"), edges=2, keep_going=True)
    by_edges = entry.by_edges[-1]
    assert (by_edges.checked, by_edges.failing, by_edges.undecided) == (3, 3, 7)


@pytest.mark.nightly
def test_a_crash_that_does_not_recur_leaves_its_world_undecided(tmp_path: Path) -> None:
    entry = search(hostile(tmp_path, "once"), edges=2)
    assert entry.verdict == "UNKNOWN"
    assert entry.lost


@pytest.mark.parametrize(
    "plan",
    [
        "at 40 skip",
        "at 40 map at 41 skip",
        "at 40 map at 41 skip at 42 skip",
        "from 20 map at 60 skip at 61 skip at 62 skip from 63 doors",
    ],
)
@pytest.mark.parametrize("keep_going", [False, True])
def test_a_second_pass_over_a_slice_replaces_no_run(
    plan: str, keep_going: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MISDEEDS", plan)
    entry = search(misdeeds(tmp_path), edges=3, keep_going=keep_going)
    assert entry.verdict in ("UNKNOWN", "REFUTED")


@pytest.mark.parametrize("deed", ["files", pytest.param("memory", marks=pytest.mark.long)])
def test_what_native_code_takes_from_its_worker_is_no_bug_of_ours(
    deed: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MISDEEDS", f"at 9 {deed}")
    entry = search(misdeeds(tmp_path), edges=2)
    assert (entry.verdict, entry.counterexample) == ("UNKNOWN", None)
    assert entry.lost


@pytest.mark.long
def test_a_library_that_costs_its_worker_in_each_world_is_given_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MISDEEDS", "from 1 engine")
    entry = search(misdeeds(tmp_path), edges=2)
    assert (entry.verdict, entry.checked) == ("UNKNOWN", 0)
    assert MAX_LOST <= len(entry.lost) < entry.total


@pytest.mark.parametrize("engine", ["compiled", "reference"])
def test_the_robot_is_read_only_in_either_engine(
    engine: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MISDEEDS", "at 1 robot")
    entry = search(misdeeds(tmp_path), edges=1, engine=engine)
    assert entry.counterexample is not None
    assert (entry.verdict, entry.counterexample.world) == ("REFUTED", "m1/0")


def test_a_signal_to_the_parent_of_a_worker_is_an_interruption(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In a process of its own: afterwards no worker can be started."""
    monkeypatch.setenv("MISDEEDS", "at 9 parent")
    words = ["-m", "topo_verify", "search", *shlex.split(misdeeds(tmp_path)), "--edges", "2"]
    done = subprocess.run([sys.executable, *words], capture_output=True, check=False)
    assert done.returncode == 3


def test_a_library_that_declines_the_same_worlds_each_time_does_the_same(tmp_path: Path) -> None:
    entry = search(hostile(tmp_path, "nothing"), edges=2, keep_going=True)
    assert (entry.verdict, entry.lost) == ("UNKNOWN", ())


@pytest.mark.nightly
def test_a_dask_cluster_comes_to_the_same_and_refuses_another_library(tmp_path: Path) -> None:
    pytest.importorskip("distributed")
    target = built(tmp_path)
    ours, theirs = search(target, edges=3, cluster="local"), search(target, edges=3)
    assert (ours.verdict, numbers(ours)) == (theirs.verdict, numbers(theirs))
    assert ours.judgements == theirs.judgements
    campaign = search_campaign([one_target(target)], edges=3)
    job = msgspec.json.encode(CampaignJob(campaign, sources="of another file"))
    with Pool(remade(job), 1) as pool, pytest.raises(InputError, match="is another one on this"):
        list(pool.run([Shard(2, 0, 10)]))


def test_the_bytes_of_a_library_are_a_part_of_what_a_search_rests_on(tmp_path: Path) -> None:
    mapper = one_target(built(tmp_path))
    before = source_hash([mapper])
    path = Path(mapper.text.removeprefix("--library "))
    path.write_bytes(path.read_bytes() + b"more")
    assert source_hash([mapper]) != before
