"""The registry of faults: each can be named, says what it is, and leaves the reference alone."""

from __future__ import annotations

import pytest

from tests.proofs.false_statements import FALSE_STATEMENTS
from topo_verify import explore
from topo_verify.algorithms import CATALOGUE, exploration
from topo_verify.campaign.targets import one_target
from topo_verify.checkers import CLAIMS
from topo_verify.faults import FAULTS
from topo_verify.faults.fault import mapper, rebound
from topo_verify.world.rooted_map import World


def test_there_are_faults_in_every_part_and_harmless_differences() -> None:
    parts = {fault.part for fault in FAULTS.values() if not fault.harmless}
    assert parts == {
        "hypotheses", "motion", "marker", "chart", "prefix", "history", "records", "folding",
        "declarations", "report",
    }  # fmt: skip
    assert sum(not fault.harmless for fault in FAULTS.values()) >= 30
    assert sum(fault.harmless for fault in FAULTS.values()) >= 6


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_found_again_by_its_target(name: str) -> None:
    fault = FAULTS[name]
    assert fault.name == name
    assert one_target(fault.target).mapper is fault
    assert fault.claim is None or fault.claim in CLAIMS
    assert fault.why[0].islower() or fault.why.startswith(("H ", "T["))


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
    assert CATALOGUE["basic"].rule.__module__ == "topo_verify.algorithms.basic"


def test_a_name_that_the_loop_does_not_know_cannot_be_replaced() -> None:
    with pytest.raises(AssertionError, match="Compass"):
        rebound(Compass=int)


def test_the_theorem_with_the_same_mistake_is_one_that_must_be_refuted() -> None:
    named = {fault.theorem for fault in FAULTS.values()} - {None}
    assert named
    assert {theorem.name for theorem in FALSE_STATEMENTS} >= named
