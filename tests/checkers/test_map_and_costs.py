"""The claims on the map and the costs are seen to fail: a real trace with one lie in it."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest

from tests.checkers.example import FINISH, LOOP, MAP, TRACE, WORLD, inserted, said, without, wrong
from tests.helpers import EIGHT, EMPTY, edited, failing, place
from topo_verify import World
from topo_verify.checkers import check
from topo_verify.robot.events import Augment, MapData, Move
from topo_verify.robot.percept import Percept

# ---------------------------------------------------------------- map-isomorphic


@pytest.mark.parametrize(
    "change",
    [
        {"dart": 4},
        {"dart": 0},
        {"dart": -5},
        {"dart": 99},
        {"edge": 0},
        {"edge": 99},
        {"edge": -1},
        {"degree": 6},
        {"kind": "new"},
    ],
)
def test_a_false_loop_is_caught(change: dict[str, Any]) -> None:
    assert "map-isomorphic" in wrong(edited(TRACE, LOOP, **change))


@pytest.mark.parametrize("change", [{"dart": 9}, {"dart": 2}, {"degree": 2}, {"kind": "loop"}])
def test_a_false_new_vertex_is_caught(change: dict[str, Any]) -> None:
    lie = edited(TRACE, place(TRACE, Augment, 3), **change)
    assert "map-isomorphic" in wrong(lie)


def test_a_loop_that_is_taken_for_new_and_a_new_vertex_taken_for_a_loop_are_named() -> None:
    lie = edited(TRACE, LOOP, kind="new", dart=8)
    assert said(lie, "map-isomorphic") == [
        "S grows by new dart 8 with degree 7, but edge 2 leads to dart 5"
    ]
    lie = edited(TRACE, FINISH - 1, kind="loop", dart=4)
    assert said(lie, "map-isomorphic") == [
        "S grows by loop dart 4 with degree 1, but edge 6 leads to a new vertex of degree 1"
    ]


def test_growing_twice_along_an_edge_is_caught() -> None:
    assert "map-isomorphic" in wrong(inserted(TRACE, LOOP + 1, TRACE[LOOP]))


def test_an_edge_that_s_never_gets_is_caught() -> None:
    last = FINISH - 1
    lie = without(without(TRACE, last), last - 1)
    assert said(lie, "map-isomorphic") == ["the map is delivered while 1 darts of S are unexplored"]


def test_after_a_false_map_nothing_is_held_against_later_decisions() -> None:
    lie = edited(TRACE, LOOP, degree=6)
    assert wrong(edited(lie, FINISH - 2, edge=99)) == {"map-isomorphic"}


@pytest.mark.parametrize(
    "drawn",
    [
        MapData(((0,), (1,)), ((0, 1),), 0),
        MapData(((0, 1), (2,)), ((0, 1), (2, 3)), 0),
        MapData(((0,), (1,), (2,), (3,)), ((0, 1), (2, 3)), 0),
        MapData(((0,), (1,)), ((0, 1),), None),
        MapData(((0,), (1,)), ((0, 1),), 2),
        MapData(((0,), (0,)), ((0, 0),), 0),
        MapData(((0, 1, 2),), ((0, 1, 2),), 0),
        MapData((), (), None),
        MapData(((),), (), None),
        MapData(((), (0, 1)), ((0, 1),), 0),
        MapData(((-1,), (2**63,)), ((-1, 2**63),), -1),
    ],
)
def test_another_map_than_the_worlds_is_caught(drawn: MapData) -> None:
    assert wrong(edited(TRACE, FINISH, map=drawn)) == {"map-isomorphic"}


def test_the_marker_belongs_to_the_map() -> None:
    assert MAP is not None
    elsewhere = msgspec.structs.replace(MAP, marker=1)
    assert wrong(edited(TRACE, FINISH, map=elsewhere)) == {"map-isomorphic"}


def test_the_mirror_image_is_another_world() -> None:
    assert MAP is not None
    mirrored = msgspec.structs.replace(MAP, vertices=tuple(row[::-1] for row in MAP.vertices))
    assert wrong(edited(TRACE, FINISH, map=mirrored)) == {"map-isomorphic"}


def test_the_numbers_of_darts_and_the_order_of_vertices_are_the_mappers_own() -> None:
    assert MAP is not None
    renamed = MapData(
        tuple(tuple(7 - 3 * dart for dart in row) for row in reversed(MAP.vertices)),
        tuple(tuple(7 - 3 * dart for dart in pair[::-1]) for pair in reversed(MAP.edges)),
        7,
    )
    assert not failing(WORLD, edited(TRACE, FINISH, map=renamed))


def test_a_missing_map_is_caught_with_the_reason_if_there_is_one() -> None:
    assert wrong(TRACE[:-1]) == {"map-isomorphic"}
    assert said(TRACE[:-1], "map-isomorphic") == [
        "no map was delivered: the trace ends without 'finish'"
    ]
    (finding,) = check(WORLD, TRACE[:-1], "it fell asleep")[4].findings
    assert finding.message == "no map was delivered: it fell asleep"
    assert finding.event is None


# ---------------------------------------------------------------- costs


@pytest.mark.parametrize("cost", [0, 15, 17, -16, 10**30])
def test_a_cost_that_is_not_the_number_of_moves_is_caught(cost: int) -> None:
    lie = edited(TRACE, FINISH, cost=cost)
    assert wrong(lie) == {"cost-honest"}
    assert said(lie, "cost-honest") == [f"the mapper reports a cost of {cost}, but made 16 moves"]


def test_a_mapper_need_not_report_its_cost() -> None:
    assert not failing(WORLD, edited(TRACE, FINISH, cost=None))


def test_more_moves_than_the_bound_are_caught() -> None:
    back, forth = Move(0, Percept(1, 0)), Move(0, Percept(7, None))
    spare = WORLD.cost_bound - 16
    assert spare == 5 * (4 + 9 * 2 * 3) - 16
    for moves, claims in ((spare // 2, set[str]()), (spare // 2 + 1, {"cost-within-bound"})):
        trace = inserted(TRACE, 3, *[back, forth] * moves)
        assert wrong(edited(trace, -1, cost=None)) == claims


def test_fewer_moves_than_edges_are_caught_if_a_map_comes_out_of_them() -> None:
    assert wrong((TRACE[0], msgspec.structs.replace(TRACE[-1], cost=0))) == {"cost-within-bound"}
    assert wrong(TRACE[:1]) == {"map-isomorphic"}


def test_the_bound_is_m_for_one_vertex_and_0_without_edges() -> None:
    assert World.from_id("m1/1").cost_bound == 1
    assert World.from_id("m1/0").cost_bound == 2 + 1 * 2 * 1
    assert EMPTY.cost_bound == 0


@pytest.mark.parametrize(
    ("change", "expected", "seen"),
    [
        ({"cost": 17}, 16, 17),
        (
            {"map": MapData(((0,), (1,)), ((0, 1),), 0)},
            "4 vertices, 5 edges",
            "2 vertices, 1 edge",
        ),
        ({"map": MapData((), (), None)}, "a map", None),
    ],
)
def test_what_was_delivered_is_wrong_at_the_last_event(
    change: dict[str, Any], expected: object, seen: object
) -> None:
    (judgement,) = (
        j for j in check(WORLD, edited(TRACE, FINISH, **change)) if j.findings and j.claim in EIGHT
    )
    (finding,) = judgement.findings
    assert (finding.event, finding.expected, finding.seen) == (FINISH, expected, seen)


def test_an_unfinished_s_is_wrong_at_the_last_event() -> None:
    lie = without(without(TRACE, FINISH - 1), FINISH - 2)
    (judgement,) = (j for j in check(WORLD, lie) if j.claim == "map-isomorphic")
    (finding,) = judgement.findings
    assert (finding.event, finding.expected, finding.seen) == (len(lie) - 1, 0, 1)


def test_s_as_declared_is_the_map_only_if_it_is_whole() -> None:
    assert MAP is not None
    last = max(when for when, event in enumerate(TRACE) if isinstance(event, Augment))
    part = msgspec.structs.replace(MAP, vertices=MAP.vertices[:-1], edges=MAP.edges[:-1])
    lie = edited(without(TRACE, last), -1, map=part)
    assert len(said(lie, "map-isomorphic")) == 2  # darts are unexplored, and it is no map
