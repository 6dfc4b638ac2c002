"""The registry of faults: each can be named, says what it is, and leaves the reference alone."""

from __future__ import annotations

from typing import get_args

import pytest

from tests.faults.every import EVERY, HARMLESS
from tests.proofs.false_statements import FALSE_STATEMENTS
from topo_verify import explore
from topo_verify.algorithms import CATALOGUE, exploration
from topo_verify.campaign.targets import one_target
from topo_verify.checkers import CLAIMS
from topo_verify.faults import FAULTS
from topo_verify.faults.fault import PartName, mapper, rebound
from topo_verify.world.rooted_map import World


def test_there_are_faults_in_every_part_of_a_mapper() -> None:
    assert {fault.part for fault in EVERY.values()} == set(get_args(PartName))
    assert {fault.part for fault in FAULTS.values()} == set(get_args(PartName)) - {"report"}
    assert len(FAULTS) >= 50
    assert len(HARMLESS) >= 10


@pytest.mark.parametrize("name", EVERY)
def test_a_fault_is_found_again_by_its_target(name: str) -> None:
    fault = EVERY[name]
    assert fault.name == name
    assert one_target(fault.target).mapper is fault
    assert fault.claim is None or fault.claim in CLAIMS
    assert fault.why[0].islower() or fault.why.startswith(("H ", "T["))


def test_the_faults_of_the_package_must_be_caught() -> None:
    assert not FAULTS.keys() & HARMLESS.keys()
    assert {fault.target.partition(":")[0] for fault in FAULTS.values()} == {
        f"topo_verify.faults.{fault.part}" for fault in FAULTS.values()
    }


@pytest.mark.parametrize("name", ["basic", "enhancement-i", "enhancement-iii-all", "folding"])
def test_with_nothing_planted_the_reference_comes_out(name: str) -> None:
    world = World.from_id("m5/4711")
    planted = explore(world, mapper(name))
    assert planted.trace[1:] == explore(world, name).trace[1:]


def test_planting_leaves_the_reference_as_it_is() -> None:
    before = dict(vars(exploration))
    space = rebound(Chart=int)
    assert space["Chart"] is int
    assert space["explore"].__globals__ is space
    assert vars(exploration) == before
    assert CATALOGUE["basic"].rule.__module__ == "topo_verify.algorithms.rules"


def test_a_name_that_the_loop_does_not_know_cannot_be_replaced() -> None:
    with pytest.raises(AssertionError, match="Compass"):
        rebound(Compass=int)


def test_the_theorem_with_the_same_mistake_is_one_that_must_be_refuted() -> None:
    named = {fault.theorem for fault in FAULTS.values()} - {None}
    assert named
    assert {theorem.name for theorem in FALSE_STATEMENTS} >= named
