"""Negatives and faulty rules: refuted by worlds, at their sizes and not below, and replayed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from itertools import islice

import pytest

from examples.undirected import undirected, unmarked
from tests.helpers import failing, some, worlds
from tests.proofs.bounded import mutants
from tests.proofs.bounded.rejections import replay_rejection
from tests.proofs.first_order.test_rule_mutants import require_refuted
from topo_verify.campaign.run import explore
from topo_verify.proofs.bounded import confirmations, statements
from topo_verify.proofs.bounded.cnf import first_model, models, solve
from topo_verify.proofs.bounded.encoding import RuleFault
from topo_verify.proofs.bounded.replay import (
    BoundedCounterexample,
    Disagreement,
    decode,
    decoded_booleans,
    replay_confirmation,
)
from topo_verify.proofs.bounded.statements import EncodedCounterexample
from topo_verify.proofs.theorem import Budget, Theorem
from topo_verify.world.enumeration.classes import WorldClass

BUDGET = Budget()


@pytest.mark.parametrize("one", [*mutants.NEGATIVES, *mutants.MUTANTS], ids=lambda one: one.name)
def test_it_is_refuted_by_a_world_that_replays(one: Theorem) -> None:
    require_refuted(one, BUDGET)


@pytest.mark.parametrize("case", confirmations.SMALLEST, ids=lambda case: case.name)
def test_below_its_size_there_is_no_such_world(case: confirmations.Negative) -> None:
    for edges in range(1, case.edges):
        encoded = confirmations.false_confirmation(edges, case.world_class, case.marker)
        assert solve(encoded.world, BUDGET).answer == "unsat"
        assert solve(confirmations.premises(edges, case.world_class), BUDGET).answer == "sat"


@pytest.mark.parametrize("world_class", ["any", "loopless", "simple"])
def test_with_the_direction_there_is_no_such_world_at_any_of_these_sizes(world_class: str) -> None:
    for edges in (1, 2, 3):
        encoded = confirmations.false_confirmation(edges, world_class, "directed")
        assert solve(encoded.world, BUDGET).answer == "unsat"


@pytest.mark.parametrize("case", confirmations.SMALLEST, ids=lambda case: case.name)
def test_the_sizes_are_those_at_which_a_mapper_confirms_what_is_false(
    case: confirmations.Negative,
) -> None:
    mapper = {"undirected": undirected, "none": unmarked}
    kind = WorldClass.parse(case.world_class)
    found = next(
        len(world.edges)
        for world in worlds(range(1, 5))
        if kind.admits(world.code)
        and "no-false-confirm" in failing(world, explore(world, mapper[case.marker]).trace)
    )
    assert found == case.edges


@pytest.mark.parametrize(
    "case", [case for case in confirmations.SMALLEST if case.edges < 4], ids=repr
)
def test_every_model_of_a_negative_replays(case: confirmations.Negative) -> None:
    encoded = confirmations.false_confirmation(case.edges, case.world_class, case.marker)
    replayed = [
        replay_confirmation(decode(encoded, model), case.marker)
        for model in islice(models(encoded.world, decoded_booleans(encoded), BUDGET), 40)
    ]
    assert replayed
    assert {replay.claim for replay in replayed} == {"no-false-confirm"}


FAULTS: list[tuple[str, Callable[[int, int], EncodedCounterexample], RuleFault]] = [
    ("trace", partial(statements.trace_way, fault="turned"), "turned"),
    ("prefix", partial(statements.prefix, fault="one-more"), "one-more"),
    ("history", partial(statements.history, fault="absolute-doors"), "absolute-doors"),
    ("history", partial(statements.history, fault="through-unexplored"), "through-unexplored"),
    ("records", partial(statements.records, levels=1, fault="first-dart"), "first-dart"),
    ("records", partial(statements.records, levels=None, fault="first-dart"), "first-dart"),
]


@pytest.mark.parametrize(("rule", "build", "fault"), FAULTS)
def test_many_models_of_a_faulty_rule_replay(
    rule: str, build: Callable[[int, int], EncodedCounterexample], fault: RuleFault
) -> None:
    encoded = build(3, 3)
    for model in islice(models(encoded.world, decoded_booleans(encoded), BUDGET), 20):
        replay = replay_rejection(decode(encoded, model), rule, fault)
        assert replay.claim == "true-hypothesis-kept"


def _story(case: confirmations.Negative) -> BoundedCounterexample:
    encoded = confirmations.false_confirmation(case.edges, case.world_class, case.marker)
    model = some(first_model(encoded.world, decoded_booleans(encoded), BUDGET).model)
    return decode(encoded, model)


def test_a_story_that_is_not_true_does_not_replay() -> None:
    counterexample = _story(confirmations.Negative("undirected", "loopless", 3))
    assert replay_confirmation(counterexample, "undirected").world.id == "m3/27"
    true = counterexample.world.alpha[counterexample.e]
    with pytest.raises(Disagreement, match="no-false-confirm does not fail"):
        replay_confirmation(replace(counterexample, h=true, word=()), "undirected")
    with pytest.raises(Disagreement):
        replay_confirmation(counterexample, "directed")


def test_a_rule_without_its_fault_rejects_nothing() -> None:
    encoded = statements.history(2, 2, fault="absolute-doors")
    model = some(first_model(encoded.world, decoded_booleans(encoded), BUDGET).model)
    with pytest.raises(Disagreement, match="rejects nothing"):
        replay_rejection(decode(encoded, model), "history", "")


@pytest.mark.long
def test_the_counterexample_is_the_same_in_every_run() -> None:
    (theorem,) = (one for one in mutants.NEGATIVES if one.name == "undirected-simple")
    first, again = theorem.prove(BUDGET), theorem.prove(Budget(seed=7))
    assert (first.counterexample, first.history) == (again.counterexample, again.history)


def test_where_nothing_is_found_the_negative_is_not_refuted() -> None:
    (theorem,) = (one for one in mutants.NEGATIVES if one.name == "undirected-simple")
    outcome = theorem.prove(Budget(rlimit=1000))
    assert outcome.verdict == "UNKNOWN"
    assert "--timeout" in outcome.note
    assert not theorem.ok(outcome)
