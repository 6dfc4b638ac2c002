"""The states of a world, found by running the mapper: their number, their costs, what fails."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import pytest

from tests.helpers import worlds
from tests.studies.search.searching import searched as search_of
from tests.studies.search.states.paths import all_runs
from topo_verify import CATALOGUE, World
from topo_verify.algorithms import Algorithm
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis, retrace
from topo_verify.algorithms.rules import NoRule
from topo_verify.campaign.attempt import Attempt
from topo_verify.campaign.judge import judge
from topo_verify.campaign.run import explore
from topo_verify.errors import InputError, InternalError
from topo_verify.programs.loader import Mapper, Target
from topo_verify.robot.events import Evidence, MapDart
from topo_verify.robot.percept import Percept
from topo_verify.studies.search.states import graph as graphs
from topo_verify.studies.search.states.every import cost_range
from topo_verify.studies.search.states.graph import StateGraph
from topo_verify.studies.search.states.memory import state
from topo_verify.studies.search.states.script import ChoicePoint, Listed, scripted


def searched(algorithm: Algorithm, world: World) -> StateGraph:
    """The states of an algorithm in a world."""

    def judged(mapper: Mapper) -> Attempt:
        run = explore(world, Target(algorithm.name, mapper))
        # Choices are made for this world alone: they cannot be repeated in a witness world.
        return Attempt(run, judge(replace(run, mapper=None)))

    graph = StateGraph(algorithm, world, judged)
    graph.search()
    return graph


def costs_of_all(graph: StateGraph) -> set[int]:
    """Every cost that some run has: the cost so far is in the state."""
    return {path.tried.run.cost for path in graph.paths}


def claims_that_fail(graph: StateGraph) -> frozenset[str]:
    """The claims that fail in some run."""
    findings = (path.tried.report.findings for path in graph.paths)
    return frozenset(finding.claim for row in findings for finding in row)


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("name", "edges", "states", "choices"),
    [
        ("basic", 1, 1, 2),
        ("basic", 2, 68, 157),
        ("enhancement-ii+i", 2, 68, 157),
        ("enhancement-iii-all+i", 2, 68, 157),
        ("folding", 2, 26, 61),
        ("basic", 3, 3677, 9979),
        ("enhancement-iii-all", 3, 3687, 9999),
        ("folding", 3, 1184, 2887),
    ],
)
def test_the_numbers_of_states_and_of_choices_are_pinned(
    name: str, edges: int, states: int, choices: int
) -> None:
    found = [cost_range(searched(CATALOGUE[name], world)) for world in worlds([edges])]
    assert (sum(one.states for one in found), sum(one.choices for one in found)) == (
        states,
        choices,
    )


def test_the_states_of_two_loops_are_counted_by_hand() -> None:
    # One vertex, two loops (m2/9). Four ways to pick e. Behind e the true hypothesis and one or two
    # false ones remain: 3 states with 3 + 2 + 2 ways. Then two ways to pick e, and a forced end.
    # Each loop has two darts and either may be e, which says by which the robot came back.
    graph = searched(CATALOGUE["basic"], World.from_id("m2/9"))
    assert len(graph.nodes) == 1 + 4 * 3 + 4
    assert graph.choices == 4 + 4 * (3 + 2 + 2) + 4 * 2


@pytest.mark.long
@pytest.mark.parametrize("name", CATALOGUE)
def test_the_states_have_the_costs_and_verdicts_of_all_runs_one_by_one(name: str) -> None:
    for world in worlds([1, 2]):
        graph = searched(CATALOGUE[name], world)
        runs = set(all_runs(CATALOGUE[name], world))
        assert claims_that_fail(graph) == frozenset[str]().union(*(claims for _, claims in runs))
        if not claims_that_fail(graph):
            assert costs_of_all(graph) == {cost for cost, _ in runs}


@pytest.mark.nightly
@pytest.mark.parametrize("step", [20, 6])
@pytest.mark.parametrize("name", ["basic", "enhancement-iii-one+i", "folding"])
def test_the_states_have_the_costs_of_all_runs_in_worlds_of_three_edges(
    name: str, step: int
) -> None:
    for world in list(worlds([3]))[::step]:
        runs = set(all_runs(CATALOGUE[name], world))
        assert costs_of_all(searched(CATALOGUE[name], world)) == {cost for cost, _ in runs}
        assert not any(claims for _, claims in runs)


# ---------------------------------------------------------------- what fails


class TiredRule(NoRule):
    """Rejects everything, true or not, once e was a lower dart than the e before, twice running."""

    def __init__(self) -> None:
        self.last, self.falls = -1, 0

    def arrive(self, chart: Chart, e: MapDart, percept: Percept) -> None:  # noqa: ARG002  a rule's
        self.falls = self.falls + 1 if e < self.last else 0
        self.last = e

    def refute(
        self,
        chart: Chart,  # noqa: ARG002  a rule's
        hypothesis: Hypothesis,
        sequences: Sequence[Executed],  # noqa: ARG002  a rule's
    ) -> Refutation | None:
        if self.falls < 2:
            return None
        return Refutation("prefix", Evidence(0, hypothesis.expected[0], hypothesis.expected[0]))


TIRED = Algorithm("tired", TiredRule, retrace)
"""A fault that the reference policies do not show in small worlds."""


class LuckyRule(NoRule):
    """Concludes that the last hypothesis is true; only the history tells whether that follows."""

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        return remaining[0] if len(remaining) == 1 else None


@pytest.mark.parametrize("rank", [13, 25, 27])
def test_the_claims_that_fail_are_those_that_fail_in_the_runs_one_by_one(rank: int) -> None:
    lucky, world = Algorithm("lucky", LuckyRule, retrace), World.from_id(f"m3/{rank}")
    claims = (failed for _, failed in all_runs(lucky, world))
    expected = frozenset[str]().union(*claims)
    assert expected
    assert claims_that_fail(searched(lucky, world)) == expected


def result(policies: str, edges: int) -> tuple[str, str, str]:
    """The verdict, the world and the command of the smallest counterexample."""
    found = search_of(Target("tired", TIRED), edges=edges, choices=policies).entry()
    first = found.counterexample
    return (found.verdict, "", "") if first is None else (found.verdict, first.world, first.replay)


@pytest.mark.long
def test_a_fault_that_only_some_policies_show_is_found_with_the_fewest_choices() -> None:
    assert result("reference", 3) == ("EXHAUSTED", "", "")
    verdict, world, replay = result("every", 3)
    assert verdict == "REFUTED"
    assert replay.startswith(f"topo-verify explore {world} --target tired --choices ")
    choices = tuple(map(int, replay.rpartition(" ")[2].split(",")))
    assert not passes(choices, world)
    # All shorter lists, and all before it in their order, are tried one by one.
    shorter = (row for n in range(len(choices)) for row in product(range(6), repeat=n))
    assert all(passes(row, world) for row in shorter)


def passes(choices: tuple[int, ...], world: str) -> bool:
    """Whether no claim fails in the run that makes these choices, then the first way each time."""
    run = explore(World.from_id(world), Target("tired", scripted(TIRED, Listed(choices))))
    return judge(run).ok


def test_of_a_rule_that_is_not_known_everything_it_holds_is_in_the_state() -> None:
    class Ours(NoRule):
        """Local, so pickle cannot find it."""

    with pytest.raises(InputError, match="what the mapper keeps cannot be pickled"):
        searched(Algorithm("ours", Ours, retrace), World.from_id("m2/9"))
    # `TiredRule` remembers more than `NoRule`, and is right in worlds of two edges.
    tired, plain = (searched(one, World.from_id("m3/50")) for one in (TIRED, CATALOGUE["basic"]))
    assert len(tired.nodes) > len(plain.nodes)
    tired, plain = (searched(one, World.from_id("m2/9")) for one in (TIRED, CATALOGUE["basic"]))
    assert costs_of_all(tired) == costs_of_all(plain)


def test_moments_that_are_wrongly_taken_for_one_state_are_noticed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def coarse(moment: ChoicePoint, world: World) -> object:
        assert state(moment, world) is not None, "no claim fails"
        # Without the past on which judgements depend, and without what the mapper keeps: only S.
        return str((moment.chart.alpha, moment.e, moment.ways))

    monkeypatch.setattr(graphs, "state", coarse)
    with pytest.raises(InternalError, match="what the mapper remembers is not all in the state"):
        [searched(CATALOGUE["basic"], world) for world in worlds([3])]
