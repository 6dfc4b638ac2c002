"""`explore --marker all`: an entry a dart, best and worst named, equal places, the heat map."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from topo_verify import World, explore
from topo_verify.world.drawing import read_back

Call = Callable[..., Any]


def test_each_dart_has_the_entry_that_it_has_alone(results: Call) -> None:
    entries = results("explore m4/100 --marker all --algorithm basic,folding")["results"]
    assert [e["marker"] for e in entries] == [*range(8), *range(8)]
    world = World.from_id("m4/100")
    for entry in entries:
        dart = entry["marker"]
        assert entry["cost"] == explore(world.with_marker(dart), entry["algorithm"]).cost
        assert entry["place"] == world.vertex_of[dart]
        assert (entry["world"], entry["ok"]) == ("m4/100", True)


def test_places_that_look_the_same_are_named_and_cost_the_same(results: Call) -> None:
    entries = results("explore 'family:cube()' --marker all --algorithm basic")["results"]
    assert [e["same_as"] for e in entries] == [None, *[0] * 23]
    assert len({e["cost"] for e in entries}) == 1
    entries = results("explore 'family:path(3)' --marker all --algorithm basic")["results"]
    assert [e["same_as"] for e in entries] == [None, None, 1, 0]


def test_a_table_names_the_best_and_the_worst_place(call: Call, results: Call) -> None:
    line = "explore m5/17 --marker all --algorithm basic"
    costs = [e["cost"] for e in results(line)["results"]]
    text = call(line).stdout
    assert "the marker at each of 10 darts, 10 of them" in text
    best, worst = costs.index(min(costs)), costs.index(max(costs))
    world = World.from_id("m5/17")
    (row,) = [words for words in map(str.split, text.splitlines()) if words[:1] == ["basic"]]
    at = [f"{world.vertex_of[dart]}:{dart}" for dart in (best, worst)]
    assert row[2:6] == [str(min(costs)), at[0], str(max(costs)), at[1]]
    assert row[6] == f"{1 - min(costs) * 10 / sum(costs):.0%}"


def test_a_faulty_mapper_is_found_where_it_fails_and_its_line_shows_it_again(
    results: Call, call: Call
) -> None:
    line = "explore m2/5 --marker all --algorithm mappers.py:ignores_direction --in-process"
    entries = results(line, code=1)["results"]
    bad = [entry for entry in entries if entry["findings"]]
    assert bad
    replay = bad[0]["findings"][0]["replay"]
    assert f"--marker {bad[0]['marker']}" in replay
    assert call(replay.removeprefix("topo-verify ")).exit_code == 1


def test_the_heat_map_is_a_true_drawing_and_has_a_colour_a_dart(call: Call) -> None:
    line = "explore m5/17 --marker all --algorithm basic --svg heat.svg"
    assert call(line).exit_code == 0
    svg = Path("heat.svg").read_text()
    assert read_back.untruths(read_back.read(svg), World.from_id("m5/17")) == []
    assert svg.count("data-mean=") == 4
    assert svg.count("data-dart=") == 9  # the arrow stands on the tenth
    assert "basic in m5/17: cost by place and direction of the marker" in svg


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("explore m0/0 --marker all", "m0/0 has no edge that a marker could point at"),
        ("explore m3/14 --marker all --svg h.svg", "expected the name of a file, one WORLD and"),
        ("explore m3/14 --marker all --svg - --algorithm basic", "expected the name of a file"),
        ("explore m3/14 --marker all --gap", "--gap is for one marker: leave it out"),
        ("explore m3/14 --marker all --trace t", "--trace is for one marker: leave it out"),
        ("explore m3/14 --marker all --player p", "--player is for one marker: leave it out"),
        ("explore m3/14 --marker every", "expected a dart (a number) or all, got 'every'"),
    ],
)
def test_bad_usage_is_one_sentence(call: Call, line: str, words: str) -> None:
    done = call(line)
    assert done.exit_code == 2
    assert words in done.stderr
    assert done.stderr.count("\n") == 1


def test_there_is_no_heat_map_of_runs_that_fail(call: Call) -> None:
    line = "explore m2/5 --marker all --algorithm mappers.py:ignores_direction --in-process"
    done = call(f"{line} --svg heat.svg")
    assert done.exit_code == 1
    assert "--svg heat.svg: not written, since not every run delivered a true map" in done.stderr
    assert not Path("heat.svg").exists()
