"""The store goes on after any end, and says in one sentence what it cannot read."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from topo_verify import InputError
from topo_verify.harness.reproduce import store as stores
from topo_verify.harness.reproduce.measuring import MeasuredRun, PlannedRun
from topo_verify.harness.reproduce.store import RunStore

RUNS = [PlannedRun("m3/14", "basic", "nearest", order) for order in ("shortest", "oldest")]
ROWS = [MeasuredRun(run, 3, 3, 4, cost, 10, 10) for cost, run in enumerate(RUNS, 4)]


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A store with both rows."""
    path = tmp_path / "runs.jsonl"
    with RunStore(path) as store:
        for row in ROWS:
            store.put(row)
    return path


def test_what_was_put_is_there_when_it_is_opened_again(path: Path) -> None:
    with RunStore(path) as store:
        assert store.runs == dict(zip(RUNS, ROWS, strict=True))
        assert store.missing(RUNS) == []
        assert not store.repaired


def test_cut_off_anywhere_it_keeps_every_whole_line(path: Path) -> None:
    data = path.read_bytes()
    for length in range(0, len(data), 5):
        path.write_bytes(data[:length])
        with RunStore(path) as store:
            whole = max(0, data[:length].count(b"\n") - 1)
            assert len(store.runs) == whole
            for row in ROWS[whole:]:
                store.put(row)
        assert path.read_bytes() == data


def test_a_run_that_is_undecided_is_made_again(tmp_path: Path) -> None:
    path = tmp_path / "runs.jsonl"
    with RunStore(path) as store:
        store.put(msgspec.structs.replace(ROWS[0], undecided="out of time"))
        assert store.missing(RUNS) == RUNS[1:]  # not within the same call
    with RunStore(path) as store:
        assert store.missing(RUNS) == RUNS


def test_one_call_at_a_time(path: Path) -> None:
    with RunStore(path), pytest.raises(InputError, match="another reproduce has it open"):
        RunStore(path)


def test_every_changed_byte_is_noticed(path: Path) -> None:
    data = path.read_bytes()
    line = data.splitlines(keepends=True)[1]
    start = data.index(line)
    for place in range(start, start + len(line) - 1):
        changed = bytearray(data)
        changed[place] ^= 1
        path.write_bytes(changed)
        with pytest.raises(InputError, match=r"line [23] is not what topo-verify wrote: remove it"):
            RunStore(path)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("size,cost\n4,40\n", "it is no store of reproduce"),
        ('{"format": "topo-verify/trace", "version": 1, "sources": ""}\n', "topo-verify/trace, no"),
        ("\n", "it is no store of reproduce"),
        ("x", "it is no store of reproduce"),
    ],
)
def test_a_foreign_file_is_refused_and_left_alone(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "runs.jsonl"
    path.write_text(text)
    with pytest.raises(InputError, match=words):
        RunStore(path)
    assert path.read_text() == text


def test_runs_of_other_sources_are_refused(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def another(_mappers: object) -> str:
        return "another"

    monkeypatch.setattr(stores, "source_hash", another)
    with pytest.raises(InputError, match="made by another version of topo-verify: remove it"):
        RunStore(path)


def test_a_folder_in_its_place_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="it cannot be opened"):
        RunStore(tmp_path)
