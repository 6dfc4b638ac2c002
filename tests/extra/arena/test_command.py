"""`topo-verify arena`: who has a place, the same bytes each time, going on, bad usage."""

from __future__ import annotations

import json
import re
import shlex
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import Call, Refused, Results, require_same_bytes
from topo_verify.extra.arena.suites import SUITES, Suite, SuiteFamily, drawn, every

LINE = "arena basic,folding --suite small --workers 0"
FAULT = "topo_verify.faults:FAULTS.forgets-its-orientation"
SAME = ("table.md", "table.csv", "runs.csv", "results.json", "ratio-small.svg")


def triangle(_seed: int) -> list[str]:
    return ["family:cycle(3)"]


@pytest.fixture(autouse=True)
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Suites that take no time."""
    grids = drawn("lattice(4,4,holes=0.2)", 2, planar=True)
    triangles = SuiteFamily("cycle(3)", 1, triangle, exact=True)
    for name, families in {"small": (every(1), grids), "triangle": (triangles,)}.items():
        monkeypatch.setitem(SUITES, name, Suite(name, "a test", families))


def files(folder: str) -> dict[str, bytes]:
    return {name: Path(folder, name).read_bytes() for name in SAME}


def test_sound_mappers_have_places(results: Results) -> None:
    envelope = results(LINE)
    assert envelope["format"] == "topo-verify/arena"
    entries = envelope["results"]
    assert [(e["place"], e["worlds"]) for e in entries] == [(1, 4), (2, 4)]
    assert entries[0]["ratio"]["mean"] < entries[1]["ratio"]["mean"]
    assert all(e["ratio"].keys() == {"mean", "low", "high"} for e in entries)
    assert all({*e["claims"].values()} == {"ok"} and e["ratio"]["mean"] >= 1 for e in entries)
    assert entries[1]["behind"]["mapper"] == entries[0]["mapper"]
    assert envelope["timing"]["ms_per_move"]["small"] == {
        entry["mapper"]: entry["ms_per_move"] for entry in entries
    }
    assert envelope["timing"]["memory_mib"]["small"]["basic"] > 1


@pytest.mark.long
def test_a_seeded_fault_and_a_lucky_guesser_have_no_place(call: Call, results: Results) -> None:
    line = f"arena basic {FAULT} mappers.py:lucky --suite triangle,small --workers 0 --in-process"
    envelope = results(line, code=1)
    places = {(e["mapper"], e["suite"]): e["place"] for e in envelope["results"]}
    assert {mapper for (mapper, _), place in places.items() if place is not None} == {"basic"}
    lucky = [e for e in envelope["results"] if e["mapper"] == "mappers.py:lucky"]
    assert [e["ratio"] for e in lucky] == [None, None]
    # The map is right, and only the proof is missing.
    failed = {claim for claim, status in lucky[0]["claims"].items() if status == "failed"}
    assert failed == {"map-entailed"}
    assert lucky[0]["counterexample"]["world"] == "family:cycle(3)"
    text = call(line).stdout
    table, _, broken = text.partition("No place")
    ranked = [line.split()[1] for line in table.splitlines() if re.match(r" *\d+=? ", line)]
    assert {*ranked} == {"basic"}
    assert "map-entailed" in broken
    assert "again: topo-verify replay" in broken


@pytest.mark.parametrize("option", ["--budget 1000", "--world-timeout 61"])
def test_runs_under_other_limits_do_not_meet(call: Call, refused: Refused, option: str) -> None:
    line = "arena basic --suite triangle --workers 0 --out here"
    assert call(line).exit_code == 0
    refused(f"{line} {option}", f"its limits are the usual ones, now {option}; name another file")


SPY = """
from pathlib import Path
from topo_verify import CATALOGUE

def peeks(robot):
    assert b",seed=" not in Path("here/runs.db").read_bytes()
    return CATALOGUE["basic"](robot)
"""


@pytest.mark.long
def test_the_seed_of_drawn_worlds_is_out_of_reach(call: Call) -> None:
    """docs/extra/arena.md says what secrecy is worth."""
    Path("spy.py").write_text(SPY)
    line = "arena spy.py:peeks --suite small --seed 271 --workers 0 --out here"
    assert call(line).exit_code == 0


RIGHT = """
from topo_verify import CATALOGUE

def maps(robot):
    return CATALOGUE["basic"](robot)
