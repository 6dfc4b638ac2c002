"""Rules against each other, at the very same state: the stronger rejects whatever the weaker does.

The run is steered by one rule; the others look on, each with a memory of its own, and are asked
about every hypothesis at every moment at which the steering rule is asked.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.helpers import variant
from tests.properties.worlds import STRATEGIES
from topo_verify import World, explore
from topo_verify.algorithms.beyond.folding import FoldingRule
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation, Rule
from topo_verify.algorithms.motion import Executed, Hypothesis, Motion, overlap, retrace
from topo_verify.algorithms.rules import HistoryRule, NoRule, PrefixRule, RecordsRule
from topo_verify.robot.events import MapDart, Policies
from topo_verify.robot.percept import Percept
from topo_verify.strategies import policies

RULES: dict[str, Callable[[], Rule]] = {
    "none": NoRule,
    "prefix": PrefixRule,
    "history": HistoryRule,
    "records(1)": lambda: RecordsRule(levels=1),
    "records(∞)": RecordsRule,
    "folding": FoldingRule,
}
"""From the weakest to the strongest."""

Asked = tuple[int, MapDart, int, frozenset[str]]
"""Which e, which h, after how many sequences, and the rules that have refuted it by then."""


class Jury:
    """Steers by one rule and asks all of them. Lives for one run.

    A rule that looks at the last sequence alone has been asked about the earlier ones before: what
    it refuted once, it keeps refuted.
    """

    def __init__(self, steering: str) -> None:
        self.steering = steering
        self.rules = {name: make() for name, make in RULES.items()}
        self.refuted: dict[tuple[str, MapDart], bool] = {}
        self.edges = 0
        self.asked: list[Asked] = []

    def arrive(self, chart: Chart, e: MapDart, percept: Percept) -> None:
        self.refuted, self.edges = {}, self.edges + 1
        for rule in self.rules.values():
            rule.arrive(chart, e, percept)

    def observe(self, sequence: Executed) -> None:
        for rule in self.rules.values():
            rule.observe(sequence)

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        by: Refutation | None = None
        for name, rule in self.rules.items():
            refutation = rule.refute(chart, hypothesis, sequences)
            self.refuted[name, hypothesis.dart] = refutation is not None or self.refuted.get(
                (name, hypothesis.dart), False
            )
            if name == self.steering:
                by = refutation
        agree = frozenset(name for name in RULES if self.refuted[name, hypothesis.dart])
        self.asked.append((self.edges, hypothesis.dart, len(sequences), agree))
        return by

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        return self.rules[self.steering].conclude(remaining)

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        for rule in self.rules.values():
            rule.learn(chart, e, entry, sequences)


def asked(
    world: World, steering: str, motion: Motion = retrace, chosen: Policies | None = None
) -> list[Asked]:
    """What the jury says during a run steered by this rule."""
    juries: list[Jury] = []

    def jury() -> Rule:
        juries.append(Jury(steering))
        return juries[-1]

    chosen = chosen or Policies()
    algorithm = variant(jury, motion).with_policies(pick=chosen.pick, order=chosen.order)
    assert explore(world, algorithm).map is not None
    return juries[0].asked


ORDERED = list(pairwise(RULES))


@pytest.mark.parametrize("strategy", STRATEGIES)
@given(
    data=st.data(),
    steering=st.sampled_from(list(RULES)),
    motion=st.sampled_from([retrace, overlap]),
    chosen=policies(),
)
def test_a_stronger_rule_never_rejects_less_at_the_same_state(
    strategy: str, data: st.DataObject, steering: str, motion: Motion, chosen: Policies
) -> None:
    world = data.draw(STRATEGIES[strategy])
    for _, _, _, refuted in asked(world, steering, motion, chosen):
        for weaker, stronger in ORDERED:
            assert weaker not in refuted or stronger in refuted


SEPARATE = {
    ("none", "prefix"): "m5/202",
    ("prefix", "history"): "m4/41",
    ("history", "records(1)"): "m5/434",
    ("records(1)", "records(∞)"): "m11/5545298064",
    ("records(∞)", "folding"): "m2/4",
}
"""A world in which the stronger rule rejects a hypothesis that the weaker keeps; else the statement
above would compare equals. The smallest there is, but for the records: that one was drawn."""


@pytest.mark.parametrize(("weaker", "stronger"), ORDERED)
def test_each_rule_rejects_more_than_the_one_before_it_somewhere(
    weaker: str, stronger: str
) -> None:
    told = [refuted for *_, refuted in asked(World.from_id(SEPARATE[weaker, stronger]), "none")]
    assert any(stronger in refuted and weaker not in refuted for refuted in told)


class Forgetful(Jury):
    """A jury whose `history` says nothing."""

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        refutation = super().refute(chart, hypothesis, sequences)
        *before, (edge, dart, number, refuted) = self.asked
        self.asked[:] = [*before, (edge, dart, number, refuted - {"history"})]
        return refutation


def test_a_rule_that_rejects_less_would_be_seen() -> None:
    juries: list[Forgetful] = []

    def jury() -> Rule:
        juries.append(Forgetful("none"))
        return juries[-1]

    explore(World.from_id("m5/202"), variant(jury))
    assert any("prefix" in told and "history" not in told for *_, told in juries[0].asked)
