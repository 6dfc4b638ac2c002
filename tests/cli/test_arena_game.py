"""`arena --game M`: the printed tables, the promised fields, the exit codes."""

from __future__ import annotations

import json
from functools import partial
from typing import Any
from unittest.mock import Mock

import pytest

from tests.cli.conftest import Call
from topo_verify.cli import arena_game
from topo_verify.cli.arena_game import play_game
from topo_verify.cli.output import Output
from topo_verify.errors import InputError, InternalError
from topo_verify.studies.game.values import MapperCosts, game_values


def played(
    capsys: pytest.CaptureFixture[str], style: str, edges: int, *mappers: str
) -> tuple[int, str]:
    code = play_game(Output(style, quiet=True), edges, mappers)
    return code, capsys.readouterr().out


def test_an_entry_a_value_and_one_a_mapper(capsys: pytest.CaptureFixture[str]) -> None:
    code, text = played(capsys, "json", 2, "folding", "folding+planar")
    envelope = json.loads(text)
    assert (code, envelope["format"], envelope["game"]) == (0, "topo-verify/arena", 2)
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
    assert next(entry for entry in entries if entry["of"] == "mapper") == {
        **game, "of": "mapper", "mapper": "folding", "worst": 3, "mean": 2.3, "value": value,
        "failing": None,
    }  # fmt: skip


def test_three_tables(capsys: pytest.CaptureFixture[str]) -> None:
    code, text = played(capsys, "markdown", 2, "basic", "folding+planar", "homing+planar")
    assert code == 0
    assert "| 2 | basic | any | 3 | 3 | 2.30 | 2.30 | 0.0 % |" in text
    assert "| 2 | folding+planar | planar | 3 | 3 | 2.33 | 2.33 | 0.0 % |" in text
    assert "| 2 | homing+planar | planar | 3 | 3 | 2.33 | 2.33 | 0.0 % |" in text
    assert "| 2 | 10 any | 3 | 3 | 2.20 | 2.30 | 4.5 % |" in text
    assert "| 2 | any | m and n | 1 | 0.60 | 73.9 % |" in text
    assert "≥" not in text


def test_a_search_that_is_cut_short_is_incomplete(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(arena_game, "game_values", partial(game_values, most_states=3))
    code, text = played(capsys, "markdown", 2, "basic")
    assert code == 3
    assert "| 2 | basic | any | 3 | ≥ 3 | 2.30 | ≥ 2.20 | ≤ 4.5 % |" in text
    assert "| 2 | 10 any | 3 | ≥ 3 | 2.20 | ≥ 2.20 | ≥ 0.0 % |" in text
    assert "≥: the search was cut short" in text


def test_a_mapper_that_breaks_a_claim_has_no_costs(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    costs = MapperCosts("mine", 1, "nothing", "any", 2, 0, 0, "m1/0")
    monkeypatch.setattr(arena_game, "mapper_costs", Mock(return_value=costs))
    code, text = played(capsys, "markdown", 1, "mine")
    assert code == 1
    assert "| 1 | mine | any | fails in m1/0 | 1 | - | 1.00 | - |" in text


def test_a_sound_mapper_below_the_value_contradicts_the_game(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    costs = MapperCosts("mine", 1, "nothing", "any", 2, 1, 1, None)
    monkeypatch.setattr(arena_game, "mapper_costs", Mock(return_value=costs))
    with pytest.raises(InternalError, match="mine costs less than the value"):
        played(capsys, "markdown", 1, "mine")


@pytest.mark.parametrize("edges", [0, 5])
def test_a_game_that_is_out_of_reach_is_refused(edges: int) -> None:
    with pytest.raises(InputError, match="expected 1 to 4 edges"):
        play_game(Output("json", quiet=True), edges)


def test_the_command_plays_the_game(call: Call) -> None:
    done = call("arena --game 2 folding,basic --format json --quiet")
    assert done.exit_code == 0
    mappers = [entry.get("mapper") for entry in json.loads(done.stdout)["results"]]
    assert [name for name in mappers if name] == ["folding", "basic"] * 2
