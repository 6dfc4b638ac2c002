"""Every seeded fault is found where docs/data/tables/faults.csv says, no harmless difference is.

The table is written by `python -m tests.faults.table`, with the functions that are compared here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import pytest

from tests.faults.every import EVERY, HARMLESS
from tests.faults.table import (
    EXAMPLES,
    SEEDS,
    by_examples,
    by_reference,
    by_search,
    stored,
)
from tests.versions import older
from topo_verify import World, examine
from topo_verify.faults import FAULTS

ROWS = stored()
FAULTY = [name for name in EVERY if name not in HARMLESS]


def edges(name: str) -> int:
    """The edges of the smallest worlds in which a fault is found, as the table has it."""
    return len(World.from_id(ROWS[name].world).edges)


def test_the_table_has_a_row_for_each_fault() -> None:
    assert list(ROWS) == list(EVERY)
    for name, row in ROWS.items():
        fault = EVERY[name]
        expected = (fault.part, fault.claim or "-", fault.theorem or "-")
        assert (row.part, row.claim, row.theorem) == expected


# ---------------------------------------------------------------- exhaustive search


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=pytest.mark.nightly if edges(name) > 4 else ()) for name in FAULTY],
)
def test_the_reference_engine_finds_a_fault_in_the_worlds_of_the_table(name: str) -> None:
    assert by_search(by_reference, EVERY[name]) == ROWS[name][3:5]


@pytest.mark.parametrize("name", [name for name in FAULTY if edges(name) > 4])
def test_a_fault_that_small_worlds_hide_is_caught_in_the_world_of_the_table(name: str) -> None:
    assert by_search(by_reference, EVERY[name], 3) == ("-", "none")
    assert examine(EVERY[name], ROWS[name].world).claims[ROWS[name].claim] == "failed"


@pytest.mark.parametrize(
    "largest",
    [3, pytest.param(4, marks=pytest.mark.long), pytest.param(5, marks=pytest.mark.nightly)],
)
@pytest.mark.parametrize("name", HARMLESS)
def test_no_claim_fails_of_a_harmless_difference(name: str, largest: int) -> None:
    assert by_search(by_reference, HARMLESS[name], largest) == ROWS[name][3:5] == ("-", "none")


def test_a_fault_that_its_own_claim_misses_and_a_harmless_difference_that_fails_are_seen() -> None:
    fault = FAULTS["restores-with-the-wrong-sign"]
    for claim in ("cost-honest", None):
        assert by_search(by_reference, replace(fault, claim=claim)) == ("-", "2 of 74")


# ---------------------------------------------------------------- property tests


@pytest.mark.parametrize("name", FAULTY)
def test_property_tests_find_a_fault_after_as_many_examples_as_the_table_says(name: str) -> None:
    if older("hypothesis", 6, 152, 9):
        pytest.skip("Hypothesis before 6.152.9 draws other worlds")
    assert by_examples(EVERY[name]) == ROWS[name].tests


@pytest.mark.parametrize(
    ("seeds", "most"), [([0], 20), pytest.param(SEEDS, EXAMPLES, marks=pytest.mark.nightly)]
)
@pytest.mark.parametrize("name", HARMLESS)
def test_property_tests_find_no_harmless_difference(
    name: str, seeds: Sequence[int], most: int
) -> None:
    assert by_examples(HARMLESS[name], seeds, most) == ROWS[name].tests == "none"
