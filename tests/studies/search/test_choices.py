"""Policies and choices: what a search goes through, and that it misses none."""

from __future__ import annotations

from itertools import product

import pytest

from tests.helpers import some
from topo_verify import CATALOGUE, World
from topo_verify.algorithms.policies import ORDERS, PICKS
from topo_verify.campaign.attempt import Attempt, attempt
from topo_verify.campaign.row import MostSaved
from topo_verify.campaign.run import Exploration
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.studies.search.choices import SEEDS, by_name, every
from topo_verify.studies.search.search import search
from topo_verify.world.enumeration import rank_order


def runs(name: str, world: str, policies: str) -> list[Exploration]:
    """The runs in one world."""

    def once(target: Target) -> Attempt:
        return attempt(World.from_id(world), target, Limits(), where=world, witness=False)

    ways = {"all": by_name, "every": every}[policies]
    made = ways(Target(name, CATALOGUE[name]), World.from_id(world), once)
    return [one.run for one in made]


def test_all_policies_are_every_pick_with_every_order() -> None:
    names = [f"random({seed})" for seed in range(SEEDS)]
    policies = [run.policies for run in runs("basic", "m3/14", "all")]
    pairs = [(p.pick, p.order) for p in policies if p is not None]
    assert pairs == [*product([*PICKS, *names], [*ORDERS, *names])]


@pytest.mark.parametrize(
    "name", ["basic", pytest.param("enhancement-ii+i", marks=pytest.mark.long)]
)
def test_every_choice_goes_through_all_policies_too_and_costs_no_less_than_they_do(
    name: str,
) -> None:
    for rank in range(rank_order.count(2)):
        named, of_all = (runs(name, f"m2/{rank}", policies) for policies in ("all", "every"))
        by_choice, by_policy = of_all[: -len(named)], of_all[-len(named) :]
        assert [run.policies for run in by_policy] == [run.policies for run in named]
        assert {run.cost for run in named} <= {run.cost for run in by_choice}


def test_the_algorithm_is_right_whatever_it_chooses() -> None:
    found = search("basic", edges=2, policies="every")
    assert (found.verdict, found.checked) == ("EXHAUSTED", 12)
    sizes = [size.every for size in found.by_edges if size.every is not None]
    sums = [(c.worlds, c.states, c.choices, c.cheapest, c.reference, c.dearest) for c in sizes]
    assert [*map(sum, zip(*sums, strict=True))] == [12, 69, 159, 24, 25, 29]
    assert sizes[1].most_saved == MostSaved("m2/6", 3, 2)
    assert search("enhancement-ii+i", edges=2, policies="all").verdict == "EXHAUSTED"


@pytest.mark.long
def test_a_finding_names_the_fewest_choices_and_the_run_that_shows_it_again() -> None:
    found = search("folding+planar", edges=2, policies="every")
    first = some(found.counterexample)
    assert first.world == "m2/8"
    assert first.message.endswith(" (choices: 0)")
    assert first.replay == "topo-verify explore m2/8 --target folding+planar --choices 0"
    named = some(search("folding+planar", edges=2, policies="all").counterexample)
    assert named.replay == "topo-verify replay m2/8 --target folding+planar"
