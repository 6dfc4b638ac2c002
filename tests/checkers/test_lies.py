"""No lie passes: doctored traces, judged twice by two programs that share nothing.

What passes both is harmless: things said in another order, a decision left out or repeated, the
same truth in other words. `docs/semantics.md` says what the claims do not ask.
"""

from __future__ import annotations

from contextlib import suppress

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.checkers.doctored import (
    Doctored,
    decisions,
    doctored,
    finishes,
    integers,
    maps,
    percepts,
    starts,
)
from tests.checkers.second_opinion import failing_claims, isomorphic
from tests.helpers import EIGHT, EMPTY, PAPER, any_world, edited, failing, of_type, trace_of
from topo_verify import InputError, World
from topo_verify.checkers import check
from topo_verify.robot.events import Event, Finish, MapData, Move, Start, Trace
from topo_verify.robot.simulator import Misuse, SimulatedRobot

names = st.sampled_from(PAPER)


@pytest.mark.long
@settings(max_examples=400)
@given(case=doctored())
@pytest.mark.no_cover
def test_a_doctored_trace_gets_the_same_verdict_from_a_second_opinion(case: Doctored) -> None:
    assert failing(case.world, case.trace) & EIGHT == failing_claims(case.world, case.trace)


@given(world=any_world(max_edges=6), name=names)
def test_a_real_trace_gets_the_same_verdict_from_a_second_opinion(world: World, name: str) -> None:
    trace = trace_of(world, name)
    assert failing(world, trace) == failing_claims(world, trace) == set()


def test_the_empty_world_gets_the_same_verdict_from_a_second_opinion() -> None:
    trace = trace_of(EMPTY)
    assert failing(EMPTY, trace) == failing_claims(EMPTY, trace) == set()


@pytest.mark.no_cover
@given(world=any_world(max_edges=5), name=names, data=st.data())
def test_any_other_percept_is_caught(world: World, name: str, data: st.DataObject) -> None:
    trace = trace_of(world, name)
    places = [i for i, event in enumerate(trace) if isinstance(event, Start | Move)]
    index, percept = data.draw(st.sampled_from(places)), data.draw(percepts)
    event = trace[index]
    assert isinstance(event, Start | Move)
    assume(event.percept != percept)
    assert "percepts-true" in failing(world, edited(trace, index, percept=percept))


@given(world=any_world(max_edges=5), name=names, data=st.data())
def test_any_other_door_is_caught_unless_it_would_have_shown_the_same(
    world: World, name: str, data: st.DataObject
) -> None:
    trace = trace_of(world, name)
    index = data.draw(st.sampled_from([i for i, e in enumerate(trace) if isinstance(e, Move)]))
    lie = edited(trace, index, door=data.draw(st.integers(0, 9) | integers))
    assert ("percepts-true" in failing(world, lie)) != shows_the_same(world, lie)


def shows_the_same(world: World, trace: Trace) -> bool:
    """Does a robot that takes these doors sense these percepts?"""
    robot = SimulatedRobot(world, len(trace))
    with suppress(Misuse):
        for move in of_type(Move, trace):
            robot.move(move.door)
    seen = [move.percept for move in of_type(Move, robot.events)]
    return seen == [move.percept for move in of_type(Move, trace)]


@given(world=any_world(max_edges=4), other=any_world(max_edges=4), drawn=st.none() | maps)
def test_any_other_map_is_caught_unless_it_is_isomorphic(
    world: World, other: World, drawn: MapData | None
) -> None:
    drawn = drawn or MapData(other.vertices, other.edges, other.marker)
    lie = edited(trace_of(world), -1, map=drawn)
    assert ("map-isomorphic" in failing(world, lie)) != isomorphic(drawn, world)


@pytest.mark.nightly
@settings(max_examples=300)
@given(
    world=any_world(max_edges=3),
    events=st.lists(decisions, max_size=12),
    head=starts,
    tail=finishes,
)
@pytest.mark.no_cover
def test_nonsense_is_judged_and_never_crashes(
    world: World, events: list[Event], head: Start, tail: Finish
) -> None:
    for trace in ((head, *events, tail), (head, *events)):
        assert failing(world, trace) & EIGHT == failing_claims(world, trace)


@given(events=st.lists(decisions | starts | finishes, max_size=5))
def test_events_in_any_order_are_judged_or_refused(events: list[Event]) -> None:
    with suppress(InputError):
        check(World.from_id("m2/5"), events)


def test_the_second_opinion_knows_a_mirror_image() -> None:
    world = World.from_id("m2/4")
    other = world.mirror()
    assert world.code != other.code
    assert not isomorphic(MapData(other.vertices, other.edges, other.marker), world)
    assert isomorphic(MapData(world.vertices, world.edges, world.marker), world)
