"""A strategy by its name and arguments, and worlds drawn from it outside of any test."""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

import pytest
from hypothesis import find

from topo_verify import InputError, World, strategies
from topo_verify.strategies import tree_worlds, worlds
from topo_verify.strategies.sample import WORLDS, resolve_strategy, sample


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


# ---------------------------------------------------------------- by its name


def test_every_exported_strategy_of_worlds_has_its_name() -> None:
    assert set(WORLDS) == {name for name in strategies.__all__ if name.endswith("worlds")} | {
        "lattices"
    }


@pytest.mark.parametrize(
    ("text", "simplest"),
    [
        ("nonplanar_worlds", "m2/8"),
        ("nonplanar_worlds(genus=2)", "m4/629"),
        ("worlds( min_edges = 3 , simple = True )", "m3/24"),
        pytest.param(
            "worlds(min_edges=1, marker='leaf', max_genus=None)", "m1/0", marks=pytest.mark.long
        ),
        pytest.param('worlds(min_edges=1, marker="hub")', "m1/0", marks=pytest.mark.long),
        ("uniform_worlds(edges=12)", "m12/0"),
    ],
)
def test_arguments_are_numbers_words_and_truth_values(text: str, simplest: str) -> None:
    assert find(resolve_strategy(text), lambda _: True).id == simplest


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("planar", "no such strategy: 'planar'; expected one of worlds, planar_worlds"),
        ("worlds(", "'(' was never closed; the strategy is worlds(min_edges="),
        ("worlds(min_edges=__import__('os'))", "expected a literal, got '__import__('os')'"),
        ("worlds(edges=3)", "unexpected keyword argument 'edges'; the strategy is"),
        ("worlds(max_edge=3)", "marker=any); did you mean 'max_edges'?"),
        ("worlds(3)", "too many positional arguments"),
        ("worlds(simple=yes)", "expected a literal, got 'yes'; the strategy is worlds("),
        ("worlds(simple='yes')", "worlds: simple='yes', expected True or False"),
        ("worlds(loopless=1)", "worlds: loopless=1, expected True or False"),
        ("uniform_worlds", "argument: 'edges'; the strategy is uniform_worlds(edges)"),
        ("worlds(marker='here')", "worlds: marker='here', expected one of"),
        ("worlds(max_degree='x')", "worlds: max_degree='x', expected an integer"),
    ],
)
def test_what_names_no_strategy_is_told_why(text: str, sentence: str) -> None:
    with pytest.raises(InputError) as refusal:
        resolve_strategy(text)
    assert sentence in str(refusal.value)


@pytest.mark.parametrize("name", WORLDS)
def test_a_drawn_world_equals_the_world_of_its_id(name: str) -> None:
    call = f"{name}(edges=9)" if name == "uniform_worlds" else name
    drawn = sample(resolve_strategy(call), 60)
    small = [world for world in drawn if len(world.edges) <= 200]
    assert small
    assert [world for world in small if world != World.from_id(world.id)] == []
    assert all(len(world.positions) in {0, len(world.vertices)} for world in drawn)
