"""The tables of `python -m research.game`, and a mapper that would contradict a value."""

from __future__ import annotations

from unittest.mock import Mock

import pytest

from research.game import __main__ as tables
from research.game import values as game
from topo_verify.campaign import campaign
from topo_verify.errors import InternalError


def value(edges: int, *, most_states: int = 1000) -> game.GameValue:
    return game.game_value(edges, "nothing", most_states=most_states)


def test_the_three_tables_of_two_edges() -> None:
    values = list(game.game_values(2))
    costs = [game.mapper_costs(name, 2, values) for name in ("basic", "folding+planar")]
    assert tables.mapper_table(costs)[1:] == (
        ("2", "basic", "any", "3", "3", "2.30", "2.30", "0.0 %"),
        ("2", "folding+planar", "planar", "3", "3", "2.33", "2.33", "0.0 %"),
    )
    assert tables.price_table(values)[1] == ("2", "10 any", "3", "3", "2.20", "2.30", "4.5 %")
    assert ("2", "any", "m and n", "1", "0.60", "73.9 %") in tables.knowledge_table(values)


def test_a_search_that_is_cut_short_is_marked_as_a_bound() -> None:
    cut = [value(2, most_states=3)]
    assert tables.price_table(cut)[1] == ("2", "10 any", "3", "≥ 3", "2.20", "≥ 2.20", "≥ 0.0 %")
    (row,) = tables.mapper_table([game.mapper_costs("basic", 2, cut)])[1:]
    assert row[3:] == ("3", "≥ 3", "2.30", "≥ 2.20", "≤ 4.5 %")


def rows(monkeypatch: pytest.MonkeyPatch, **fields: object) -> None:
    """Let the mapper's campaign return one such row."""
    result = Mock(rows=[Mock(**fields)])
    monkeypatch.setattr(campaign, "results", Mock(return_value=[(None, result)]))


def test_a_mapper_that_breaks_a_claim_has_no_costs(monkeypatch: pytest.MonkeyPatch) -> None:
    rows(monkeypatch, failed=("map-isomorphic",), world="m1/0", cost=1)
    (row,) = tables.mapper_table([game.mapper_costs("basic", 1, [value(1)])])[1:]
    assert row == ("1", "basic", "any", "fails in m1/0", "1", "-", "1.00", "-")


def test_a_sound_mapper_below_the_value_contradicts_the_game(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rows(monkeypatch, failed=(), cost=0)
    with pytest.raises(InternalError, match="basic costs less than the value of the game"):
        game.mapper_costs("basic", 1, [value(1)])
