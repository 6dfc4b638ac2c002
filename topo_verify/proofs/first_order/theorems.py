"""The obligations as theorems, and mutants of them, which lack one premise.

**Theorem**: premises and negated goal have no model, but a tiny structure (`finite_models.py`)
satisfies the premises. **Mutant**: without one needed premise a structure, evaluated without a
solver, refutes the goal. One mutant is a control in the catalogue; tests refute one of each
theorem, and rules with a mistake.
"""

from __future__ import annotations

from topo_verify.proofs.first_order import finite_models
from topo_verify.proofs.first_order.obligations import Obligation, growth, hypotheses
from topo_verify.proofs.first_order.terms import Term, conj, implies, neg, script, shown
from topo_verify.proofs.first_order.theory import INVARIANT, LEMMAS
from topo_verify.proofs.solvers import z3_solver
from topo_verify.proofs.theorem import Budget, Theorem, TheoremResult, one_query, timed


def theorem(obligation: Obligation) -> Theorem:
    given = tuple(obligation.given.values())
    statement = implies(conj(*given), obligation.goal) if given else obligation.goal
    return Theorem(
        name=obligation.name,
        kind="inductive",
        claims=obligation.claims,
        words=obligation.words,
        symbols=shown(statement),
        solver_part=_solver_part(obligation),
        argued=obligation.argued,
        assumed=tuple(n for n in obligation.theory if n not in {*LEMMAS, *INVARIANT}),
        expected="PROVED",
        prove=timed(lambda budget: _prove(obligation, budget)),
        queries=one_query(obligation.name, lambda: script(obligation.negation()), "unsat"),
    )


def _solver_part(obligation: Obligation) -> str:
    lemmas = dict.fromkeys(LEMMAS[name] for name in obligation.theory if name in LEMMAS)
    words = "for all worlds and maps of the theory, of any size"
    if set(obligation.theory) & set(INVARIANT):
        words += ", if S is a part of the world (the invariant, which augmentations keep)"
    return words + (f", given {', '.join(lemmas)}" if lemmas else "")


def _prove(obligation: Obligation, budget: Budget) -> TheoremResult:
    reply = refute(obligation.negation(), budget)
    # Only `unsat` is a proof; `sat` is not evaluated, and refutes nothing.
    if reply.answer != "unsat":
        why = reply.why or "no reason given"
        return z3_solver.z3_result(
            verdict="UNKNOWN", note=f"{z3_solver.name()} answers {reply.answer}: {why}"
        )
    premises = finite_models.smallest(obligation.premises(), budget).answer
    satisfiable = {"sat": True, "unsat": False, "unknown": None}[premises]
    return z3_solver.z3_result(
        verdict="PROVED",
        premises_satisfiable=satisfiable,
        core=tuple(name for name in reply.core if name != "goal-fails"),
    )


def refute(assertions: dict[str, Term], budget: Budget) -> z3_solver.Z3Reply:
    """Can all of these hold? The core has their names."""
    return z3_solver.refute(script(assertions), assertions, budget)


def mutant(obligation: Obligation, lost: str) -> Theorem:
    """The obligation without one premise, which must be refuted."""
    dropped = obligation.premises()[lost]
    formulas = obligation.premises(without=lost)
    # Its negation loses no structure: where the premise holds, so does the goal.
    formulas |= {"premise-fails": neg(dropped), "goal-fails": neg(obligation.goal)}

    def prove(budget: Budget) -> TheoremResult:
        model = finite_models.smallest(formulas, budget)
        if model.structure is None:
            # No model: EXHAUSTED is unexpected.
            largest = finite_models.SIZES[-1][0]
            return z3_solver.z3_result(
                verdict="EXHAUSTED" if model.answer == "unsat" else "UNKNOWN",
                note=model.why or f"no structure of up to {largest} darts breaks it",
            )
        return z3_solver.z3_result(
            verdict="REFUTED",
            counterexample=finite_models.described(model),
            note=f"{lost} is false there, the other premises are true, the goal is false",
        )

    name = f"{obligation.name}-without-{lost}"
    return Theorem(
        name=name,
        kind="mutant",
        claims=obligation.claims,
        words=f"{obligation.words}; but without {lost}",
        symbols=f"not assumed: {shown(dropped)}",
        solver_part="a structure of a few elements in which it fails, evaluated without a solver",
        expected="REFUTED",
        prove=timed(prove),
        queries=one_query(name, lambda: finite_models.question(formulas), "sat"),
        of=obligation.name,
    )


OBLIGATIONS = hypotheses.OBLIGATIONS + growth.OBLIGATIONS
"""A lemma comes before its uses."""

INDUCTIVE: tuple[Theorem, ...] = tuple(map(theorem, OBLIGATIONS))

CONTROL: Theorem = next(
    mutant(obligation, "rot-injective")
    for obligation in OBLIGATIONS
    if obligation.name == "confirm-final"
)
"""Refuted in milliseconds: the last step of claim 4, which needs the marker's direction."""
