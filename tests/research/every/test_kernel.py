"""The kernel is held to the states that are found by running the mapper."""

# A test may look inside.
# pyright: reportPrivateUsage=false

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from unittest.mock import Mock

import msgspec
import pytest

from research.every import kernel, table
from tests.helpers import typed, worlds
from tests.studies.search.states.test_graph import searched
from topo_verify import CATALOGUE, World
from topo_verify.algorithms.motion import Executed, Hypothesis, overlap
from topo_verify.campaign.run import explore
from topo_verify.errors import InternalError
from topo_verify.programs.loader import Target
from topo_verify.robot.simulator import percepts
from topo_verify.studies.search.states import every, graph
from topo_verify.studies.search.states.memory import state
from topo_verify.studies.search.states.script import ChoicePoint, ScriptedPolicies, scripted

pytest.importorskip("numba")

from research.every import best

KNOWN = [name for name, algorithm in CATALOGUE.items() if table.is_known(algorithm)]


def test_the_kernel_knows_the_rules_that_remember_nothing() -> None:
    assert KNOWN == ["basic", "enhancement-i", "enhancement-ii", "enhancement-ii+i"]


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> Callable[[str, World], tuple[int, ...]]:
    """The states and choices as the kernel counts them, and both costs, as the mapper has them."""
    seen: dict[object, int] = {}

    def noted(moment: ChoicePoint, world: World) -> object:
        seen[coarse(moment, world)] = len(moment.ways)
        return state(moment, world)

    def count(name: str, world: World) -> tuple[int, ...]:
        seen.clear()
        costs = every.cost_range(searched(CATALOGUE[name], world))
        return len(seen), sum(seen.values()), costs.cheapest, costs.dearest

    monkeypatch.setattr(graph, "state", noted)
    return count


def coarse(moment: ChoicePoint, world: World) -> object:
    """A state as the kernel has it, for rules that remember nothing, in darts of the world."""
    chart, darts, frame = moment.chart, table.world_darts(moment.chart, world), moment.frame
    assert darts is not None
    assert frame is not None
    explored = frozenset(darts[d] for d, other in enumerate(chart.alpha) if other is not None)
    drawn = explored, frozenset(darts[first] for first in chart.first)
    variables: dict[str, Any] = frame.f_locals
    if moment.e is None:
        at: int = variables["at"]
        return *drawn, world.vertex_of[darts[at]]
    script = typed(ScriptedPolicies, variables["motion"].__self__)
    hypotheses: list[Hypothesis] = variables["remaining"]
    remaining = frozenset(darts[h.dart] for h in hypotheses)
    executed: list[Executed] = variables["sequences"]
    sequences = executed if script.algorithm.motion is overlap else ()
    return *drawn, darts[moment.e], remaining, sequences[-1].doors if sequences else ()


@pytest.mark.nightly
@pytest.mark.parametrize("name", KNOWN)
@pytest.mark.parametrize("edges", [1, 2, 3])
def test_it_finds_the_states_the_choices_and_the_costs_that_the_mapper_has(
    name: str, edges: int, counted: Callable[[str, World], tuple[int, ...]]
) -> None:
    for world in worlds([edges]):
        found = table.found_in(world, CATALOGUE[name])
        assert found.wrong == 0
        assert found[1:5] == counted(name, world)


@pytest.mark.nightly
@pytest.mark.parametrize("name", KNOWN)
def test_it_does_so_where_rules_and_motions_differ(
    name: str, counted: Callable[[str, World], tuple[int, ...]]
) -> None:
    for rank in (133, 402, 560):
        world = World.from_id(f"m4/{rank}")
        assert table.found_in(world, CATALOGUE[name])[1:5] == counted(name, world)


@pytest.mark.parametrize(
    ("name", "totals"),
    [
        ("basic", (185413, 609908, 3633, 6220)),
        ("enhancement-i", (187889, 615580, 3633, 6204)),
        ("enhancement-ii", (185233, 609548, 3633, 6218)),
        ("enhancement-ii+i", (187721, 615244, 3633, 6202)),
    ],
)
def test_the_numbers_in_all_worlds_of_four_edges_are_pinned(
    name: str, totals: tuple[int, ...]
) -> None:
    found = [table.found_in(world, CATALOGUE[name]) for world in worlds([4])]
    rows = [(one.states, one.choices, one.cheapest, one.dearest) for one in found]
    assert tuple(map(sum, zip(*rows, strict=True))) == totals


