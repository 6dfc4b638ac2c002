"""Strategies by their names, as the command line takes them."""

from __future__ import annotations

import pytest
from hypothesis import find

from topo_verify import InputError, strategies
from topo_verify.strategies.resolve import WORLDS, resolve_strategy


def test_every_exported_strategy_of_worlds_has_its_name() -> None:
    assert set(WORLDS) == {name for name in strategies.__all__ if name.endswith("worlds")} | {
        "lattices"
    }


def test_a_name_alone_is_the_strategy_with_its_widest_arguments() -> None:
    assert find(resolve_strategy("nonplanar_worlds"), lambda _: True).id == "m2/8"


@pytest.mark.parametrize(
    ("text", "simplest"),
    [
        ("nonplanar_worlds(genus=2)", "m4/629"),
        ("worlds( min_edges = 3 , simple = True )", "m3/24"),
        ("worlds(min_edges=1, marker='leaf', max_genus=None)", "m1/0"),
        ('worlds(min_edges=1, marker="hub")', "m1/0"),
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
        (
            "worlds(edges=3)",
            "unexpected keyword argument 'edges'; the strategy is worlds(min_edges=",
        ),
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
