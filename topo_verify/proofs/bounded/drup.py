"""Certificates that clauses are unsatisfiable: one program proves it, another checks the proof.

A SAT solver (of python-sat) looks for a refutation and records the clauses that it learns: a DRUP
proof, in which unit propagation derives each line from those before it, and the last line is the
empty clause. `drup`, a checker extracted from a development verified in Why3, follows the proof. It
calls no solver and trusts nothing that the solver reports.

The checker is slow and the solver is fast. So the solver first reduces the clauses to those that it
uses, several times over. The checker follows a refutation of these, and `objection` makes sure that
they are clauses of the formula: if some of its clauses contradict each other, all of them do.

What this does not show: that the clauses say what they should. The encoding is compared with the
enumeration (`theorems.py`), and its rules with the simulator (`replay.py`).

Source: M. Heule, W. Hunt, N. Wetzler, "Trimming while checking clausal proofs", FMCAD 2013.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module, metadata
from typing import Any

from topo_verify.errors import InputError
from topo_verify.proofs.bounded.cnf import Clause, Formula
from topo_verify.proofs.theorem import RefutationCertificate

FORMAT = "drup"
SOLVERS = ("glucose4", "lingeling", "cadical153")
"""The solvers that make a proof; the shortest proof is checked."""

PER_SECOND = 100_000
"""The product of clauses and steps that the checker manages in a second on a slow machine."""

_ROUNDS = 8
_FEWEST_CLAUSES = 400
"""The least number of clauses of a formula with a long proof: limits the search for a proof."""


@dataclass(frozen=True, slots=True)
class DrupRefutation:
    """Contradictory clauses, and the learned clauses that show it; the last one is empty."""

    clauses: tuple[Clause, ...]
    steps: tuple[Clause, ...]


def require_tools() -> None:
    """Raise an `InputError` where python-sat or drup cannot be loaded."""
    for package, module in (("python-sat", "pysat.solvers"), ("drup", "drup")):
        try:
            import_module(module)
        except (ImportError, OSError) as error:
            raise InputError(
                f"certificates need the package {package}, which does not load here ({error}):"
                " install topo-verify[proofs] (drup brings its checker for Linux on x86_64 and for"
                " nothing else), or leave out --certify"
            ) from error


def checker() -> str:
    """Name and version of the checker."""
    return f"drup {metadata.version('drup')}"


def certify(formula: Formula, *, seconds: float = 60.0) -> RefutationCertificate | str:
    """A checked certificate that the formula is unsatisfiable, or the reason why it has none.

    A proof that the checker refuses gives a certificate with `checked` false: a bug, not a limit.

    Args:
        seconds: the longest time, as estimated, that a proof may keep the checker busy.
    """
    largest = round(seconds * PER_SECOND)
    # The checker has time for `largest` clauses times steps, so a longer proof is of no use.
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
    """A short refutation, or the reason why it has none: satisfiable, or too many steps."""
    clauses = formula.clauses
    # Each round keeps the clauses that the last one used, until a round drops less than 3 %.
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
    """The reason why the refutation is refused, or "" if it is accepted; calls no solver."""
    drup: Any = import_module("drup")
    if not set(refutation.clauses) <= set(formula.clauses):
        return "it refutes clauses that are not those of the formula"
    if not refutation.steps or refutation.steps[-1]:
        return "its last step is not the empty clause"
    outcome = drup.check_proof(refutation.clauses, refutation.steps).outcome
    return "" if outcome == drup.Outcome.VALID else f"{checker()} refuses it"


def together(certificates: list[RefutationCertificate]) -> RefutationCertificate:
    """One certificate for several formulas: checked if all are; clauses and steps are summed."""
    return RefutationCertificate(
        format=FORMAT,
        checker=checker(),
        checked=all(part.checked for part in certificates),
        clauses=sum(part.clauses for part in certificates),
        steps=sum(part.steps for part in certificates),
        why=next((part.why for part in certificates if part.why), ""),
    )


def _used(clauses: list[Clause], names: int, most_steps: int) -> list[Clause] | str:
    """The clauses that a solver used to refute all of them, or the reason why it did not."""
    solvers: Any = import_module("pysat.solvers")
    # A switch for each clause: assuming all switches, the core names the clauses that were used.
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
    """The clauses that a solver learned on its way to the empty one, without its deletions."""
    solvers: Any = import_module("pysat.solvers")
    with solvers.Solver(name=name, bootstrap_with=clauses, with_proof=True) as solver:
        solver.solve()
        # Deletions may go: what propagation derives from some clauses, it derives from more.
        learned = [line.split() for line in solver.get_proof() if not line.startswith("d")]
    # A line ends with 0, as in DIMACS.
    steps = [tuple(map(int, line[:-1])) for line in learned]
    return (*(step for step in steps if step), ())
