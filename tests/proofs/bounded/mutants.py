"""What a world must refute, as theorems: each negative, and each rule with one mistake."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from tests.proofs.bounded.rejections import replay_rejection
from topo_verify.errors import plural
from topo_verify.proofs.bounded import encoding as enc
from topo_verify.proofs.bounded import statements
from topo_verify.proofs.bounded.confirmations import SMALLEST, negative, refute, script
from topo_verify.proofs.bounded.replay import (
    BoundedCounterexample,
    ReplayedCounterexample,
    replay_confirmation,
)
from topo_verify.proofs.bounded.statements import EncodedCounterexample
from topo_verify.proofs.theorem import Theorem, one_query, timed


@dataclass(frozen=True, slots=True)
class _FaultyRule:
    rule: str
    fault: enc.RuleFault | enc.MarkerDetail
    edges: int
    mistake: str


_RULES: dict[str, Callable[..., EncodedCounterexample]] = {
    "confirm": statements.confirm,
    "trace": statements.trace_way,
    "prefix": statements.prefix,
    "history": statements.history,
    "records-one": partial(statements.records, levels=1),
    "records-all": partial(statements.records, levels=None),
}

_LATER = "each percept is compared with the one behind the next door"
_FIRST_DART = "sequences are traced again from the vertex's first dart"

_FAULTY_RULES = (
    _FaultyRule(
        "confirm", "undirected", 2, "the last percept is compared without the marker's direction"
    ),
    _FaultyRule("confirm", "none", 2, "the last percept is compared without the marker"),
    _FaultyRule(
        "trace", "turned", 2, "after an excursion it is forgotten that the reference dart is turned"
    ),
    _FaultyRule("trace", "shifted", 2, _LATER),
    _FaultyRule("prefix", "one-more", 2, "the door behind the common prefix is compared too"),
    _FaultyRule(
        "history",
        "through-unexplored",
        1,
        "an unexplored dart is traced as if it led back to itself",
    ),
    _FaultyRule("history", "absolute-doors", 2, "doors are counted from the vertex's first dart"),
    _FaultyRule("history", "shifted", 2, _LATER),
    _FaultyRule("records-one", "first-dart", 2, _FIRST_DART),
    _FaultyRule("records-all", "first-dart", 2, _FIRST_DART),
)


def _mutant(case: _FaultyRule) -> Theorem:
    confirms = case.rule == "confirm"
    name = f"words-{case.rule}-{case.fault}"
    mistake = {"marker" if confirms else "fault": case.fault}
    build = partial(_RULES[case.rule], case.edges, case.edges, **mistake)
    return Theorem(
        name=name,
        kind="mutant",
        claims=("no-false-confirm" if confirms else "true-hypothesis-kept",),
        words=f"Rule {case.rule} with a fault goes wrong: {case.mistake}.",
        symbols="h ≠ alpha(e) is confirmed" if confirms else "h = alpha(e) is rejected",
        solver_part=f"finds a world with {plural(case.edges, 'edge')}, a map and doors",
        expected="REFUTED",
        prove=timed(partial(refute, build, _replay_of(case))),
        queries=one_query(name, partial(script, build), "sat"),
        edges=case.edges,
        of=f"words-{case.rule}",
    )


def _replay_of(case: _FaultyRule) -> Callable[[BoundedCounterexample], ReplayedCounterexample]:
    match case.fault:
        case "directed" | "undirected" | "none" as marker:
            return partial(replay_confirmation, marker=marker, whole=False)
        case fault:
            return partial(replay_rejection, rule=case.rule.split("-")[0], fault=fault)


NEGATIVES: tuple[Theorem, ...] = tuple(map(negative, SMALLEST))
"""Each negative as a theorem about its smallest size."""

MUTANTS: tuple[Theorem, ...] = tuple(map(_mutant, _FAULTY_RULES))
"""Each faulty rule as a theorem about the smallest worlds in which it fails."""
