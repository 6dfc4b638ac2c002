"""A log judged by itself: proved, incomplete with what is left to walk, or refuted."""

from __future__ import annotations

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.helpers import EMPTY, any_world, path, trace_of, worlds
from topo_verify import World, certify
from topo_verify.checkers import Fold
from topo_verify.errors import InputError, InternalError
from topo_verify.robot.events import Augment, Event, Finish, MapData, Move, Start, Trace
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import SimulatedRobot, exit_dart, first_percept
from topo_verify.studies.log_report import open_doors

LEAF, THERE, BACK = Start(percept=Percept(1, 0)), Move(0, Percept(1, None)), Move(0, Percept(1, 0))
"""The world of one edge, walked there and back."""


def plain(trace: Trace) -> list[Event]:
    """The doors and percepts alone, as a real robot writes them."""
    return [
        msgspec.structs.replace(event, purpose=None) if isinstance(event, Move) else event
        for event in trace
        if isinstance(event, Start | Move)
    ]


def test_a_plain_log_of_a_right_mapper_proves_the_world() -> None:
    for world in worlds(range(1, 4)):
        certificate = certify(plain(trace_of(world)))
        assert certificate.map is not None
        assert certificate.map.is_isomorphic(world)
        assert (certificate.open_darts, certificate.decisions, certificate.findings) == (0, 0, ())


def test_a_whole_trace_has_its_decisions_judged_too() -> None:
    certificate = certify(trace_of("m4/300"))
    assert certificate.map is not None
    assert certificate.entailed == certificate.decisions > 0
    assert not certificate.findings


def test_a_log_that_stops_early_has_two_worlds_that_tell() -> None:
    log = plain(trace_of("m4/300"))
    certificate = certify(log[:-2])
    assert certificate.map is None
    one, other = certificate.witnesses
    assert not one.is_isomorphic(other)
    assert (certificate.verdict, certificate.findings) == ("UNKNOWN", ())
    assert (certificate.vertices, certificate.edges) == (len(one.vertices), len(one.edges))
    assert len(other.edges) == certificate.edges + certificate.open_darts


def test_a_log_that_no_world_shows_names_its_line() -> None:
    log = plain(trace_of("m4/300"))
    log[2] = Move(0, Percept(9, None))
    log.insert(3, Move(0, Percept(7, None)))
    certificate = certify(log)
    assert (certificate.verdict, certificate.map, certificate.fold) == ("REFUTED", None, None)
    assert certificate.witnesses == ()
    assert not open_doors(certificate)
    assert certificate.findings[0].event is not None
    assert "no world shows this history" in certificate.findings[0].message


def test_a_delivered_map_must_be_the_proved_one() -> None:
    trace = trace_of("m2/0")
    wrong = (*trace[:-1], Finish(99, MapData(((0,), (1,)), ((0, 1),), 0)))
    assert {f.claim for f in certify(wrong).findings} == {
        "map-isomorphic", "map-entailed", "cost-honest",
    }  # fmt: skip


def test_standing_in_the_world_without_edges_proves_it() -> None:
    certificate = certify([Start(percept=Percept(0, None))])
    assert certificate.map == EMPTY


def test_out_of_order_is_refused() -> None:
    with pytest.raises(InputError, match="out of order"):
        certify([Move(0, Percept(1, None))])
    with pytest.raises(InputError, match="out of order"):
        certify([])


@given(any_world(max_edges=9), st.data())
def test_a_tampered_log_is_caught_or_certifies_a_world_that_shows_it(
    world: World, data: st.DataObject
) -> None:
    log = plain(trace_of(world, "folding"))
    for _ in range(data.draw(st.integers(1, 3))):
        place = data.draw(st.integers(1, len(log) - 1))
        move = log[place]
        assert isinstance(move, Move)
        degree = data.draw(st.integers(1, 5))
        marker = data.draw(st.none() | st.integers(0, degree - 1))
        tampered = Move(data.draw(st.integers(0, 4)), Percept(degree, marker))
        log[place] = data.draw(st.sampled_from([tampered, Move(tampered.door, move.percept)]))
    certificate = certify(log)
    for shown in (certificate.map, *certificate.witnesses):
        if shown is not None:
            robot = SimulatedRobot(shown, budget=len(log))
            assert all(not isinstance(e, Move) or robot.move(e.door) == e.percept for e in log)
    expected = (
        "REFUTED" if certificate.fold is None else "UNKNOWN" if certificate.open_darts else "PROVED"
    )
    assert certificate.verdict == expected


