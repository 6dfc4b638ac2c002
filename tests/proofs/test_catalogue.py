"""The catalogue of theorems: names, claims, choosing."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from tests.proofs.false_statements import FALSE_STATEMENTS
from tests.proofs.first_order.refuted import AXIOM_MUTANTS
from tests.python import python
from topo_verify.checkers import CLAIMS
from topo_verify.errors import InputError
from topo_verify.proofs.catalogue import CONTROLS, FORMER, catalogue, choose
from topo_verify.proofs.first_order.theorems import INDUCTIVE

ROOT = Path(__file__).resolve().parents[2]


def test_every_obligation_has_a_mutant() -> None:
    changed = Counter(theorem.of for theorem in FALSE_STATEMENTS if theorem.kind == "mutant")
    assert all(changed[theorem.name] for theorem in INDUCTIVE)


def test_two_false_statements_remain_as_controls() -> None:
    false = [theorem for theorem in catalogue() if theorem.expected == "REFUTED"]
    assert [theorem.kind for theorem in false] == ["negative", "mutant"]
    assert {theorem.name for theorem in false} < {theorem.name for theorem in FALSE_STATEMENTS}


def test_a_false_statement_that_was_a_theorem_says_where_it_is_now() -> None:
    names = {theorem.name for theorem in FALSE_STATEMENTS}
    names -= {theorem.name for theorem in CONTROLS}
    assert names - {theorem.name for theorem in AXIOM_MUTANTS} == FORMER
    for name in names:
        with pytest.raises(InputError, match="tests/proofs"):
            choose([name])


def test_every_claim_that_a_proof_can_carry_rests_on_a_theorem() -> None:
    carried = {claim for theorem in INDUCTIVE for claim in theorem.claims}
    left = {"percepts-true", "cost-honest", "cost-within-bound", "rejection-justified"}
    assert carried == CLAIMS.keys() - left, "docs/proofs.md says why these are left"


def test_every_step_that_is_argued_stands_in_the_page_on_proofs() -> None:
    page = " ".join((ROOT / "docs" / "proofs.md").read_text(encoding="utf-8").split()).lower()
    for theorem in INDUCTIVE:
        stem = theorem.name.removesuffix("-base").removesuffix("-step")
        assert any(f"`{stem}{end}`" in page for end in ("", "-base", "-step")), theorem.name
        for step in theorem.argued:
            assert step in page, (theorem.name, step)


@pytest.mark.nightly
def test_each_question_is_a_whole_script_and_says_what_is_expected() -> None:
    for theorem in (*INDUCTIVE, *AXIOM_MUTANTS):
        for query in theorem.queries():
            assert query.smt2.startswith("(set-logic ")
            assert query.expected == ("unsat" if theorem.kind == "inductive" else "sat")


def test_a_name_is_chosen_once_and_in_the_order_given() -> None:
    names = [theorem.name for theorem in choose(["trace-step", "percept", "trace-step"])]
    assert names == ["trace-step", "percept"]


def test_a_theorem_in_coq_is_also_found_by_its_place_there() -> None:
    (theorem,) = choose(["Undirected.undirected_not_enough", "undirected_not_enough"])
    assert theorem.name == "coq-undirected-mapper"


def test_a_name_of_the_catalogue_comes_before_one_in_coq() -> None:
    chosen = [theorem.name for one in catalogue() for theorem in choose([one.name])]
    assert chosen == [theorem.name for theorem in catalogue()]


def test_no_such_theorem_is_refused_with_what_comes_near() -> None:
    with pytest.raises(InputError, match="do you mean trace-step"):
        choose(["trace-stop"])


@pytest.mark.long
def test_the_package_alone_loads_no_solver() -> None:
    code = "import topo_verify, topo_verify.cli, sys; print('z3' in sys.modules)"
    done = python("-c", code, check=True)
    assert done.stdout.strip() == "False"
