"""Ask Z3 about clauses, and read what it says.

Z3 reads the SMT-LIB 2 text that is also exported and handed to other solvers, so all of them answer
the same question. The answer is one of three; a time-out is `unknown`, whatever words come with it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib import import_module
from time import perf_counter
from typing import Any

from topo_verify.proofs.bounded.cnf import Formula, Row
from topo_verify.proofs.theorem import Answer, Budget

_z3: Any = import_module("z3")  # as in z3solver.py: the package has no types

LOGIC = "QF_FD"
"""Z3's solver for finite domains: of those tried the fastest on these clauses."""


@dataclass(frozen=True, slots=True)
class Model:
    """An assignment that satisfies a formula: the Booleans that are true."""

    true: frozenset[int]

    def holds(self, literal: int) -> bool:
        """Is the literal true?"""
        return (abs(literal) in self.true) == (literal > 0)

    def index(self, row: Row) -> int:
        """Which literal of a one-hot row is true."""
        (place,) = (index for index, literal in enumerate(row) if self.holds(literal))
        return place


@dataclass(frozen=True, slots=True)
class Decision:
    """What Z3 said.

    Attributes:
        model: if the answer is sat.
        core: the groups of clauses that an unsat answer used; not minimal.
        why: why it is unknown.
    """

    answer: Answer
    seconds: float
    model: Model | None = None
    core: tuple[str, ...] = ()
    why: str = ""


def decide(formula: Formula, budget: Budget) -> Decision:
    """Is the formula satisfiable? Never raises for a time-out."""
    began = perf_counter()
    solver = _solver(budget, formula, tracked=True)
    answer = _answer(solver.check())
    seconds = perf_counter() - began
    match answer:
        case "sat":
            return Decision("sat", seconds, _model(formula, solver))
        case "unsat":
            core = sorted(map(str, solver.unsat_core()))
            return Decision("unsat", seconds, core=tuple(core))
        case "unknown":
            return Decision("unknown", seconds, why=solver.reason_unknown())


def first_model(formula: Formula, over: Row, budget: Budget) -> Decision:
    """As `decide`, and a model is always the same one: the first of all, by the Booleans `over`.

    First is the one in which the earliest of them are true. (What Z3 finds first varies from run to
    run.)
    """
    began = perf_counter()
    solver = _solver(budget, formula)
    answer = _answer(solver.check())
    model = _model(formula, solver) if answer == "sat" else Model(frozenset())
    assumed: list[Any] = []
    for literal in over if answer == "sat" else ():
        name = _z3.Bool(formula.names[abs(literal) - 1])
        wanted, other = (name, _z3.Not(name)) if literal > 0 else (_z3.Not(name), name)
        if not model.holds(literal):
            answer = _answer(solver.check(*assumed, wanted))
            if answer == "unknown":
                break
            if answer == "sat":
                model = _model(formula, solver)
        assumed.append(wanted if model.holds(literal) else other)
    seconds = perf_counter() - began
    if answer == "unknown":
        return Decision("unknown", seconds, why=solver.reason_unknown())
    return Decision("sat", seconds, model) if model.true else Decision("unsat", seconds)


def models(formula: Formula, over: Row, budget: Budget) -> Iterator[Model]:
    """All models, one for each assignment of the Booleans `over`; the order is Z3's.

    Raises:
        Undecided: Z3 gave up before it had said that there are no more.
    """
    solver = _solver(budget, formula)
    while (answer := _answer(solver.check())) == "sat":
        model = _model(formula, solver)
        yield model
        names = [(formula.names[abs(literal) - 1], model.holds(literal)) for literal in over]
        other = [_z3.Not(_z3.Bool(name)) if held else _z3.Bool(name) for name, held in names]
        solver.add(_z3.Or(other))
    if answer == "unknown":
        raise Undecided(solver.reason_unknown())


class Undecided(Exception):
    """The solver gave up: give it more time with `--timeout`."""


def _solver(budget: Budget, formula: Formula, *, tracked: bool = False) -> Any:
    solver = _z3.SolverFor(LOGIC)
    solver.set("timeout", max(1, round(budget.timeout * 1000)))
    solver.set("random_seed", budget.seed)
    if budget.rlimit:
        solver.set("rlimit", budget.rlimit)
    parsed = _z3.parse_smt2_string(formula.smt2())
    for group, assertion in zip(formula.groups, parsed, strict=True):
        if tracked:
            solver.assert_and_track(assertion, group)
        else:
            solver.add(assertion)
    return solver


def _model(formula: Formula, solver: Any) -> Model:
    model = solver.model()
    true = {str(name) for name in model.decls() if _z3.is_true(model[name])}
    return Model(frozenset(v for v, name in enumerate(formula.names, 1) if name in true))


def _answer(said: Any) -> Answer:
    if said == _z3.sat:
        return "sat"
    return "unsat" if said == _z3.unsat else "unknown"
