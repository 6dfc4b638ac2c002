"""cvc5, the second solver, reads the same scripts as Z3.

Disagreement is an error: one solver is wrong. `unknown` counts neither way; questions with
quantifiers are then asked again with `full-saturate-quant`.
"""

from __future__ import annotations

import sys
from collections import Counter
from dataclasses import dataclass
from importlib import import_module
from time import perf_counter
from typing import Any, Literal

from topo_verify.cli.prove import SecondOpinion
from topo_verify.errors import InputError, InternalError
from topo_verify.proofs.theorem import Budget, Query, SolverAnswer, Theorem

Agreement = Literal["agrees", "disagrees", "unknown"]

NAME = "cvc5"


@dataclass(frozen=True, slots=True)
class SecondAnswer:
    """cvc5's answer; `why`: the reason for `unknown`, or the option that it took."""

    query: str
    solver: str
    answer: SolverAnswer
    expected: SolverAnswer
    seconds: float
    why: str = ""

    @property
    def agreement(self) -> Agreement:
        """Does cvc5 give the expected answer?"""
        if self.answer == "unknown":
            return "unknown"
        return "agrees" if self.answer == self.expected else "disagrees"

    def __str__(self) -> str:
        match self.agreement:
            case "agrees":
                return f"{self.query}: {self.solver} agrees: {self.answer}"
            case "unknown":
                return f"{self.query}: cvc5 unknown ({self.why})"
            case "disagrees":
                return f"{self.query}: {self.solver} says {self.answer}, not {self.expected}"


def require() -> None:
    """Check that cvc5 loads; InputError if not."""
    try:
        import_module("cvc5")
    except (ImportError, OSError) as error:
        raise InputError(
            f"a second opinion needs the package cvc5, which does not load here ({error}):"
            f" {sys.executable} -m pip install 'topo-verify[sat]', or leave out --solver"
        ) from error


def opinion(theorem: Theorem, *, timeout: float) -> SecondOpinion | None:
    """How often cvc5 agrees with Z3 on a theorem; None if the theorem has no questions.

    Raises:
        InternalError: the solvers disagree.
    """
    answers = [ask(query, timeout=timeout) for query in theorem.queries()]
    for answer in answers:
        if answer.agreement == "disagrees":
            raise InternalError(f"the solvers disagree: {answer}")
    if not answers:
        return None
    count = Counter(answer.agreement for answer in answers)
    return SecondOpinion(answers[0].solver, count["agrees"], count["unknown"], len(answers))


def ask(query: Query, *, timeout: float = 60.0) -> SecondAnswer:
    """Ask cvc5, at most twice with `timeout` seconds each.

    Raises:
        InputError: cvc5 is missing, or cannot read the script.
    """
    require()
    began = perf_counter()
    answer, why = _check(query, timeout, {})
    if answer == "unknown" and "forall" in query.smt2:
        answer, why = _check(query, timeout, {"full-saturate-quant": "true"})
        why = why or "full-saturate-quant"
    solver = f"cvc5 {import_module('cvc5').__version__}"
    return SecondAnswer(query.name, solver, answer, query.expected, perf_counter() - began, why)


def _check(query: Query, timeout: float, options: dict[str, str]) -> tuple[SolverAnswer, str]:
    cvc5: Any = import_module("cvc5")
    solver = cvc5.Solver(cvc5.TermManager())
    limit = str(Budget(timeout=timeout).milliseconds)
    for option, value in {"tlimit-per": limit, **options}.items():
        solver.setOption(option, value)
    parser = cvc5.InputParser(solver)
    parser.setStringInput(cvc5.InputLanguage.SMT_LIB_2_6, query.smt2, query.name)
    output = ""
    try:
        while not (command := parser.nextCommand()).isNull():
            output += str(command.invoke(solver, parser.getSymbolManager()))
    except RuntimeError as error:
        raise InputError(f"cvc5 cannot read the question {query.name}: {error}") from error
    match output.split():
        case ["sat"]:
            return "sat", ""
        case ["unsat"]:
            return "unsat", ""
        case ["unknown", *reason]:
            return "unknown", " ".join(reason).strip("()").lower() or "it gave up"
        case _:
            raise InputError(f"cvc5 answers the question {query.name} with {output.strip()!r}")
