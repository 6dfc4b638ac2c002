"""Asking Z3: a script in, one of three answers out.

Z3 is given SMT-LIB text, the same that `--smt2` writes to a file. Proofs over uninterpreted sorts
are searched with E-matching alone: `auto_config` and `mbqi` are off, since with them questions that
take milliseconds can come back unknown. An answer of `unknown` is handed on as such, with Z3's
reason.

Each question gets a context of its own: what was asked before leaves no trace in the answer.

(The z3 package has no types; it is loaded here, as `Any`, and nowhere else in these files.)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

from topo_verify.proofs.first_order.terms import BOOL, App, Term, declarations, script, text
from topo_verify.proofs.theorem import Answer, Budget

_z3: Any = import_module("z3")


def name() -> str:
    """The solver and its version."""
    return f"z3 {'.'.join(map(str, _z3.get_version()[:3]))}"


@dataclass(frozen=True, slots=True)
class Reply:
    """What Z3 said.

    Attributes:
        why: the reason for `unknown`, in Z3's words.
        core: the names of the assertions that cannot hold together (not a least set).
        values: the constants of a model: name -> value as text.
    """

    answer: Answer
    why: str = ""
    core: tuple[str, ...] = ()
    values: dict[str, str] = field(default_factory=dict[str, str])


def prove(assertions: dict[str, Term], budget: Budget) -> Reply:
    """Can all of these hold at once? By E-matching: the answer is unsat or unknown."""
    context = _z3.Context()
    solver = _solver(context, budget)
    parsed = _z3.parse_smt2_string(script(assertions), ctx=context)
    for label, assertion in zip(assertions, parsed, strict=True):
        solver.assert_and_track(assertion, label)
    return _reply(solver)


def satisfy(assertions: Sequence[Term], wanted: Sequence[App], budget: Budget) -> Reply:
    """Can all of these hold at once? For formulas without quantifiers, where Z3 decides.

    Args:
        wanted: constants whose values are wanted, if so.
    """
    context = _z3.Context()
    solver = _z3.SolverFor("QF_UF", ctx=context)
    _limit(solver, budget)
    lines = [*declarations([*assertions, *wanted]), *(f"(assert {text(t)})" for t in assertions)]
    solver.add(_z3.parse_smt2_string("\n".join(lines), ctx=context))
    reply = _reply(solver)
    if reply.answer != "sat":
        return reply
    model = solver.model()
    values = {constant.symbol.name: _value(context, model, constant) for constant in wanted}
    return Reply("sat", values=values)


def _value(context: Any, model: Any, constant: App) -> str:
    name, of = constant.symbol.name, constant.sort
    sort = _z3.BoolSort(context) if of == BOOL else _z3.DeclareSort(of, ctx=context)
    return str(model.eval(_z3.Const(name, sort), model_completion=True))


def _solver(context: Any, budget: Budget) -> Any:
    solver = _z3.Solver(ctx=context)
    solver.set(auto_config=False, mbqi=False, unsat_core=True)
    _limit(solver, budget)
    return solver


def _limit(solver: Any, budget: Budget) -> None:
    solver.set("timeout", max(1, round(budget.timeout * 1000)))
    solver.set("random_seed", budget.seed)
    if budget.rlimit:
        solver.set("rlimit", budget.rlimit)


def _reply(solver: Any) -> Reply:
    result = solver.check()
    if result == _z3.unsat:
        return Reply("unsat", core=tuple(sorted(map(str, solver.unsat_core()))))
    if result == _z3.sat:
        return Reply("sat")
    return Reply("unknown", why=str(solver.reason_unknown()))
