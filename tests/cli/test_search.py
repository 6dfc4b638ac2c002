"""`search` on the command line: its JSON, its exit codes, and what a person reads."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

import msgspec
import pytest

from tests.cli.conftest import Call, Results, interrupted
from topo_verify import search
from topo_verify.studies.search.search import LostWorker


def test_the_entry_of_an_exhausted_class_has_its_numbers_and_worst_worlds(results: Results) -> None:
    (entry,) = results("search basic --edges 3 --class planar")["results"]
    assert (entry["target"], entry["class"], entry["edges"]) == ("basic", "planar", 3)
    assert (entry["verdict"], entry["checked"], entry["total"]) == ("EXHAUSTED", 65, 65)
    assert entry["counterexample"] is None
    assert [size["max_cost"] for size in entry["by_edges"]] == [1, 3, 10]
    assert entry["by_edges"][2]["worst"] == ["m3/9"]


@pytest.mark.nightly
def test_a_mapper_out_of_time_exits_3(results: Results, call: Call) -> None:
    line = "search mappers.py:loops --edges 1 --workers 0 --world-timeout 0.02"
    (entry,) = results(line, code=3)["results"]
    assert (entry["verdict"], entry["checked"]) == ("UNKNOWN", 0)
    assert entry["undecided"]["world"] == "m1/0"
    words = "; 2 more not decided, first m1/0: the mapper was stopped after 0.02 s in this world"
    assert words in " ".join(call(line).stdout.split())


# ---------------------------------------------------------------- for people


def test_a_library_that_does_not_do_the_same_again_is_led_to_the_sanitizer() -> None:
    lost = (LostWorker("m3/8", "it ended its process (signal 6)"),) * 5
    entry = search("basic", edges=1)
    change = partial(msgspec.structs.replace, entry, lost=lost, verdict="REFUTED")
    shown = " ".join(str(change(target="--library ./mapper.so")).split())
    assert "2 of 2 worlds checked, another verdict when one was run again" in shown
    assert "the library does not do the same in these worlds" in shown
    assert "-fsanitize=address and put LD_PRELOAD=" in shown
    assert "and 2 more: --format json has them" in shown
    assert "another program may be the cause" in str(change(target="basic"))


def test_the_table_says_how_many_worlds_were_checked(call: Call) -> None:
    text = call("search basic --edges 3 --workers 0").stdout
    assert text.splitlines()[0] == "basic: worlds of 1 to 3 edges"
    assert "EXHAUSTED: 86 of 86 worlds checked, no claim failed" in text
    assert "max cost" not in text


def test_the_smallest_counterexample_is_shown_with_a_line_that_shows_it_again(
    call: Call, results: Results
) -> None:
    line = "search mappers.py:guesses --edges 3 --workers 0"
    (entry,) = results(line, code=1)["results"]
    first = entry["counterexample"]
    assert first.keys() == {"world", "edges", "claim", "message", "replay"}
    assert call(first["replay"].removeprefix("topo-verify ")).exit_code == 1
    text = call(line).stdout
    assert "REFUTED: 2 of 86 worlds checked, a claim fails in 1" in text
    assert "smallest counterexample: m1/1\n" in text
    assert "  again: topo-verify replay m1/1 --target mappers.py:guesses\n" in text
    assert "delivers a map" in text.partition("The walk of mappers.py:guesses in m1/1:")[2]


@pytest.mark.parametrize("policies", ["all", "every"])
def test_the_walk_of_other_policies_is_shown_too(call: Call, policies: str) -> None:
    done = call(f"search folding+planar --edges 2 --workers 0 --policies {policies}")
    _, _, walk = done.stdout.partition("The walk of folding+planar in m2/8:")
    assert "!! true-hypothesis-kept" in walk


@pytest.mark.long
def test_keeping_going_shows_the_smallest_world_of_each_claim(call: Call) -> None:
    text = call("search mappers.py:guesses --edges 3 --workers 0 --keep-going").stdout
    assert "claim that fails   in worlds  smallest\n" in text
    assert "cost-within-bound" in text


def test_worst_shows_costs_and_the_worlds_that_have_them(call: Call) -> None:
    lines = call("search basic --edges 3 --workers 0 --worst").stdout.splitlines()
    titles = "edges checked total failing max cost mean in worlds which"
    assert " ".join(lines[1].split()) == titles
    assert lines[4].split() == ["3", "74", "74", "0", "10", "3.91", "1", "m3/9"]
    assert "m2/1, m2/2, m2/6" in lines[3]


# ---------------------------------------------------------------- ledger, Ctrl-C


def test_two_mappers_are_compared_under_the_names_a_and_b(call: Call, results: Results) -> None:
    line = "search --compare enhancement-ii,enhancement-i --edges 2 --workers 0"
    (entry,) = results(line)["results"]
    assert [size["compare"]["totals"][0] for size in entry["by_edges"]] == [
        size["total_cost"] for size in entry["by_edges"]
    ]
    assert "A enhancement-ii, B enhancement-i: worlds of 1 to 2 edges" in call(line).stdout


def test_ctrl_c_exits_3_and_tells_whether_the_ledger_has_finished_work(
    folder: Path, call: Call
) -> None:
    line = "search mappers.py:starts_and_sleeps --move-timeout 60 --workers 1 --ledger"
    words = f"{line} none --edges 2 --class genus:1 --format json".split()
    code, out, error = interrupted(folder, *words)
    assert code == json.loads(out)["exit"] == 3
    assert json.loads(out)["results"][0]["verdict"] == "UNKNOWN"
    assert error.startswith("topo-verify: none has nothing yet: no shard of worlds was finished\n")
    call(f"{line} some --edges 1")
    (folder / "at-work").unlink()
    *_, error = interrupted(folder, *f"{line} some --edges 2".split())
    assert error.startswith("topo-verify: some has the finished work: the same command goes on\n")


def test_a_world_of_an_endless_loop_is_run_twice(folder: Path, call: Call) -> None:
    text = "def f(robot):\n    print(file=open('runs', 'a'))\n    while True:\n        pass\n"
    (folder / "loop.py").write_text(text)
    result = call("search loop.py:f --edges 1 --workers 1 --move-timeout 1")
    assert "The walk of loop.py:f in m1/0:" in result.stdout
    assert (folder / "runs").read_text() == 2 * "\n"  # the walk is that of a try


def test_every_choice_shows_the_range_of_the_costs(results: Results, call: Call) -> None:
    line = "search basic --edges 2 --workers 0 --policies every --worst"
    (entry,) = results(line)["results"]
    every = entry["by_edges"][1]["every"]
    assert (every["worlds"], every["states"], every["choices"]) == (10, 68, 157)
    assert (every["cheapest"], every["reference"], every["dearest"]) == (22, 23, 27)
    assert every["most_saved"] == {"world": "m2/6", "reference": 3, "cheapest": 2}
    assert every["judged_by"] == "every claim, on a run for each choice"
    assert (every["decided_by"], entry["decided_by"]) == ("mapper", "mapper")
    shown = " ".join(call(line).stdout.split())
    assert "No policy of pick and order saves more than 4.0% of what" in shown
    (entry,) = results("search basic --edges 1 --workers 0")["results"]
    assert entry["by_edges"][0]["every"] is entry["decided_by"] is None


RUNS = """
def explore(robot):
    with open("runs", "a") as file:
        file.write(".")
    return {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}
"""


@pytest.mark.parametrize("report", ["", "--report page.html"])
def test_what_is_shown_is_the_judged_run_and_no_mapper_runs_for_it(
    folder: Path, call: Call, report: str
) -> None:
    """It runs in the first world, in its witness, and once more alone."""
    (folder / "counts.py").write_text(RUNS)
    done = call(f"search counts.py:explore --edges 2 {report}")
    assert done.exit_code == 1
    assert "The walk of counts.py:explore in m1/0:" in done.stdout
    assert "witness m2/0: run there, the mapper is wrong" in done.stdout
    assert (folder / "runs").read_text() == "..."


def test_the_runs_of_a_search_that_goes_on_are_those_that_were_judged(
    folder: Path, call: Call
) -> None:
    (folder / "counts.py").write_text(RUNS)
    line = "search counts.py:explore --edges 2 --keep-going"
    call(line)
    alone = (folder / "runs").read_text()
    (folder / "runs").unlink()
    call(f"{line} --report page.html")
    assert (folder / "runs").read_text() == alone
    assert "counts.py:explore in m1/0" in (folder / "page.html").read_text()
