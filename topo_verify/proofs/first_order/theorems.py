"""The obligations as theorems, and for each a mutant that lacks one of its premises.

**Theorem**: Z3 shows that the premises and the negated goal have no model. A tiny structure
(`finite_models.py`) shows that the premises alone have one. A theorem whose premises have none is
vacuous, and not `ok`.

**Mutant**: without one premise, which the obligation names, there is a structure in which all other
premises hold and the goal fails. It is evaluated without a solver before it counts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from time import perf_counter

from topo_verify.proofs.first_order import finite_models
from topo_verify.proofs.first_order.axioms import INVARIANT, LEMMAS
from topo_verify.proofs.first_order.obligations import OBLIGATIONS, Obligation
from topo_verify.proofs.first_order.terms import Term, conj, implies, neg, script, shown
from topo_verify.proofs.solvers import z3_solver
from topo_verify.proofs.theorem import Budget, Query, Theorem, TheoremResult


def theorem(obligation: Obligation) -> Theorem:
    """The obligation as a theorem."""
    given = tuple(obligation.given.values())
    statement = implies(conj(*given), obligation.goal) if given else obligation.goal

    def queries() -> Iterator[Query]:
        yield Query(obligation.name, script(obligation.negation()), "unsat")

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
        prove=_prover(obligation),
        queries=queries,
    )


def _solver_part(obligation: Obligation) -> str:
    lemmas = dict.fromkeys(LEMMAS[name] for name in obligation.theory if name in LEMMAS)
    words = "for all worlds and maps of the theory, of any size"
    if set(obligation.theory) & set(INVARIANT):
        words += ", if S is a part of the world (the invariant, which augmentations keep)"
    return words + (f", given {', '.join(lemmas)}" if lemmas else "")


def _prover(obligation: Obligation) -> Callable[[Budget], TheoremResult]:
    def prove(budget: Budget) -> TheoremResult:
        begin = perf_counter()
        reply = refute(obligation.negation(), budget)
        # Only `unsat` is a proof. No model with quantifiers is evaluated, so `sat` refutes nothing.
        if reply.answer != "unsat":
            return TheoremResult(
                verdict="UNKNOWN",
                solver=z3_solver.name(),
                seconds=perf_counter() - begin,
                note=f"{z3_solver.name()} answers {reply.answer}: {reply.why or 'no reason given'}",
            )
        # Z3 cannot find models of quantified formulas, so a tiny one is sought for the premises.
        premises = finite_models.smallest(obligation.premises(), budget).answer
        satisfiable = {"sat": True, "unsat": False, "unknown": None}[premises]
        return TheoremResult(
            verdict="PROVED",
            solver=z3_solver.name(),
            seconds=perf_counter() - begin,
            premises_satisfiable=satisfiable,
            core=tuple(name for name in reply.core if name != "goal-fails"),
            note="" if satisfiable else "no structure was found where its premises hold: vacuous",
        )

    return prove


def refute(assertions: dict[str, Term], budget: Budget) -> z3_solver.Z3Reply:
    """Z3's reply: can all of these hold at once? The core consists of their names."""
    return z3_solver.refute(script(assertions), assertions, budget)


def mutant(obligation: Obligation, lost: str) -> Theorem:
    """The obligation without one premise as a theorem that must be refuted."""
    dropped = obligation.premises()[lost]
    formulas = obligation.premises(without=lost)
    # Where the premise holds, so does the goal (the theorem), so its negation loses no structure.
    formulas |= {"premise-fails": neg(dropped), "goal-fails": neg(obligation.goal)}

    def prove(budget: Budget) -> TheoremResult:
        begin = perf_counter()
        found = finite_models.smallest(formulas, budget)
        if found.structure is None:
            # No model of these sizes: the mutant was not refuted, and EXHAUSTED is unexpected.
            exhausted = found.answer == "unsat"
            return TheoremResult(
                verdict="EXHAUSTED" if exhausted else "UNKNOWN",
                solver=z3_solver.name(),
                seconds=perf_counter() - begin,
                note=found.why
                or f"no structure of up to {finite_models.SIZES[-1][0]} darts breaks it",
            )
        return TheoremResult(
            verdict="REFUTED",
            solver=z3_solver.name(),
            seconds=perf_counter() - begin,
            counterexample=finite_models.described(found),
            note=f"{lost} is false there, the other premises are true, the goal is false",
        )

    def queries() -> Iterator[Query]:
        yield Query(f"{obligation.name}-without-{lost}", finite_models.question(formulas), "sat")

    return Theorem(
        name=f"{obligation.name}-without-{lost}",
        kind="mutant",
        claims=obligation.claims,
        words=f"{obligation.words}; but without {lost}",
        symbols=f"not assumed: {shown(dropped)}",
        solver_part="a structure of a few elements in which it fails, evaluated without a solver",
        expected="REFUTED",
        prove=prove,
        queries=queries,
        of=obligation.name,
    )


def _telling(obligation: Obligation) -> str:
    """The most telling premise to drop: the first axiom or lemma that is needed, if any."""
    return next((n for n in obligation.needs if n in obligation.theory), obligation.needs[0])


INDUCTIVE: tuple[Theorem, ...] = tuple(map(theorem, OBLIGATIONS))

AXIOM_MUTANTS: tuple[Theorem, ...] = tuple(mutant(one, _telling(one)) for one in OBLIGATIONS)
