"""Put clauses to Z3, and read assignments back.

Z3 reads the SMT-LIB 2 text that is also exported and handed to other solvers, so all of them answer
the same question. The answer is one of three; a time-out is `unknown`, whatever words come with it.
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
    """An assignment that satisfies a formula: the Booleans that are true."""

    true: frozenset[int]

    def holds(self, literal: int) -> bool:
        """Is the literal true?"""
        return (abs(literal) in self.true) == (literal > 0)

    def index(self, row: CnfRow) -> int:
        """Which literal of a one-hot row is true."""
        (place,) = (index for index, literal in enumerate(row) if self.holds(literal))
        return place


@dataclass(frozen=True, slots=True)
class SatResult:
    """Z3's answer about a formula.

    Attributes:
        model: if the answer is sat.
        core: the groups of clauses that an unsat answer used; not minimal.
        why: why it is unknown.
    """

    answer: SolverAnswer
    seconds: float
    model: Assignment | None = None
    core: tuple[str, ...] = ()
    why: str = ""


def solve(formula: Formula, budget: Budget) -> SatResult:
    """Is the formula satisfiable? Never raises for a time-out."""
    began = perf_counter()
    question = Z3Question(formula.smt2(), budget, setup="clauses", labels=tuple(formula.groups))
    answer = question.check()
    seconds = perf_counter() - began
    model = _model(formula, question) if answer == "sat" else None
    return SatResult(answer, seconds, model, core=question.core, why=question.why)


def first_model(formula: Formula, over: CnfRow, budget: Budget) -> SatResult:
    """As `decide`, and a model is always the same one: the first of all, by the Booleans `over`.

    First is the one in which the earliest of them are true. (What Z3 finds first varies from run to
    run.)
    """
    began = perf_counter()
    question = Z3Question(formula.smt2(), budget, setup="clauses")
    if (answer := question.check()) != "sat":
        return SatResult(answer, perf_counter() - began, why=question.why)
    model = _model(formula, question)
    assumed: dict[str, bool] = {}
    for literal in over:
        name = formula.names[abs(literal) - 1]
        # One Boolean after the other is made true where it can be; what can be is then assumed.
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
        Undecided: Z3 gave up before it had said that there are no more.
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
    """The solver gave up: give it more time with `--timeout`."""


def _model(formula: Formula, question: Z3Question) -> Assignment:
    true = question.true()
    return Assignment(frozenset(v for v, name in enumerate(formula.names, 1) if name in true))
