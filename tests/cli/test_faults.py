"""`faults` on the command line: what it prints, and with which exit code it ends."""

from __future__ import annotations

from dataclasses import replace
from unittest.mock import Mock

import pytest

from tests.cli.conftest import Call, Results
from topo_verify.faults import FAULTS
from topo_verify.studies import faults as campaign
from topo_verify.studies.faults import STRATEGIES, Examples

NAME = "restores-with-the-wrong-sign"


def test_a_fault_that_is_caught(results: Results) -> None:
    (entry,) = results(f"faults {NAME} --workers 0")["results"]
    assert (entry["name"], entry["part"], entry["claim"]) == (NAME, "motion", "map-isomorphic")
    assert entry["search"].items() >= {"edges": 3, "failing": 2, "total": 74}.items()
    assert entry["properties"]["median_examples"] <= 100
    assert (entry["harmless"], entry["ok"]) == (False, True)


def test_only_what_is_asked_for_is_tried(results: Results) -> None:
    (entry,) = results(f"faults {NAME} --by properties")["results"]
    assert entry["search"] is None
    assert entry["properties"] is not None


def test_the_table_says_how_many_of_how_many(call: Call) -> None:
    done = call(f"faults {NAME} counts-no-ways-back --by search --workers 0")
    lines = done.stdout.splitlines()
    assert max(map(len, lines)) <= 80
    assert "motion:" in lines
    assert f"{NAME}   map-isomorphic         3: 2 of 74         -  ok" in lines
    text = " ".join(done.stdout.split())
    assert "2 of 2 faults caught, 0 of 0 harmless differences flagged" in text
    assert "judged without its world: 1 of the faults" in text


def test_markdown_has_the_part_in_the_table(call: Call) -> None:
    text = call(f"faults {NAME} --by search --workers 0 --format markdown").stdout
    assert f"| {NAME} | motion | map-isomorphic | 3: 2 of 74 | - | ok |" in text


def test_an_asterisk_marks_the_second_strategy(call: Call, monkeypatch: pytest.MonkeyPatch) -> None:

    drawn = Examples(9, STRATEGIES[1], {STRATEGIES[1]: (9,)}, 100)
    monkeypatch.setattr(campaign, "examples", Mock(return_value=drawn))
    done = call(f"faults {NAME} --by properties")
    assert " 9*  ok" in done.stdout


@pytest.mark.parametrize("claim", [None, "cost-honest"])
def test_a_fault_that_its_own_claim_does_not_catch_exits_1(
    call: Call, monkeypatch: pytest.MonkeyPatch, claim: str | None
) -> None:
    monkeypatch.setitem(FAULTS, NAME, replace(FAULTS[NAME], claim=claim))
    done = call(f"faults {NAME} --by search --workers 0")
    assert done.exit_code == 1
    assert f"{NAME}: back at a place" in done.stdout
    assert ("again: topo-verify replay m3/8" in done.stdout) is (claim is None)