"""


@pytest.mark.nightly
def test_a_changed_mapper_costs_its_own_runs_alone(call: Call) -> None:
    line = "arena basic mine.py:maps mappers.py:silent --suite small --workers 0 --out here"
    Path("mine.py").write_text(RIGHT)
    assert call(line).exit_code == 0
    first = files("here")
    Path("mine.py").write_text(f"{RIGHT}\nmaps = dict\n")
    wrong = call(line)
    assert wrong.exit_code == 1, "the runs of the right mapper are not taken for those of this one"
    assert "8 of 12 runs are in here/runs.db" in wrong.stderr
    (words,) = (text for text in wrong.stderr.splitlines() if "making" in text)
    assert words.startswith("topo-verify: making 4 runs of mine.py:maps in here/runs.db again: ")
    assert "source of the mapper" in words
    Path("mine.py").write_text(RIGHT)
    again = call(line)
    assert again.exit_code == 0
    assert "making 1 run of mine.py:maps in here/runs.db again: " in again.stderr
    assert files("here") == first
    assert "12 of 12 runs" in (last := call(line)).stderr
    assert "making" not in last.stderr


@pytest.mark.long
def test_a_report_says_which_runs_of_the_store_it_does_not_show(call: Call) -> None:
    assert "not shown" not in call(f"{LINE} --out here".replace("small", "small,triangle")).stdout
    words = "In here/runs.db and not shown: 1 run of basic, 5 runs of folding. To show"
    done = call("arena basic --suite small --workers 0 --out here")
    for text in (
        done.stdout,
        Path("here/table.md").read_text(),
        Path("here/report.html").read_text(),
    ):
        assert words in text
    assert "not shown" not in call(f"{LINE} --out here".replace("small", "small,triangle")).stdout


def test_a_folder_has_the_page_a_player_and_the_counterexample(call: Call) -> None:
    line = "arena basic mappers.py:lucky --suite triangle --workers 0 --in-process --out here"
    assert call(line).exit_code == 1
    made = {str(path.relative_to("here")) for path in Path("here").rglob("*") if path.is_file()}
    (picture,) = (name for name in made if name.endswith(".svg") and "counterexamples" in name)
    assert made >= {"report.html", "players/basic.html", picture.replace(".svg", ".html")}
    page = Path("here/report.html").read_text()
    for words in (
        '<p class="verdict">first in triangle: basic; 1 of 2 mappers break a claim<',
        *("Worlds to look at", "cost / LB by family", 'id="run-2"'),
        '<a href="#world-1">drawn in another run</a>',
    ):
        assert words in page
    assert page.count("<figure>") == 1, "the world of both runs is drawn once"
    assert "<svg" in Path("here", picture).read_text()
    entries = json.loads(Path("here/results.json").read_text())["results"]
    assert not any("ms_per_move" in entry for entry in entries)
    assert [e["counterexample"]["ended"] for e in entries if e["counterexample"]] == ["map"]


def test_a_page_plays_each_beside_the_first_where_it_loses_most(call: Call) -> None:
    assert call(f"{LINE} --out here").exit_code == 0
    (loss,) = (
        entry["losses"][0]
        for entry in json.loads(Path("here/results.json").read_text())["results"]
        if entry["losses"]
    )
    words = f"loses most: {loss['cost']} edge traversals, folding {loss['other']}"
    assert words in Path("here/table.md").read_text()
    assert words in Path("here/report.html").read_text()
    assert (
        " SAMPLED: first in small: folding; 8 of 8 runs</" in Path("here/report.html").read_text()
    )
    assert '<a href="#world-1">basic</a>' in Path("here/report.html").read_text()
    page = Path("here/players/basic.html").read_text()
    assert f"<title>folding beside basic in {loss['world']}<" in page


def test_a_page_says_what_the_moves_of_each_were_for(call: Call) -> None:
    assert call(f"{LINE} --out here").exit_code == 0
    table = Path("here/table.md").read_text()
    (line,) = (line for line in table.splitlines() if line.startswith("basic in family:"))
    spent = [int(number) for number in re.findall(r" (\d+)[,;]", line.partition("basic: ")[2])]
    spent.append(int(line.rsplit(" ", 1)[1]))
    cost = int(line.partition("loses most: ")[2].partition(" ")[0])
    assert sum(spent) == cost
    page = Path("here/report.html").read_text()
    assert page.index('id="worlds"') < page.index('id="judged"')


STRAYS = """
from topo_verify import CATALOGUE
from topo_verify.robot.events import Confirm, Pose

