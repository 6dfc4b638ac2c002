"""`explore`: fields, tables, findings, and replay lines that show the same again."""

from __future__ import annotations

import json
import shlex
from pathlib import Path
from unittest.mock import Mock

import pytest

from tests.cli.conftest import Call, Results
from tests.helpers import SURE
from topo_verify import World, families
from topo_verify import explore as run_mapper


def test_an_entry_tells_of_the_world_and_of_the_run(results: Results) -> None:
    envelope = results("explore m3/14 --target basic")
    assert {"format", "version", "tool", "ok", "exit", "results", "timing"} <= envelope.keys()
    assert envelope["format"] == "topo-verify/explore"
    (entry,) = envelope["results"]
    assert (entry["world"], entry["vertices"], entry["edges"], entry["genus"]) == ("m3/14", 3, 3, 0)
    assert (entry["cost"], entry["isomorphic"], entry["ok"]) == (4, True, True)
    assert entry["policies"] == {"pick": "nearest", "order": "shortest"}
    assert (entry["least_cost"], entry["entailed"], entry["stopped"]) == (4, True, None)


def test_policies_reach_the_algorithms(results: Results) -> None:
    line = "explore m5/17 --target basic --pick last --order 'random(3)'"
    (entry,) = results(line)["results"]
    assert entry["policies"] == {"pick": "last", "order": "random(3)"}


def test_a_world_is_called_by_its_name_its_id_or_its_file(results: Results) -> None:
    world = World.from_id("m3/14")
    named = world.to_json()
    bare = named.replace('"name":"m3/14",', "")
    Path("bare.json").write_text(bare)
    Path("named.json").write_text(named.replace("m3/14", "my town"))
    line = "explore bare.json named.json - 'family:lattice(2,2)' --target basic"
    names = [entry["world"] for entry in results(line, bare)["results"]]
    assert names == ["bare", "my town", "m3/14", "lattice(2,2)"]


def test_a_marker_laid_elsewhere_makes_another_world(results: Results) -> None:
    (entry,) = results("explore m3/14 --target basic --marker 5")["results"]
    assert entry["world"] == World.from_id("m3/14").with_marker(5).id != "m3/14"


@pytest.mark.long
@pytest.mark.parametrize(
    ("mapper", "options", "words"),
    [
        ("ignores_direction", "", "door"),
        ("guesses", "", "not isomorphic"),
        ("nonsense", "", "int has no 'vertices'"),
        ("raises", "", "ValueError: no"),
        ("loops", "--move-timeout 0.2", "did not move for 0.2 s"),
        ("walks", "", "more than"),
        ("walks", "--budget 10", "more than 10 moves"),
    ],
)
def test_a_faulty_mapper_is_found_and_its_line_shows_it_again(
    results: Results, call: Call, mapper: str, options: str, words: str
) -> None:
    line = f"explore m2/3 --marker 2 --target mappers.py:{mapper} {options}"
    envelope = results(line, code=1)
    (entry,) = envelope["results"]
    assert not entry["ok"]
    assert any(words in finding["message"] for finding in entry["findings"])
    (again,) = {finding["replay"] for finding in entry["findings"]}
    for word in ("--marker 2", options):
        assert word in again
    again = again.removeprefix("topo-verify ")
    assert call(again).exit_code == 1
    (repeated,) = results(again, code=1)["results"]
    assert [f["message"] for f in repeated["findings"]] == [f["message"] for f in entry["findings"]]


@pytest.mark.parametrize("command", ["explore", "replay"])
@pytest.mark.parametrize(
    ("signal", "code"), [("SIGKILL", 3), ("SIGTERM", 3), ("SIGINT", 3), ("SIGABRT", 1)]
)
def test_a_mapper_whose_process_was_killed_is_run_again_as_in_a_search(
    results: Results, command: str, signal: str, code: int
) -> None:
    Path("once.py").write_text(
        "import os, pathlib, signal\n"
        "from topo_verify import CATALOGUE\n"
        "def once(robot):\n"
        "    if not pathlib.Path('mark').exists():\n"
        "        pathlib.Path('mark').touch()\n"
        f"        os.kill(os.getpid(), signal.{signal})\n"
        "    return CATALOGUE['basic'](robot)\n"
    )
    (entry,) = results(f"{command} m2/7 --target once.py:once", code=code)["results"]
    ended = "the second try passed" if code == 3 else "at the second try it delivered one"
    assert not entry["ok"]
    assert f"was ended by {signal}" in entry["stopped"]
    assert entry["stopped"].endswith(ended)
    assert bool(entry["findings"]) == (code == 1)


