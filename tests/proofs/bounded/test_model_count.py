"""The worlds of the encoding are the rooted maps, each exactly once."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from topo_verify.proofs.bounded import model_count
from topo_verify.proofs.bounded.encoding import Worlds
from topo_verify.proofs.bounded.model_count import codes, every_world, missing_and_spurious
from topo_verify.proofs.bounded.solve import SolverGaveUp
from topo_verify.proofs.bounded.theorems import worlds_theorem
from topo_verify.proofs.theorem import Budget
from topo_verify.world.enumeration import rank_order


@pytest.mark.parametrize(("edges", "worlds"), [(1, 2), (2, 10), (3, 74), (4, 706)])
def test_the_models_are_exactly_the_canonical_codes(edges: int, worlds: int) -> None:
    found = list(codes(edges))
    assert len(found) == worlds
    assert set(found) == set(rank_order.tables(edges))


def test_that_there_is_no_other_world_is_certified() -> None:
    pytest.importorskip("drup", reason="drup is not installed: topo-verify[proofs]")
    pytest.importorskip("pysat", reason="python-sat is not installed: topo-verify[proofs]")
    theorem = worlds_theorem("bounded-worlds", range(1, 4))
    outcome = theorem.prove(Budget(certify=True))
    assert outcome.certificate is not None
    assert outcome.certificate.checked
    assert theorem.ok(outcome)


@pytest.mark.slow
def test_with_five_edges_too() -> None:
    assert missing_and_spurious(5) == (8162, [], [])


@pytest.mark.parametrize(
    ("world_class", "worlds"), [("loopless", [1, 3, 14, 87]), ("simple", [1, 2, 6, 23])]
)
def test_a_class_is_the_class_of_the_enumeration(world_class: str, worlds: list[int]) -> None:
    for edges, total in enumerate(worlds, 1):
        assert missing_and_spurious(edges, world_class) == (total, [], [])


def _without(group: str) -> Callable[[int, str], Worlds]:
    def build(edges: int, world_class: str = "any") -> Worlds:
        world = every_world(edges, world_class)
        del world.groups[group]
        return world

    return build


def _one_world_less(edges: int, world_class: str = "any") -> Worlds:
    world = every_world(edges, world_class)
    world.add("fault", -world.edge(0, 1))
    return world


@pytest.mark.parametrize("group", ["numbering", "connected"])
def test_an_encoding_that_forgets_a_premise_has_spurious_models(
    group: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(model_count, "every_world", _without(group))
    found, missing, spurious = missing_and_spurious(3)
    assert (found > 74, missing, bool(spurious)) == (True, [], True)


def test_an_encoding_that_loses_a_world_is_refuted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(model_count, "every_world", _one_world_less)
    theorem = worlds_theorem("bounded-worlds", range(1, 4))
    outcome = theorem.prove(Budget())
    assert outcome.verdict == "REFUTED"
    assert not theorem.ok(outcome)
    assert outcome.checked != outcome.total


def test_a_solver_that_gives_up_has_not_listed_all() -> None:
    with pytest.raises(SolverGaveUp):
        list(codes(4, budget=Budget(rlimit=1)))
