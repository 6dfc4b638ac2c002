"""What must be refuted, as theorems: obligations without a premise, and rules with one mistake.

A structure refutes an obligation without a premise that it needs. A scene refutes a faulty rule,
and the simulator replays it.
"""

from __future__ import annotations

from functools import partial
from typing import Literal

from tests.proofs.first_order import scenes
from tests.proofs.first_order.mutants import RuleMutant, growth, hypotheses
from topo_verify.errors import InternalError
from topo_verify.proofs.first_order.obligations import Obligation
from topo_verify.proofs.first_order.terms import shown
from topo_verify.proofs.first_order.theorems import OBLIGATIONS, mutant
from topo_verify.proofs.solvers import z3_solver
from topo_verify.proofs.theorem import Budget, Theorem, TheoremResult, one_query, timed


def _telling(obligation: Obligation) -> str:
    return next((n for n in obligation.needs if n in obligation.theory), obligation.needs[0])


def rule_mutant(faulty: RuleMutant, kind: Literal["mutant", "negative"] = "mutant") -> Theorem:
    """The claim that the faulty rule is right, which must be refuted."""
    edges, known = faulty.size
    script_of = partial(scenes.question, faulty.scene, edges=edges, known=known)
    return Theorem(
        name=faulty.name,
        kind=kind,
        claims=faulty.claims,
        words=faulty.words,
        symbols=shown(faulty.rule),
        solver_part="a world, a map and a history in which it fails; replayed in the simulator",
        expected="REFUTED",
        prove=timed(lambda budget: _refute(faulty, budget)),
        queries=one_query(faulty.name, script_of, "sat"),
        edges=edges,
        of=faulty.of if kind == "mutant" else None,
    )


def _refute(faulty: RuleMutant, budget: Budget) -> TheoremResult:
    edges, known = faulty.size
    scene, answer, why = scenes.find(faulty.scene, budget, edges=edges, known=known)
    if scene is None:
        note = f"{z3_solver.name()} answers {answer} with {edges} edges"
        note += f": {why}" if why else ""
        return z3_solver.z3_result(
            verdict="EXHAUSTED" if answer == "unsat" else "UNKNOWN", note=note
        )
    replay = scenes.SceneReplay(scene, without=faulty.without)
    if not faulty.plays(replay, faulty.rule):
        raise InternalError(
            f"the model of {faulty.name} does not replay: the doors {list(replay.history)} in world"
            f" {scene.world.id} show no failure"
        )
    return z3_solver.z3_result(
        verdict="REFUTED",
        replayed=(1, 1),
        counterexample=scene.world.id,
        history=replay.history,
    )


RULE_MUTANTS = (
    hypotheses.REJECTIONS
    + hypotheses.RECORDS
    + hypotheses.CONFIRMATIONS
    + growth.GROWTH
    + growth.FOLD_STEPS
)

AXIOM_MUTANTS: tuple[Theorem, ...] = tuple(
    mutant(obligation, _telling(obligation)) for obligation in OBLIGATIONS
)

FAULTY_RULES: tuple[Theorem, ...] = tuple(map(rule_mutant, RULE_MUTANTS))

PLANAR: Theorem = rule_mutant(growth.PLANAR, "negative")
"""The planar prior is not sound: a torus with two edges refutes it."""
