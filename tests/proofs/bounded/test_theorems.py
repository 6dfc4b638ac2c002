"""Bounded theorems: they hold, each premise is needed, and nothing but unsat is a pass.

The worlds of their encoding are the rooted maps, each exactly once.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from unittest.mock import Mock

import pytest

from tests.marks import with_marks
from topo_verify.errors import InputError
from topo_verify.proofs.bounded import statements, theorems
from topo_verify.proofs.bounded.cnf import REFUTED, SolverGaveUp, solve
from topo_verify.proofs.bounded.encoding import Worlds
from topo_verify.proofs.bounded.statements import (
    ONE_DOOR_STATEMENTS,
    WHOLE_WORD_STATEMENTS,
    BoundedStatement,
)
from topo_verify.proofs.bounded.theorems import (
    bounded,
    codes,
    every_world,
    joint_certificate,
    missing_and_spurious,
    theorem,
    worlds_theorem,
)
from topo_verify.proofs.theorem import Budget, RefutationCertificate, Theorem
from topo_verify.world.enumeration import rank_order

BUDGET = Budget()


@pytest.mark.parametrize(
    "one",
    with_marks(
        (theorem(s, range(1, 5)) for s in ONE_DOOR_STATEMENTS),
        long=["bounded-door", "bounded-confirm-back"],
        nightly=["bounded-pose"],
    ),
    ids=lambda one: one.name,
)
def test_one_door_theorems_hold_in_all_worlds_up_to_four_edges(one: Theorem) -> None:
    outcome = one.prove(BUDGET)
    assert (outcome.verdict, outcome.premises_satisfiable) == ("EXHAUSTED", True)
    assert outcome.checked == outcome.total == 2 + 10 + 74 + 706
    assert one.ok(outcome)


@pytest.mark.parametrize(
    "one",
    with_marks(
        (theorem(s, range(1, 4)) for s in WHOLE_WORD_STATEMENTS),
        long=["words-records-one"],
        nightly=["words-records-all"],
    ),
    ids=lambda one: one.name,
)
def test_whole_words_hold_in_all_worlds_up_to_three_edges(one: Theorem) -> None:
    outcome = one.prove(BUDGET)
    assert one.ok(outcome), outcome
    assert outcome.checked == (86 if one.name == "words-confirm" else 84)


@pytest.mark.nightly
@pytest.mark.parametrize("one", [t for t in bounded() if t.deep], ids=lambda one: one.name)
def test_the_deep_ones_hold_too(one: Theorem) -> None:
    assert one.ok(one.prove(Budget(timeout=300)))


NEEDED = [
    (statements.pose, "S.reachable"),
    (statements.pose, "edges"),
    (statements.door, "corresponding"),
    (statements.door, "edges"),
    (statements.confirm_back, "corresponding"),
    (statements.confirm_back, "edges"),
    (statements.confirm_final, "home"),
    (statements.confirm_final, "seen"),
    (statements.record, "crossed"),
    (statements.new_vertex, "end-unknown"),
    (statements.new_vertex, "S.reachable"),
    (statements.closed, "connected"),
    (statements.closed, "nothing-open"),
    (partial(statements.confirm, steps=3), "home"),
    (partial(statements.confirm, steps=3), "matching"),
    (partial(statements.trace_way, steps=3), "h"),
    (partial(statements.prefix, steps=3), "prefix"),
    (partial(statements.history, steps=3), "h"),
    (partial(statements.records, steps=2, levels=1), "retraced"),
    (partial(statements.records, steps=2, levels=None), "records"),
]


@pytest.mark.parametrize(("build", "premise"), NEEDED)
def test_without_this_premise_it_is_false(
    build: Callable[[int], Worlds | statements.EncodedCounterexample], premise: str
) -> None:
    built = build(3)
    formula = built if isinstance(built, Worlds) else built.world
    assert solve(formula, BUDGET).answer == "unsat"
    del formula.groups[premise]
    assert solve(formula, BUDGET).answer == "sat"


def _false(edges: int) -> Worlds:
    return statements.confirm_final(edges, marker="undirected")


def _vacuous(edges: int) -> Worlds:
    world = statements.closed(edges)
    world.add("fault", -world.first[0])
    return world


def _statement(refuted: Callable[[int], Worlds]) -> BoundedStatement:
    return BoundedStatement(name="planted", claims=(), words="", symbols="", refuted=refuted)


def test_a_false_theorem_is_refuted_by_a_world() -> None:
    planted = theorem(_statement(_false), range(1, 4))
    outcome = planted.prove(BUDGET)
    assert (outcome.verdict, outcome.counterexample) == ("REFUTED", "m1/1")
    assert not planted.ok(outcome)


def test_a_vacuous_theorem_is_no_pass() -> None:
    planted = theorem(_statement(_vacuous), range(1, 3))
    outcome = planted.prove(BUDGET)
    assert (outcome.verdict, outcome.premises_satisfiable) == ("EXHAUSTED", False)
    assert not planted.ok(outcome)


def test_a_theorem_on_words_is_vacuous_where_no_word_is_compared() -> None:
    assert solve(statements.history(1, 1).world, BUDGET).answer == "unsat"
    assert solve(statements.history(1, 1).world.premises(), BUDGET).answer == "unsat"
    assert solve(statements.history(2, 2).world.premises(), BUDGET).answer == "sat"


def test_unknown_is_no_pass_and_tells_the_mend() -> None:
    (confirm,) = (one for one in bounded() if one.name == "words-confirm")
    outcome = confirm.prove(Budget(rlimit=1000))
    assert outcome.verdict == "UNKNOWN"
    assert "--timeout" in outcome.note
    assert not confirm.ok(outcome)


def test_worlds_that_are_missing_in_the_encoding_are_no_pass(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(theorems, "worlds_encoded", Mock(side_effect=[1, 9]))
    planted = theorem(_statement(statements.closed), range(1, 3))
    outcome = planted.prove(BUDGET)
    assert (outcome.checked, outcome.total) == (10, 12)
    assert not planted.ok(outcome)


@pytest.mark.parametrize("edges", [0, 7])
def test_too_many_edges_are_refused_with_a_sentence(edges: int) -> None:
    with pytest.raises(InputError, match=f"--edges {edges}: .* 1 to 6 edges"):
        bounded(edges)


@pytest.mark.long
def test_each_question_is_a_script_of_its_own() -> None:
    names = [query.name for one in bounded() for query in one.queries()]
    assert len(names) == len(set(names))
    (query,) = (q for one in bounded() for q in one.queries() if q.name == "bounded-closed-m1")
    assert query.smt2.startswith("(set-logic QF_UF)\n")
    assert query.smt2.endswith("(check-sat)\n")
    assert f":named {REFUTED})" in query.smt2
    assert query.expected == "unsat"


@pytest.mark.nightly
@pytest.mark.parametrize(("edges", "worlds"), [(1, 2), (2, 10), (3, 74), (4, 706)])
def test_the_models_are_exactly_the_canonical_codes(edges: int, worlds: int) -> None:
    found = list(codes(edges))
    assert len(found) == worlds
    assert set(found) == set(rank_order.tables(edges))


@pytest.mark.nightly
def test_with_five_edges_too() -> None:
    assert missing_and_spurious(5) == (8162, [], [])


@pytest.mark.parametrize(
    ("world_class", "worlds"), [("loopless", [1, 3, 14, 87]), ("simple", [1, 2, 6, 23])]
)
def test_a_class_is_the_class_of_the_enumeration(world_class: str, worlds: list[int]) -> None:
    for edges, total in enumerate(worlds, 1):
        assert missing_and_spurious(edges, world_class) == (total, [], [])


def _without(group: str) -> Callable[[int, str], Worlds]:
    def build(edges: int, world_class: str = "any") -> Worlds:
        world = every_world(edges, world_class)
        del world.groups[group]
        return world

    return build


def _one_world_less(edges: int, world_class: str = "any") -> Worlds:
    world = every_world(edges, world_class)
    world.add("fault", -world.edge(0, 1))
    return world


@pytest.mark.parametrize("group", ["numbering", "connected"])
def test_an_encoding_that_forgets_a_premise_has_spurious_models(
    group: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(theorems, "every_world", _without(group))
    found, missing, spurious = missing_and_spurious(3)
    assert (found > 74, missing, bool(spurious)) == (True, [], True)


def test_an_encoding_that_loses_a_world_is_refuted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(theorems, "every_world", _one_world_less)
    theorem = worlds_theorem("bounded-worlds", range(1, 4))
    outcome = theorem.prove(Budget())
    assert outcome.verdict == "REFUTED"
    assert not theorem.ok(outcome)
    assert outcome.checked != outcome.total


def test_a_solver_that_gives_up_has_not_listed_all() -> None:
    with pytest.raises(SolverGaveUp):
        list(codes(4, budget=Budget(rlimit=1)))


def test_several_certificates_are_checked_only_if_all_are() -> None:
    good = RefutationCertificate(format="drup", checker="drup", checked=True, clauses=2, steps=3)
    bad = replace(good, checked=False, why="refused")
    assert joint_certificate([good, good]) == replace(good, clauses=4, steps=6)
    joint = joint_certificate([good, bad])
    assert (joint.checked, joint.why) == (False, "refused")
