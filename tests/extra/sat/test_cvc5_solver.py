"""cvc5 on the exported questions: it agrees, it disagrees, or it does not know."""

from __future__ import annotations

import sys
from dataclasses import replace

import pytest

from tests.marks import with_marks
from tests.proofs.bounded.mutants import MUTANTS, NEGATIVES
from topo_verify.errors import InputError
from topo_verify.extra.sat.cvc5_solver import ask
from topo_verify.proofs.bounded.theorems import bounded
from topo_verify.proofs.first_order.theorems import INDUCTIVE
from topo_verify.proofs.theorem import Query, Theorem

pytest.importorskip("cvc5", reason="cvc5 is not installed: topo-verify[sat]")

CONTRADICTION = Query(
    "contradiction",
    "(set-logic QF_UF)\n(declare-const p Bool)\n(assert p)\n(assert (not p))\n(check-sat)\n",
    "unsat",
)


@pytest.mark.parametrize(
    "one",
    with_marks(
        (one for one in bounded(3) if not one.deep),
        long=["words-records-one", "words-records-all"],
    ),
    ids=lambda one: one.name,
)
def test_it_agrees_on_the_bounded_theorems(one: Theorem) -> None:
    for query in one.queries():
        assert ask(query).agreement == "agrees", query.name


@pytest.mark.parametrize("one", [*NEGATIVES, *MUTANTS], ids=lambda one: one.name)
def test_it_finds_the_counterexamples_too(one: Theorem) -> None:
    for query in one.queries():
        assert ask(query).answer == "sat"


def test_it_is_never_against_an_inductive_theorem() -> None:
    """Some quantified questions are too hard for it; none may come out the other way."""
    opinions = [ask(query, timeout=2) for one in INDUCTIVE[:6] for query in one.queries()]
    assert {opinion.agreement for opinion in opinions} <= {"agrees", "unknown"}
    assert "agrees" in {opinion.agreement for opinion in opinions}


def test_a_contradiction_between_solvers_is_seen() -> None:
    opinion = ask(replace(CONTRADICTION, expected="sat"))
    assert opinion.agreement == "disagrees"
    assert "says unsat, not sat" in str(opinion)


def test_unknown_is_said_as_such() -> None:
    pigeons = [f"(declare-const p{i}.{j} Bool)" for i in range(11) for j in range(10)]
    pigeons += [f"(assert (or {' '.join(f'p{i}.{j}' for j in range(10))}))" for i in range(11)]
    pigeons += [
        f"(assert (not (and p{i}.{j} p{k}.{j})))"
        for j in range(10)
        for i in range(11)
        for k in range(i)
    ]
    script = "\n".join(["(set-logic QF_UF)", *pigeons, "(check-sat)", ""])
    opinion = ask(Query("pigeons", script, "unsat"), timeout=0.2)
    assert opinion.agreement == "unknown"
    assert str(opinion).startswith("pigeons: cvc5 unknown (")


def test_a_script_that_it_cannot_read_is_refused() -> None:
    with pytest.raises(InputError, match="cvc5 cannot read the question broken"):
        ask(Query("broken", "(set-logic QF_UF)\n(assert (nonsense))\n(check-sat)\n", "unsat"))
    with pytest.raises(InputError, match="answers the question silent"):
        ask(Query("silent", "(set-logic QF_UF)\n", "unsat"))


def test_a_missing_cvc5_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cvc5", None)
    with pytest.raises(InputError, match=r"-m pip install 'topo-verify\[sat\]', or"):
        ask(CONTRADICTION)
