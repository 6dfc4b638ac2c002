"""Theorems that must be refuted by a world: the negatives, and rules with one mistake.

    negative   a mapper that ignores the direction, or the whole, of the marker confirms a false
               hypothesis: in the smallest worlds of their class (`negatives`)
    mutant     a rule with a fault (`walks.RuleFault`) confirms a false hypothesis, or rejects the
               true one

The solver finds a world, a map and doors. Then the simulator repeats them, and the checkers must
find that the claim fails (`replay.py`). A model that does not replay is a bug, and raises.

Source: docs/semantics.md, sections 7 and 10.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from time import perf_counter

from topo_verify.proofs.bounded import negatives, word_rules
from topo_verify.proofs.bounded.decode import BoundedCounterexample, decode, decoded_booleans
from topo_verify.proofs.bounded.encoding import MarkerDetail
from topo_verify.proofs.bounded.replay import (
    ReplayedCounterexample,
    replay_confirmation,
    replay_rejection,
)
from topo_verify.proofs.bounded.solve import first_model
from topo_verify.proofs.bounded.walks import RuleFault
from topo_verify.proofs.bounded.word_rules import EncodedCounterexample
from topo_verify.proofs.solvers.z3_solver import name as solver_name
from topo_verify.proofs.theorem import Budget, Query, Theorem, TheoremResult


@dataclass(frozen=True, slots=True)
class _FaultyRule:
    """A rule with one mistake: its name, the fault, the edges of its smallest counterexample."""

    rule: str
    fault: RuleFault | MarkerDetail
    edges: int
    build: Callable[[int, int], EncodedCounterexample]
    mistake: str


def negative_theorems() -> tuple[Theorem, ...]:
    """Every negative as a theorem about its smallest size."""
    return tuple(map(_negative, negatives.SMALLEST))


def mutant_theorems() -> tuple[Theorem, ...]:
    """Every faulty rule as a theorem about the smallest worlds in which it fails."""
    return tuple(map(_mutant, _MUTANTS))


def _negative(case: negatives.Negative) -> Theorem:
    build = partial(negatives.false_confirmation, case.edges, case.world_class, case.marker)
    return Theorem(
        name=case.name,
        kind="negative",
        claims=("no-false-confirm",),
        words=f"{case.statement} {case.edges} edges are enough.",
        symbols="every percept on a shortest way home as expected ∧ h ≠ alpha(e)",
        solver_part=f"finds a world with {case.edges} edges, a map and a hypothesis",
        expected="REFUTED",
        prove=partial(_refute, build, partial(replay_confirmation, marker=case.marker)),
        queries=partial(_queries, case.name, build),
        edges=case.edges,
    )


_MUTANTS = (
    _FaultyRule(
        "confirm",
        "undirected",
        2,
        partial(word_rules.confirm, marker="undirected"),
        "the last percept is compared without the marker's direction",
    ),
    _FaultyRule(
        "confirm",
        "none",
        2,
        partial(word_rules.confirm, marker="none"),
        "the last percept is compared without the marker",
    ),
    _FaultyRule(
        "trace",
        "turned",
        2,
        partial(word_rules.trace_way, fault="turned"),
        "after an excursion it is forgotten that the reference dart is turned",
    ),
    _FaultyRule(
        "trace",
        "shifted",
        2,
        partial(word_rules.trace_way, fault="shifted"),
        "each percept is compared with the one behind the next door",
    ),
    _FaultyRule(
        "prefix",
        "one-more",
        2,
        partial(word_rules.prefix, fault="one-more"),
        "the door behind the common prefix is compared too",
    ),
    _FaultyRule(
        "history",
        "through-unexplored",
        1,
        partial(word_rules.history, fault="through-unexplored"),
        "an unexplored dart is traced as if it led back to itself",
    ),
    _FaultyRule(
        "history",
        "absolute-doors",
        2,
        partial(word_rules.history, fault="absolute-doors"),
        "doors are counted from the vertex's first dart",
    ),
    _FaultyRule(
        "history",
        "shifted",
        2,
        partial(word_rules.history, fault="shifted"),
        "each percept is compared with the one behind the next door",
    ),
    _FaultyRule(
        "records-one",
        "first-dart",
        2,
        partial(word_rules.records, levels=1, fault="first-dart"),
        "sequences are traced again from the vertex's first dart",
    ),
    _FaultyRule(
        "records-all",
        "first-dart",
        2,
        partial(word_rules.records, levels=None, fault="first-dart"),
        "sequences are traced again from the vertex's first dart",
    ),
)


def _mutant(case: _FaultyRule) -> Theorem:
    confirms = case.rule == "confirm"
    name = f"words-{case.rule}-{case.fault}"
    # Words of as many doors as there are edges, as in the theorem that is changed.
    build = partial(case.build, case.edges, case.edges)
    return Theorem(
        name=name,
        kind="mutant",
        claims=("no-false-confirm" if confirms else "true-hypothesis-kept",),
        words=f"Rule {case.rule} with a fault goes wrong: {case.mistake}.",
        symbols="h ≠ alpha(e) is confirmed" if confirms else "h = alpha(e) is rejected",
        solver_part=f"finds a world with {_edges(case.edges)}, a map and doors",
        expected="REFUTED",
        prove=partial(_refute, build, _replay_of(case)),
        queries=partial(_queries, name, build),
        edges=case.edges,
        of=f"words-{case.rule}",
    )


def _replay_of(case: _FaultyRule) -> Callable[[BoundedCounterexample], ReplayedCounterexample]:
    # A fault of `confirm` is how much of the marker is compared; any other is a `RuleFault`.
    match case.fault:
        case "directed" | "undirected" | "none" as marker:
            return partial(replay_confirmation, marker=marker, whole=False)
        case fault:
            return partial(replay_rejection, rule=case.rule.split("-")[0], fault=fault)


def _refute(
    build: Callable[[], EncodedCounterexample],
    replay: Callable[[BoundedCounterexample], ReplayedCounterexample],
    budget: Budget,
) -> TheoremResult:
    """The result of looking for a model; one that is found is decoded and replayed."""
    began = perf_counter()
    encoded = build()
    result = first_model(encoded.world, decoded_booleans(encoded), budget)
    if result.model is None:
        # No model: the mutant was not refuted, and EXHAUSTED is not what is expected of it.
        exhausted = result.answer == "unsat"
        return TheoremResult(
            verdict="EXHAUSTED" if exhausted else "UNKNOWN",
            solver=solver_name(),
            seconds=perf_counter() - began,
            note="there is no such world" if exhausted else f"{result.why}; more time: --timeout",
        )
    replayed = replay(decode(encoded, result.model))
    return TheoremResult(
        verdict="REFUTED",
        solver=solver_name(),
        seconds=perf_counter() - began,
        replayed=(1, 1),
        counterexample=replayed.world.id,
        history=replayed.doors,
        note=f"{replayed.claim} fails in {replayed.world.id} at event {replayed.event}",
    )


def _queries(name: str, build: Callable[[], EncodedCounterexample]) -> Iterator[Query]:
    yield Query(name, build().world.smt2() + "(check-sat)\n", "sat")


def _edges(edges: int) -> str:
    return f"{edges} edge{'s' * (edges > 1)}"
