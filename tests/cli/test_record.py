"""`topo-verify record`: what it writes, what it says, and how it ends."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Call, Results
from topo_verify.studies.baseline import file


@pytest.mark.nightly
def test_the_default_corpus_is_recorded(results: Results, folder: Path) -> None:
    envelope = results("record basic --out b.jsonl.gz")
    assert (envelope["format"], envelope["seed"]) == ("topo-verify/record", 0)
    (entry,) = envelope["results"]
    assert (entry["worlds"], entry["equal"], entry["wrong"]) == (953, 953, 0)
    assert entry["corpus"] == "edges<=4 (792), generated:160 (160), nyc (1)"
    written = file.load(folder / "b.jsonl.gz")
    assert written.header.worlds == ("corpus",)
    assert written.header.digest == entry["digest"]
    assert sum(one.cost for one in written.entries) == entry["cost"]


@pytest.mark.long
def test_workers_and_a_store_change_nothing_in_the_file(
    call: Call, results: Results, folder: Path
) -> None:
    line = "record mappers.py:guesses --worlds 'edges<=2' --out"
    alone = results(f"{line} one", code=1)["results"][0]
    for out, workers, stored in (("two", 2, 0), ("three", 0, 12), ("four", 1, 12)):
        envelope = results(f"{line} {out} --workers {workers} --store runs.db", code=1)
        assert envelope["timing"]["from_store"] == stored
        assert {**envelope["results"][0], "file": "one"} == alone
        assert (folder / out).read_bytes() == (folder / "one").read_bytes()
    done = call(f"{line} five --store runs.db")
    assert "12 of 12 runs are in runs.db" in done.stderr


def test_a_store_is_resumed_in_more_worlds_and_by_compare(results: Results) -> None:
    stored = [
        results(line)["timing"]["from_store"]
        for line in (
            "record basic --worlds 'edges<=1' --out b --store runs.db",
            "record basic --worlds nyc --worlds 'edges<=2' --out b --store runs.db",
            "compare b basic --store runs.db",
        )
    ]
    assert stored == [0, 2, 13]


def test_limits_worlds_seed_and_policies_are_in_the_file(call: Call, folder: Path) -> None:
    call(
        "record basic --pick last --worlds generated:8 --worlds nyc --seed 5 --budget 9999"
        " --move-timeout 2 --out b"
    )
    header = file.load(folder / "b").header
    assert (header.worlds, header.seed, header.total) == (("generated:8", "nyc"), 5, 9)
    assert header.policies is not None
    assert (header.policies.pick, header.policies.order) == ("last", "shortest")
    assert (header.limits.budget, header.limits.move_timeout) == (9999, 2)


def test_a_mapper_that_fails_is_recorded_and_exits_1(results: Results, call: Call) -> None:
    line = "record mappers.py:guesses --worlds 'edges<=2' --out b"
    (entry,) = results(line, code=1)["results"]
    assert (entry["equal"], entry["wrong"], entry["file"]) == (1, 11, "b")
    assert entry["findings"][0]["world"] == "m1/1"
    assert call(entry["findings"][0]["replay"].removeprefix("topo-verify ")).exit_code == 1
    text = call(line).stdout
    assert "again: topo-verify replay m1/1 --target mappers.py:guesses" in text
    assert "written: b" in text


@pytest.mark.nightly
def test_a_mapper_that_hangs_has_no_baseline(call: Call, results: Results, folder: Path) -> None:
    line = "record mappers.py:loops --worlds 'edges<=2' --move-timeout 0.06 --out b"
    (entry,) = results(line, code=1)["results"]
    assert (entry["wrong"], entry["undecided"], entry["file"]) == (3, 9, None)
    assert not (folder / "b").exists()
    assert "No baseline was written" in call(line).stdout
