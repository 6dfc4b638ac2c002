"""Formulas in conjunctive normal form over named Booleans.

Solvers and the checker of certificates read the same clauses, so no translation must be trusted.
Literal `v` says that Boolean `v` is true, `-v` that it is false. Each premise is a **group** of
clauses, which a core can name. Of a one-hot **row** exactly one literal is true.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from topo_verify.proofs.solvers.z3_solver import Z3Question
from topo_verify.proofs.theorem import Budget, SolverAnswer

CnfLiteral = int
CnfRow = tuple[CnfLiteral, ...]
Clause = tuple[CnfLiteral, ...]

REFUTED = "refuted"
"""The group of the negated conclusion; without it, a formula must be satisfiable."""

MET = "met"
"""In the premises alone, the group that requires a case for the conclusion."""


class Formula:
    """A growing conjunction; Boolean `v` is `names[v - 1]`, `met` the clauses of `MET`."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self.groups: dict[str, list[Clause]] = {}
        self.met: list[Clause] = []

    def boolean(self, name: str) -> CnfLiteral:
        self.names.append(name)
        return len(self.names)

    def booleans(self, name: str, size: int) -> CnfRow:
        return tuple(self.boolean(f"{name}.{index}") for index in range(size))

    def row(self, group: str, name: str, size: int) -> CnfRow:
        row = self.booleans(name, size)
        self.exactly_one(group, row)
        return row

    def add(self, group: str, *literals: CnfLiteral) -> None:
        self.groups.setdefault(group, []).append(literals)

    def imply(self, group: str, premises: Sequence[CnfLiteral], *conclusions: CnfLiteral) -> None:
        """Add: if all premises hold, so does one of the conclusions."""
        self.add(group, *(-premise for premise in premises), *conclusions)

    def exactly_one(self, group: str, literals: Sequence[CnfLiteral]) -> None:
        self.add(group, *literals)
        for one, other in combinations(literals, 2):
            self.add(group, -one, -other)

    def define_and(self, group: str, name: str, literals: Sequence[CnfLiteral]) -> CnfLiteral:
        both = self.boolean(name)
        for literal in literals:
            self.add(group, -both, literal)
        self.imply(group, literals, both)
        return both

    def define_or(self, group: str, name: str, literals: Sequence[CnfLiteral]) -> CnfLiteral:
        return -self.define_and(group, name, [-literal for literal in literals])

    def equate(self, group: str, guard: Sequence[CnfLiteral], one: CnfRow, other: CnfRow) -> None:
        """Add: under the guard the rows are equal."""
        for a, b in zip(one, other, strict=True):
            self.imply(group, (*guard, a), b)
            self.imply(group, (*guard, b), a)

    def define_equal(self, group: str, name: str, one: CnfRow, other: CnfRow) -> CnfLiteral:
        equal = self.boolean(name)
        self.equate(group, (equal,), one, other)
        # Rows are one-hot, so one shared place suffices.
        for a, b in zip(one, other, strict=True):
            self.imply(group, (a, b), equal)
        return equal

    @property
    def clauses(self) -> list[Clause]:
        return [clause for clauses in self.groups.values() for clause in clauses]

    def premises(self) -> Formula:
        """The premises with `MET`: satisfiable unless the theorem is vacuous."""
        alone = Formula()
        alone.names = list(self.names)
        alone.groups = {name: row for name, row in self.groups.items() if name != REFUTED}
        alone.groups[MET] = list(self.met)
        return alone

    def smt2(self) -> str:
        """SMT-LIB 2, one named assertion for each group."""
        lines = ["(set-logic QF_UF)"]
        # Well-formed for empty and single clauses, too.
        lines += [f"(declare-const {name} Bool)" for name in self.names]
        for group, clauses in self.groups.items():
            lines.append("(assert (! (and true")
            lines += [f"  {self._disjunction(clause)}" for clause in clauses]
            lines.append(f") :named {group}))")
        return "\n".join(lines) + "\n"

    def _disjunction(self, clause: Iterable[CnfLiteral]) -> str:
        written = [
            self.names[literal - 1] if literal > 0 else f"(not {self.names[-literal - 1]})"
            for literal in clause
        ]
        return written[0] if len(written) == 1 else f"(or false {' '.join(written)})"


@dataclass(frozen=True, slots=True)
class Assignment:
    """The Booleans that are true in a model."""

    true: frozenset[int]

    def holds(self, literal: int) -> bool:
        return (abs(literal) in self.true) == (literal > 0)

    def index(self, row: CnfRow) -> int:
        """The index of a one-hot row's true literal."""
        (place,) = (index for index, literal in enumerate(row) if self.holds(literal))
        return place


@dataclass(frozen=True, slots=True)
class SatResult:
    """Z3's answer, with a model, the reason for `unknown`, or the groups used (not minimal)."""

    answer: SolverAnswer
    model: Assignment | None = None
    core: tuple[str, ...] = ()
    why: str = ""


def solve(formula: Formula, budget: Budget) -> SatResult:
    question = Z3Question(formula.smt2(), budget, setup="clauses", labels=tuple(formula.groups))
    answer = question.check()
    model = _model(formula, question) if answer == "sat" else None
    return SatResult(answer, model, core=question.core, why=question.why)


def first_model(formula: Formula, over: CnfRow, budget: Budget) -> SatResult:
    """The first model in the order of `over`, earliest literals true.

    Z3's choice of a model may vary; a printed counterexample must not.
    """
    question = Z3Question(formula.smt2(), budget, setup="clauses")
    if (answer := question.check()) != "sat":
        return SatResult(answer, why=question.why)
    model = _model(formula, question)
    assumed: dict[str, bool] = {}
    for literal in over:
        name = formula.names[abs(literal) - 1]
        # Make each literal true where possible, and assume the outcome.
        if not model.holds(literal):
            answer = question.check(assumed | {name: literal > 0})
            if answer == "unknown":
                return SatResult("unknown", why=question.why)
            if answer == "sat":
                model = _model(formula, question)
        assumed[name] = model.holds(abs(literal))
    return SatResult("sat", model)


def models(formula: Formula, over: CnfRow, budget: Budget) -> Iterator[Assignment]:
    """Yield one model for each assignment of `over`.

    Raises:
        SolverGaveUp: further models were not excluded.
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
