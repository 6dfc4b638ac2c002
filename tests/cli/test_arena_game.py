"""`arena --game M`: the printed tables, the promised fields, the exit codes."""

from __future__ import annotations

from functools import partial
from typing import Any
from unittest.mock import Mock

import pytest

from tests.cli.conftest import Call, Refused, Results
from topo_verify.campaign import campaign
from topo_verify.studies.game import values
from topo_verify.studies.game.values import game_values


def test_an_entry_a_value_and_one_a_mapper(results: Results) -> None:
    envelope = results("arena --game 2 folding,folding+planar --quiet")
    assert (envelope["format"], envelope["game"]) == ("topo-verify/arena", 2)
    entries: list[dict[str, Any]] = [entry for entry in envelope["results"] if entry["game"] == 2]
    assert [entry["knows"] for entry in entries if entry["of"] == "value"] == [
        "nothing", "n", "m", "m and n", "nothing", "planar", "m", "m and planar",
    ]  # fmt: skip
    game = {"game": 2, "knows": "nothing", "drawn": "any", "worlds": 10}
    value = {"worst": 3, "mean": 2.3, "worst_is_value": True, "mean_is_value": True}
    least = value | {"mean": 2.2}
    assert entries[0] | {"states": 0} == {
        **game, "of": "value", "value": value, "least": least, "states": 0,
    }  # fmt: skip
    mappers = [entry for entry in entries if entry["of"] == "mapper"]
    assert [entry["mapper"] for entry in mappers] == ["folding", "folding+planar"]
    assert mappers[0] == {
        **game, "of": "mapper", "mapper": "folding", "worst": 3, "mean": 2.3, "value": value,
        "failing": None,
    }  # fmt: skip


def played(call: Call, edges: int, mappers: str, code: int = 0) -> str:
    """The tables, as Markdown."""
    done = call(f"arena --game {edges} {mappers} --format markdown")
    assert done.exit_code == code
    return done.stdout


def test_three_tables(call: Call) -> None:
    text = played(call, 2, "basic,folding+planar,homing+planar")
    assert "| 2 | basic | any | 3 | 3 | 2.30 | 2.30 | 0.0 % |" in text
    assert "| 2 | folding+planar | planar | 3 | 3 | 2.33 | 2.33 | 0.0 % |" in text
    assert "| 2 | homing+planar | planar | 3 | 3 | 2.33 | 2.33 | 0.0 % |" in text
    assert "| 2 | 10 any | 3 | 3 | 2.20 | 2.30 | 4.5 % |" in text
    assert "| 2 | any | m and n | 1 | 0.60 | 73.9 % |" in text
    assert "≥" not in text


def test_a_search_that_is_cut_short_is_incomplete(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(values, "game_values", partial(game_values, most_states=3))
    text = played(call, 2, "basic", code=3)
    assert "| 2 | basic | any | 3 | ≥ 3 | 2.30 | ≥ 2.20 | ≤ 4.5 % |" in text
    assert "| 2 | 10 any | 3 | ≥ 3 | 2.20 | ≥ 2.20 | ≥ 0.0 % |" in text
    assert "≥: the search was cut short" in text


def rows(monkeypatch: pytest.MonkeyPatch, **fields: object) -> None:
    """Let the mapper's campaign return one such row."""
    result = Mock(rows=[Mock(**fields)])
    monkeypatch.setattr(campaign, "results", Mock(return_value=[(None, result)]))


def test_a_mapper_that_breaks_a_claim_has_no_costs(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows(monkeypatch, failed=("map-isomorphic",), world="m1/0", cost=1)
    text = played(call, 1, "basic", code=1)
    assert "| 1 | basic | any | fails in m1/0 | 1 | - | 1.00 | - |" in text


def test_a_sound_mapper_below_the_value_contradicts_the_game(
    call: Call, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows(monkeypatch, failed=(), cost=0)
    done = call("arena --game 1 basic")
    assert done.exit_code == 70
    assert "basic costs less than the value of the game with 1 edges" in done.stderr


@pytest.mark.parametrize("edges", [0, 5])
def test_a_game_that_is_out_of_reach_is_refused(edges: int, refused: Refused) -> None:
    refused(f"arena --game {edges}", "expected 1 to 4 edges")
