"""`play`, and `--player` of `explore`: one page, for one world."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

from tests.cli.conftest import Call, Refused, Results


def recorded(file: str) -> dict[str, Any]:
    """The data in a page."""
    found = re.search(r'<script type="application/json" id="recording">(.*)</script>', read(file))
    assert found is not None
    data: dict[str, Any] = json.loads(found[1])
    return data


def read(file: str) -> str:
    """The text of a page."""
    return Path(file).read_text(encoding="utf-8")


def test_an_entry_has_the_promised_fields(results: Results) -> None:
    (entry,) = results("play m3/14 -o it.html")["results"]
    assert entry == {
        "world": "m3/14",
        "file": "it.html",
        "algorithms": ["enhancement-ii"],
        "findings": 0,
    }
    assert recorded("it.html")["name"] == "m3/14"


def test_several_algorithms_are_in_one_page(call: Call) -> None:
    done = call("play 'family:lattice(2,2)' --target basic,folding")
    assert done.exit_code == 0
    assert "player.html: basic, folding in lattice(2,2)" in done.stdout
    assert [run["name"] for run in recorded("player.html")["runs"]] == ["basic", "folding"]


def test_findings_are_counted_and_the_exit_code_stays_0(results: Results) -> None:
    line = "play m2/9 --in-process --target mappers.py:ignores_direction"
    (entry,) = results(line)["results"]
    assert entry["findings"] > 0
    assert len(recorded("player.html")["runs"][0]["findings"]) == entry["findings"]


def test_explore_writes_the_page_of_all_its_runs(call: Call) -> None:
    done = call("explore m3/14 --target basic,enhancement-i --player runs.html")
    assert done.exit_code == 0
    assert len(recorded("runs.html")["runs"]) == 2
    same = call("play m3/14 --target basic,enhancement-i -o played.html")
    assert same.exit_code == 0
    assert read("runs.html") == read("played.html")


def test_replay_writes_the_page_of_a_run_and_of_its_trace(call: Call) -> None:
    target = "mappers.py:ignores_direction"
    assert call(f"replay m2/9 --in-process --target {target} --player run.html").exit_code == 1
    done = call(f"explore m2/9 --in-process --target {target} --trace run.jsonl")
    assert done.exit_code == 1
    assert call("replay run.jsonl --player trace.html").exit_code == 1
    pages = recorded("run.html"), recorded("trace.html")
    assert pages[0]["runs"][0]["events"] == pages[1]["runs"][0]["events"]
    assert pages[0]["runs"][0]["findings"]
    assert call("replay m3/14 --player -").exit_code == 2


def test_a_page_shows_one_world(call: Call, refused: Refused) -> None:
    refused("explore m3/14 m3/15 --player runs.html", "expected one WORLD, got 2")
    assert not Path("runs.html").exists()
    assert call("play m3/14 -o -").exit_code == 2
    assert call("explore m3/14 --player no/such/folder/x.html").exit_code == 2
