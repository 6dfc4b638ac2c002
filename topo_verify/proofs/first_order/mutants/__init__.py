"""Rules with one mistake: each fails in some world, of which the smallest is found.

A mutant is refuted by a scene: an exact world, a reachable map S of it, an edge e with a hypothesis
h, and the moves behind e. The scene is then replayed in the simulator without a solver: the faulty
rule, evaluated on S and on the sensed percepts, must reject what is true or confirm what is false.
A scene that does not replay is a bug of ours, and raises.

What this does not show: that a mapper with the reference policies would make these moves. Claims
hold for every history, so any history that breaks one will do.

    rejection.py      a true hypothesis is rejected      records.py      records are misplaced
    confirmation.py   a false one is confirmed           fold_steps.py   what differs is identified
    growth.py         S grows in the wrong place

Source: docs/semantics.md, sections 4, 6, 7 and 8.
"""

from __future__ import annotations

from collections.abc import Iterator
from time import perf_counter
from typing import Literal

from topo_verify.errors import InternalError
from topo_verify.proofs.first_order import scenes
from topo_verify.proofs.first_order.mutants import (
    confirmation,
    fold_steps,
    growth,
    records,
    rejection,
)
from topo_verify.proofs.first_order.mutants.mutant import RuleMutant
from topo_verify.proofs.first_order.scene_replay import SceneReplay
from topo_verify.proofs.first_order.terms import shown
from topo_verify.proofs.solvers import z3_solver
from topo_verify.proofs.theorem import Budget, Query, Theorem, TheoremResult

RULE_MUTANTS: tuple[RuleMutant, ...] = (
    *rejection.REJECTIONS,
    *records.RECORDS,
    *confirmation.CONFIRMATIONS,
    *growth.GROWTH,
    *fold_steps.FOLD_STEPS,
)

__all__ = ["MUTANTS", "PLANAR", "RULE_MUTANTS", "RuleMutant", "theorem"]


def theorem(mutant: RuleMutant, kind: Literal["mutant", "negative"] = "mutant") -> Theorem:
    """The statement that the faulty rule is right, as a theorem that must be refuted."""
    edges, known = mutant.size

    def queries() -> Iterator[Query]:
        asked = scenes.question(mutant.scene, edges=edges, known=known)
        yield Query(mutant.name, asked, "sat")

    return Theorem(
        name=mutant.name,
        kind=kind,
        claims=mutant.claims,
        words=mutant.words,
        symbols=shown(mutant.rule),
        solver_part="a world, a map and a history in which it fails; replayed in the simulator",
        expected="REFUTED",
        prove=lambda budget: _refute(mutant, budget),
        queries=queries,
        edges=edges,
        of=mutant.of if kind == "mutant" else None,
    )


def _refute(mutant: RuleMutant, budget: Budget) -> TheoremResult:
    begin = perf_counter()
    edges, known = mutant.size
    scene, answer, why = scenes.find(mutant.scene, budget, edges=edges, known=known)
    if scene is None:
        note = f"{z3_solver.name()} answers {answer} with {edges} edges" + (
            f": {why}" if why else ""
        )
        return TheoremResult(
            verdict="EXHAUSTED" if answer == "unsat" else "UNKNOWN",
            solver=z3_solver.name(),
            seconds=perf_counter() - begin,
            note=note,
        )
    replay = SceneReplay(scene, without=mutant.without)
    if not mutant.plays(replay, mutant.rule):
        raise InternalError(
            f"the model of {mutant.name} does not replay: the doors {list(replay.history)} in world"
            f" {scene.world.id} show no failure"
        )
    return TheoremResult(
        verdict="REFUTED",
        solver=z3_solver.name(),
        seconds=perf_counter() - begin,
        replayed=(1, 1),
        counterexample=scene.world.id,
        history=replay.history,
    )


MUTANTS: tuple[Theorem, ...] = tuple(map(theorem, RULE_MUTANTS))

PLANAR: Theorem = theorem(fold_steps.PLANAR, "negative")
"""The planar prior is not sound in all worlds: a torus with two edges refutes it."""