def test_what_a_mapper_does_not_declare_is_not_called_ok(results: Results, call: Call) -> None:
    line = "explore m3/14 --target mappers.py:silent"
    (entry,) = results(line)["results"]
    assert sorted(entry["claims"].values()) == ["not-declared"] * 5 + ["ok"] * 5
    assert entry["policies"] == {"pick": None, "order": None}
    text = call(line).stdout
    assert "5 of 10 hold, 5 not declared" in " ".join(text.split())
    row = next(line for line in text.splitlines() if line.startswith("mappers.py:silent"))
    assert row.split()[3:5] == ["-", "-"]  # rejected free, moving: not declared
    silent = "Not judged, because mappers.py:silent declares nothing about it: true-hypothesis-"
    assert silent in text.replace("\n", " ")


# ---------------------------------------------------------------- worlds that are gone


def test_a_small_world_from_stdin_is_found_again_by_its_id(results: Results) -> None:
    world = World.from_id("m3/14").to_json()
    line = "explore - --target mappers.py:guesses --marker 5"
    (entry,) = results(line, world, code=1)["results"]
    moved = World.from_id("m3/14").with_marker(5)
    again = entry["findings"][0]["replay"]
    assert again == f"topo-verify replay {moved.id} --target mappers.py:guesses"


@pytest.mark.long
def test_a_large_world_from_stdin_is_kept_in_a_file_for_the_line(
    results: Results, call: Call, folder: Path
) -> None:
    world = families.lattice(12, 12)
    line = "explore - --target mappers.py:guesses"
    before = set(folder.iterdir())
    first, second = (results(line, world.to_json(), code=1)["results"][0] for _ in "12")
    assert first == second  # and one file, for it is the same world
    (kept,) = set(folder.iterdir()) - before
    assert World.load(kept) == world
    again = first["findings"][0]["replay"]
    assert again == f"topo-verify replay {kept.name} --target mappers.py:guesses"
    assert call(again.removeprefix("topo-verify ")).exit_code == 1


def test_a_world_is_never_kept_over_another_file(results: Results, folder: Path) -> None:
    line, text = "explore - --target mappers.py:guesses", families.lattice(12, 12).to_json()
    before = set(folder.iterdir())
    results(line, text, code=1)
    (kept,) = set(folder.iterdir()) - before
    kept.write_text("something of the user's")
    (entry,) = results(line, text, code=1)["results"]
    assert f"{kept.stem}-2.json" in entry["findings"][0]["replay"]
    assert kept.read_text() == "something of the user's"


