"""Bounded theorems: they hold, each premise is needed, and nothing but unsat is a pass."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import pytest

from topo_verify.errors import InputError
from topo_verify.proofs.bounded import door_steps, word_rules
from topo_verify.proofs.bounded import theorems as room
from topo_verify.proofs.bounded.cnf import REFUTED
from topo_verify.proofs.bounded.encoding import Worlds
from topo_verify.proofs.bounded.solve import solve
from topo_verify.proofs.bounded.statements import (
    ONE_DOOR_STATEMENTS,
    WHOLE_WORD_STATEMENTS,
    BoundedStatement,
)
from topo_verify.proofs.bounded.theorems import bounded, theorem
from topo_verify.proofs.theorem import Budget, Theorem
from topo_verify.world.enumeration import rank_order

BUDGET = Budget()


@pytest.mark.parametrize(
    "one", [theorem(s, range(1, 5)) for s in ONE_DOOR_STATEMENTS], ids=lambda one: one.name
)
def test_one_door_theorems_hold_in_all_worlds_up_to_four_edges(one: Theorem) -> None:
    outcome = one.prove(BUDGET)
    assert (outcome.verdict, outcome.premises_satisfiable) == ("EXHAUSTED", True)
    assert outcome.checked == outcome.total == 2 + 10 + 74 + 706
    assert one.ok(outcome)


@pytest.mark.parametrize(
    "one", [theorem(s, range(1, 4)) for s in WHOLE_WORD_STATEMENTS], ids=lambda one: one.name
)
def test_whole_words_hold_in_all_worlds_up_to_three_edges(one: Theorem) -> None:
    outcome = one.prove(BUDGET)
    assert one.ok(outcome), outcome
    assert outcome.checked == (86 if one.name == "words-confirm" else 84)


@pytest.mark.slow
@pytest.mark.parametrize("one", [t for t in bounded() if t.deep], ids=lambda one: one.name)
def test_the_deep_ones_hold_too(one: Theorem) -> None:
    assert one.ok(one.prove(Budget(timeout=300)))


NEEDED = [
    (door_steps.pose, "S.reachable"),
    (door_steps.pose, "edges"),
    (door_steps.door, "corresponding"),
    (door_steps.door, "edges"),
    (door_steps.confirm_back, "corresponding"),
    (door_steps.confirm_back, "edges"),
    (door_steps.confirm_final, "home"),
    (door_steps.confirm_final, "seen"),
    (door_steps.record, "crossed"),
    (door_steps.new_vertex, "end-unknown"),
    (door_steps.new_vertex, "S.reachable"),
    (door_steps.closed, "connected"),
    (door_steps.closed, "nothing-open"),
    (partial(word_rules.confirm, steps=3), "home"),
    (partial(word_rules.confirm, steps=3), "matching"),
    (partial(word_rules.trace_way, steps=3), "h"),
    (partial(word_rules.prefix, steps=3), "prefix"),
    (partial(word_rules.history, steps=3), "h"),
    (partial(word_rules.records, steps=2, levels=1), "retraced"),
    (partial(word_rules.records, steps=2, levels=None), "records"),
]


@pytest.mark.parametrize(("build", "premise"), NEEDED)
def test_without_this_premise_it_is_false(
    build: Callable[[int], Worlds | word_rules.EncodedCounterexample], premise: str
) -> None:
    built = build(3)
    formula = built if isinstance(built, Worlds) else built.world
    assert solve(formula, BUDGET).answer == "unsat"
    del formula.groups[premise]
    assert solve(formula, BUDGET).answer == "sat"


def _false(edges: int) -> Worlds:
    return door_steps.confirm_final(edges, marker="undirected")


def _vacuous(edges: int) -> Worlds:
    world = door_steps.closed(edges)
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
    assert solve(word_rules.history(1, 1).world, BUDGET).answer == "unsat"
    assert solve(word_rules.history(1, 1).world.premises(), BUDGET).answer == "unsat"
    assert solve(word_rules.history(2, 2).world.premises(), BUDGET).answer == "sat"


def test_unknown_is_no_pass_and_tells_the_mend() -> None:
    (confirm,) = (one for one in bounded() if one.name == "words-confirm")
    outcome = confirm.prove(Budget(rlimit=1000))
    assert outcome.verdict == "UNKNOWN"
    assert "--timeout" in outcome.note
    assert not confirm.ok(outcome)


def test_worlds_that_are_missing_in_the_encoding_are_no_pass(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def one_less(edges: int, _world_class: str) -> int:
        return rank_order.count(edges) - 1

    monkeypatch.setattr(room, "worlds_encoded", one_less)
    planted = theorem(_statement(door_steps.closed), range(1, 3))
    outcome = planted.prove(BUDGET)
    assert (outcome.checked, outcome.total) == (10, 12)
    assert not planted.ok(outcome)


@pytest.mark.parametrize("edges", [0, 7])
def test_too_many_edges_are_refused_with_a_sentence(edges: int) -> None:
    with pytest.raises(InputError, match=f"--edges {edges}: .* 1 to 6 edges"):
        bounded(edges)


def test_each_question_is_a_script_of_its_own() -> None:
    names = [query.name for one in bounded() for query in one.queries()]
    assert len(names) == len(set(names))
    (query,) = (q for one in bounded() for q in one.queries() if q.name == "bounded-closed-m1")
    assert query.smt2.startswith("(set-logic QF_UF)\n")
    assert query.smt2.endswith("(check-sat)\n")
    assert f":named {REFUTED})" in query.smt2
    assert query.expected == "unsat"
