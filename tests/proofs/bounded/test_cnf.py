"""Clauses: what the building blocks say, and that all solvers read the same."""

from __future__ import annotations

from itertools import product

import pytest

from topo_verify.proofs.bounded import statements
from topo_verify.proofs.bounded.cnf import REFUTED, Formula, first_model, models, solve
from topo_verify.proofs.theorem import Budget

BUDGET = Budget()


def satisfying(formula: Formula, names: int) -> set[tuple[bool, ...]]:
    """The assignments of the first names that can be completed, by trying them all."""
    total = len(formula.names)
    found = set[tuple[bool, ...]]()
    for values in product([False, True], repeat=total):
        if all(any(values[abs(x) - 1] == (x > 0) for x in clause) for clause in formula.clauses):
            found.add(values[:names])
    return found


def test_one_hot_rows_have_exactly_one_true() -> None:
    formula = Formula()
    formula.row("row", "row", 3)
    assert satisfying(formula, 3) == {
        (True, False, False),
        (False, True, False),
        (False, False, True),
    }


@pytest.mark.parametrize("kind", ["and", "or"])
def test_a_defined_boolean_is_what_its_definition_says(kind: str) -> None:
    formula = Formula()
    a, b = formula.booleans("x", 2)
    defined = (formula.define_and if kind == "and" else formula.define_or)("d", "both", [a, b])
    meant = all if kind == "and" else any
    positive = defined > 0
    assert satisfying(formula, 3) == {
        (x, y, meant((x, y)) == positive) for x, y in product([False, True], repeat=2)
    }


def test_equal_is_equal() -> None:
    formula = Formula()
    one, other = formula.row("r", "one", 2), formula.row("r", "other", 2)
    formula.define_equal("d", "same", one, other)
    assert satisfying(formula, 5) == {
        (a, not a, b, not b, a == b) for a, b in product([False, True], repeat=2)
    }


def test_the_premises_are_all_but_the_negated_conclusion() -> None:
    formula = statements.closed(2)
    alone = formula.premises()
    assert REFUTED in formula.groups
    assert REFUTED not in alone.groups
    assert len(alone.clauses) < len(formula.clauses)


def test_the_first_model_is_the_first_of_all_models() -> None:
    formula = Formula()
    row = formula.booleans("x", 4)
    formula.add("some", *row)
    formula.add("not-both", -row[0], -row[2])
    every = [[model.holds(x) for x in row] for model in models(formula, row, BUDGET)]
    assert len(every) == len(satisfying(formula, 4))
    first = first_model(formula, row, BUDGET).model
    assert first is not None
    assert [first.holds(x) for x in row] == max(every)


def test_a_contradiction_has_no_first_model() -> None:
    formula = Formula()
    (x,) = formula.booleans("x", 1)
    formula.add("yes", x)
    formula.add("no", -x)
    assert first_model(formula, (x,), BUDGET).answer == "unsat"
    assert solve(formula, BUDGET).core == ("no", "yes")
