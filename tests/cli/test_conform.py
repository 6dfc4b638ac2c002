"""`topo-verify conform`: entries, exit codes, what a person is shown."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import Call, Results

ROOM = Path(__file__).parents[1] / "programs"

BASIC = f"--cmd '{sys.executable} -m topo_verify.programs.serve basic'"
SKIPS = f"--cmd '{sys.executable} {ROOM / 'misbehaving.py'} skips'"
BATCH = f"--cmd '{sys.executable} {ROOM / 'batch_program.py'} right'"


@pytest.mark.long
def test_each_level_has_an_entry(results: Results) -> None:
    found = results(f"conform {BASIC} --like basic --worlds edges<=2 --workers 1")
    assert found["format"] == "topo-verify/conform"
    assert [entry["level"] for entry in found["results"]] == [
        *("result", "claims", "decisions", "cost")
    ]
    for entry in found["results"]:
        assert entry["cost"].keys() == {"mapper", "reference", "ratio"}
        assert (entry["worlds"], entry["passed"], entry["verdict"]) == (12, 12, "EXHAUSTED")


def test_a_finding_exits_1_and_says_how_to_see_it_again(results: Results) -> None:
    line = "conform mappers.py:guesses --worlds edges<=2 --workers 0"
    found = results(line, code=1)
    finding = found["results"][0]["findings"][0]
    again = shlex.split(finding["replay"])
    assert again[:3] == ["topo-verify", "conform", "mappers.py:guesses"]
    once = results(shlex.join([*again[1:], "--workers", "0"]), code=1)
    assert once["results"][0]["findings"][0]["message"] == finding["message"]


def test_a_skipped_world_exits_3(results: Results) -> None:
    found = results(f"conform {SKIPS} --worlds edges<=1 --workers 0", code=3)
    assert found["results"][0]["skipped"] == 1
    assert found["results"][0]["verdict"] == "UNKNOWN"


def test_the_cost_is_shown_as_measured(call: Call) -> None:
    (line,) = (
        line for line in call("conform basic --worlds m1/0").stdout.splitlines() if "cost  " in line
    )
    assert line.split() == ["cost", "measured", "1", "-", "0", "1"]


def test_batch_mode(results: Results) -> None:
    found = results(f"conform {BATCH} --batch --like basic --worlds edges<=2 --worlds m4/41")
    assert {entry["passed"] for entry in found["results"]} == {13}


def test_each_of_several_mappers_has_its_own_entries(results: Results) -> None:
    found = results("conform basic,enhancement-i --worlds nyc --workers 0")
    assert [(e["target"], e["level"]) for e in found["results"]] == [
        (target, level)
        for target in ("basic", "enhancement-i")
        for level in ("result", "claims", "cost")
    ]
    assert found["results"][-1]["cost"] == {"mapper": 982, "reference": 1468, "ratio": 0.6689}


def test_each_of_several_algorithms_is_compared(call: Call, results: Results) -> None:
    line = "conform basic --like enhancement-ii,basic --worlds m4/41 --workers 0 --store runs.db"
    found = results(line, code=1)["results"]
    decisions = [entry for entry in found if entry["level"] == "decisions"]
    assert [(entry["like"], entry["verdict"]) for entry in decisions] == [
        ("enhancement-ii", "REFUTED"),
        ("basic", "SAMPLED"),
    ]
    assert "--like enhancement-ii" in decisions[0]["findings"][0]["replay"].split(" --worlds")[0]
    text = call(line).stdout
    assert "basic, like enhancement-ii\n" in text
    assert "\n\nbasic, like basic\n" in text


def test_the_report_shows_where_two_runs_diverge(call: Call) -> None:
    done = call("conform basic --like enhancement-ii --worlds m4/41 --workers 0")
    assert done.exit_code == 1
    for words in (
        "decisions  ! REFUTED",
        "decisions in 1 world, first m4/41:",
        "rejects that edge 7 leads to 3 (by motion)",  # both do, before they part
        "Here they part:\n  enhancement-ii: rejects that edge 7 leads to 4 (by history)",
        "  basic: takes door 0 and sees (5)",
        "v1 (w1): 1-0  2-6  3-?[4]  4-?[3]  5-?[7]",
        "again: topo-verify conform basic --like enhancement-ii --worlds m4/41",
        "Cost over 1 world: 11 edge traversals, enhancement-ii 9: 1.222 of it.",
    ):
        assert words in done.stdout


def test_the_walk_in_the_first_world_that_convicts_is_shown(call: Call) -> None:
    text = call("conform mappers.py:guesses --worlds edges<=1 --workers 0").stdout
    _, _, walk = text.partition("The walk of mappers.py:guesses in m1/1:")
    assert "delivers a map" in walk
    assert "again: topo-verify replay m1/1 --target mappers.py:guesses" in walk
    done = call("conform basic --like enhancement-ii --worlds m4/41 --workers 0")
    assert "The walk of" not in done.stdout  # it is shown where the two part


def test_the_report_says_why_a_world_is_not_decided(call: Call) -> None:
    done = call(f"conform {SKIPS} --worlds edges<=1 --workers 0")
    assert "Not decided: 1 skipped." in done.stdout
    assert "no loops, please" in done.stdout


@pytest.mark.usefixtures("cut_off")
def test_an_interrupted_run_goes_on_from_its_store(results: Results) -> None:
    line = "conform basic --like basic --worlds edges<=2 --workers 0"
    assert results(f"{line} --store runs.db", code=3)["results"][0]["not_tried"] > 0
    envelope = results(f"{line} --store runs.db")
    assert envelope["timing"]["from_store"] == 3
    assert envelope["results"] == results(line)["results"]


def test_a_store_knows_a_world_in_another_place_of_the_list(results: Results) -> None:
    line = "conform basic --like enhancement-ii --workers 0 --worlds"
    results(f"{line} m4/41 --store runs.db", code=1)
    stored = results(f"{line} m1/0 --worlds m4/41 --store runs.db", code=1)["results"]
    assert stored == results(f"{line} m1/0 --worlds m4/41", code=1)["results"]


def test_transcripts_are_kept(call: Call, folder: Path) -> None:
    call("conform mappers.py:guesses --worlds m2/0 --workers 0 --transcript said/here")
    assert (folder / "said" / "here" / "m2-0.jsonl").is_file()


LISTENER = """
from topo_verify import CATALOGUE

def explore(robot):
    with open("met", "a") as file:
        file.write(f"{robot.percept.degree} ")
    return CATALOGUE["basic"](robot)
"""


@pytest.mark.nightly
def test_a_program_meets_the_worlds_in_an_order_that_is_drawn_anew(
    results: Results, folder: Path
) -> None:
    (folder / "listener.py").write_text(LISTENER)
    met: list[str] = []
    found: list[dict[str, object]] = []
    seeds: list[str] = []
    for option in ("", "", "--seed 0:7", "--seed 0:7"):
        line = f"conform listener.py:explore --worlds edges<=3 --workers 0 {option}"
        envelope = results(line)
        seeds.append(envelope.pop("timing")["seed"])
        found.append(envelope)
        met.append((folder / "met").read_text())
        (folder / "met").unlink()
    assert found[0] == found[1] == found[2]
    assert len(set(met[:3])) == 3
    assert met[2] == met[3]
    assert seeds[2:] == ["0:7", "0:7"]
    results(f"conform listener.py:explore --worlds edges<=3 --workers 0 --seed {seeds[0]}")
    assert (folder / "met").read_text() == met[0]
