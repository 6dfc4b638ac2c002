"""The catalogue: eight names, each a rule and a motion, and the door to the package."""

from __future__ import annotations

import runpy
from dataclasses import replace
from itertools import product
from pathlib import Path

import pytest
from hypothesis.vendor.pretty import pretty

import topo_verify
import topo_verify.algorithms
from tests.helpers import PAPER, trace_of
from topo_verify import CATALOGUE, Algorithm
from topo_verify.algorithms import NAMED, REFERENCE, Policies, algorithm
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.motion import overlap, retrace
from topo_verify.algorithms.rules import HistoryRule, NoRule, PrefixRule, RecordsRule
from topo_verify.robot.percept import Percept

ROOT = Path(__file__).parents[2]


def test_the_catalogue_lists_every_algorithm_of_the_paper_with_its_rule_and_motion() -> None:
    assert [(name, type(CATALOGUE[name].rule()), CATALOGUE[name].motion) for name in PAPER] == [
        ("basic", NoRule, retrace),
        ("enhancement-i", PrefixRule, overlap),
        ("enhancement-ii", HistoryRule, retrace),
        ("enhancement-ii+i", HistoryRule, overlap),
        ("enhancement-iii-one", RecordsRule, retrace),
        ("enhancement-iii-one+i", RecordsRule, overlap),
        ("enhancement-iii-all", RecordsRule, retrace),
        ("enhancement-iii-all+i", RecordsRule, overlap),
    ]
    assert all(name == entry.name for name, entry in CATALOGUE.items())


def test_an_algorithm_is_found_by_its_name() -> None:
    assert algorithm("enhancement-ii") is CATALOGUE["enhancement-ii"]


def test_an_unknown_name_is_refused_with_the_list_of_those_there_are() -> None:
    with pytest.raises(ValueError, match=r"no algorithm 'enhancement-iv': there are basic, enh"):
        algorithm("enhancement-iv")


def test_the_reference_policies_are_nearest_and_shortest() -> None:
    assert Policies("nearest", "shortest") == REFERENCE
    assert all(entry.policies == REFERENCE for entry in CATALOGUE.values())


@pytest.mark.parametrize("name", CATALOGUE)
def test_an_algorithm_prints_as_code_that_makes_it_again(name: str) -> None:
    mapper = CATALOGUE[name]
    for pick, order in product([None, "last", "random(7)"], [None, "oldest"]):
        chosen = mapper.with_policies(pick=pick, order=order)
        assert eval(repr(chosen), {"tv": topo_verify}) == chosen  # noqa: S307  as pasted
    assert repr(mapper) == f"tv.CATALOGUE[{name!r}]"
    assert pretty(mapper.with_policies(order="oldest")).endswith(".with_policies(order='oldest')")


def test_an_algorithm_that_is_not_of_the_catalogue_does_not_pass_for_one() -> None:
    assert repr(Algorithm("mine", NoRule, retrace)) == "<Algorithm 'mine'>"
    assert repr(replace(CATALOGUE["basic"], motion=overlap)) == "<Algorithm 'basic'>"


def test_other_policies_leave_the_catalogue_as_it_is() -> None:
    deep = CATALOGUE["basic"].with_policies(pick="last")
    assert deep.policies == Policies("last", "shortest")
    assert deep.with_policies(order="oldest").policies == Policies("last", "oldest")
    assert CATALOGUE["basic"].policies == REFERENCE


@pytest.mark.parametrize("name", NAMED)
def test_the_same_world_gives_the_same_run(name: str) -> None:
    assert trace_of("m7/20231", name) == trace_of("m7/20231", name)


def test_the_package_refuses_to_run_as_a_script() -> None:
    with pytest.raises(ImportError, match="its classes would exist twice"):
        runpy.run_path(str(topo_verify.algorithms.__file__))


def test_crossing_an_unexplored_dart_of_the_map_is_an_error_of_the_algorithm() -> None:
    with pytest.raises(AssertionError, match="dart 1 is unexplored"):
        Chart(Percept(2, 0)).across(1)
