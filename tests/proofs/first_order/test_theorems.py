"""The inductive obligations: proved, not vacuous, and each premise that is named is needed."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from tests.proofs.first_order.refuted import AXIOM_MUTANTS
from topo_verify.checkers import CLAIMS
from topo_verify.proofs.first_order import finite_models, theorems
from topo_verify.proofs.first_order.obligations import A, B, Obligation, X
from topo_verify.proofs.first_order.terms import Term, eq, neg
from topo_verify.proofs.first_order.theory import AXIOMS, LEMMAS, phi
from topo_verify.proofs.theorem import Budget, RefutationCertificate, Theorem, TheoremResult

NAMES = [obligation.name for obligation in theorems.OBLIGATIONS]
BY_NAME = {obligation.name: obligation for obligation in theorems.OBLIGATIONS}
BUDGET = Budget(timeout=60)
REFUSED = RefutationCertificate(
    format="drup", checker="a checker", checked=False, why="a step does not follow"
)


@pytest.mark.parametrize("one", theorems.INDUCTIVE, ids=NAMES)
def test_it_is_proved_and_its_premises_can_hold(one: Theorem) -> None:
    outcome = one.prove(BUDGET)
    assert (outcome.verdict, outcome.premises_satisfiable) == ("PROVED", True), outcome.note
    assert one.ok(outcome)


@pytest.mark.parametrize("one", AXIOM_MUTANTS, ids=lambda one: one.name)
def test_its_mutant_is_refuted_by_a_structure(one: Theorem) -> None:
    outcome = one.prove(BUDGET)
    assert outcome.verdict == "REFUTED", outcome.note
    assert outcome.counterexample
    assert one.ok(outcome)


@pytest.mark.nightly
@pytest.mark.parametrize("one", theorems.OBLIGATIONS, ids=NAMES)
def test_every_premise_that_is_named_is_needed(one: Obligation) -> None:
    for lost in one.needs:
        assert theorems.mutant(one, lost).prove(BUDGET).verdict == "REFUTED", lost


def test_each_rule_and_each_augmentation_has_its_theorem() -> None:
    wanted = {
        *("motion-keeps", "prefix-keeps", "history-keeps", "records-one-level-keep"),
        *("records-all-levels-keep", "posed", "new-is-new", "loop-edges", "new-edges"),
        *("fold-hypothesis", "fold-closed-onto"),
    }
    assert wanted <= set(NAMES)
    assert not [name for name in NAMES if "planar" in name], "it must not be provable"


def test_inductions_come_as_base_and_step() -> None:
    for name in NAMES:
        if name.endswith("-step"):
            assert name == "trace-step" or name.replace("-step", "-base") in NAMES


def test_every_lemma_that_is_used_was_proved_before_it_is_used() -> None:
    proved: set[str] = set()
    for obligation in theorems.OBLIGATIONS:
        for name in obligation.theory:
            if name in LEMMAS:
                assert f"{LEMMAS[name]}-base" in proved, (obligation.name, name)
                assert f"{LEMMAS[name]}-step" in proved, (obligation.name, name)
        proved.add(obligation.name)


def test_a_lemma_says_what_its_induction_proves() -> None:
    """The statement at k0 of each induction over doors is the lemma at k0."""
    for lemma, name in LEMMAS.items():
        if name == "word-trace":
            continue
        base = BY_NAME[f"{name}-base"]
        premises = {"lemma": AXIOMS[lemma], "base-fails": neg(base.goal)}
        assert theorems.refute(premises, BUDGET).answer == "unsat", lemma
        step = BY_NAME[f"{name}-step"]
        premises = {"lemma": AXIOMS[lemma], "step-fails": neg(step.goal)}
        if lemma != "turning-adds":
            assert theorems.refute(premises, BUDGET).answer == "unsat", lemma


def test_the_claims_that_rest_on_them_are_claims() -> None:
    for one in theorems.INDUCTIVE:
        assert one.claims
        assert set(one.claims) <= set(CLAIMS)


def test_the_core_names_premises_only() -> None:
    one = next(one for one in theorems.INDUCTIVE if one.name == "confirm-conclude")
    assert one.prove(BUDGET).core == ("alpha-involution", "behind-e", "same-place")


# ---------------------------------------------------------------- checks that can fail


def spoiled(name: str = "spoiled", **given: Term) -> Theorem:
    """An obligation that does not follow, as a theorem; it has these premises more."""
    return theorems.theorem(
        Obligation(
            name=name,
            words="",
            claims=("no-false-confirm",),
            theory=("phi-injective",),
            goal=eq(A, B),
            given=given,
            needs=(),
        )
    )


def test_what_does_not_follow_is_unknown_and_no_pass() -> None:
    one = spoiled()
    outcome = one.prove(BUDGET)
    assert outcome.verdict == "UNKNOWN"
    assert "unknown" in outcome.note or "sat" in outcome.note
    assert one.status(outcome) == "open"


def test_a_vacuous_theorem_is_proved_and_no_pass() -> None:
    one = spoiled(absurd=neg(eq(A, A)))
    outcome = one.prove(BUDGET)
    assert (outcome.verdict, outcome.premises_satisfiable) == ("PROVED", False)
    assert one.status(outcome) == "open"


def test_a_time_out_is_unknown() -> None:
    hard = BY_NAME["history-keeps"]
    outcome = theorems.theorem(hard).prove(Budget(timeout=60, rlimit=1))
    assert outcome.verdict == "UNKNOWN"


def test_a_mutant_that_holds_is_not_refuted() -> None:
    one = theorems.mutant(BY_NAME["confirm-final"], "map-v0-sees-root")  # the others imply it
    outcome = one.prove(BUDGET)
    assert outcome.verdict != "REFUTED"
    assert one.status(outcome) == "failed"


@pytest.mark.parametrize(
    ("outcome", "status"),
    [
        (TheoremResult(verdict="PROVED", solver="", premises_satisfiable=True), "ok"),
        (TheoremResult(verdict="PROVED", solver="", premises_satisfiable=None), "open"),
        (TheoremResult(verdict="UNKNOWN", solver=""), "open"),
        (TheoremResult(verdict="REFUTED", solver=""), "failed"),
    ],
)
def test_only_an_expected_and_complete_result_is_ok(outcome: TheoremResult, status: str) -> None:
    one = theorems.INDUCTIVE[0]
    assert one.status(outcome) == status
    verdicts = {"ok": "PROVED", "open": "UNKNOWN", "failed": "REFUTED"}
    assert one.reported(outcome).verdict == verdicts[status]


@pytest.mark.parametrize(
    ("facts", "why"),
    [
        ({"premises_satisfiable": False}, "its premises cannot hold at once: vacuous"),
        ({"premises_satisfiable": None}, "its premises are not shown satisfiable"),
        ({"replayed": (1, 2)}, "the simulator replayed 1 of 2 models"),
        ({"replayed": (0, 0)}, "the simulator replayed 0 of 0 models"),
        ({"checked": 3, "total": 4}, "3 of 4 worlds were checked"),
        ({"certificate": REFUSED}, "the checker refused the certificate: a step does not follow"),
    ],
)
def test_an_expected_verdict_that_does_not_stand_is_reported_as_unknown(
    facts: dict[str, Any], why: str
) -> None:
    proved = TheoremResult(verdict="PROVED", solver="", premises_satisfiable=True)
    outcome = replace(proved, **facts)
    reported = theorems.INDUCTIVE[0].reported(outcome)
    assert (reported.verdict, reported.note) == ("UNKNOWN", why)
    outcome = replace(outcome, note="the solver ran long")
    assert theorems.INDUCTIVE[0].reported(outcome).note == f"the solver ran long; {why}"


def test_a_structure_that_is_none_is_a_bug() -> None:
    found = finite_models.model([eq(phi(X), A), neg(eq(A, B))], {"M": 1, "W": 2}, BUDGET)
    assert found.structure is not None
    assert found.structure.holds(neg(eq(A, B)))
    assert not found.structure.holds(eq(A, B))
