"""Certificates: made by a SAT solver, believed only when a checker has followed them."""

from __future__ import annotations

import sys
from dataclasses import replace

import pytest

from tests.helpers import typed
from topo_verify.errors import InputError
from topo_verify.extra.sat import drup
from topo_verify.extra.sat.drup import DrupRefutation, certify, objection, refute
from topo_verify.proofs.bounded import statements
from topo_verify.proofs.bounded.cnf import Formula
from topo_verify.proofs.bounded.statements import (
    ONE_DOOR_STATEMENTS,
    WHOLE_WORD_STATEMENTS,
    BoundedStatement,
)
from topo_verify.proofs.bounded.theorems import theorem, worlds_theorem
from topo_verify.proofs.theorem import Budget

pytest.importorskip("pysat", reason="python-sat is not installed: topo-verify[sat]")
pytest.importorskip("drup", reason="drup is not installed: topo-verify[sat]")


def named(name: str) -> BoundedStatement:
    (statement,) = (
        one for one in (*ONE_DOOR_STATEMENTS, *WHOLE_WORD_STATEMENTS) if one.name == name
    )
    return statement


def refuted(formula: Formula) -> DrupRefutation:
    return typed(DrupRefutation, refute(formula))


@pytest.mark.parametrize("name", [one.name for one in ONE_DOOR_STATEMENTS])
def test_one_door_theorems_up_to_two_edges_carry_a_checked_certificate(name: str) -> None:
    one = theorem(named(name), range(1, 3))
    outcome = one.prove(Budget(certify=certify))
    assert outcome.certificate is not None
    assert outcome.certificate.checked
    assert outcome.certificate.checker.startswith("drup ")
    assert one.ok(outcome)


def test_without_being_asked_for_there_is_none() -> None:
    assert theorem(named("bounded-closed"), range(1, 3)).prove(Budget()).certificate is None


@pytest.mark.parametrize("build", [statements.confirm_back, statements.record])
def test_a_tampered_proof_is_refused(build: type) -> None:
    formula = build(2)
    refutation = refuted(formula)
    assert objection(formula, refutation) == ""
    cut = replace(refutation, steps=refutation.steps[-1:])
    flipped = replace(
        refutation, steps=tuple(tuple(-literal for literal in step) for step in refutation.steps)
    )
    assert "refuses" in objection(formula, cut)
    assert "refuses" in objection(formula, flipped)


def test_a_proof_that_does_not_end_in_the_empty_clause_is_refused() -> None:
    formula = statements.confirm_back(2)
    refutation = refuted(formula)
    short = replace(refutation, steps=refutation.steps[:-1])
    assert objection(formula, short) == "its last step is not the empty clause"
    assert objection(formula, replace(refutation, steps=())) != ""


def test_a_refutation_of_other_clauses_is_refused() -> None:
    formula = statements.closed(2)
    other = DrupRefutation(((1,), (-1,)), ((),))
    assert "not those of the formula" in objection(formula, other)


def test_no_proof_makes_satisfiable_clauses_contradict() -> None:
    premises = statements.closed(2).premises()
    bogus = DrupRefutation(tuple(premises.clauses), ((1,), (-1,), ()))
    assert "refuses" in objection(premises, bogus)
    assert certify(premises) == "the SAT solver finds that the clauses can all hold"


def test_a_refused_certificate_is_no_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    def none_at_all(_clauses: object, _name: str) -> tuple[tuple[int, ...], ...]:
        return ((),)

    monkeypatch.setattr(drup, "_proof", none_at_all)
    one = theorem(named("bounded-confirm-back"), range(2, 3))
    outcome = one.prove(Budget(certify=certify))
    assert outcome.verdict == "EXHAUSTED"
    assert outcome.certificate is not None
    assert not outcome.certificate.checked
    assert "refuses" in outcome.certificate.why
    assert not one.ok(outcome)


def test_what_is_too_long_for_the_checker_has_no_certificate_and_says_so() -> None:
    formula = statements.confirm(3, 3).world
    told = typed(str, certify(formula, seconds=0.1))
    assert "--timeout" in told
    one = theorem(named("words-confirm"), range(1, 4))
    outcome = one.prove(Budget(certify=certify, timeout=10))
    assert outcome.certificate is None
    assert outcome.note.startswith("certificates checked for 2 of 3 sizes; m = 3: ")


def test_that_there_is_no_other_world_is_certified() -> None:
    one = worlds_theorem("bounded-worlds", range(1, 4))
    outcome = one.prove(Budget(certify=certify))
    assert outcome.certificate is not None
    assert outcome.certificate.checked
    assert one.ok(outcome)


@pytest.mark.parametrize("module", ["drup", "pysat.solvers"])
def test_a_missing_tool_is_said(module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(InputError, match=r"does not load here .* -m pip install \S+ \("):
        theorem(named("bounded-closed"), range(1, 2)).prove(Budget(certify=certify))