def explore(robot):
    robot.move(0)
    robot.declare(Pose(0, (1,)))
    robot.declare(Confirm(0, 1, "motion"))
    while True:
        robot.move(0)
"""


def test_a_counterexample_ends_soon_after_the_failing_claim(call: Call, results: Results) -> None:
    Path("strays.py").write_text(STRAYS)
    line = "arena basic strays.py:explore --worlds family:lattice(4,4) --workers 0 --out here"
    *_, strays = results(line, code=1)["results"]
    again = strays["counterexample"]["replay"]
    assert again.endswith("--target strays.py:explore --budget 103")
    assert strays["counterexample"]["claim"] in call(again.removeprefix("topo-verify ")).stdout
    (page,) = Path("here/counterexamples").glob("*.html")
    named = call(f"{line} --name strays.py:explore=Team")
    assert "2 of 2 runs are in here/runs.db" in named.stderr
    whole = "topo-verify replay 'family:lattice(4,4)' --target strays.py:explore"
    _, _, walk = named.stdout.partition("The walk of Team in")
    for text in (page.read_text(), walk):
        assert "map-isomorphic: no map" not in text
    for text in (walk, Path("here/table.md").read_text()):
        assert "cut here" in text
        assert whole in " ".join(text.split())
    assert [*Path("here/counterexamples").glob("Team*.html")]


def test_over_budget_is_told_apart_from_wrong(call: Call) -> None:
    line = f"arena basic,folding {FAULT} --suite small --workers 0 --in-process --out here"
    assert call(f"{line} --budget 30").exit_code == 1
    text = Path("here/table.md").read_text()
    assert "No place: a claim fails, --budget is exceeded, or it cannot be loaded" in text
    assert "| basic | over budget | budget |" in text
    assert f"| {FAULT} | over budget" not in text
    assert (
        "1 of 3 mappers break a claim; 2 of 3 mappers are over budget"
        in Path("here/report.html").read_text()
    )


def test_mappers_have_names_in_the_tables(call: Call, refused: Refused) -> None:
    line = "arena basic folding --suite triangle --workers 0"
    shown = call(f"{line} --name 'basic=Team A' --name folding=B").stdout
    assert "Team A" in shown
    assert "basic " not in shown.replace("--target basic ", "")
    assert " CPU ms  MiB" in shown
    shown = call(f"{LINE} --name 'basic=Team A' --name folding=B").stdout
    (command,) = (text for text in shown.splitlines() if "side by side: topo-verify" in text)
    played = call(command.partition(" topo-verify ")[2]).stdout
    assert played.startswith("basic-small-1.html: B, Team A in ")
    call(f"{line} --name 'basic=Team A' --out here")
    timing = json.loads(Path("here/timing.json").read_text())
    assert {row["name"] for row in timing} == {"Team A", "folding"}
    limits = "moves, the bound of claim 7; 5 s without a move, 60 s in all"
    assert limits in " ".join(Path("here/report.html").read_text().split())
    refused(f"{line} --name other=B", "expected TARGET=NAME with one of basic, folding")
    refused(f"{line} --name basic=folding", "two mappers have one name")


def test_an_entrant_that_cannot_be_loaded_is_last_and_the_others_are_ranked(
    call: Call, results: Results, refused: Refused
) -> None:
    Path("open.py").write_text("def explore(robot):\n    x = (\n")
    Path("notes.txt").write_text("#!/no/such/interpreter\n")
    Path("notes.txt").chmod(0o755)
    wrong = "open.py:explore gone.py:explore mappers.py:gone,basick --cmd ./gone --cmd ./notes.txt"
    line = f"arena basic folding {wrong} --suite triangle,small --workers 0 --out here"
    entries = [e for e in results(line, code=1)["results"] if e["suite"] == "small"]
    assert [entry["place"] for entry in entries] == [1, 2, *[None] * 6]
    why = {entry["mapper"]: entry["counterexample"] for entry in entries[2:]}
    assert {example["ended"] for example in why.values()} == {"not-loaded"}
    assert (
        "SyntaxError: '(' was never closed (open.py, line 2)" in why["open.py:explore"]["message"]
    )
    assert "cannot start './gone': No such file" in why["--cmd ./gone"]["message"]
    done = call(f"{line} --name './gone=Team G'")
    assert "topo-verify: no place: target 'mappers.py:gone': mappers.py has no" in done.stderr
    assert "Team G:\n  cannot be loaded: --cmd: cannot start './gone'" in done.stdout
    assert "6 of 8 mappers cannot be loaded" in Path("here/report.html").read_text()
    assert ",open.py:explore,small,," in (table := Path("here/table.csv").read_text())
    assert table.count("cannot be loaded\n") == 12
    refused("arena gone.py:explore --suite triangle", "there is no file 'gone.py'")


def test_a_program_takes_part_over_the_pipe_and_pays_what_its_twin_pays(results: Results) -> None:
    serve = shlex.quote(f"{sys.executable} -m topo_verify.programs.serve basic")
    program, twin = results(f"arena basic --cmd {serve} --suite small --workers 0")["results"]
    assert {program["place"], twin["place"]} == {1}
    assert program["ratio"] == twin["ratio"]
    assert program["claims"] == twin["claims"]


@pytest.mark.long
def test_what_is_not_decided_has_no_place_and_exits_3(call: Call) -> None:
    done = call("arena basic mappers.py:loops --suite triangle --world-timeout 0.02 --workers 0")
    assert done.exit_code == 3
    text = " ".join(done.stdout.split())
    assert (
        "mappers.py:loops has no place in triangle: 1 world of 1 not decided (--world-timeout)"
    ) in text
    line = "arena mappers.py:loops gone.py:explore --suite triangle --world-timeout 0.02"
    call(f"{line} --workers 0 --out there")
    words = "1 of 2 mappers cannot be loaded; 1 of 2 mappers out of time"
    assert words in Path("there/report.html").read_text()
    assert "family:cycle(3): the mapper was stopped after 0.02 s in this world\n" in done.stdout


def test_the_line_of_a_hanging_mapper_is_in_no_file_but_those_of_its_run(call: Call) -> None:
    """The line is one of many by chance."""
    line = "arena mappers.py:loops --suite triangle --move-timeout 0.05 --workers 0 --out here"
    assert "it was at mappers.py, line" in " ".join(call(line).stdout.split())
    for name in ("table.md", "table.csv", "results.json"):
        assert "it was at" not in Path("here", name).read_text()
    assert "the mapper did not move for 0.05 s" in Path("here/table.md").read_text()


@pytest.mark.long
def test_the_standings_come_first_then_where_each_lost(call: Call) -> None:
    text = call(LINE.replace("small", "small,triangle")).stdout
    words = [
        "small: a test", "triangle: a test", "depend on the machine",
        "small: where each loses most against folding", "side by side: topo-verify play 'family:",
        "small: cost/LB by family",
    ]  # fmt: skip
    places = list(map(text.find, words))
    assert -1 not in places
    assert places == sorted(places)
    (command,) = (line for line in text.splitlines() if "side by side: topo-verify" in line)
    done = call(command.partition(" topo-verify ")[2])
    assert (done.exit_code, done.stdout[:35]) == (0, "basic-small-1.html: folding, basic ")


def test_a_mapper_that_assumes_planar_worlds_is_left_out_of_others(call: Call) -> None:
    done = call("arena folding+planar --suite lattices,small --budget 1 --workers 0")
    assert "folding+planar assumes planar worlds: left out of small" in done.stderr


ENTRANTS = """
import os, sys
import topo_verify as tv
from topo_verify.programs import loaded

