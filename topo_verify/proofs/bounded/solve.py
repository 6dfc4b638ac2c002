"""The satisfiability of clauses, and their models, found by Z3.

Z3 reads the SMT-LIB 2 text that is also exported and handed to other solvers, so all of them answer
the same question.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from time import perf_counter

from topo_verify.proofs.bounded.cnf import CnfRow, Formula
from topo_verify.proofs.solvers.z3_solver import Z3Question
from topo_verify.proofs.theorem import Budget, SolverAnswer


@dataclass(frozen=True, slots=True)
class Assignment:
    """A model of a formula: the Booleans that are true; all others are false."""

    true: frozenset[int]

    def holds(self, literal: int) -> bool:
        """Whether the literal is true."""
        return (abs(literal) in self.true) == (literal > 0)

    def index(self, row: CnfRow) -> int:
        """The index of the literal of a one-hot row that is true."""
        (place,) = (index for index, literal in enumerate(row) if self.holds(literal))
        return place


@dataclass(frozen=True, slots=True)
class SatResult:
    """Z3's answer about a formula.

    Attributes:
        model: an assignment, if the answer is sat.
        core: the groups of clauses that an unsat answer used; not minimal.
        why: the reason for unknown, in Z3's words.
    """

    answer: SolverAnswer
    seconds: float
    model: Assignment | None = None
    core: tuple[str, ...] = ()
    why: str = ""


def solve(formula: Formula, budget: Budget) -> SatResult:
    """Z3's answer to the question whether the formula is satisfiable; a time-out is `unknown`."""
    began = perf_counter()
    question = Z3Question(formula.smt2(), budget, setup="clauses", labels=tuple(formula.groups))
    answer = question.check()
    seconds = perf_counter() - began
    model = _model(formula, question) if answer == "sat" else None
    return SatResult(answer, seconds, model, core=question.core, why=question.why)


def first_model(formula: Formula, over: CnfRow, budget: Budget) -> SatResult:
    """As `solve`, but the model is the first of all in the order of the literals `over`.

    The first makes the earliest literals true. Which model Z3 finds by itself may vary from run to
    run, and a counterexample that is printed must not.
    """
    began = perf_counter()
    question = Z3Question(formula.smt2(), budget, setup="clauses")
    if (answer := question.check()) != "sat":
        return SatResult(answer, perf_counter() - began, why=question.why)
    model = _model(formula, question)
    assumed: dict[str, bool] = {}
    for literal in over:
        name = formula.names[abs(literal) - 1]
        # Make one literal after the other true where that is possible, and assume the outcome.
        if not model.holds(literal):
            answer = question.check(assumed | {name: literal > 0})
            if answer == "unknown":
                return SatResult("unknown", perf_counter() - began, why=question.why)
            if answer == "sat":
                model = _model(formula, question)
        assumed[name] = model.holds(abs(literal))
    return SatResult("sat", perf_counter() - began, model)


def models(formula: Formula, over: CnfRow, budget: Budget) -> Iterator[Assignment]:
    """All models, one for each assignment of the Booleans `over`; the order is Z3's.

    Raises:
        SolverGaveUp: Z3 gave up before it had excluded further models.
    """
    question = Z3Question(formula.smt2(), budget, setup="clauses")
    names = {abs(literal): formula.names[abs(literal) - 1] for literal in over}
    while (answer := question.check()) == "sat":
        model = _model(formula, question)
        yield model
        question.forbid({name: model.holds(number) for number, name in names.items()})
    if answer == "unknown":
        raise SolverGaveUp(question.why)


class SolverGaveUp(Exception):
    """The solver gave up. Give it more time with `--timeout`."""


def _model(formula: Formula, question: Z3Question) -> Assignment:
    true = question.true()
    return Assignment(frozenset(v for v, name in enumerate(formula.names, 1) if name in true))
