"""Where the robot walks, and where it stands: the parts of a run that its cost does not tell.

Worlds are pinned by their ids. Each was found by search as the smallest where the other reading of
the paper makes other moves; what that reading would do is said beside it.
"""

from __future__ import annotations

import pytest

from tests.helpers import EMPTY, PAPER, doors, of_type, sketch, trace_of, typed
from topo_verify import World
from topo_verify.algorithms import NAMED
from topo_verify.algorithms.chart import Chart
from topo_verify.robot.events import Augment, Finish, Pose, Reject
from topo_verify.robot.percept import Percept


def test_the_walk_follows_the_tree_that_is_rooted_at_its_end() -> None:
    # Two shortest ways lead from v2 to v0. The tree rooted at v0 takes dart 5 (door 0), which is
    # how v2 was found; the one rooted at v2 would take dart 7 (doors 2, then 3 for the crossing).
    trace = trace_of("m5/1694")
    assert sketch(trace[19:22]) == ["augment", "walk 0", "cross 1"]


def test_the_two_trees_differ_where_two_shortest_ways_lead_to_the_same_vertex() -> None:
    chart = Chart(Percept(2, 0))  # a square: v0 (darts 0, 1), then v1 (2, 3), v2 (4, 5), v3 (6, 7)
    for _ in range(3):
        chart.add_vertex(Percept(2, None))
    for e, other in ((0, 2), (1, 4), (3, 6), (5, 7)):
        chart.join(e, other)
    assert chart.tree(0).parent == [None, 2, 4, 6]  # from v3 by dart 6: over v1
    assert chart.tree(3).parent == [0, 3, 5, None]
    chart.alpha = [4, 2, 1, 6, 0, 7, 3, 5]
    assert chart.tree(0).parent[3] == 7  # the lower dart of the root is scanned first: over v2


def test_a_tree_that_stops_early_leaves_the_rest_unreached() -> None:
    chart = Chart(Percept(2, 0))
    chart.join(0, chart.add_vertex(Percept(1, None)))
    chart.join(1, chart.add_vertex(Percept(1, None)))
    assert chart.tree(0, until=0).depth == [0, -1, -1]


def test_back_at_vu_the_next_door_allows_for_the_turn() -> None:
    # Out by door 2 and back by door 0: the reference dart is turned by 2, so door 1 of the entry
    # dart is door 1 - 2 = 3 of 4. Without the turn it would be door 1.
    trace = trace_of("m3/5")
    assert sketch(trace[4:11]) == [
        "cross 1", "pose", "validate 2", "reject", "retrace 0", "validate 3", "confirm",
    ]  # fmt: skip


@pytest.mark.parametrize("name", PAPER)
def test_after_all_are_rejected_it_goes_back_to_vu_even_from_v0(name: str) -> None:
    # The only hypothesis dies at v0 itself, by the marker's direction. From there v0's other door
    # would be nearer than the way back; that move is made all the same.
    trace = trace_of("m4/105", name)
    assert sketch(trace[4:11]) == [
        "cross 1", "pose", "validate 1", "reject", "retrace 0", "augment", "cross 0",
    ]  # fmt: skip
    (reject,) = of_type(Reject, trace)
    assert (reject.evidence.expected, reject.evidence.observed) == (Percept(2, 0), Percept(2, 1))


@pytest.mark.parametrize("name", PAPER)
def test_after_a_confirmation_it_stays_at_v0(name: str) -> None:
    trace = trace_of("m4/105", name)
    assert sketch(trace[15:20]) == ["cross 2", "pose", "validate 2", "confirm", "augment"]
    assert isinstance(trace[-1], Finish)


@pytest.mark.parametrize("name", PAPER)
def test_where_vu_shows_the_marker_nothing_is_walked(name: str) -> None:
    trace = trace_of("m2/5", name)  # v0 has a loop and a leaf: the other end is dart 1 or dart 2
    assert sketch(trace[1:6]) == ["cross 0", "pose", "reject", "confirm", "augment"]
    (reject,) = of_type(Reject, trace)
    assert (reject.hypothesis, reject.rule, reject.evidence.step) == (1, "motion", 0)


@pytest.mark.parametrize("name", PAPER)
def test_the_darts_of_vk_itself_are_hypotheses(name: str) -> None:
    trace = trace_of("m1/1", name)  # a loop: e = 0, and what it leads to is dart 1 of the same v0
    assert of_type(Pose, trace) == [Pose(0, (1,))]


def test_hypotheses_have_the_signature_of_vu_and_come_in_the_order_of_their_ways_home() -> None:
    poses = of_type(Pose, trace_of("m5/1009"))
    assert [pose.hypotheses for pose in poses] == [(), (4, 5), (5,), (5, 8, 9), (9,)]


def test_new_darts_are_numbered_from_the_entry_dart_on() -> None:
    grown = of_type(Augment, trace_of("m5/1694"))
    assert [(a.edge, a.kind, a.dart, a.degree) for a in grown] == [
        (0, "new", 3, 2), (4, "new", 5, 4), (6, "loop", 2, 3), (1, "loop", 8, 4), (7, "new", 9, 1),
    ]  # fmt: skip


@pytest.mark.parametrize("name", NAMED)
def test_the_empty_world_is_its_own_map_and_costs_nothing(name: str) -> None:
    (_, finish) = trace_of(EMPTY, name)
    assert isinstance(finish, Finish)
    assert (finish.cost, finish.map.vertices, finish.map.edges, finish.map.marker) == (
        0, ((),), (), None,
    )  # fmt: skip


def test_the_map_is_the_world_in_the_numbers_of_s() -> None:
    world = World.from_id("m5/1694")
    finish = typed(Finish, trace_of(world)[-1])
    assert World.from_map(finish.map).code == world.code
    assert finish.cost == len(doors(trace_of(world)))
