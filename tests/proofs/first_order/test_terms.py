"""Formulas: sorts are checked, what is written is SMT-LIB, what is evaluated is what is written."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from topo_verify.proofs.first_order import finite_models, terms
from topo_verify.proofs.first_order.theorems import refute
from topo_verify.proofs.theorem import Budget

f = terms.Symbol("f", ("W",), "W")
p = terms.Symbol("p", ("W",), terms.BOOL)
a, b = terms.Var("a", "W"), terms.Var("b", "W")
c = terms.constant("c", "W")
BUDGET = Budget(timeout=10)


def test_a_wrong_sort_is_refused() -> None:
    with pytest.raises(TypeError, match="f takes"):
        f(terms.constant("k", "K"))
    with pytest.raises(TypeError, match="= between"):
        terms.eq(c, terms.constant("k", "K"))


def test_a_formula_is_written_as_smt_lib_and_for_people() -> None:
    term = terms.forall((a, b), terms.eq(f(a), f(b)), terms.eq(a, b))
    assert terms.text(term) == "(forall ((a W) (b W)) (=> (= (f a) (f b)) (= a b)))"
    assert terms.shown(term) == "∀a,b: (f(a) = f(b)) → (a = b)"
    assert terms.shown(terms.neg(terms.eq(a, b))) == "a ≠ b"


def test_a_pattern_means_nothing_and_is_written() -> None:
    term = terms.forall(a, p(a), tried_at=((f(a),),))
    assert terms.text(term) == "(forall ((a W)) (! (p a) :pattern ((f a))))"
    assert terms.shown(term) == terms.shown(terms.forall(a, p(a)))


def test_a_script_declares_what_it_uses() -> None:
    lines = terms.script({"one": p(f(c))}).splitlines()
    assert lines == [
        "(set-logic UF)",
        "(declare-sort W 0)",
        "(declare-fun c () W)",
        "(declare-fun f (W) W)",
        "(declare-fun p (W) Bool)",
        "(assert (! (p (f c)) :named one))",
        "(check-sat)",
    ]


def test_an_assertion_may_not_be_called_like_a_symbol() -> None:
    with pytest.raises(TypeError, match="p: an assertion is called like a symbol"):
        terms.script({"p": p(c)})


def test_one_name_means_one_symbol() -> None:
    with pytest.raises(TypeError, match="two symbols are called f"):
        terms.script({"one": terms.eq(f(c), c), "two": terms.Symbol("f", ("W",), terms.BOOL)(c)})


def test_bound_variables_are_not_replaced() -> None:
    term = terms.conj(p(a), terms.forall(a, p(a)))
    assert terms.substitute(term, {a: c}) == terms.conj(p(c), terms.forall(a, p(a)))


def formulas() -> st.SearchStrategy[terms.Term]:
    """Formulas about one constant, f and p."""
    places = st.sampled_from([c, f(c), f(f(c))])
    atoms = st.one_of(places.map(p), st.tuples(places, places).map(lambda row: terms.eq(*row)))
    quantified = st.sampled_from(
        [
            terms.forall(a, p(a)),
            terms.forall(a, terms.differ(f(a), a)),
            terms.forall((a, b), terms.eq(f(a), f(b)), terms.eq(a, b)),
        ]
    )

    def larger(inner: st.SearchStrategy[terms.Term]) -> st.SearchStrategy[terms.Term]:
        two = st.tuples(inner, inner)
        return st.one_of(
            inner.map(terms.neg),
            two.map(lambda row: terms.conj(*row)),
            two.map(lambda row: terms.disj(*row)),
            two.map(lambda row: terms.implies(*row)),
            two.map(lambda row: terms.eq(*row)),
        )

    return st.recursive(st.one_of(atoms, quantified), larger, max_leaves=6)


@pytest.mark.nightly
@given(
    formula=formulas(),
    of_f=st.tuples(st.integers(0, 1), st.integers(0, 1)),
    of_p=st.tuples(st.booleans(), st.booleans()),
)
def test_evaluation_and_solver_agree(
    formula: terms.Term, of_f: tuple[int, int], of_p: tuple[bool, bool]
) -> None:
    """In a structure that is spelt out, a formula holds iff Z3 finds it possible there."""
    element = [finite_models.element("W", number) for number in range(2)]
    spelt = [terms.eq(c, element[0])]
    for place in range(2):
        spelt.append(terms.eq(f(element[place]), element[of_f[place]]))
        spelt.append(p(element[place]) if of_p[place] else terms.neg(p(element[place])))
    structure = terms.of_tables(
        {"W": 2}, {"c": {(): 0}, "f": dict(enumerate_rows(of_f)), "p": dict(enumerate_rows(of_p))}
    )
    possible = finite_models.model([*spelt, formula], {"W": 2}, BUDGET).answer
    assert possible == ("sat" if structure.holds(formula) else "unsat")


def enumerate_rows(values: tuple[int, ...]) -> list[tuple[tuple[int, ...], int]]:
    return [((place,), value) for place, value in enumerate(values)]


def test_what_cannot_hold_together_is_named() -> None:
    reply = refute(
        {"all": terms.forall(a, p(a)), "none": terms.neg(p(c)), "idle": terms.eq(f(c), c)}, BUDGET
    )
    assert (reply.answer, reply.core) == ("unsat", ("all", "none"))


def test_what_z3_cannot_decide_is_unknown_with_a_reason() -> None:
    reply = refute({"possible": terms.forall(a, p(f(a)))}, BUDGET)
    assert reply.answer != "unsat"
    assert reply.answer == "sat" or reply.why