basic = tv.CATALOGUE["basic"]

def descends(robot):
    sys.setrecursionlimit(60)
    def walk():
        robot.move(0)
        walk()
    walk()

def denies(robot):
    loaded.loaded = lambda *_: os._exit(0)
    return basic(robot)
"""


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("descends", "the mapper raised RecursionError"),
        ("denies", "its process ended with exit code 0 before it said what it had loaded"),
    ],
)
def test_an_entrant_that_fails_between_two_messages_ends_no_league(
    call: Call, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, words: str
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.py").write_text(ENTRANTS)
    done = call(f"arena mine.py:{name} folding --suite triangle --workers 0 --out league")
    assert done.exit_code == 1
    assert "1  folding  " in done.stdout
    assert words in done.stdout.replace("\n ", "")


@pytest.mark.usefixtures("cut_off")
def test_an_interrupted_league_says_how_many_runs_are_done(call: Call) -> None:
    assert "interrupted after 4 of 8 runs" in call(f"{LINE} --out here").stderr


@pytest.mark.nightly
@pytest.mark.usefixtures("cut_off")
def test_the_same_bytes_however_many_workers_and_however_often_interrupted(call: Call) -> None:
    require_same_bytes(call, LINE[:-2], 8, files)


def test_worlds_of_your_own_are_a_suite_in_which_nothing_is_drawn(
    results: Results, call: Call
) -> None:
    line = "arena basic,folding --worlds family:wheel(4) --worlds edges<=2 --workers 0"
    first, second = results(line)["results"]
    assert (first["suite"], first["total"]) == ("own", 13)
    assert [family["family"] for family in first["families"]] == ["family:wheel(4)", "edges<=2"]
    assert first["ratio"]["low"] == first["ratio"]["mean"] < second["ratio"]["mean"]
    assert "own: worlds of your own, 13 worlds\n" in call(line).stdout


def test_a_sample_of_your_own_has_an_interval_and_another_seed_draws_it_anew(
    results: Results, call: Call
) -> None:
    line = "arena basic --worlds drawn:4:lattice(3,3,holes=0.2) --worlds edges<=2 --workers 0"
    one, other = (results(f"{line} --seed {seed}")["results"][0]["families"] for seed in (0, 7))
    assert one[0]["ratio"]["low"] < one[0]["ratio"]["mean"] < one[0]["ratio"]["high"]
    assert one[0] != other[0]
    assert one[1] == other[1]
    assert one[1]["ratio"]["low"] == one[1]["ratio"]["high"]
    assert "drawn:4" in (said := call(f"{line} --seed 7")).stdout
    twins = call("arena basic enhancement-i --worlds drawn:2:lattice(2,2) --workers 0").stdout
    assert "+0.00 ±0.00" in twins  # a sample is not exact, however equal
    assert "exact" not in twins
    assert "--seed draws nothing" not in said.stderr
    alone = call("arena basic --worlds m2/4 --seed 7 --workers 0").stderr
    assert "--seed draws nothing in --worlds without drawn: and generated:" in alone


def test_drawn_worlds_without_a_name_are_no_suite(refused: Refused) -> None:
    line = "arena basic --worlds generated:1:lattices(min_edges=220,max_edges=240)"
    refused(line, "generated:1:lattices(min_edges=220,max_edges=240)#0 has no name")


def test_a_run_that_fails_only_once_is_named(call: Call) -> None:
    Path("once.py").write_text(
        "from topo_verify import CATALOGUE\n"
        "runs = []\n"
        "def explore(robot):\n"
        "    runs.append(robot)\n"
        "    return CATALOGUE['basic'](robot) if len(runs) != 5 else None\n"
    )
    done = call("arena basic once.py:explore --suite tiny --workers 0 --in-process")
    assert done.exit_code == 1
    words = " ".join(done.stdout.split())
    assert "once.py:explore in m2/2, run once more: map-isomorphic holds." in words
    assert "map-isomorphic m2/2 tiny 4 of 792" in words or "5 of 792" in words


def test_after_three_time_outs_a_mapper_plays_no_further(results: Results, call: Call) -> None:
    line = "arena mappers.py:loops --suite tiny --world-timeout 0.02 --workers 0"
    (entry,) = results(line, code=3)["results"]
    assert (entry["worlds"], entry["undecided"], entry["total"]) == (0, 3, 792)
    assert (
        "789 of 792 worlds not played after three time-outs, 3 worlds of 792 not decided"
        in " ".join(call(line).stdout.split())
    )


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("arena", "name the TARGETs that take part"),
        ("arena basic --game 3", "arena: --game went with version 0.4: in a checkout"),
        ("arena basic --suite lattice", "did you mean 'lattices'?"),
        ("arena basic,folding basic", "'basic' takes part twice: name each mapper once"),
        ("arena folding+planar --suite tiny", "assumes planar worlds, and --suite tiny has"),
        ("arena basick", "no algorithm 'basick'; did you mean 'basic'?"),
        ("arena basic --out mappers.py", "--out mappers.py: cannot create this folder"),
    ],
)
def test_bad_usage_is_one_sentence(refused: Refused, line: str, words: str) -> None:
    refused(line, words)
