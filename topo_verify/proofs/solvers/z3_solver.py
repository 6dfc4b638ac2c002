"""Z3, with every limit set here. Each question has its own context, so answers are independent.

    quantified   E-matching alone: with `auto_config` and `mbqi`, questions that take milliseconds
                 can come back unknown
    ground       equality without quantifiers, which Z3 decides
    clauses      the solver for finite domains, the fastest tried

What this does not show: that Z3 is right (see `extra/sat`).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from importlib import import_module
from itertools import starmap
from typing import Any, Literal

from topo_verify.proofs.theorem import Budget, SolverAnswer, TheoremResult

_z3: Any = import_module("z3")

Z3Setup = Literal["quantified", "ground", "clauses"]

_CTRL_C = "interrupted from keyboard"

_LOGIC = {"ground": "QF_UF", "clauses": "QF_FD"}


def name() -> str:
    """The solver and its version."""
    return f"z3 {'.'.join(map(str, _z3.get_version()[:3]))}"


z3_result = partial(TheoremResult, solver=name())


@dataclass(frozen=True, slots=True)
class Z3Reply:
    """Z3's answer, with the reason for `unknown`, a core (not minimal), or values as text."""

    answer: SolverAnswer
    why: str = ""
    core: tuple[str, ...] = ()
    values: dict[str, str] = field(default_factory=dict[str, str])


def refute(smt2: str, labels: Iterable[str], budget: Budget) -> Z3Reply:
    """Ask a script with quantifiers; `unsat` comes with a core of its labels."""
    question = Z3Question(smt2, budget, setup="quantified", labels=tuple(labels))
    answer = question.check()
    return Z3Reply(answer, why=question.why, core=question.core)


def find_values(smt2: str, wanted: Mapping[str, str], budget: Budget) -> Z3Reply:
    """Ask a script without quantifiers for the values of constants, given with their sorts."""
    question = Z3Question(smt2, budget, setup="ground")
    answer = question.check()
    values = question.values(wanted) if answer == "sat" else {}
    return Z3Reply(answer, why=question.why, values=values)


class Z3Question:
    """A script in Z3; answers are about the last `check`.

    Args:
        labels: one for each assertion, in order; without them there is no core.
    """

    def __init__(
        self, smt2: str, budget: Budget, *, setup: Z3Setup, labels: Sequence[str] = ()
    ) -> None:
        self._context = _z3.Context()
        self._answer: SolverAnswer = "unknown"
        if setup == "quantified":
            self._solver = _z3.Solver(ctx=self._context)
            self._solver.set(auto_config=False, mbqi=False, unsat_core=True)
        else:
            self._solver = _z3.SolverFor(_LOGIC[setup], ctx=self._context)
        self._solver.set("timeout", budget.milliseconds)
        self._solver.set("random_seed", budget.seed)
        if budget.rlimit:
            self._solver.set("rlimit", budget.rlimit)
        assertions = _z3.parse_smt2_string(smt2, ctx=self._context)
        if not labels:
            self._solver.add(assertions)
        # With a label too few, an assertion would be left out.
        for label, assertion in zip(labels, assertions if labels else (), strict=True):
            # Z3 drops the names of a script.
            self._solver.assert_and_track(assertion, label)

    def check(self, assumed: Mapping[str, bool] | None = None) -> SolverAnswer:
        """The answer if these Booleans have these values; KeyboardInterrupt at Ctrl-C."""
        result = self._solver.check(*starmap(self._literal, (assumed or {}).items()))
        if result == _z3.unknown and self._solver.reason_unknown() == _CTRL_C:
            raise KeyboardInterrupt  # Z3 heeds the signal itself, so Python does not see it
        if result == _z3.sat:
            self._answer = "sat"
        else:
            self._answer = "unsat" if result == _z3.unsat else "unknown"
        return self._answer

    def forbid(self, values: Mapping[str, bool]) -> None:
        """Require another value of at least one of these Booleans."""
        others = [self._literal(name, not value) for name, value in values.items()]
        self._solver.add(_z3.Or(others))

    @property
    def why(self) -> str:
        """The reason for `unknown`, or ""."""
        return str(self._solver.reason_unknown()) if self._answer == "unknown" else ""

    @property
    def core(self) -> tuple[str, ...]:
        """The sorted labels of an `unsat` answer."""
        if self._answer != "unsat":
            return ()
        return tuple(sorted(map(str, self._solver.unsat_core())))

    def true(self) -> frozenset[str]:
        """The Booleans that are true in the model."""
        model = self._solver.model()
        # A Boolean that the model leaves open counts as false.
        return frozenset(str(name) for name in model.decls() if _z3.is_true(model[name]))

    def values(self, wanted: Mapping[str, str]) -> dict[str, str]:
        """The values of constants, given with their sorts."""
        model = self._solver.model()
        return {
            name: str(model.eval(_z3.Const(name, self._sort(sort)), model_completion=True))
            for name, sort in wanted.items()
        }

    def _sort(self, name: str) -> Any:
        if name == "Bool":
            return _z3.BoolSort(self._context)
        return _z3.DeclareSort(name, ctx=self._context)

    def _literal(self, name: str, value: bool) -> Any:  # noqa: FBT001  a name and its value
        boolean = _z3.Bool(name, ctx=self._context)
        return boolean if value else _z3.Not(boolean)
