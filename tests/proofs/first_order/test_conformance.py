"""The link to the code: what Z3 is given decides as the algorithms do, and a change is seen."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from random import Random
from typing import Any

import pytest

from tests.helpers import trace_of, variant, worlds
from tests.proofs.first_order.conformance import DescribedRule, compare
from topo_verify import World, families
from topo_verify.algorithms import exploration, rules
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.exploration import hypotheses as exploration_hypotheses
from topo_verify.algorithms.motion import Executed, Hypothesis, common_prefix
from topo_verify.algorithms.rules import HistoryRule, PrefixRule, RecordsRule
from topo_verify.proofs.first_order.terms import conj, neg
from topo_verify.proofs.first_order.theory import RULES
from topo_verify.robot.events import Reject, Trace
from topo_verify.world.enumeration import rank_order

DESCRIBED: dict[str, tuple[str, int | None]] = {
    "basic": ("none", None),
    "enhancement-i": ("prefix", None),
    "enhancement-ii": ("history", None),
    "enhancement-ii+i": ("history", None),
    "enhancement-iii-one": ("records", 1),
    "enhancement-iii-one+i": ("records", 1),
    "enhancement-iii-all": ("records", None),
    "enhancement-iii-all+i": ("records", None),
}


def differences(trace: Trace, name: str, **more: object) -> list[str]:
    """Where a run decides otherwise than the described rules of this algorithm."""
    rule, levels = DESCRIBED[name]
    return list(compare(trace, DescribedRule(rule, levels, **more)))  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]


def alike_places() -> Iterator[World]:
    """Lattices, where many places look alike for long."""
    return (families.lattice(5, 5, holes=0.2, seed=seed) for seed in range(6))


def rejections(traces: Sequence[Trace]) -> int:
    return sum(isinstance(event, Reject) for trace in traces for event in trace)


@pytest.mark.long
@pytest.mark.parametrize("name", DESCRIBED)
def test_every_decision_in_every_world_to_four_edges(name: str) -> None:
    traces = [trace_of(world, name) for world in worlds(range(1, 5))]
    assert rejections(traces) == 1817  # all false hypotheses of 792 worlds
    for trace in traces:
        assert not differences(trace, name)


@pytest.mark.nightly
@pytest.mark.parametrize("name", DESCRIBED)
def test_every_decision_in_every_world_of_five_edges(name: str) -> None:
    for world in worlds([5]):
        assert not differences(trace_of(world, name), name), world.id


@pytest.mark.parametrize("name", DESCRIBED)
def test_every_decision_in_some_lattices(name: str) -> None:
    for world in alike_places():
        assert not differences(trace_of(world, name), name)


@pytest.mark.parametrize("number", [12, pytest.param(500, marks=pytest.mark.nightly)])
@pytest.mark.parametrize("name", DESCRIBED)
def test_every_decision_in_generated_worlds(name: str, number: int) -> None:
    random = Random(0)
    for _ in range(number):
        world = World.from_code(rank_order.sample(random.randint(6, 20), random))
        assert not differences(trace_of(world, name), name), world.id


# ---------------------------------------------------------------- a change makes it fail


class LazyPrefix(PrefixRule):
    """Knows nothing of the last door that is shared."""

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        last = sequences[-1:]
        shorter = [Executed(s.doors[:-1], s.percepts[:-1]) for s in last]
        return super().refute(chart, hypothesis, [*sequences[:-1], *shorter])


@pytest.mark.parametrize(
    ("name", "rule"),
    [
        ("enhancement-i", LazyPrefix),
        ("enhancement-ii", PrefixRule),
        ("enhancement-i", HistoryRule),
        ("enhancement-iii-all", HistoryRule),
    ],
)
def test_another_rule_than_the_described_one_is_seen(
    name: str, rule: type[PrefixRule | HistoryRule]
) -> None:
    algorithm = variant(rule)
    assert any(differences(trace_of(world, algorithm), name) for world in alike_places())


def all_but_the_last(*arguments: Any, **named: Any) -> list[Hypothesis]:
    return exploration_hypotheses(*arguments, **named)[:-1]


def one_less(one: Sequence[int], other: Sequence[int]) -> int:
    return max(0, common_prefix(one, other) - 1)


def never(*_: object) -> None:
    return None


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("algorithm", "place", "name", "change"),
    [
        ("basic", exploration, "hypotheses", all_but_the_last),
        ("enhancement-i", rules, "common_prefix", one_less),
        ("enhancement-ii", HistoryRule, "refute", never),
        ("enhancement-iii-all", RecordsRule, "_record", never),
    ],
)
def test_a_change_inside_an_algorithm_is_seen(
    monkeypatch: pytest.MonkeyPatch, algorithm: str, place: object, name: str, change: object
) -> None:
    assert not any(differences(trace_of(w, algorithm), algorithm) for w in alike_places())
    monkeypatch.setattr(place, name, change)
    assert any(differences(trace_of(w, algorithm), algorithm) for w in alike_places())


@pytest.mark.parametrize(
    ("term", "algorithm"),
    [
        ("alike", "basic"),
        ("posed", "basic"),
        ("motion", "basic"),
        ("prefix", "enhancement-i"),
        ("history", "enhancement-ii"),
        ("leaves", "enhancement-iii-all"),
        ("record-differs", "enhancement-iii-all"),
    ],
)
def test_a_changed_term_is_seen_as_well(term: str, algorithm: str) -> None:
    """A term that is never true makes a difference: none stands idle in the comparison."""
    changed = {**RULES, term: conj(RULES[term], neg(RULES[term]))}
    traces = (trace_of(world, algorithm) for world in alike_places())
    assert any(differences(trace, algorithm, terms=changed) for trace in traces)
