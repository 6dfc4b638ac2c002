"""Worlds drawn outside of tests: as many as asked for, and the same ones for the same seed."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import pytest

from topo_verify.strategies import tree_worlds, worlds
from topo_verify.strategies.sample import sample


@pytest.mark.parametrize("number", [0, 1, 7, 150])
def test_as_many_are_drawn_as_are_asked_for(number: int) -> None:
    assert len(sample(worlds(max_edges=9), number)) == number


def test_where_there_are_fewer_they_come_again() -> None:
    assert {world.id for world in sample(tree_worlds(min_edges=0, max_edges=1), 9)} == {
        "m0/0",
        "m1/0",
    }


def test_the_same_seed_draws_the_same_worlds_and_another_others() -> None:
    first, again, other = (sample(worlds(), 20, start=seed) for seed in (3, 3, 4))
    assert first == again
    assert first != other


def test_no_module_that_is_loaded_changes_what_is_drawn(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = sample(worlds(), 100, start=5)
    strings = [bytes([byte]) * length for byte in range(9) for length in range(1, 30)]
    (tmp_path / "literals.py").write_text(f"BYTES = {strings}\nNUMBERS = {list(range(300))}\n")
    monkeypatch.setattr(sys, "path", [str(tmp_path), *sys.path])
    importlib.import_module("literals")
    assert sample(worlds(), 100, start=5) == before


def test_nearly_all_are_different() -> None:
    assert len({world.code for world in sample(worlds(min_edges=5), 100)}) >= 90
