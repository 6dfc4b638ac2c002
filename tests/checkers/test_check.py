"""What the checkers judge, what they refuse, and that they let pass what is right."""

from __future__ import annotations

import pytest

from tests import helpers
from tests.checkers.example import LOOP, TRACE, WORLD, inserted
from topo_verify import InputError, World
from topo_verify.checkers import CLAIMS, Finding, check
from topo_verify.checkers.darts import KnownDart
from topo_verify.checkers.replayed_trace import ReplayedTrace
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept


@pytest.mark.parametrize(
    "world_id",
    [
        "m5/481",  # a sequence is cited after rejections without motion, which have no number
        "m6/11094",  # a record is cited less deep than it goes
        "m6/23746",  # a record shows the marker's direction
        "m7/20231",  # a record is cited beyond its first place
        "m7/21540",  # a record lies behind explored edges
        "m7/41544",  # a record lies behind the hypothesis
    ],
)
def test_no_claim_fails_where_evidence_comes_from_far(world_id: str) -> None:
    world = World.from_id(world_id)
    for name in helpers.PAPER:
        assert set(helpers.statuses(world, helpers.trace_of(world, name)).values()) == {"ok"}


def test_the_numbers_of_the_worlds_own_darts_do_not_matter() -> None:
    other = WORLD.renumbered([9, 3, 0, 5, 1, 7, 2, 8, 6, 4])
    assert other.root == 9
    trace = helpers.trace_of(other, "enhancement-iii-all")
    assert trace == TRACE
    assert set(helpers.statuses(other, trace).values()) == {"ok"}
    assert helpers.failing(other, helpers.edited(trace, 4, door=2)) == helpers.failing(
        WORLD, helpers.edited(TRACE, 4, door=2)
    )


def test_the_claims_are_those_of_the_semantics_in_their_order() -> None:
    names = [
        "percepts-true", "true-hypothesis-posed", "true-hypothesis-kept", "no-false-confirm",
        "map-isomorphic", "cost-honest", "cost-within-bound", "rejection-justified",
    ]  # fmt: skip
    assert list(CLAIMS)[:8] == names
    assert [judgement.claim for judgement in check(WORLD, TRACE)] == list(CLAIMS)
    assert set(names) == helpers.EIGHT


def test_a_finding_names_the_claim_the_event_and_what_should_be_there() -> None:
    (finding,) = check(WORLD, helpers.edited(TRACE, 1, percept=Percept(6, None)))[0].findings
    assert finding == Finding(
        "percepts-true", 1, Percept(7, None), Percept(6, None),
        "the trace says (degree 6, no marker) where the world shows (degree 7, no marker)",
    )  # fmt: skip


def test_what_was_found_is_not_changed_afterwards() -> None:
    judgement = check(WORLD, helpers.edited(TRACE, 1, percept=Percept(6, None)))[0]
    with pytest.raises(AttributeError, match="immutable"):
        judgement.status = "ok"  # type: ignore[misc]  # pyright: ignore[reportAttributeAccessIssue]
    with pytest.raises(AttributeError, match="immutable"):
        judgement.findings[0].claim = ""  # type: ignore[misc]  # pyright: ignore[reportAttributeAccessIssue]


@pytest.mark.parametrize(
    "trace",
    [
        (),
        TRACE[1:],
        (*TRACE, TRACE[0]),
        (TRACE[0], *TRACE),
        (*TRACE, TRACE[-1]),
        (TRACE[0], TRACE[-1], *TRACE[1:]),
    ],
)
def test_events_in_no_such_order_are_refused(trace: ev.Trace) -> None:
    with pytest.raises(InputError, match="'start'"):
        check(WORLD, trace)


def test_decisions_that_were_not_declared_are_not_called_ok() -> None:
    moves = tuple(e for e in TRACE if isinstance(e, ev.Start | ev.Move | ev.Finish))
    verdict = helpers.statuses(WORLD, moves)
    assert verdict["percepts-true"] == verdict["map-isomorphic"] == verdict["cost-honest"] == "ok"
    for claim in helpers.EIGHT:
        assert (verdict[claim] == "not-declared") == bool(CLAIMS[claim][1])


SEEN = Percept(0, None)
"""What the empty world shows."""


@pytest.mark.parametrize(
    ("event", "claim"),
    [
        (ev.Move(0, SEEN), "percepts-true"),
        (ev.Pose(0, ()), "true-hypothesis-posed"),
        (ev.Confirm(0, 0, "motion"), "no-false-confirm"),
        (ev.Augment(0, "new", 0, 0), "map-isomorphic"),
        (
            ev.Reject(0, 0, "motion", ev.Evidence(0, Percept(1, 0), Percept(0, None))),
            "rejection-justified",
        ),
    ],
)
def test_in_the_empty_world_every_event_is_a_lie(event: ev.Event, claim: str) -> None:
    assert claim in helpers.failing(
        helpers.EMPTY, inserted(helpers.trace_of(helpers.EMPTY), 1, event)
    )


def test_a_replayed_trace_knows_where_the_robot_was_and_what_s_was() -> None:
    run = ReplayedTrace(WORLD, TRACE)
    assert run.cost == 16
    assert run.positions[0] == WORLD.root
    assert (run.illegal, run.spoiled) == (None, None)
    assert run.map.is_open(2, LOOP)
    assert not run.map.is_open(2, LOOP + 1)
    assert run.map.alpha[KnownDart(2)] == 5
    assert [r.truth for r in run.rounds if r.event.edge == 2] == [5] * 5


def test_a_trace_with_a_door_that_is_not_there_is_no_history() -> None:
    run = ReplayedTrace(WORLD, helpers.edited(TRACE, helpers.place(TRACE, ev.Move), door=99))
    assert run.false_percepts == []
    assert not run.is_history


@pytest.mark.parametrize("degree", [-1, 0, 2**62])
@pytest.mark.parametrize("index", [0, 1])
def test_false_percepts_prove_nothing_and_are_not_even_folded(index: int, degree: int) -> None:
    lie = helpers.edited(TRACE, index, percept=Percept(degree, None))
    assert helpers.failing(WORLD, lie) == {"percepts-true", "map-entailed", "decisions-entailed"}


def test_false_percepts_justify_no_rejection_by_folding() -> None:
    trace = helpers.trace_of(WORLD, "folding")
    assert not helpers.failing(WORLD, trace)
    assert "rejection-justified" in helpers.failing(
        WORLD, helpers.edited(trace, 0, percept=Percept(2**62, 0))
    )
