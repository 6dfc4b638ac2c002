"""The claims on percepts and decisions are seen to fail: a real trace with one lie in it."""

from __future__ import annotations

import pytest

from tests.checkers.example import FINISH, LOOP, TRACE, WORLD, inserted, said, without, wrong
from tests.helpers import edited, place, trace_of
from topo_verify import World
from topo_verify.checkers import check
from topo_verify.robot.events import Confirm, Evidence, Pose, Reject
from topo_verify.robot.percept import Percept

# ---------------------------------------------------------------- percepts-true


@pytest.mark.parametrize(
    ("index", "percept"),
    [
        (0, Percept(1, None)),
        (0, Percept(2, 0)),
        (1, Percept(7, 0)),
        (4, Percept(6, None)),
        (12, Percept(1, None)),
        (FINISH - 3, Percept(1, 0)),
    ],
)
def test_a_percept_that_the_world_does_not_show_is_caught(index: int, percept: Percept) -> None:
    assert wrong(edited(TRACE, index, percept=percept)) == {"percepts-true"}


@pytest.mark.parametrize("door", [-1, 7, 10**9])
def test_a_door_that_is_not_there_is_caught_and_nothing_after_it_is_judged(door: int) -> None:
    lie = edited(TRACE, 6, door=door)
    assert wrong(edited(lie, 20, hypothesis=99)) == {"percepts-true"}
    assert said(lie, "percepts-true") == [f"there is no door {door} at a vertex of degree 7"]


def test_another_door_than_the_one_that_was_taken_is_caught() -> None:
    assert "percepts-true" in wrong(edited(TRACE, 18, door=3))


def test_the_direction_of_the_marker_is_compared() -> None:
    world = World.from_id("m2/5")
    trace = trace_of(world)
    assert wrong(edited(trace, 1, percept=Percept(3, 2)), world) == {"percepts-true"}


# ---------------------------------------------------------------- true-hypothesis-posed


def test_leaving_the_true_hypothesis_out_is_caught() -> None:
    lie = edited(TRACE, place(TRACE, Pose, 1), hypotheses=(3, 4, 6, 7))
    assert wrong(lie) == {"true-hypothesis-posed"}
    assert said(lie, "true-hypothesis-posed") == [
        "edge 2 leads to dart 5, which is not among the hypotheses"
    ]


@pytest.mark.parametrize("dart", [-1, 0, 1, 8, 2**63])
def test_posing_what_is_no_unexplored_dart_is_caught(dart: int) -> None:
    lie = edited(TRACE, place(TRACE, Pose, 1), hypotheses=(3, 4, 5, 6, 7, dart))
    assert wrong(lie) == {"true-hypothesis-posed"}
    no_edge = edited(TRACE, place(TRACE, Pose, 1), edge=dart)
    posed = next(j for j in check(WORLD, no_edge) if j.claim == "true-hypothesis-posed")
    assert posed.findings[0].expected == "unexplored darts"


def test_posing_before_the_edge_is_crossed_is_caught() -> None:
    index = place(TRACE, Pose, 1)
    early = inserted(without(TRACE, index), index - 1, TRACE[index])
    assert said(early, "true-hypothesis-posed") == ["dart 2 is posed before the robot crossed it"]


def test_growing_along_an_edge_that_was_not_posed_is_caught() -> None:
    lie = without(TRACE, place(TRACE, Pose, 1))
    assert "S grows along dart 2, which was not posed" in said(lie, "true-hypothesis-posed")
    other = edited(TRACE, place(TRACE, Pose, -1), edge=4)
    assert "true-hypothesis-posed" in wrong(other)


# ---------------------------------------------------------------- kept, and no false confirmation


def test_rejecting_the_true_hypothesis_is_caught() -> None:
    evidence = Evidence(1, Percept(1, None), Percept(1, 0))
    lie = inserted(TRACE, LOOP - 1, Reject(2, 5, "motion", evidence))
    assert wrong(lie) == {"true-hypothesis-kept", "rejection-justified"}
    assert said(lie, "true-hypothesis-kept") == [
        "edge 2 does lead to dart 5, which rule 'motion' rejects"
    ]


def test_dropping_the_true_hypothesis_in_silence_is_caught() -> None:
    lie = edited(TRACE, LOOP, kind="new", dart=8)
    assert wrong(lie) == {"true-hypothesis-kept", "map-isomorphic"}
    assert said(lie, "true-hypothesis-kept") == [
        "edge 2 leads to dart 5, but S grows by a new vertex"
    ]


@pytest.mark.parametrize("hypothesis", [3, 4, 0, -1, 99])
def test_confirming_a_false_hypothesis_is_caught(hypothesis: int) -> None:
    lie = edited(TRACE, LOOP - 1, hypothesis=hypothesis)
    assert wrong(lie) == {"no-false-confirm"}
    assert said(lie, "no-false-confirm") == [
        f"edge 2 leads to dart 5, but dart {hypothesis} is confirmed"
    ]


@pytest.mark.parametrize(
    ("edge", "end"),
    [(6, "a new vertex of degree 1"), (77, "nowhere (it is not an unexplored dart of S)")],
)
def test_confirming_anything_for_an_edge_that_leads_to_no_dart_is_caught(
    edge: int, end: str
) -> None:
    lie = inserted(TRACE, FINISH - 1, Confirm(edge, 4, "motion"))
    assert wrong(lie) == {"no-false-confirm"}
    assert said(lie, "no-false-confirm") == [f"edge {edge} leads to {end}, but dart 4 is confirmed"]
