"""`--engine` and `--dask` on the command line: what is promised of them, and what is refused."""

from __future__ import annotations

import sys

import pytest

from tests.cli.conftest import Call, Refused, Results
from topo_verify import extras


def test_an_entry_says_who_judged_and_both_engines_count_alike(results: Results) -> None:
    pytest.importorskip("numba")
    line = "search basic --edges 3 --workers 0 --worst"
    whole = results(f"{line} --engine compiled")
    (ours,), (theirs,) = results(line)["results"], whole["results"]
    assert (ours["engine"], theirs["engine"]) == ("reference", "compiled")
    assert theirs["judged_by"].startswith("the compiled engine; every counterexample, the worst")
    assert theirs["by_checkers"] > 0
    assert whole["timing"]["engine"].keys() == {"engine", "checkers"}
    own = {"engine", "judged_by", "by_checkers"}
    assert {k: v for k, v in theirs.items() if k not in own} == {
        k: v for k, v in ours.items() if k not in own
    }


def test_people_are_told_who_judged(call: Call) -> None:
    pytest.importorskip("numba")
    text = " ".join(call("search basic --edges 2 --workers 0 --engine compiled").stdout.split())
    assert "EXHAUSTED: 12 of 12 worlds checked, no claim failed" in text
    assert "judged by the compiled engine; every counterexample, the worst worlds" in text


def test_a_counterexample_of_the_compiled_engine_exits_1_and_its_line_shows_it_again(
    results: Results, call: Call
) -> None:
    pytest.importorskip("numba")
    line = "search folding+planar --edges 3 --workers 0"
    (entry,) = results(f"{line} --engine compiled", code=1)["results"]
    (other,) = results(line, code=1)["results"]
    assert entry["counterexample"] == other["counterexample"]
    assert call(entry["counterexample"]["replay"].removeprefix("topo-verify ")).exit_code == 1


@pytest.mark.nightly
def test_a_local_cluster_gives_the_entry_of_workers_here(results: Results) -> None:
    pytest.importorskip("numba")
    pytest.importorskip("distributed")
    line = "search basic --edges 3 --engine compiled --keep-going"
    assert results(f"{line} --dask local")["results"] == results(f"{line} --workers 1")["results"]


OWN = {"engine", "judged_by", "by_checkers"}


@pytest.mark.parametrize(
    ("mapper", "code"), [("guesses", 1), ("ignores_direction", 1), ("right", 0), ("raises", 1)]
)
def test_the_compiled_judge_judges_a_mapper_of_the_users_as_the_checkers_do(
    results: Results, mapper: str, code: int
) -> None:
    pytest.importorskip("numba")
    line = f"search mappers.py:{mapper} --edges 3 --workers 1 --worst --keep-going --in-process"
    (ours,) = results(line, code=code)["results"]
    (theirs,) = results(f"{line} --engine compiled", code=code)["results"]
    assert {k: v for k, v in theirs.items() if k not in OWN} == {
        k: v for k, v in ours.items() if k not in OWN
    }
    assert theirs["judged_by"].startswith("the compiled judge; every finding, the most expensive")
    assert 0 < theirs["by_checkers"] <= ours["by_checkers"]


def test_without_numba_the_extra_is_named(
    refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(extras.PACKAGES, "fast", ("no_such_numba",))
    refused(
        "search basic --edges 2 --engine compiled",
        f"the extra fast needs no_such_numba: {sys.executable} -m pip install 'topo-verify[fast]'",
    )
