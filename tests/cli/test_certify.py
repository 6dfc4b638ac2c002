"""`topo-verify certify`: logs judged with no world."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Call, Results
from topo_verify import World

RING = """\
{"type": "start", "percept": {"degree": 2, "marker": 0}}
{"type": "move", "door": 0, "percept": {"degree": 2, "marker": null}}
{"type": "move", "door": 1, "percept": {"degree": 2, "marker": 1}}
"""
FIELDS = {
    "trace", "verdict", "vertices", "edges", "open_darts", "decisions", "witnesses", "findings",
}  # fmt: skip


@pytest.fixture(autouse=True)
def logs(folder: Path) -> None:
    """The logs of a ring of two, whole and cut short, in the current folder."""
    (folder / "ring.jsonl").write_text(RING)
    (folder / "short.jsonl").write_text("".join(RING.splitlines(keepends=True)[:2]))


def test_a_proved_map_is_written(results: Results) -> None:
    (entry,) = results("certify ring.jsonl -o map.json")["results"]
    assert entry.keys() >= FIELDS
    assert (entry["verdict"], entry["edges"], entry["open_darts"]) == ("PROVED", 2, 0)
    assert entry["decisions"] == {"entailed": 0, "total": 0}
    assert World.load("map.json").degrees == (2, 2)


def test_a_log_that_proves_nothing_exits_1_with_its_two_worlds(
    call: Call, results: Results
) -> None:
    assert call("certify short.jsonl").exit_code == 1
    (entry,) = results("certify short.jsonl --witness there", code=1)["results"]
    assert entry["verdict"] == "REFUTED"
    one, other = map(World.load, entry["witnesses"])
    assert not one.is_isomorphic(other)
    assert results("certify short.jsonl", code=1)["results"][0]["witnesses"] == [one.id, other.id]


def test_a_trace_of_explore_is_a_log(call: Call, results: Results) -> None:
    call("explore m4/300 --algorithm folding --trace trace.jsonl")
    (entry,) = results("certify trace.jsonl")["results"]
    assert entry["verdict"] == "PROVED"
    assert entry["decisions"]["entailed"] == entry["decisions"]["total"] > 0
    assert " of " in call("certify trace.jsonl").stdout


def test_standard_input_is_a_log(results: Results) -> None:
    (entry,) = results("certify -", RING)["results"]
    assert entry["verdict"] == "PROVED"


def test_findings_are_printed_with_the_witness_worlds(call: Call) -> None:
    text = call("certify short.jsonl").stdout
    assert "with 2 darts of its fold never crossed" in " ".join(text.split())
    assert "2 worlds that show this log and differ" in text


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("certify nowhere.jsonl", "nowhere.jsonl"),
        ("certify ring.jsonl short.jsonl -o map.json", "expected one TRACE, got 2"),
        ("certify short.jsonl --witness ring.jsonl", "cannot create this folder"),
    ],
)
def test_bad_input_gets_one_sentence(call: Call, line: str, why: str) -> None:
    done = call(line)
    assert done.exit_code == 2
    assert why in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_a_witness_too_large_for_an_id_is_named_by_its_size(call: Call) -> None:
    Path("large.jsonl").write_text('{"type": "start", "percept": {"degree": 300, "marker": 0}}\n')
    assert "a world of 300 edges (--witness DIR writes it)" in call("certify large.jsonl").stdout