def test_a_fold_that_does_not_show_its_log_would_be_a_bug_of_ours(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def another(_fold: Fold, _hang: int = 1) -> World:
        return path(3, marker=0)

    monkeypatch.setattr(Fold, "world", another)
    with pytest.raises(InternalError):
        certify(plain(trace_of("m4/300")))
    incomplete = certify(plain(trace_of("m4/300"))[:-2])
    with pytest.raises(InternalError):
        _ = incomplete.witnesses


def test_a_false_decision_is_found_with_its_world_proved() -> None:
    trace = list(trace_of("m3/14"))
    place = next(i for i, event in enumerate(trace) if isinstance(event, Augment))
    trace[place] = msgspec.structs.replace(trace[place], degree=9)
    certificate = certify(trace)
    assert certificate.map is not None
    assert certificate.entailed < certificate.decisions
    assert certificate.findings


def test_a_false_decision_at_the_end_of_a_log_is_found_in_its_world() -> None:
    certificate = certify([LEAF, THERE, BACK, Augment(0, "new", 1, 9)])
    assert certificate.map == World.from_id("m1/0")
    wrong = {finding.claim for finding in certificate.findings if finding.event == 3}
    assert wrong == {"map-isomorphic", "decisions-entailed"}


def test_a_log_is_not_a_mapper_and_may_walk_an_edge_as_often_as_it_likes() -> None:
    certificate = certify([LEAF, THERE, BACK, THERE, BACK, THERE])
    assert (certificate.verdict, certificate.findings) == ("PROVED", ())
    assert certificate.map == World.from_id("m1/0")


def test_a_log_with_decisions_may_walk_an_edge_as_often_as_it_likes() -> None:
    walk = [THERE, BACK] * 20  # m1/0 has one edge: a mapper owes less
    certificate = certify([LEAF, *walk, THERE, Augment(0, "new", 1, 1)])
    assert (certificate.verdict, certificate.decisions) == ("PROVED", 1)
    assert certificate.findings == ()


def test_decisions_are_judged_however_large_the_proved_world(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("topo_verify.checkers.claims.LARGE", 0)
    certificate = certify([LEAF, THERE, BACK, Augment(0, "new", 1, 9)])
    assert "decisions-entailed" in {finding.claim for finding in certificate.findings}


def test_a_map_that_an_incomplete_log_delivers_does_not_follow() -> None:
    trace = trace_of("m4/300")
    delivered = (*plain(trace)[:-2], trace[-1])
    (finding,) = certify(delivered).findings
    assert (finding.claim, finding.event) == ("map-entailed", len(delivered) - 1)
    assert finding.witness is not None


def test_a_decision_in_an_incomplete_log_that_does_not_follow_is_found() -> None:
    start = Start(percept=first_percept(World.from_id("m2/0")))
    certificate = certify([start, Augment(0, "new", 1, 2)])
    assert (certificate.verdict, certificate.entailed, certificate.decisions) == ("REFUTED", 0, 1)
    (finding,) = certificate.findings
    assert (finding.claim, finding.event) == ("decisions-entailed", 1)


def test_decisions_in_a_log_that_stops_early_follow_all_the_same() -> None:
    trace = trace_of("m4/300")
    crossed = [i for i, e in enumerate(trace) if isinstance(e, Move) and e.purpose == "cross"]
    certificate = certify(trace[: crossed[-1]])
    assert (certificate.verdict, certificate.entailed) == ("UNKNOWN", certificate.decisions)


# ---------------------------------------------------------------- what is left to walk


@given(any_world(max_edges=12), st.lists(st.integers(0, 23), max_size=20))
def test_the_walk_to_an_open_door_ends_where_the_door_is_said_to_be(
    world: World, doors: list[int]
) -> None:
    robot = SimulatedRobot(world, budget=len(doors))
    log: list[Event] = [Start(percept=robot.percept)]
    at, crossed = world.root or 0, set[int]()
    places = [at]  # of each event: the robot's reference dart
    for door in doors:
        if robot.percept.degree:
            log.append(Move(taken := door % robot.percept.degree, robot.move(taken)))
            leaves = exit_dart(world, at, taken)
            at = world.alpha[leaves]
            crossed |= {leaves, at}
            places.append(at)
    certificate = certify(log)
    found = open_doors(certificate)
    assert len(found) == certificate.open_darts
    assert [len(door.walk) for door in found] == sorted(len(door.walk) for door in found)
    for opened in found:
        exits, here = exit_dart(world, places[opened.event], opened.door), at
        for step in opened.walk[:-1]:
            here = exit_dart(world, here, step)
            assert here in crossed
            here = world.alpha[here]
        assert exit_dart(world, here, opened.walk[-1]) == exits
    assert open_doors(certificate, 2) == found[:2]


def test_an_open_door_is_named_from_the_first_event_at_its_place() -> None:
    crossing, v0 = Percept(4, None), Percept(2, 0)
    log: list[Event] = [Start(percept=v0), Move(0, crossing), Move(0, v0), Move(0, crossing)]
    named = {(door.event, door.door) for door in open_doors(certify([*log, Move(1, crossing)]))}
    assert named == {(0, 1), (1, 2), (1, 3), (4, 1), (4, 2), (4, 3)}


# ---------------------------------------------------------------- what a log may cost


def test_a_place_with_a_million_doors_makes_no_world_until_one_is_asked_for() -> None:
    certificate = certify([Start(percept=Percept(10**6, 0))])
    assert (certificate.verdict, certificate.open_darts) == ("UNKNOWN", 10**6)
    (nearest,) = open_doors(certificate, 1)
    assert (nearest.event, nearest.door, nearest.walk) == (0, 0, (0,))


def test_the_doors_of_all_places_of_a_log_have_a_bound() -> None:
    start = Start(percept=Percept(10**6, 0))
    with pytest.raises(InputError, match="have 1100000 doors together: expected at most 1048576"):
        certify([start, Move(0, Percept(10**5, None))])


def test_a_long_log_may_have_sixteen_doors_an_event(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("topo_verify.checkers.certificate.MOST_DARTS", 1)
    start = Start(percept=Percept(2, 0))
    assert certify([start, Move(0, Percept(30, None))]).verdict == "UNKNOWN"
    with pytest.raises(InputError, match="101 doors together: expected at most 32"):
        certify([start, Move(0, Percept(99, None))])
