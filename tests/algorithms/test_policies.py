"""The choices that the paper leaves open: every one gives a correct map, at its own cost."""

from __future__ import annotations

from itertools import product

import pytest

from tests.helpers import of_type, trace_of, worlds
from topo_verify import CATALOGUE, World, examine
from topo_verify.algorithms import policies
from topo_verify.algorithms.chart import Chart
from topo_verify.robot.events import Pose
from topo_verify.robot.percept import Percept

PICKS = (*policies.PICKS, "random(1)", "random(2)")
ORDERS = (*policies.ORDERS, "random(1)")


@pytest.mark.long
@pytest.mark.parametrize(("pick", "order"), list(product(PICKS, ORDERS)))
@pytest.mark.no_cover
def test_every_pair_of_policies_keeps_all_claims_on_every_world_with_3_edges(
    pick: str, order: str
) -> None:
    for name in ("basic", "enhancement-i", "enhancement-ii", "enhancement-iii-all+i"):
        for world in worlds(range(1, 4)):
            report = examine(name, world, pick=pick, order=order)
            assert set(report.claims.values()) == {"ok"}, str(report)


@pytest.fixture
def chart() -> Chart:
    """v0 with darts 0 … 2; at the end of dart 1 a vertex with darts 3 … 5."""
    chart = Chart(Percept(3, 0))
    chart.join(1, chart.add_vertex(Percept(3, None)))
    return chart


def test_nearest_counts_from_the_robot_and_breaks_ties_by_the_lowest_dart(chart: Chart) -> None:
    assert policies.nearest(chart, 2) == 0
    assert policies.nearest(chart, 3) == 4
    chart.join(4, chart.add_vertex(Percept(2, None)))  # darts 6 and 7
    chart.join(5, chart.add_vertex(Percept(1, None)))
    assert policies.nearest(chart, 3) == 0  # at distance 1 as dart 7 is, and lower


def test_nearest_does_not_look_beyond_the_distance_of_the_first_that_it_finds(chart: Chart) -> None:
    chart.join(0, chart.add_vertex(Percept(2, None)))  # darts 6 and 7
    assert policies.nearest(chart, 0) == 2  # v0 still has one
    chart.join(2, chart.add_vertex(Percept(1, None)))
    assert policies.nearest(chart, 6) == 7


def test_last_goes_deep_and_first_goes_broad(chart: Chart) -> None:
    assert policies.last(chart, 0) == 5
    assert policies.first(chart, 3) == 0


def test_orders_sort_by_the_way_home_by_age_and_by_youth(chart: Chart) -> None:
    chart.join(4, chart.add_vertex(Percept(2, None)))  # darts 6 and 7, two edges from v0
    chart.join(0, chart.add_vertex(Percept(2, None)))  # darts 8 and 9, one edge from v0
    tree = chart.tree(0)
    assert policies.shortest([7, 9, 5, 2], chart, tree) == [2, 5, 9, 7]
    assert policies.oldest([7, 9, 5, 2], chart, tree) == [2, 5, 7, 9]
    assert policies.newest([7, 9, 5, 2], chart, tree) == [9, 7, 5, 2]


@pytest.mark.parametrize(("order", "posed"), [("oldest", (3, 4, 5)), ("newest", (5, 4, 3))])
def test_hypotheses_are_posed_in_the_order_of_the_policy(
    order: str, posed: tuple[int, ...]
) -> None:
    trace = trace_of("m3/8", CATALOGUE["basic"].with_policies(order=order))
    assert of_type(Pose, trace)[1].hypotheses == posed


def test_random_policies_repeat_for_the_same_seed_and_differ_for_others() -> None:
    world = World.from_id("m8/5000000")

    def runs(text: str) -> list[object]:
        algorithm = CATALOGUE["enhancement-ii+i"].with_policies(pick=text, order=text)
        return [trace_of(world, algorithm) for _ in range(2)]

    one, again = runs("random(1)")
    assert one == again
    assert len({str(runs(f"random({seed})")[0]) for seed in range(5)}) > 1


@pytest.mark.parametrize(
    "text", ["", "near", "Nearest", "random", "random()", "random(-1)", "random(1.5)", "random(1) "]
)
def test_an_unknown_policy_is_refused_with_the_list_of_those_there_are(text: str) -> None:
    with pytest.raises(ValueError, match="there are nearest, last, first, random"):
        policies.pick_policy(text)
    with pytest.raises(ValueError, match="there are shortest, oldest, newest, random"):
        policies.order_policy(text)


def test_an_algorithm_refuses_policies_that_do_not_exist() -> None:
    with pytest.raises(ValueError, match="no pick policy 'far'"):
        CATALOGUE["basic"].with_policies(pick="far")
    with pytest.raises(ValueError, match="no order policy 'far'"):
        CATALOGUE["basic"].with_policies(order="far")
