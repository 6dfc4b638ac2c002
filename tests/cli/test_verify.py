"""`verify` on the command line: what it prints, and with which exit code it ends."""

from __future__ import annotations

import pytest

from tests.cli.conftest import Call, Results
from topo_verify import CATALOGUE

pytestmark = pytest.mark.usefixtures("proved_once")

PARTS = ["counts", "small-worlds", "proofs", "sampled-worlds", "generated-worlds", "street-network"]


@pytest.mark.nightly
def test_quick_checks_the_catalogue_in_six_parts(results: Results) -> None:
    envelope = results("verify --quick")
    assert (envelope["format"], envelope["seed"]) == ("topo-verify/verify", 0)
    parts = envelope["results"]
    assert [part["part"] for part in parts] == PARTS
    for part in parts:
        assert part.keys() >= {"part", "verdict", "ok", "checked", "total", "summary", "findings"}
        assert part["ok"]
        assert part["checked"] == part["total"]
    assert [part["verdict"] for part in parts] == ["EXHAUSTED"] * 2 + ["PROVED"] + ["SAMPLED"] * 3
    assert [part["total"] for part in parts] == [8954, 86, 63, 40, 40, 1]
    assert (
        parts[1]["summary"] == "86 of 86 worlds of 1 to 3 edges × 9 mappers: 10 of 10 claims hold"
    )
    assert [cost["algorithm"] for cost in parts[-1]["costs"]] == list(CATALOGUE)[:9]
    assert parts[-1]["costs"][0]["ratio"] == 1


@pytest.mark.long
def test_each_part_has_its_own_line(call: Call) -> None:
    lines = call("verify basic --quick --seed 3").stdout.splitlines()
    assert lines[0].endswith("basic, 10 claims, seed 3")
    starts = [line.split()[:2] for line in lines if line.split()[:1] and line.split()[0] in PARTS]
    assert starts == [
        *map(list, zip(PARTS, ["EXHAUSTED"] * 2 + ["PROVED"] + ["SAMPLED"] * 3, strict=True))
    ]


@pytest.mark.nightly
def test_what_does_not_concern_a_mapper_of_ones_own_is_left_out_and_said(
    results: Results, call: Call
) -> None:
    """The numbers of worlds and the theorems are the same, whoever the mapper is."""
    envelope = results("verify mappers.py:right --quick")
    assert envelope["left_out"] == ["counts", "proofs"]
    assert [part["part"] for part in envelope["results"]] == [
        part for part in PARTS if part not in envelope["left_out"]
    ]
    for style in ("pretty", "markdown"):
        text = " ".join(call(f"verify mappers.py:right --quick --format {style}").stdout.split())
        assert "Left out: counts and proofs, which do not depend on the mapper" in text
        assert "No claim failed in the worlds counted above; nothing else was checked." in text
    assert results("verify basic --quick")["left_out"] == []


@pytest.mark.long
@pytest.mark.parametrize(
    ("target", "style"),
    [("basic", "pretty"), ("mappers.py:silent", "json"), ("mappers.py:guesses", "markdown")],
)
def test_the_word_verified_is_never_printed(call: Call, target: str, style: str) -> None:
    done = call(f"verify {target} --quick --format {style}")
    assert "verified" not in done.output.lower()


@pytest.mark.long
def test_a_refuted_part_shows_its_smallest_counterexample(call: Call) -> None:
    text = call("verify mappers.py:guesses --quick").stdout
    assert "smallest counterexample here: m1/1:" in text
    assert "again: topo-verify replay m1/1 --target mappers.py:guesses\n" in text
    assert "A claim fails" in text
    _, _, walk = text.partition("The walk of mappers.py:guesses in m1/1:")
    assert "delivers a map of 2 vertices and 1 edge" in walk
    assert walk.endswith("  again: topo-verify replay m1/1 --target mappers.py:guesses\n")


@pytest.mark.nightly
def test_time_outs_leave_a_part_undecided(results: Results, call: Call) -> None:
    line = "verify mappers.py:loops --quick --world-timeout 0.02"
    parts = results(line, code=3)["results"]
    assert (parts[0]["verdict"], parts[0]["findings"]) == ("UNKNOWN", [])
    assert parts[0]["checked"] < parts[0]["total"]
    assert parts[0]["summary"].endswith("5 runs not decided; stopped after 5 time-outs")
    assert "No claim failed, but not everything was checked." in call(line).stdout
