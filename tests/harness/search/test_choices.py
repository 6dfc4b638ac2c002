"""Policies and choices: what a search goes through, and that it misses none."""

from __future__ import annotations

from itertools import product

import pytest

from topo_verify import CATALOGUE, World
from topo_verify.algorithms.policies import ORDERS, PICKS
from topo_verify.harness.run import Exploration
from topo_verify.harness.search.choices import SEEDS, examinations
from topo_verify.harness.search.exhaustive import search
from topo_verify.harness.search.plan import Choices, Plan
from topo_verify.harness.tally import CostPair
from topo_verify.programs.loader import Target
from topo_verify.world.enumeration import rank_order


def runs(name: str, world: str, policies: Choices) -> list[Exploration]:
    """The runs in one world."""
    plan = Plan(targets=(name,), edges=1, choices=policies)
    target = Target(name, CATALOGUE[name])
    found = examinations(target, plan, World.from_id(world), lambda: None)
    return [run for run, *_ in found]


def test_all_policies_are_every_pick_with_every_order() -> None:
    plan = Plan(targets=("basic",), edges=1, choices="all")
    found = examinations(
        Target("basic", CATALOGUE["basic"]), plan, World.from_id("m3/14"), lambda: None
    )
    names = [f"random({seed})" for seed in range(SEEDS)]
    policies = [run.policies for run, *_ in found]
    pairs = [(p.pick, p.order) for p in policies if p is not None]
    assert pairs == [*product([*PICKS, *names], [*ORDERS, *names])]


@pytest.mark.parametrize("name", ["basic", "enhancement-ii+i"])
def test_every_choice_includes_what_any_named_policy_costs(name: str) -> None:
    for rank in range(rank_order.count(2)):
        named = [run.cost for run in runs(name, f"m2/{rank}", "all")]
        every = [run.cost for run in runs(name, f"m2/{rank}", "every")]
        assert set(named) <= set(every)


def test_the_algorithm_is_right_whatever_it_chooses() -> None:
    found = search("basic", edges=2, policies="every")
    assert (found.verdict, found.checked) == ("EXHAUSTED", 12)
    costs = found.tally.policy_costs["basic"]
    assert (costs.worlds, costs.states, costs.choices) == (12, 63, 147)
    assert (costs.cheapest, costs.reference, costs.dearest) == (24, 25, 29)
    assert costs.most_saved == CostPair("m2/6", 3, 2)
    assert search("enhancement-ii+i", edges=2, policies="all").verdict == "EXHAUSTED"


def test_a_finding_names_the_fewest_choices_and_the_run_that_shows_it_again() -> None:
    found = search("folding+planar", edges=2, policies="every")
    first = found.counterexample
    assert first is not None
    assert first.world == "m2/8"
    assert first.message.endswith(" (choices: 0)")
    assert first.replay == "topo-verify explore m2/8 --algorithm folding+planar --choices 0"
    named = search("folding+planar", edges=2, policies="all").counterexample
    assert named is not None
    assert named.replay == "topo-verify replay m2/8 --target folding+planar"