def test_a_world_that_cannot_be_saved_is_an_error(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    denied = PermissionError(13, "Permission denied")
    monkeypatch.setattr(Path, "open", Mock(side_effect=denied))
    done = call("explore - --target mappers.py:guesses", families.lattice(12, 12).to_json())
    assert done.exit_code == 2
    assert "cannot be saved" in done.stderr


def test_a_file_that_looks_like_an_option_gets_a_line_that_works(call: Call, folder: Path) -> None:
    World.from_id("m3/14").save(folder / "-w.json")
    text = call("explore --target mappers.py:guesses -- -w.json").stdout
    assert "again: topo-verify replay ./-w.json --target mappers.py:guesses\n" in text
    assert call("replay ./-w.json --target mappers.py:guesses").exit_code == 1


# ---------------------------------------------------------------- traces and tables


def test_the_trace_of_a_run_is_written_and_judged_again(
    call: Call, results: Results, folder: Path
) -> None:
    call("explore m5/17 --target enhancement-ii --trace run.jsonl")
    lines = [json.loads(line) for line in (folder / "run.jsonl").read_text().splitlines()]
    assert (lines[0]["type"], lines[0]["world"], lines[-1]["type"]) == ("start", "m5/17", "finish")
    (entry,) = results("replay run.jsonl")["results"]
    assert (entry["target"], entry["world"], entry["ok"]) == ("enhancement-ii", "m5/17", True)


@pytest.mark.long
def test_one_world_gets_a_table_of_the_whole_catalogue(call: Call) -> None:
    done = call("explore nyc")
    assert done.exit_code == 0
    lines = done.stdout.splitlines()
    assert lines[0] == "nyc_osmnx: 46 vertices, 73 edges, genus 0, least cost 415"
    assert lines[1].split()[:3] == ["algorithm", "cost", "of"]
    assert lines[2].split()[:3] == ["basic", "1468", "1.00"]
    assert [line.split()[0] for line in lines[2:]] == SURE


def test_one_algorithm_gets_a_table_of_worlds(call: Call) -> None:
    lines = call("explore nyc m3/14 m5/17 --target basic").stdout.splitlines()
    assert lines[0] == "basic"
    assert [line.split()[0] for line in lines[1:]] == ["world", "nyc_osmnx", "m3/14", "m5/17"]


def test_replay_lines_are_split_by_a_shell_as_they_were_meant(
    results: Results, folder: Path
) -> None:
    (folder / "my town's.json").write_text(World.from_id("m3/14").to_json())
    line = """explore "my town's.json" --target mappers.py:guesses"""
    (entry,) = results(line, code=1)["results"]
    words = shlex.split(entry["findings"][0]["replay"])
    assert words == ["topo-verify", "replay", "my town's.json", "--target", "mappers.py:guesses"]


def test_the_walk_of_the_first_failing_run_is_shown(call: Call) -> None:
    text = call("explore m1/0 m1/1 m2/5 --target mappers.py:guesses").stdout
    _, _, walk = text.partition("The walk of mappers.py:guesses in m1/1:")
    assert "!! map-isomorphic" in walk
    assert walk.endswith("  again: topo-verify replay m1/1 --target mappers.py:guesses\n")
    assert "The walk of" not in call("explore m1/0 --target mappers.py:guesses").stdout


def test_choices_are_told_one_by_one(call: Call) -> None:
    told = call("explore m2/8 --target folding+planar --choices 0 --format json")
    assert told.exit_code == 1
    (entry,) = json.loads(told.stdout)["results"]
    line = "topo-verify explore m2/8 --target folding+planar --choices 0"
    assert {finding["replay"] for finding in entry["findings"]} == {line}
    assert call("explore m2/8 --target basic --choices 0,1").exit_code == 0


# ---------------------------------------------------------------- --marker all


def test_each_dart_has_the_entry_that_it_has_alone(results: Results) -> None:
    entries = results("explore m4/100 --marker all --target basic,folding")["results"]
    assert [e["marker"] for e in entries] == [*range(8), *range(8)]
    world = World.from_id("m4/100")
    for entry in entries:
        dart = entry["marker"]
        assert entry["cost"] == run_mapper(world.with_marker(dart), entry["algorithm"]).cost
        assert entry["place"] == world.vertex_of[dart]
        assert (entry["world"], entry["ok"]) == ("m4/100", True)


def test_places_that_look_the_same_are_named_and_cost_the_same(results: Results) -> None:
    entries = results("explore 'family:cube()' --marker all --target basic")["results"]
    assert [e["same_as"] for e in entries] == [None, *[0] * 23]
    assert len({e["cost"] for e in entries}) == 1
    entries = results("explore 'family:path(3)' --marker all --target basic")["results"]
    assert [e["same_as"] for e in entries] == [None, None, 1, 0]


def test_a_table_names_the_best_and_the_worst_place(call: Call, results: Results) -> None:
    line = "explore m5/17 --marker all --target basic"
    costs = [e["cost"] for e in results(line)["results"]]
    text = call(line).stdout
    assert "the marker at each of 10 darts, 10 of them" in text
    best, worst = costs.index(min(costs)), costs.index(max(costs))
    world = World.from_id("m5/17")
    (row,) = [words for words in map(str.split, text.splitlines()) if words[:1] == ["basic"]]
    at = [f"{world.vertex_of[dart]}:{dart}" for dart in (best, worst)]
    assert row[2:6] == [str(min(costs)), at[0], str(max(costs)), at[1]]
    assert row[6] == f"{1 - min(costs) * 10 / sum(costs):.0%}"


def test_a_faulty_mapper_is_found_at_the_marker_where_it_fails(
    results: Results, call: Call
) -> None:
    line = "explore m2/5 --marker all --target mappers.py:ignores_direction --in-process"
    entries = results(line, code=1)["results"]
    bad = [entry for entry in entries if entry["findings"]]
    assert bad
    replay = bad[0]["findings"][0]["replay"]
    assert f"--marker {bad[0]['marker']}" in replay
    assert call(replay.removeprefix("topo-verify ")).exit_code == 1
