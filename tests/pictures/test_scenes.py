"""What each event of a run means: places, questions, evidence, findings."""

from __future__ import annotations

from itertools import islice

import msgspec
import pytest

from tests.helpers import some, trace_of, typed, worlds
from topo_verify import World
from topo_verify.algorithms import CATALOGUE
from topo_verify.campaign.run import explore
from topo_verify.checkers import check
from topo_verify.checkers.darts import KnownDart
from topo_verify.pictures.scenes import Growth, Playback, Spent
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept


def playback(
    world: str, mapper: str = "basic", changed: dict[int, ev.Event] | None = None
) -> Playback:
    """A run of a mapper in a world, some of its events replaced by others."""
    there = World.from_id(world)
    trace = list(trace_of(there, mapper))
    for number, event in (changed or {}).items():
        trace[number] = event
    return Playback(there, trace, check(there, trace))


@pytest.fixture(scope="module")
def example() -> Playback:
    """The example of docs/semantics.md, section 13: events 8 to 15 are printed there."""
    return playback("m4/41", "enhancement-ii")


def test_a_moment_says_where_the_robot_really_stands(example: Playback) -> None:
    cross, first_try = example.moments[7], example.moments[9]
    assert (cross.known, cross.through) == (5, 7)  # edge 7 does lead to dart 5
    assert (first_try.known, first_try.through) == (4, 3)
    assert first_try.position == example.map.phi[KnownDart(4)]


def test_a_moment_says_which_hypotheses_are_left(example: Playback) -> None:
    assert [(m.edge, m.hypotheses) for m in example.moments[8:16]] == [
        (7, (3, 4, 5)),
        (7, (3, 4, 5)),
        (7, (4, 5)),
        (7, (5,)),
        (7, (5,)),
        (7, (5,)),
        (7, ()),
        (None, ()),
    ]


def test_a_moment_says_what_was_spent_on_what(example: Playback) -> None:
    assert example.moments[-1].spent == Spent(walk=1, cross=4, validate=3, retrace=1)
    assert example.moments[-1].spent.cost == example.cost == 9


def test_s_grows_as_the_mapper_declares(example: Playback) -> None:
    assert example.moments[15].growth == Growth(7, "loop", 5, 5, True)
    assert example.map_at(15) == (((0, 1), (1, 5), (6, 2)), ((0, 1), (2, 6), (7, 5)))
    assert example.map_at(14).edges == ((0, 1), (2, 6))


def test_a_rejection_shows_where_its_evidence_lies(example: Playback) -> None:
    moved, free = example.moments[10].mismatch, example.moments[11].mismatch
    assert moved is not None
    assert (moved.sequence, moved.doors, moved.traced) == (None, (3,), (3, 0))
    assert free is not None
    assert (free.sequence, free.doors, free.traced) == (0, (3,), (4, 6))
    assert free.trail == moved.trail  # both look at the same place of the world


@pytest.mark.parametrize("name", ["basic", "enhancement-i", "enhancement-iii-all+i", "folding"])
def test_the_places_of_evidence_show_the_percepts_that_it_cites(name: str) -> None:
    seen = 0
    for world in [*worlds([3]), *islice(worlds([4]), 0, None, 8)]:
        run = Playback(world, trace_of(world, name))
        for moment in run.moments:
            if not isinstance(moment.event, ev.Reject):
                continue
            found = some(moment.mismatch)
            if found.evidence.observed is not None:
                assert run.map.seen_at(found.trail[-1]) == found.evidence.observed
                if found.leaves is None:
                    at = run.map.phi[found.traced[-1]]
                    assert run.map.seen_at(at) == found.evidence.expected
                assert (found.leaves is None) == (found.evidence.record is None)
            seen += 1
    assert seen > 50


def test_records_are_shown_when_they_are_written() -> None:
    run = playback("m4/41", "enhancement-iii-all")
    (written,) = [moment for moment in run.moments if moment.recorded]
    ((dart, word),) = written.recorded
    assert (written.number, dart, [step.door for step in word]) == (15, 3, [3])


def test_a_finding_stands_at_its_event() -> None:
    wrong = ev.Confirm(7, 4, "motion")
    run = playback("m4/41", "enhancement-ii", {14: wrong})
    assert "no-false-confirm" in {finding.claim for finding in run.moments[14].findings}
    assert some(run.first_finding).event == 14


def test_behind_an_illegal_move_nothing_is_known() -> None:
    illegal = ev.Move(9, Percept(5, None))
    run = playback("m4/41", "enhancement-ii", {9: illegal})
    assert run.moments[8].position is not None
    assert [(m.position, m.known) for m in run.moments[9:]] == [(None, None)] * 14
    assert run.moments[9].left_by is None


def test_a_false_map_is_told_from_a_true_one() -> None:
    false = ev.Augment(7, "new", 8, 5)
    run = playback("m4/41", "enhancement-ii", {15: false})
    assert [m.growth.true for m in run.moments if m.growth] == [True, True, False, None]


def test_evidence_that_is_not_there_has_no_place() -> None:
    trace = trace_of("m4/41", "enhancement-ii")
    reject = typed(ev.Reject, trace[10])
    for evidence in (ev.Evidence(2), ev.Evidence(-1), ev.Evidence(1, sequence=3)):
        false = msgspec.structs.replace(reject, evidence=evidence)
        assert playback("m4/41", "enhancement-ii", {10: false}).moments[10].mismatch is None
    for hypothesis in (2**60, -1, 0):
        false = msgspec.structs.replace(reject, hypothesis=hypothesis)
        assert playback("m4/41", "enhancement-ii", {10: false}).moments[10].mismatch is None


def test_findings_about_the_run_come_after_those_of_an_event() -> None:
    run = playback("m4/41")
    assert run.first_finding is None
    cut = Playback(run.world, run.trace[:9], check(run.world, run.trace[:9]))
    assert some(cut.first_finding) in cut.about_the_run


def test_a_world_without_edges_has_one_moment_and_a_finish() -> None:
    world = World((), (), None)
    assert [m.spent.cost for m in Playback(world, explore(world).trace).moments] == [0, 0]


def test_every_mapper_of_the_catalogue_can_be_played() -> None:
    for name in CATALOGUE:
        run = playback("m5/17", name)
        assert [m.number for m in run.moments] == [*range(len(run.trace))]
