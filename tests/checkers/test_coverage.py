"""Every judgement says how much of the run it rests on: `judged` of `of`."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import pytest

from tests.helpers import EMPTY, edited, fits, place, trace_of, worlds
from topo_verify import CATALOGUE, World, families
from topo_verify.algorithms.chart import Survey
from topo_verify.checkers import CLAIMS, Judgement, check
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept

LATTICE = families.lattice(4, 4)
"""Basic finds 15 of its 24 edges to lead to new vertices, and rejects 28 hypotheses of POSED."""

POSED = 55

DECISIONS = (
    "true-hypothesis-posed",
    "true-hypothesis-kept",
    "no-false-confirm",
    "rejection-justified",
    "decisions-entailed",
)


@cache
def lattice_trace() -> ev.Trace:
    return trace_of(LATTICE, "basic")


def told(world: World, trace: ev.Trace) -> dict[str, Judgement]:
    """The judgement of each claim."""
    return {judgement.claim: judgement for judgement in check(world, trace)}


def only(trace: ev.Trace, keeps: Callable[[ev.Decision], bool]) -> ev.Trace:
    """The trace without the decisions that `keeps` does not want."""
    return tuple(e for e in trace if isinstance(e, ev.Start | ev.Move | ev.Finish) or keeps(e))


def shares(world: World, trace: ev.Trace) -> dict[str, tuple[str, int, int]]:
    """The status of each claim on decisions, and how much it rests on."""
    judgements = told(world, trace)
    return {c: (judgements[c].status, judgements[c].judged, judgements[c].of) for c in DECISIONS}


def number(trace: ev.Trace, kind: type[ev.Event]) -> int:
    return sum(isinstance(event, kind) for event in trace)


@pytest.mark.no_cover
def test_the_algorithms_of_the_catalogue_are_judged_in_full() -> None:
    for world in worlds(range(1, 4)):
        for name in CATALOGUE:
            if fits(name, world):
                for judgement in check(world, trace_of(world, name)):
                    assert (judgement.status, judgement.findings) == ("ok", ())
                    assert judgement.judged == judgement.of


def test_what_is_counted_for_each_claim() -> None:
    trace = lattice_trace()
    rejects, confirms = number(trace, ev.Reject), number(trace, ev.Confirm)
    posed = sum(len(event.hypotheses) for event in trace if isinstance(event, ev.Pose))
    expected = {
        "percepts-true": 1 + number(trace, ev.Move),
        "true-hypothesis-posed": 24,
        "true-hypothesis-kept": posed,
        "no-false-confirm": confirms,
        "map-isomorphic": 1,
        "cost-honest": 1,
        "cost-within-bound": 1,
        "rejection-justified": rejects,
        "map-entailed": 1,
        "decisions-entailed": rejects + confirms + 24,
    }
    assert (confirms, list(expected)) == (9, list(CLAIMS))
    assert {claim: one.of for claim, one in told(LATTICE, trace).items()} == expected


def test_one_pose_and_one_trivial_rejection_are_not_the_whole_run() -> None:
    silent = only(lattice_trace(), lambda _: False)
    # The vertex behind the marked dart has degree 3; so dart 1 of v0, which has 2, is not its end.
    evidence = ev.Evidence(0, Percept(2, 1), Percept(3, None))
    trace = (*silent[:2], ev.Pose(0, (1,)), ev.Reject(0, 1, "motion", evidence), *silent[2:])
    assert shares(LATTICE, trace) == {
        "true-hypothesis-posed": ("partial", 1, 24),
        "true-hypothesis-kept": ("partial", 1, 1 + 24),
        "no-false-confirm": ("not-declared", 0, 24),
        "rejection-justified": ("partial", 1, 1 + 24),
        "decisions-entailed": ("partial", 1, 1 + 24),
    }


def test_decisions_on_the_first_edges_alone_are_partial() -> None:
    trace = lattice_trace()
    early = trace[: place(trace, ev.Augment, 3) + 1]  # to three new vertices, and one known
    assert shares(LATTICE, only(trace, lambda event: event in early)) == {
        "true-hypothesis-posed": ("partial", 4, 24),
        "true-hypothesis-kept": ("partial", 2, 2 + 20),
        "no-false-confirm": ("partial", 1, 1 + 20),
        "rejection-justified": ("partial", 1, 1 + 20),
        "decisions-entailed": ("partial", 2 + 4, 2 + 4 + 20),
    }


def test_an_edge_that_is_still_in_question_counts_once_whatever_is_left_of_it() -> None:
    trace = lattice_trace()
    posed = place(trace, ev.Pose, 12)
    event = trace[posed]
    assert isinstance(event, ev.Pose)
    assert len(event.hypotheses) > 1
    whole = trace[: posed + 1]
    one_left = edited(whole, posed, hypotheses=event.hypotheses[:1])
    claim = "rejection-justified"
    assert told(LATTICE, whole)[claim].of == told(LATTICE, one_left)[claim].of


def test_a_loop_that_was_not_confirmed_is_not_judged_by_claim_4() -> None:
    trace = lattice_trace()
    assert shares(LATTICE, only(trace, lambda event: not isinstance(event, ev.Confirm))) == {
        "true-hypothesis-posed": ("ok", 24, 24),
        "true-hypothesis-kept": ("ok", POSED, POSED),
        "no-false-confirm": ("not-declared", 0, 9),
        "rejection-justified": ("ok", 28, 28),
        "decisions-entailed": ("ok", 28 + 24, 28 + 24),
    }
    first = next(event for event in trace if isinstance(event, ev.Confirm))
    some = only(trace, lambda event: not isinstance(event, ev.Confirm) or event == first)
    assert shares(LATTICE, some)["no-false-confirm"] == ("partial", 1, 9)


def test_a_mapper_that_declares_augmentations_alone_is_judged_on_all_of_them() -> None:
    augments = only(lattice_trace(), lambda event: isinstance(event, ev.Augment))
    assert shares(LATTICE, augments) == {
        "true-hypothesis-posed": ("not-declared", 0, 24),
        "true-hypothesis-kept": ("not-declared", 0, 24),
        "no-false-confirm": ("not-declared", 0, 24),
        "rejection-justified": ("not-declared", 0, 24),
        "decisions-entailed": ("ok", 24, 24),
    }


@pytest.mark.parametrize("every", [1, 2])
def test_a_hypothesis_without_a_fate_is_a_finding_of_claim_3(every: int) -> None:
    trace = lattice_trace()
    behind_new = {e.edge for e in trace if isinstance(e, ev.Augment) and e.kind == "new"}
    rejects = [e for e in trace if isinstance(e, ev.Reject) and e.edge in behind_new]
    dropped = rejects[::every]
    judgements = told(LATTICE, only(trace, lambda event: event not in dropped))
    kept = judgements["true-hypothesis-kept"]
    assert (kept.status, kept.judged, kept.of) == ("failed", POSED - len(dropped), POSED)
    finding = kept.findings[0]
    assert (finding.expected, finding.seen) == ("each rejected", [dropped[0].hypothesis])
    assert "hypotheses are left" in finding.message
    assert "declare a reject for each" in finding.message
    assert isinstance(trace[-1], ev.Finish)
    assert judgements["rejection-justified"].of == 28


def test_a_hypothesis_that_was_no_dart_of_s_is_wrong_by_claim_2_and_not_dropped() -> None:
    world = World.from_id("m2/0")
    trace = trace_of(world, "basic")
    first = next(e for e in trace if isinstance(e, ev.Pose))
    # Dart 2 comes with the vertex behind the posed edge: it is new, and not still unexplored.
    early = ev.Pose(first.edge, (2,))
    judgements = told(world, tuple(early if event is first else event for event in trace))
    assert judgements["true-hypothesis-posed"].status == "failed"
    assert judgements["true-hypothesis-kept"].status == "ok"


STAR = World.from_rotations([(0, 1, 2), (3,), (4,), (5,)], [(0, 3), (1, 4), (2, 5)], 0)


def comes_back(robot: ev.Robot, again: tuple[int, ...]) -> Survey:
    """Maps the star. Poses dart 1 behind dart 0, and goes to dart 1 before it decides."""
    robot.move(0)
    robot.declare(ev.Pose(0, (1,)))
    at = 0  # the dart of v0 that is the reference dart there
    for edge, hypotheses, dart in ((1, (), 3), (0, again, 4), (2, (), 5)):
        robot.move(0)
        robot.move((edge - at) % 3)
        at = edge
        robot.declare(ev.Pose(edge, hypotheses))
        robot.declare(ev.Augment(edge, "new", dart, 1))
    return Survey(((0, 1, 2), (3,), (4,), (5,)), ((1, 3), (0, 4), (2, 5)), 0, 7)


def test_a_hypothesis_that_was_explored_meanwhile_needs_no_rejection() -> None:
    trace = trace_of(STAR, lambda robot: comes_back(robot, ()))
    kept = told(STAR, trace)["true-hypothesis-kept"]
    assert (kept.status, kept.judged, kept.of) == ("ok", 1, 1)


def test_a_hypothesis_that_is_posed_later_needs_its_rejection() -> None:
    trace = trace_of(STAR, lambda robot: comes_back(robot, (2,)))
    kept = told(STAR, trace)["true-hypothesis-kept"]
    assert (kept.status, kept.judged, kept.of) == ("failed", 1, 2)
    assert kept.findings[0].seen == [2]


def test_what_is_posed_again_must_be_rejected_again() -> None:
    trace = lattice_trace()
    at = place(trace, ev.Reject)
    pose = next(event for event in trace if isinstance(event, ev.Pose) and event.hypotheses)
    again = (*trace[: at + 1], pose, *trace[at + 1 :])
    (finding,) = told(LATTICE, again)["true-hypothesis-kept"].findings
    assert finding.seen == list(pose.hypotheses)


def test_the_empty_world_leaves_nothing_to_judge() -> None:
    for judgement in check(EMPTY, trace_of(EMPTY)):
        assert (judgement.status, judgement.judged) == ("ok", judgement.of)


def test_a_run_that_delivers_no_map_leaves_claim_9_nothing_to_judge() -> None:
    judgements = told(LATTICE, lattice_trace()[:-1])
    assert judgements["map-isomorphic"].status == "failed"
    nothing = judgements["map-entailed"]
    assert (nothing.status, nothing.judged, nothing.of) == ("not-declared", 0, 1)


def test_after_a_door_that_is_not_there_no_percept_is_judged() -> None:
    trace = lattice_trace()
    index = place(trace, ev.Move, 3)
    percepts = told(LATTICE, edited(trace, index, door=9))["percepts-true"]
    assert (percepts.status, percepts.judged) == ("failed", 4)
    assert percepts.of == 1 + number(trace, ev.Move)


def test_a_cost_that_is_not_reported_is_not_judged() -> None:
    honest = told(LATTICE, edited(lattice_trace(), -1, cost=None))["cost-honest"]
    assert (honest.status, honest.judged, honest.of) == ("ok", 0, 0)


def test_a_pose_of_an_explored_edge_hides_nothing_of_what_follows() -> None:
    trace = lattice_trace()
    at = place(trace, ev.Augment)
    augment = trace[at]
    assert isinstance(augment, ev.Augment)
    explored = ev.Pose(augment.edge, ())
    found = told(LATTICE, (*trace[: at + 1], explored, *trace[at + 1 :]))
    assert found["true-hypothesis-posed"].status == "failed"
    for claim in DECISIONS[:-1]:
        before = told(LATTICE, trace)[claim]
        assert (found[claim].judged, found[claim].of) == (before.judged, before.of)
