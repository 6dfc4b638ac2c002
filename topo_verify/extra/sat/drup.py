"""Certificates that clauses are unsatisfiable: one program finds the proof, another checks it.

A SAT solver (python-sat) records a DRUP proof, in which unit propagation derives each line from
those before it, up to the empty clause. `drup`, a checker extracted from a Why3 development,
follows it. It is slow, so the solver first reduces the clauses to those it uses; `objection`
requires that they belong to the formula.

What this does not show: that the clauses say what they should.

Source: M. Heule, W. Hunt, N. Wetzler, "Trimming while checking clausal proofs", FMCAD 2013.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from importlib import import_module, metadata
from typing import Any

from topo_verify.errors import InputError
from topo_verify.proofs.bounded.cnf import Clause, Formula
from topo_verify.proofs.theorem import RefutationCertificate

FORMAT = "drup"
SOLVERS = ("glucose4", "lingeling", "cadical153")
"""The shortest of their proofs is checked."""

PER_SECOND = 100_000
"""Clauses times steps that the checker manages in a second."""

_ROUNDS = 8
_FEWEST_CLAUSES = 400
"""No long proof has fewer clauses."""


@dataclass(frozen=True, slots=True)
class DrupRefutation:
    """Contradictory clauses, and the learned clauses up to the empty one."""

    clauses: tuple[Clause, ...]
    steps: tuple[Clause, ...]


def require() -> None:
    """Check that both programs load; InputError if not."""
    for package, module in (("python-sat", "pysat.solvers"), ("drup", "drup")):
        try:
            import_module(module)
        except (ImportError, OSError) as error:
            raise InputError(
                f"certificates need the package {package}, which does not load here ({error}):"
                f" {sys.executable} -m pip install 'topo-verify[sat]' (drup brings its checker for"
                " Linux on x86_64 and for nothing else), or leave out --certify"
            ) from error


def checker() -> str:
    return f"drup {metadata.version('drup')}"


def certify(formula: Formula, *, seconds: float = 60.0) -> RefutationCertificate | str:
    """A certificate of unsatisfiability, or the reason why none was made.

    If the checker refuses the proof, `checked` is false: a bug, not a limit.

    Args:
        seconds: the longest estimated time of the checker.
    Raises:
        InputError: a package is missing.
    """
    require()
    largest = round(seconds * PER_SECOND)
    refutation = refute(formula, most_steps=largest // _FEWEST_CLAUSES)
    if isinstance(refutation, str):
        return refutation
    clauses, steps = len(refutation.clauses), len(refutation.steps)
    if clauses * steps > largest:
        return f"too long for the checker: {steps} steps over {clauses} clauses (--timeout)"
    why = objection(formula, refutation)
    return RefutationCertificate(
        format=FORMAT,
        checker=checker(),
        checked=not why,
        clauses=clauses,
        steps=steps,
        why=why,
    )


def refute(formula: Formula, *, most_steps: int = 1_000_000) -> DrupRefutation | str:
    """A short refutation, or the reason against one: satisfiable, or too many steps."""
    clauses = formula.clauses
    # Keep only used clauses, until a round drops less than 3 %.
    for _ in range(_ROUNDS):
        used = _used(clauses, len(formula.names), most_steps)
        if isinstance(used, str):
            return used
        if len(used) > 0.97 * len(clauses):
            break
        clauses = used
    proofs = [_proof(clauses, name) for name in SOLVERS]
    return DrupRefutation(tuple(clauses), min(proofs, key=len))


def objection(formula: Formula, refutation: DrupRefutation) -> str:
    """Why the refutation is refused, or ""; calls no solver."""
    drup: Any = import_module("drup")
    if not set(refutation.clauses) <= set(formula.clauses):
        return "it refutes clauses that are not those of the formula"
    if not refutation.steps or refutation.steps[-1]:
        return "its last step is not the empty clause"
    outcome = drup.check_proof(refutation.clauses, refutation.steps).outcome
    return "" if outcome == drup.Outcome.VALID else f"{checker()} refuses it"


def _used(clauses: list[Clause], names: int, most_steps: int) -> list[Clause] | str:
    solvers: Any = import_module("pysat.solvers")
    # Assuming a switch for each clause, the core names the used clauses.
    chosen = range(names + 1, names + 1 + len(clauses))
    with solvers.Solver(name=SOLVERS[0]) as solver:
        for clause, switch in zip(clauses, chosen, strict=True):
            solver.add_clause([*clause, -switch])
        solver.conf_budget(most_steps)
        satisfiable = solver.solve_limited(assumptions=list(chosen))
        if satisfiable is None:
            return f"more than {most_steps} steps are needed, too many for the checker (--timeout)"
        if satisfiable:
            return "the SAT solver finds that the clauses can all hold"
        return [clauses[switch - names - 1] for switch in sorted(solver.get_core())]


def _proof(clauses: list[Clause], name: str) -> tuple[Clause, ...]:
    solvers: Any = import_module("pysat.solvers")
    with solvers.Solver(name=name, bootstrap_with=clauses, with_proof=True) as solver:
        solver.solve()
        learned = [line.split() for line in solver.get_proof() if not line.startswith("d")]
    steps = [tuple(map(int, line[:-1])) for line in learned]
    return (*(step for step in steps if step), ())
