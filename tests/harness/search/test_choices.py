"""Policies and choices: what a search goes through, and that it misses none."""

from __future__ import annotations

from itertools import product

import pytest

from topo_verify import CATALOGUE, World
from topo_verify.algorithms.policies import ORDERS, PICKS
from topo_verify.harness.search.choices import SEEDS, Script, examinations
from topo_verify.harness.search.exhaustive import search
from topo_verify.harness.search.plan import Choices, Plan
from topo_verify.programs.loader import Target
from topo_verify.robot.events import Pose
from topo_verify.world.enumeration import rank_order


def runs(name: str, world: str, policies: Choices) -> list[tuple[object, ...]]:
    """The traces in one world."""
    plan = Plan(targets=(name,), edges=1, choices=policies)
    target = Target(name, CATALOGUE[name])
    found = examinations(target, plan, World.from_id(world), lambda: None)
    return [run.trace[1:] for run, *_ in found]


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
def test_every_choice_includes_what_any_named_policy_chooses(name: str) -> None:
    for rank in range(rank_order.count(2)):
        every = runs(name, f"m2/{rank}", "every")
        assert len(every) == len(set(every))
        kept = {_without_the_rest(trace) for trace in every}
        assert {_without_the_rest(trace) for trace in runs(name, f"m2/{rank}", "all")} <= kept


def _without_the_rest(trace: tuple[object, ...]) -> tuple[object, ...]:
    """A trace in which the order of H shows in what was tried alone."""
    return tuple(
        Pose(event.edge, tuple(sorted(event.hypotheses))) if isinstance(event, Pose) else event
        for event in trace
    )


def test_the_number_of_ways_to_choose_is_counted_by_hand() -> None:
    # One vertex, two loops (m2/9): 4 ways to pick e; H are 3 darts, tried until one is confirmed,
    # so 1 + 2 + 2 orders, the true one first, second or last; then 2 ways to pick e.
    assert len(runs("basic", "m2/9", "every")) == 4 * (1 + 2 + 2) * 2
    # With `overlap` every order counts: 3! of them.
    assert len(runs("enhancement-i", "m2/9", "every")) == 4 * 6 * 2


def test_the_algorithm_is_right_whatever_it_chooses() -> None:
    found = search("basic", edges=2, policies="every")
    assert (found.verdict, found.checked) == ("EXHAUSTED", 12)
    assert found.tally.costs["basic"].runs == 3 + 147
    assert search("enhancement-ii+i", edges=2, policies="all").verdict == "EXHAUSTED"


def test_a_finding_names_the_choices_and_the_search_that_shows_it_again() -> None:
    found = search("folding+planar", edges=2, policies="every")
    first = found.counterexample
    assert first is not None
    assert first.world == "m2/8"
    assert first.message.endswith(")")
    assert " (choices: e = 0, H = [" in first.message
    assert first.replay == "topo-verify search folding+planar --edges 2 --policies every"
    named = search("folding+planar", edges=2, policies="all").counterexample
    assert named is not None
    assert named.replay == "topo-verify replay m2/8 --target folding+planar"


def test_a_script_goes_through_all_ways_and_ends() -> None:
    script = Script()
    seen: list[tuple[int, ...]] = []
    more = True
    while more:
        first = script.choose(2)
        seen.append((first, script.choose(3) if first else 0))
        more = script.advance()
    assert seen == [(0, 0), (1, 0), (1, 1), (1, 2)]
