"""`reproduce`: fields, files, the same bytes each time, going on, findings, bad usage."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any
from zlib import crc32

import msgspec
import pytest

from topo_verify.checkers import Finding
from topo_verify.harness.reproduce.measuring import MeasuredRun, PlannedRun
from topo_verify.report.figures.pictures import picture

Call = Callable[..., Any]

command: Any = import_module("topo_verify.cli.reproduce")  # its package has the command itself

DRAWING = "topo_verify.report.figures.pictures.picture"

LINE = "reproduce --figure 3 --quick --graphs 2 --workers 1"

FIELDS = {"figure", "algorithm", "size", "graphs", "mean", "stderr", "paper"}


def csv(folder: str) -> bytes:
    return Path(folder, "figure-3.csv").read_bytes()


def make(run: PlannedRun) -> MeasuredRun:
    """A run that nobody made: fast, and different for each graph."""
    return MeasuredRun(
        run, 5, 20, 30, 100 + len(run.algorithm) + crc32(run.world.encode()) % 50, 10, 10
    )


def made_up(
    runs: list[PlannedRun], _workers: int, _engine: str = "reference"
) -> Iterator[MeasuredRun]:
    return map(make, runs)


def draw_nothing(*_arguments: object) -> bytes:
    return b"a picture"


@pytest.fixture(autouse=True)
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """tests/report/figures/test_pictures.py draws; one test here does, too."""
    monkeypatch.setattr(DRAWING, draw_nothing)


@pytest.fixture
def fast(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(command, "measured_runs", made_up)


@pytest.mark.usefixtures("fast")
def test_an_entry_has_the_promised_fields_and_the_files_are_there(results: Call) -> None:
    envelope = results(f"{LINE} --out here")
    assert envelope["format"] == "topo-verify/reproduce"
    assert all(entry.keys() >= FIELDS for entry in envelope["results"])
    stated = [entry for entry in envelope["results"] if entry["paper"] is not None]
    assert [(e["algorithm"], e["size"], e["paper"]) for e in stated] == [("basic", 10, 10000)]
    assert {(e["held"], e["of"]) for e in envelope["results"] if e["pick"]} == {(10, 10)}
    assert {path.name for path in Path("here").iterdir()} == {
        "figure-3.csv", "figure-3.svg", "figure-3.png", "growth.csv", "figures.md", "runs.jsonl",
    }  # fmt: skip


def test_the_same_bytes_however_many_workers_and_however_often_interrupted(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert call(f"{LINE} --out whole").exit_code == 0
    assert call(f"{LINE} --out two --workers 2").exit_code == 0
    real = command.measured_runs

    def cut_off(
        runs: list[PlannedRun], workers: int, _engine: str = "reference"
    ) -> Iterator[MeasuredRun]:
        for number, made in enumerate(real(runs, workers)):
            if number == 3:
                raise KeyboardInterrupt
            yield made

    monkeypatch.setattr(command, "measured_runs", cut_off)
    done = call(f"{LINE} --out parts")
    assert done.exit_code == 3
    assert "3 of 16 runs are kept in parts/runs.jsonl; the same command goes on" in done.stderr
    monkeypatch.setattr(command, "measured_runs", real)
    done = call(f"{LINE} --out parts")
    assert done.exit_code == 0
    assert "3 of 16 runs are in parts/runs.jsonl" in done.stderr
    assert csv("whole") == csv("two") == csv("parts")


@pytest.mark.usefixtures("fast")
def test_another_seed_draws_other_graphs(results: Call) -> None:
    one, other = (results(f"{LINE} --seed {seed}")["results"] for seed in (0, 1))
    assert one != other


@pytest.mark.usefixtures("fast")
def test_people_see_a_table_a_paragraph_exponents_and_what_was_judged(call: Call) -> None:
    text = call("reproduce --quick --figure 3,6a --graphs 2").stdout
    assert "Figure 6a: Enhancement I, lattices" in text
    assert "Does not follow from the text" in text
    assert "Growth: cost ~ m^exponent" in text
    assert "24 runs were judged: 10 of 10 claims held in each." in text


@pytest.mark.usefixtures("fast")
def test_policies_make_a_line_each(results: Call) -> None:
    entries = results(f"{LINE} --policies")["results"]
    pairs = {(e["pick"], e["order"]) for e in entries if e["algorithm"] == "basic"}
    assert len(pairs) == 10


@pytest.mark.usefixtures("fast")
def test_without_matplotlib_the_csv_is_written_all_the_same(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(DRAWING, picture)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    done = call(f"{LINE} --out bare")
    assert done.exit_code == 0
    assert done.stderr.count("pip install 'topo-verify[plots]'") == 1
    assert csv("bare")
    assert not Path("bare/figure-3.svg").exists()
    assert ".svg" not in Path("bare/figures.md").read_text()


def test_a_claim_that_fails_in_a_run_is_a_finding(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = Finding("no-false-confirm", 3, None, None, "confirmed", replay="topo-verify replay x")

    def faulty(
        runs: list[PlannedRun], _workers: int, _engine: str = "reference"
    ) -> Iterator[MeasuredRun]:
        first, *rest = map(make, runs)
        yield msgspec.structs.replace(first, held=9, findings=(found,))
        yield from rest

    monkeypatch.setattr(command, "measured_runs", faulty)
    done = call(LINE)
    assert done.exit_code == 1
    assert "16 runs were judged: a claim fails in 1 of them." in done.stdout
    assert "again: topo-verify replay x" in done.stdout
    monkeypatch.setattr(command, "measured_runs", made_up)
    assert call(LINE).exit_code == 1  # from the store, too


def test_a_run_out_of_time_is_incomplete(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:
    def slow(
        runs: list[PlannedRun], _workers: int, _engine: str = "reference"
    ) -> Iterator[MeasuredRun]:
        first, *rest = map(make, runs)
        yield msgspec.structs.replace(first, undecided="out of time")
        yield from rest

    monkeypatch.setattr(command, "measured_runs", slow)
    done = call(LINE)
    assert done.exit_code == 3
    assert "15 runs were judged: 10 of 10 claims held in each. 1 more were not" in done.stdout


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("reproduce --figure 4", "--figure '4': expected all, 6 or one of 3, 6a"),
        ("reproduce --out mappers.py", "--out mappers.py: cannot create this folder"),
        ("reproduce --graphs 0", "0 is not in the range"),
    ],
)
def test_bad_usage_is_one_sentence(call: Call, line: str, words: str) -> None:
    done = call(line)
    assert done.exit_code == 2
    assert words in done.stderr
    assert done.stderr.count("\n") == 1


def test_a_foreign_store_is_one_sentence(call: Call) -> None:
    Path("figures").mkdir()
    Path("figures/runs.jsonl").write_text("mine\n")
    done = call(LINE)
    assert done.exit_code == 2
    assert done.stderr.count("\n") == 1
    assert "figures/runs.jsonl: it is no store of reproduce" in done.stderr
