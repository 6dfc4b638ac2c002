"""The table of `research.every`: its costs are those of the search; a difference ends it."""

from __future__ import annotations

from unittest.mock import Mock

import pytest

pytest.importorskip("numba")

from research.every import table
from research.every.__main__ import costs_in
from topo_verify import CATALOGUE, World, explore
from topo_verify.campaign.row import PolicyCosts
from topo_verify.errors import InternalError
from topo_verify.studies.search.search import EveryCost, search
from topo_verify.world.enumeration import rank_order


def of_the_model(name: str, edges: int) -> PolicyCosts:
    """The sums in the model over all worlds with this many edges."""
    worlds = (f"m{edges}/{rank}" for rank in range(rank_order.count(edges)))
    return sum((costs_in(name, world) for world in worlds), PolicyCosts())


def of_the_search(name: str, edges: int) -> EveryCost:
    """The sums of the search in which the mapper makes each choice."""
    every = search(name, edges=edges, policies="every").by_edges[-1].every
    assert every is not None
    return every


@pytest.mark.parametrize(("name", "edges"), [("basic", 3), ("enhancement-ii+i", 2)])
def test_the_costs_are_those_of_the_mapper(name: str, edges: int) -> None:
    model, mapper = of_the_model(name, edges), of_the_search(name, edges)
    for field in ("worlds", "cheapest", "reference", "dearest", "most_saved"):
        assert getattr(model, field) == getattr(mapper, field)


LARGE = World.from_id("m5/402")


def test_a_larger_world_has_the_costs_of_the_kernel_and_of_the_reference_run() -> None:
    found = table.found_in(LARGE, CATALOGUE["basic"])
    costs = costs_in("basic", LARGE.id)
    assert (costs.states, costs.choices) == (found.states, found.choices)
    assert (costs.cheapest, costs.dearest) == (found.cheapest, found.dearest)
    assert costs.reference == explore(LARGE, "basic").cost


def test_a_cost_that_the_mapper_does_not_have_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    found = table.found_in(LARGE, CATALOGUE["basic"])
    wrong = found._replace(cheapest=found.cheapest - 1)
    monkeypatch.setattr(table, "found_in", Mock(return_value=wrong))
    with pytest.raises(InternalError, match="in the model"):
        costs_in("basic", LARGE.id)


def test_a_claim_that_the_model_finds_false_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    wrong = table.found_in(LARGE, CATALOGUE["basic"])._replace(wrong=1)
    monkeypatch.setattr(table, "found_in", Mock(return_value=wrong))
    with pytest.raises(InternalError, match="a claim false"):
        costs_in("basic", LARGE.id)
