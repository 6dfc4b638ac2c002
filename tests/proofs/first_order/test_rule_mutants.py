"""Mutated rules: each is refuted by a world, and what is refuted comes true in the simulator."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.marks import with_marks
from tests.proofs.first_order import refuted, scenes
from tests.proofs.first_order.mutants import RuleMutant
from tests.proofs.first_order.mutants.growth import PLANAR as PLANAR_SCENE
from tests.proofs.first_order.scenes import SceneReplay
from topo_verify import World
from topo_verify.errors import InternalError
from topo_verify.proofs.first_order.terms import Term
from topo_verify.proofs.first_order.theorems import INDUCTIVE
from topo_verify.proofs.theorem import Budget, Theorem
from topo_verify.robot.simulator import SimulatedRobot

BUDGET = Budget(timeout=60)
EVERY = (*refuted.RULE_MUTANTS, PLANAR_SCENE)


def require_refuted(one: Theorem, budget: Budget) -> None:
    """Require that a world of its size refutes the theorem, and replays."""
    outcome = one.prove(budget)
    assert (outcome.verdict, outcome.replayed) == ("REFUTED", (1, 1)), outcome.note
    assert one.ok(outcome)
    world = World.from_id(outcome.counterexample or "")
    assert len(world.edges) == one.edges
    robot = SimulatedRobot(world, 1000)
    for door in outcome.history or ():
        robot.move(door)  # raises if there is no such door


@pytest.mark.parametrize(
    "one",
    with_marks([*refuted.FAULTY_RULES, refuted.PLANAR], long=["records-stale-root"]),
    ids=lambda one: one.name,
)
def test_it_is_refuted_in_a_world_and_replayed(one: Theorem) -> None:
    require_refuted(one, BUDGET)


def test_the_planar_prior_is_wrong_on_the_torus_of_two_edges() -> None:
    outcome = refuted.PLANAR.prove(BUDGET)
    assert refuted.PLANAR.kind == "negative"
    assert World.from_id(outcome.counterexample or "").genus == 1


def test_mutants_change_rules_that_are_proved() -> None:
    proved = {one.name for one in INDUCTIVE}
    assert {mutant.of for mutant in refuted.RULE_MUTANTS} <= proved
    assert len({mutant.name for mutant in EVERY}) == len(EVERY)


@pytest.mark.nightly
@pytest.mark.parametrize("mutant", EVERY, ids=lambda one: one.name)
def test_no_smaller_scene_shows_it(mutant: RuleMutant) -> None:
    for edges in range(1, mutant.size[0] + 1):
        for known in range(1, 2 * edges + 1):
            if (edges, known) >= mutant.size:
                return
            _, answer, why = scenes.find(mutant.scene, BUDGET, edges=edges, known=known)
            assert answer == "unsat", (edges, known, why)


def never(_stage: SceneReplay, _rule: Term) -> bool:
    return False


def test_what_does_not_replay_is_reported_as_our_bug() -> None:
    harmless = replace(refuted.RULE_MUTANTS[0], plays=never)
    with pytest.raises(InternalError, match=r"does not replay: the doors .* in world m2/"):
        refuted.rule_mutant(harmless).prove(BUDGET)


def test_a_mutant_without_a_scene_is_not_refuted() -> None:
    one = refuted.rule_mutant(replace(refuted.RULE_MUTANTS[0], size=(1, 1)))
    outcome = one.prove(BUDGET)
    assert outcome.verdict == "EXHAUSTED"
    assert one.status(outcome) == "failed"


@pytest.mark.long
def test_a_stage_draws_the_map_of_the_scene() -> None:
    mutant = next(one for one in refuted.RULE_MUTANTS if one.name == "records-stale-root")
    edges, known = mutant.size
    scene, answer, _ = scenes.find(mutant.scene, BUDGET, edges=edges, known=known)
    assert (answer, scene is not None) == ("sat", True)
    assert scene is not None
    whole, part = SceneReplay(scene), SceneReplay(scene, without=mutant.without)
    assert len(whole.chart.alpha) == len(part.chart.alpha) == known
    explored = [sum(a is not None for a in replay.chart.alpha) for replay in (whole, part)]
    assert explored[0] == len(scene.explored) == explored[1] + 2
