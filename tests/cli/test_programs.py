"""Programs as TARGETs: every command that takes a mapper takes `--cmd`."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import Call, Refused, Results

RIGHT = f"{shlex.quote(sys.executable)} -m topo_verify.programs.serve basic"
WRONG = f"{shlex.quote(sys.executable)} -m topo_verify.programs.serve mappers.py:guesses"


@pytest.mark.long
@pytest.mark.parametrize("workers", [0, 2])
def test_search_goes_through_all_worlds_with_a_program(results: Results, workers: int) -> None:
    (entry,) = results(f'search --cmd "{RIGHT}" --edges 3 --workers {workers}')["results"]
    assert (entry["verdict"], entry["checked"]) == ("EXHAUSTED", 86)
    assert entry["target"].startswith("--cmd ")
    assert entry["by_edges"][2]["max_cost"] == 10


@pytest.mark.nightly
def test_a_wrong_program_has_its_smallest_counterexample_which_replay_shows(
    results: Results,
) -> None:
    (entry,) = results(f'search --cmd "{WRONG}" --edges 3', code=1)["results"]
    (ours,) = results("search mappers.py:guesses --edges 3", code=1)["results"]
    assert entry["counterexample"]["world"] == ours["counterexample"]["world"]
    line = entry["counterexample"]["replay"].removeprefix("topo-verify ")
    (again,) = results(line, code=1)["results"]
    assert again["findings"]


@pytest.mark.nightly
def test_a_changed_program_does_not_go_on_with_a_ledger(
    call: Call, refused: Refused, folder: Path
) -> None:
    script = folder / "run.sh"
    script.write_text(f"#!/bin/sh\nexec {RIGHT}\n")
    script.chmod(0o755)
    line = f'search --cmd "{script}" --edges 2 --ledger book.sqlite'
    assert call(line).exit_code == 0
    assert call(line).exit_code == 0
    script.write_text(f"#!/bin/sh\n# changed\nexec {RIGHT}\n")
    refused(line, "has changed since")


SKIPPER = Path(__file__).parents[1] / "programs" / "misbehaving.py"
SKIPS = f"{shlex.quote(sys.executable)} {SKIPPER} skips"


@pytest.mark.parametrize("command", ["explore", "replay"])
def test_a_world_that_a_program_skips_is_not_decided(
    results: Results, call: Call, command: str
) -> None:
    (entry,) = results(f'{command} m1/1 --cmd "{SKIPS}"', code=3)["results"]
    assert (entry["ok"], entry["findings"]) == (False, [])
    assert entry["stopped"] == "the program skips this world: no loops, please"
    told = call(f'{command} m1/1 --cmd "{SKIPS}"').stdout
    assert "not decided" in " ".join(told.split())


def test_a_search_in_which_a_program_skips_worlds_is_open(results: Results) -> None:
    line = f'search --cmd "{SKIPS}" --edges 1 --workers 0'
    (entry,) = results(line, code=3)["results"]
    assert (entry["verdict"], entry["checked"], entry["counterexample"]) == ("UNKNOWN", 1, None)


@pytest.mark.nightly
def test_verify_and_explore_run_programs(results: Results) -> None:
    parts = results(f'verify --cmd "{RIGHT}" --quick')["results"]
    assert {part["ok"] for part in parts} == {True}
    (entry,) = results(f'explore nyc --cmd "{RIGHT}"')["results"]
    (ours,) = results("explore nyc --target basic")["results"]
    assert entry["cost"] == ours["cost"]