@pytest.mark.parametrize("name", KNOWN)
def test_no_call_makes_machine_code_beside_that_which_is_kept(name: str) -> None:
    """Else the next process would find it without a checksum, and compile all again."""
    table.found_in(World.from_id("m4/133"), CATALOGUE[name])
    entries = [each for each in vars(table._tables()).values() if hasattr(each, "signatures")]
    assert [len(each.signatures) for each in entries] == [1] * 6


@pytest.mark.parametrize("name", KNOWN)
def test_its_two_runs_cost_the_mapper_what_it_says(name: str) -> None:
    algorithm = CATALOGUE[name]
    for world in list(worlds([4]))[::10]:
        found = table.found_in(world, algorithm)
        for order, cost in ((found.cheap, found.cheapest), (found.costly, found.dearest)):
            run = explore(world, Target(name, scripted(algorithm, table.Ordered(world, order))))
            assert run.cost == cost


def test_without_the_direction_of_the_marker_it_finds_false_confirmations() -> None:
    # docs/semantics.md, section 10: such worlds have two edges and more.
    found: list[str] = []
    for world in worlds([1, 2]):
        blind = [
            msgspec.structs.replace(seen, marker=None if seen.marker is None else 0)
            for seen in percepts(world)
        ]
        if table.found_in(world, CATALOGUE["basic"], blind).wrong:
            found.append(world.id)
    assert "m2/5" in found
    assert not {"m1/0", "m1/1"} & {*found}


# ---------------------------------------------------------------- mistakes in the kernel


@pytest.fixture
def uncompiled(monkeypatch: pytest.MonkeyPatch) -> None:
    """The kernels run as plain Python, so that a mistake can be planted in one."""

    def itself(function: object, _layout: object) -> object:
        return function

    monkeypatch.setattr(best, "compiled", itself)
    monkeypatch.setattr(table, "_tables", best.Tables)


def seen_in_3_edges(name: str) -> set[int]:
    """What is wrong in the worlds with 3 edges."""
    return {table.found_in(world, CATALOGUE[name]).wrong for world in list(worlds([3]))[::6]}


@pytest.mark.filterwarnings("ignore:overflow encountered")  # a hash wraps around
@pytest.mark.usefixtures("uncompiled")
@pytest.mark.parametrize("name", KNOWN)
def test_as_plain_python_it_finds_nothing_wrong(name: str) -> None:
    assert seen_in_3_edges(name) == {kernel.GOOD}


@pytest.mark.filterwarnings("ignore:overflow encountered")  # a hash wraps around
@pytest.mark.usefixtures("uncompiled")
def test_a_rule_that_rejects_what_is_true_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernel, "refutes", Mock(return_value=True))
    assert seen_in_3_edges("enhancement-ii") == {kernel.GOOD, kernel.KILLED}
    assert seen_in_3_edges("basic") == {kernel.GOOD}  # which asks no rule


@pytest.mark.filterwarnings("ignore:overflow encountered")  # a hash wraps around
@pytest.mark.usefixtures("uncompiled")
def test_a_true_way_home_that_differs_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    right: Callable[..., int] = kernel.walk_home

    def differs(*arguments: object) -> int:
        return max(0, right(*arguments))

    monkeypatch.setattr(kernel, "walk_home", differs)
    assert seen_in_3_edges("basic") == {kernel.GOOD, kernel.DIFFERS}


@pytest.mark.filterwarnings("ignore:overflow encountered")  # a hash wraps around
@pytest.mark.usefixtures("uncompiled")
def test_more_states_than_there_is_room_for_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kernel, "ROOM", 16)
    with pytest.raises(InternalError, match="has too many states for the kernel"):
        table.found_in(World.from_id("m3/9"), CATALOGUE["basic"])
