"""The states of a world, found by running the mapper: their number, their costs, what fails."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import pytest

from tests.harness.search.states.paths import all_runs
from topo_verify import CATALOGUE, World
from topo_verify.algorithms import Algorithm
from topo_verify.algorithms.basic import NoRule
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis, Motion, retrace
from topo_verify.errors import InputError, InternalError
from topo_verify.harness.judge import judge
from topo_verify.harness.run import explore
from topo_verify.harness.search.exhaustive import Search
from topo_verify.harness.search.plan import Plan
from topo_verify.harness.search.states import graph as graphs
from topo_verify.harness.search.states.graph import StateGraph
from topo_verify.harness.search.states.memory import state
from topo_verify.harness.search.states.ranges import cost_range, costs_of_all
from topo_verify.harness.search.states.script import ChoicePoint, Listed, scripted
from topo_verify.harness.second_try import Tried
from topo_verify.programs.loader import Mapper, Target
from topo_verify.robot.events import Evidence, MapDart
from topo_verify.robot.percept import Percept
from topo_verify.world.enumeration import rank_order


def worlds(edges: int) -> list[World]:
    """Every world with so many edges."""
    return [World.from_id(f"m{edges}/{rank}") for rank in range(rank_order.count(edges))]


def searched(algorithm: Algorithm, world: World) -> StateGraph:
    """The states of an algorithm in a world."""

    def judged(mapper: Mapper) -> Tried:
        run = explore(world, Target(algorithm.name, mapper))
        return Tried(run, judge(run))

    graph = StateGraph(algorithm, world, judged)
    graph.search()
    return graph


@pytest.mark.parametrize(
    ("name", "edges", "states", "choices"),
    [
        ("basic", 1, 1, 2),
        ("basic", 2, 62, 145),
        ("enhancement-ii+i", 2, 62, 145),
        ("enhancement-iii-all+i", 2, 62, 145),
        ("folding", 2, 20, 49),
        ("basic", 3, 3287, 9079),
        ("enhancement-iii-all", 3, 3337, 9179),
        ("folding", 3, 601, 1601),
    ],
)
def test_the_numbers_of_states_and_of_choices_are_pinned(
    name: str, edges: int, states: int, choices: int
) -> None:
    found = [cost_range(searched(CATALOGUE[name], world)) for world in worlds(edges)]
    assert (sum(one.states for one in found), sum(one.choices for one in found)) == (
        states,
        choices,
    )


def test_the_states_of_two_loops_are_counted_by_hand() -> None:
    # One vertex, two loops (m2/9). Four ways to pick e. Behind e the true hypothesis and one or two
    # false ones remain: 3 states with 3 + 2 + 2 ways. Then two ways to pick e, and a forced end.
    # The first loop has two darts and either may be e; so may those of the second: the states
    # behind e are counted for each of 4 darts, those between edges once for each loop.
    graph = searched(CATALOGUE["basic"], World.from_id("m2/9"))
    assert len(graph.nodes) == 1 + 4 * 3 + 2
    assert graph.choices == 4 + 4 * (3 + 2 + 2) + 2 * 2


@pytest.mark.parametrize("name", CATALOGUE)
def test_the_states_have_the_costs_and_verdicts_of_all_runs_one_by_one(name: str) -> None:
    for world in [*worlds(1), *worlds(2)]:
        graph = searched(CATALOGUE[name], world)
        runs = set(all_runs(CATALOGUE[name], world))
        if all(ok for _, ok in runs):
            assert costs_of_all(graph) == {cost for cost, _ in runs}
            assert {ok for _, ok in runs} == {p.tried.report.ok for p in graph.paths}
        else:
            assert graph.shortest_failing() is not None


@pytest.mark.parametrize("step", [20, pytest.param(6, marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", ["basic", "enhancement-iii-one+i", "folding"])
def test_the_states_have_the_costs_of_all_runs_in_worlds_of_three_edges(
    name: str, step: int
) -> None:
    for world in worlds(3)[::step]:
        runs = set(all_runs(CATALOGUE[name], world))
        assert costs_of_all(searched(CATALOGUE[name], world)) == {cost for cost, _ in runs}
        assert all(ok for _, ok in runs)


@pytest.mark.parametrize("name", ["basic", "enhancement-ii+i"])
def test_the_cheapest_and_the_dearest_choices_make_runs_of_these_costs(name: str) -> None:
    for world in worlds(2):
        graph = searched(CATALOGUE[name], world)
        found = cost_range(graph)
        for ways, cost in ((found.cheap, found.cheapest), (found.dear, found.dearest)):
            assert graph.run(ways).tried.run.cost == cost


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


def result(policies: str, edges: int) -> tuple[str, str, str]:
    """The verdict, the world and the command of the smallest counterexample."""
    plan = Plan(targets=("tired",), edges=edges, choices=policies)  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    search = Search(plan, (Target("tired", TIRED),))
    search.work()
    found = search.found()
    first = found.counterexample
    return (found.verdict, "", "") if first is None else (found.verdict, first.world, first.replay)


def test_a_fault_that_only_some_policies_show_is_found_with_the_fewest_choices() -> None:
    assert result("reference", 3) == ("EXHAUSTED", "", "")
    verdict, world, replay = result("every", 3)
    assert verdict == "REFUTED"
    assert replay.startswith(f"topo-verify explore {world} --algorithm tired --choices ")
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

    with pytest.raises(InputError, match="what rule Ours remembers cannot be pickled"):
        searched(Algorithm("ours", Ours, retrace), World.from_id("m2/9"))
    # `TiredRule` is right in worlds of two edges and remembers more than `NoRule`: more states.
    tired, plain = (searched(one, World.from_id("m2/9")) for one in (TIRED, CATALOGUE["basic"]))
    assert len(tired.nodes) > len(plain.nodes)
    assert costs_of_all(tired) == costs_of_all(plain)


def test_moments_that_are_wrongly_taken_for_one_state_are_noticed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def coarse(moment: ChoicePoint, motion: Motion, world: World) -> object:
        found = state(moment, motion, world)
        assert found is not None
        # Without where the robot stands: only S and the number of ways.
        return (str(found[0]).rpartition("), ")[0], len(found[1])), found[1]

    monkeypatch.setattr(graphs, "state", coarse)
    with pytest.raises(InternalError, match="what the mapper remembers is not all in the state"):
        [searched(CATALOGUE["basic"], world) for world in worlds(3)]
