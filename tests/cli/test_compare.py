"""`topo-verify compare`: what it says has changed, and with which exit code it ends."""

from __future__ import annotations

import re
import shlex
import shutil
from pathlib import Path

import pytest
from click.testing import CliRunner

from tests.cli.conftest import Call, Program, Results
from topo_verify.cli import main

WORLDS = "--worlds 'edges<=3' --worlds m9/67076232 --worlds m10/1957360526 --worlds nyc"
NUMBERS = ("equal", "wrong", "dearer", "cheaper", "other_decisions", "newly_right", "undecided")


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with baselines of basic and of enhancement-i."""
    made = tmp_path_factory.mktemp("baselines")
    for name in ("basic", "enhancement-i"):
        line = f"record {name} {WORLDS} --out {shlex.quote(str(made / f'{name}.gz'))}"
        assert CliRunner().invoke(main, shlex.split(line)).exit_code == 0
    return made


@pytest.fixture(autouse=True)
def _baselines(recorded: Path, folder: Path) -> None:
    """The same files in the current folder."""
    shutil.copytree(recorded, folder, dirs_exist_ok=True)


@pytest.mark.long
def test_a_lower_cost_passes_and_a_higher_one_does_not(results: Results, call: Call) -> None:
    (better,) = results("compare basic.gz enhancement-i")["results"]
    assert (better["cheaper"], better["other_decisions"], better["dearer"]) == (2, 1, 0)
    (worse,) = results("compare enhancement-i.gz basic", code=1)["results"]
    assert (worse["dearer"], worse["beyond"]) == (2, 2)
    assert worse["cost"] == {"before": better["cost"]["after"], "after": better["cost"]["before"]}
    for entry in (better, worse):
        assert sum(entry[number] for number in NUMBERS) == entry["worlds"]
    text = call("compare enhancement-i.gz basic").stdout
    assert text.endswith("A regression: 2 worlds exceed the tolerance of 0 %.\n")


def test_what_is_dearer_within_the_tolerance_exits_0(results: Results) -> None:
    envelope = results("compare enhancement-i.gz basic --tolerance 77.8")
    assert envelope["format"] == "topo-verify/compare"
    (entry,) = envelope["results"]
    assert entry["baseline"]["target"] == "enhancement-i"
    assert (entry["tolerance"], entry["dearer"], entry["beyond"]) == ("77.8", 2, 0)


@pytest.mark.long
def test_a_wrong_mapper_exits_1_and_the_line_shows_it_again(results: Results, call: Call) -> None:
    (entry,) = results("compare basic.gz mappers.py:guesses --tolerance 100", code=1)["results"]
    assert entry["wrong"] == 88
    assert entry["examples"][0]["world"] == "m1/1"
    assert call(entry["examples"][0]["replay"].removeprefix("topo-verify ")).exit_code == 1
    text = call("compare basic.gz mappers.py:guesses").stdout
    assert "a claim fails: 88, smallest worlds first" in text
    assert "again: topo-verify replay m1/1 --target mappers.py:guesses" in text
    assert "A regression: in 88 worlds a claim fails, in 1 world the mapper declares" in text


def test_a_silent_mapper_exits_1_against_a_baseline_with_decisions(call: Call) -> None:
    done = call("compare basic.gz tests.faults.harmless:declares_nothing")
    assert done.exit_code == 1
    assert "A regression: in 89 worlds the mapper declares nothing and the baseline" in done.stdout


@pytest.mark.nightly
def test_a_time_out_is_incomplete(call: Call, results: Results) -> None:
    call("record mappers.py:strolls --worlds m1/0 --worlds m6/8161 --world-timeout 1.5 --out s.gz")
    (entry,) = results("compare s.gz mappers.py:strolls", code=3)["results"]
    assert (entry["equal"], entry["undecided"]) == (1, 1)
    assert (
        "No regression in 1 of 2 worlds; 1 world not decided."
        in call("compare s.gz mappers.py:strolls").stdout
    )


@pytest.mark.long
def test_an_algorithm_has_the_policies_of_the_baseline_unless_others_are_asked_for(
    call: Call, results: Results
) -> None:
    call(f"record basic --pick last --order newest {WORLDS} --out last.gz")
    assert results("compare last.gz basic")["results"][0]["equal"] == 89
    (other,) = results("compare last.gz basic --pick nearest", code=1)["results"]
    assert 0 < other["equal"] < 89
    assert other["baseline"]["policies"] == {"pick": "last", "order": "newest"}


def test_a_report_shows_each_group_and_each_change(call: Call) -> None:
    text = call("compare enhancement-i.gz basic --format markdown").stdout
    assert "| edges 51-100 | 1 | 1 | 0 | 982 | 1,468 | +49.5 |" in text
    assert "- nyc: 982 → 1,468 edge traversals (+49.5 %), beyond the tolerance" in text
    assert "`topo-verify replay nyc --target basic`" in text


@pytest.mark.long
def test_only_what_has_changed_has_a_row(call: Call) -> None:
    text = call("compare basic.gz enhancement-i").stdout
    assert re.search(r"^edges 51-100 +1 +1 +0 +1,468 +982 +-33\.1$", text, re.MULTILINE)
    assert not re.search(r"^edges 3 ", text, re.MULTILINE)
    assert "by class" not in call("compare basic.gz basic").stdout


@pytest.mark.long
def test_two_comparisons_are_equal_but_for_the_time(program: Program) -> None:
    first, second = (
        program("compare basic.gz enhancement-i --format json", PYTHONHASHSEED=seed).stdout
        for seed in ("1", "2")
    )
    assert first.partition('"timing"')[0] == second.partition('"timing"')[0]
    assert '"timing"' in first


@pytest.mark.nightly
def test_the_page_shows_what_is_printed(call: Call) -> None:
    page = (Path(__file__).parents[2] / "docs" / "baselines.md").read_text()
    record, compare = re.findall(r"^    \$ topo-verify (.*)$", page, re.MULTILINE)
    assert call(record).exit_code == 0
    (shown,) = re.findall(r"```\n(.*?)```", page, re.DOTALL)
    assert call(compare).stdout == shown
