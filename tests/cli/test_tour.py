"""`topo-verify tour`: the cheapest walk that proves a map, and a map judged by a log."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Call, Refused, Results
from tests.helpers import of_type
from topo_verify import World
from topo_verify.robot.events import Move, read_trace, write_trace
from topo_verify.studies.map_check import tour_log


@pytest.fixture(autouse=True)
def logs(folder: Path) -> None:
    """The tour of m3/40, whole and cut short, and a log of another world."""
    log = tour_log(World.from_id("m3/40"))
    (folder / "whole.jsonl").write_bytes(write_trace(log))
    (folder / "short.jsonl").write_bytes(write_trace(log[:3]))
    (folder / "other.jsonl").write_bytes(write_trace(tour_log(World.from_id("m3/41"))))


def test_an_entry_has_the_doors_of_the_tour_and_what_should_be_seen(results: Results) -> None:
    (entry,) = results("tour m3/40")["results"]
    world = World.from_id("m3/40")
    assert entry["world"] == "m3/40"
    assert entry["doors"] == [*world.proof_tour()]
    assert entry["cost"] == len(entry["doors"]) == world.least_cost()
    assert [seen["degree"] for seen in entry["seen"]] == [
        event.percept.degree for event in of_type(Move, tour_log(world))
    ]
    assert entry["against"] is None


def test_the_log_that_is_written_is_certified(results: Results) -> None:
    results("tour nyc -o tour.jsonl")
    (entry,) = results("certify tour.jsonl")["results"]
    assert (entry["verdict"], entry["edges"]) == ("PROVED", 73)
    (entry,) = results("tour nyc --against tour.jsonl")["results"]
    assert (entry["against"]["verdict"], entry["cost"]) == ("PROVED", 0)


def test_the_world_without_an_edge_has_an_empty_tour_that_is_a_proof(results: Results) -> None:
    (entry,) = results("tour m0/0 -o empty.jsonl")["results"]
    assert (entry["cost"], entry["doors"]) == (0, [])
    assert results("certify empty.jsonl")["results"][0]["verdict"] == "PROVED"
    assert results("tour m0/0 --against empty.jsonl")["results"][0]["against"]["moves"] == 0


def test_people_read_a_line_a_move(call: Call) -> None:
    lines = call("tour m2/7").stdout.splitlines()
    assert lines[0].startswith("m2/7: this walk of 2 moves proves the map")
    assert [line.split() for line in lines[-2:]] == [["1", "0", "4", "3"], ["2", "1", "4", "1"]]


def test_a_map_that_the_log_refutes_exits_1_and_names_the_event(
    call: Call, results: Results, folder: Path
) -> None:
    (entry,) = results("tour m3/40 --against other.jsonl", code=1)["results"]
    assert entry["against"]["verdict"] == "REFUTED"
    assert entry["against"]["event"] > 0
    assert entry["doors"] == entry["against"]["unproved"] == []
    done = call("tour m3/40 --against other.jsonl -o on.jsonl")
    assert (done.exit_code, (folder / "on.jsonl").exists()) == (1, False)
    event = entry["against"]["event"]
    words = f"event {event} (line {event + 1}) refutes the map"
    assert words in " ".join(done.stdout.split())
    assert "not written" in done.stderr


def test_a_map_that_the_log_proves_exits_0(call: Call) -> None:
    done = call("tour m3/40 --against whole.jsonl")
    assert (done.exit_code, done.stdout.split()[0]) == (0, "PROVED:")


def test_a_map_that_is_open_exits_3_with_a_way_on_that_proves_it(results: Results) -> None:
    (entry,) = results("tour m3/40 --against short.jsonl -o on.jsonl", code=3)["results"]
    against = entry["against"]
    assert (against["verdict"], against["moves"], against["event"]) == ("UNKNOWN", 2, None)
    assert entry["cost"] == len(entry["doors"]) == World.from_id("m3/40").least_cost() - 2
    assert 0 < len(against["unproved"]) < 3
    assert results("certify on.jsonl")["results"][0]["verdict"] == "PROVED"


def test_the_events_of_a_mapper_are_left_out_of_the_log_that_goes_on(
    call: Call, results: Results, folder: Path
) -> None:
    call("explore m3/40 --target basic --trace basic.jsonl")
    events = (folder / "basic.jsonl").read_bytes().splitlines(keepends=True)
    (folder / "begun.jsonl").write_bytes(b"".join(events[:5]))
    results("tour m3/40 --against begun.jsonl -o on.jsonl", code=3)
    assert len(read_trace((folder / "on.jsonl").read_bytes())) > 3
    assert results("certify on.jsonl")["results"][0]["decisions"]["total"] == 0


def test_a_log_may_come_from_standard_input(results: Results, folder: Path) -> None:
    log = (folder / "whole.jsonl").read_text()
    assert results("tour m3/40 --against -", log)["results"][0]["against"]["verdict"] == "PROVED"


def test_the_marker_may_lie_elsewhere(results: Results) -> None:
    (entry,) = results("tour m3/40 --marker 3")["results"]
    assert entry["cost"] == World.from_id("m3/40").with_marker(3).least_cost()


@pytest.mark.parametrize("line", ["", " --against short.jsonl", " --against other.jsonl"])
def test_the_player_shows_the_walk(call: Call, folder: Path, line: str) -> None:
    call(f"tour m3/40 --player tour.html{line}")
    page = (folder / "tour.html").read_text()
    assert '"name":"tour"' in page.replace('": "', '":"')


def test_a_log_that_does_not_begin_with_its_start_is_refused(
    refused: Refused, folder: Path
) -> None:
    (folder / "moves.jsonl").write_text(
        '{"type": "move", "door": 0, "percept": {"degree": 2, "marker": null}}\n'
    )
    refused("tour m3/40 --against moves.jsonl", "moves.jsonl")
