"""`reproduce`: fields, files, the same bytes each time, going on, findings, bad usage."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import astuple
from pathlib import Path
from unittest.mock import Mock
from zlib import crc32

import pytest
from msgspec.structs import replace

from tests.cli.conftest import Call, Refused, Results, require_same_bytes
from tests.extra.figures.rows import made_up
from topo_verify.campaign.campaign import Campaign, Shard, ShardResult
from topo_verify.campaign.row import Row
from topo_verify.campaign.tally import Counts
from topo_verify.checkers import Finding
from topo_verify.extra.figures.figures import PAIRS, REFERENCE
from topo_verify.extra.figures.points import PlannedRun

DRAWING = "topo_verify.extra.figures.command.picture"

LINE = "reproduce --figure 3 --quick --graphs 2 --workers 1"


def csv(folder: str) -> bytes:
    return Path(folder, "figure-3.csv").read_bytes()


Changes = list[Callable[[Row], Row]]
"""What is done to the first rows, one each."""


def make(run: PlannedRun) -> Row:
    """A row of a run that was not made: fast, and different for each graph."""
    return made_up(run, 100 + len(run.algorithm) + crc32(run.world.encode()) % 50, 20, 30)


@pytest.fixture(autouse=True)
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """tests/extra/figures/test_pictures.py draws."""
    monkeypatch.setattr(DRAWING, Mock(return_value=b"a picture"))


@pytest.fixture
def fast(monkeypatch: pytest.MonkeyPatch) -> Changes:
    """No run is made; the changes are made to the first rows."""
    changes: Changes = []

    def examine(
        campaign: Campaign, _mappers: object, shard: Shard, *_: object, **__: object
    ) -> ShardResult:
        pairs = (REFERENCE,) if campaign.ways is None else PAIRS
        runs = [PlannedRun(shard.listed[0][0], *campaign.mappers, *astuple(p)) for p in pairs]
        rows = [changes.pop()(make(run)) if changes else make(run) for run in runs]
        counts = Counts()
        counts.enter(rows)
        return ShardResult(counts.tally(), tuple(rows))

    monkeypatch.setattr("topo_verify.campaign.campaign.examine", examine)
    return changes


@pytest.mark.usefixtures("fast")
def test_entries_have_what_the_paper_states_and_the_files_are_there(results: Results) -> None:
    envelope = results(f"{LINE} --out here")
    assert envelope["format"] == "topo-verify/reproduce"
    stated = [entry for entry in envelope["results"] if entry["paper"] is not None]
    assert [(e["algorithm"], e["size"], e["paper"]) for e in stated] == [("basic", 10, 10000)]
    assert {(e["held"], e["of"]) for e in envelope["results"] if e["pick"]} == {(10, 10)}
    assert {path.name for path in Path("here").iterdir()} == {
        "figure-3.csv", "figure-3.svg", "figure-3.png", "growth.csv", "figures.md", "runs.db",
    }  # fmt: skip


@pytest.mark.usefixtures("fast")
def test_another_seed_draws_other_graphs(results: Results) -> None:
    one, other = (results(f"{LINE} --seed {seed}")["results"] for seed in (0, 1))
    assert one != other


@pytest.mark.long
@pytest.mark.usefixtures("fast")
def test_people_see_a_table_a_paragraph_exponents_and_what_was_judged(call: Call) -> None:
    text = call("reproduce --quick --figure 3,6a --graphs 2").stdout
    assert "Figure 6a: Enhancement I, lattices" in text
    assert "Not reproduced: at 10×10" in text
    assert "Growth: cost ~ m^exponent" in text
    assert "24 runs were judged: 10 of 10 claims held in each." in text


@pytest.mark.usefixtures("fast")
def test_policies_make_a_line_each(results: Results) -> None:
    entries = results(f"{LINE} --policies")["results"]
    pairs = {(e["pick"], e["order"]) for e in entries if e["algorithm"] == "basic"}
    assert len(pairs) == 10


def test_without_the_packages_of_the_extra_a_sentence_says_what_brings_them(
    call: Call, refused: Refused, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    refused(f"{LINE} --out bare", "matplotlib", f"{sys.executable} -m pip install", "[figures]")
    assert not Path("bare").exists()
    assert call("reproduce --help").exit_code == 0


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("--figure 4", "--figure '4': expected all, 6 or one of 3, 6a"),
        ("--out mappers.py", "--out mappers.py: cannot create this folder"),
        ("--graphs 0", "0 is not in the range"),
    ],
)
def test_bad_usage_is_one_sentence(refused: Refused, line: str, words: str) -> None:
    refused(f"reproduce {line}", words)


def test_a_claim_that_fails_in_a_run_is_a_finding(call: Call, fast: Changes) -> None:
    wrong = Finding("no-false-confirm", 3, None, None, "confirmed", replay="topo-verify replay x")
    fast.append(lambda row: replace(row, findings=(wrong,)))
    done = call(LINE)
    assert done.exit_code == 1
    assert "16 runs were judged: a claim fails in 1 of them." in done.stdout
    assert "again: topo-verify replay x" in done.stdout
    assert call(LINE).exit_code == 1  # from the store, too


def test_a_run_out_of_time_is_incomplete(call: Call, fast: Changes) -> None:
    fast.append(lambda row: replace(row, undecided="out of time"))
    done = call(LINE)
    assert done.exit_code == 3
    assert "15 runs were judged: 10 of 10 claims held in each. 1 more were not" in done.stdout


def test_a_foreign_store_is_one_sentence(refused: Refused) -> None:
    Path("figures").mkdir()
    Path("figures/runs.db").write_text("mine\n" * 100)
    refused(LINE, "figures/runs.db: it is no store of topo-verify")


@pytest.mark.nightly
@pytest.mark.usefixtures("cut_off")
def test_the_same_bytes_however_many_workers_and_however_often_interrupted(call: Call) -> None:
    require_same_bytes(call, LINE[:-2], 16, csv)
