"""The narrator: what it says of an event is so in the world, or is said to be the mapper's word."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import msgspec
import pytest

from tests.faults.every import EVERY
from tests.pictures.played import confirms_at_once
from tests.pictures.played import playback_of as played
from topo_verify import CATALOGUE, Percept, World
from topo_verify.campaign.run import explore
from topo_verify.pictures.narrator import Narrator, Saying
from topo_verify.pictures.scenes import Moment, Playback
from topo_verify.pictures.walk import Extent, lines
from topo_verify.programs.loader import Mapper
from topo_verify.robot import events as ev

WORLDS = ("m2/1", "m2/5", "m3/8", "m3/20", "m4/41")
LOOKED = "Every place on the way looked as it should"
LONG = 500
"""Events of a run that is not looked at: a wrong mapper may go on and on."""


def told(playback: Playback) -> list[tuple[Moment, Saying]]:
    return [*zip(playback.moments, Narrator(playback).sayings, strict=True)]


def runs() -> Iterator[Playback]:
    """The runs of all mappers, right and wrong, in small worlds."""
    mappers: list[Mapper | str] = [*CATALOGUE, *(fault.mapper for fault in EVERY.values())]
    for world in WORLDS[1:3]:
        for mapper in mappers:
            run = played(world, mapper)
            if len(run.trace) <= LONG:
                yield run


def is_true(playback: Playback, moment: Moment) -> bool:
    """Whether a decision is true in the world, as far as S is true."""
    event, drawn = moment.event, playback.map
    assert isinstance(event, ev.Reject | ev.Confirm)
    spoiled = playback.replayed.spoiled
    if spoiled is not None and spoiled < moment.number:
        return False
    if not drawn.is_open(event.edge, moment.number):
        return False
    leads_there = drawn.number.get(drawn.end(event.edge)) == event.hypothesis
    return leads_there == isinstance(event, ev.Confirm)


def test_what_is_false_in_the_world_is_the_mapper_s_word() -> None:
    false = good = 0
    for run in runs():
        for moment, saying in told(run):
            if isinstance(moment.event, ev.Reject | ev.Confirm):
                is_word = saying.title.endswith(", it says")
                assert is_word or is_true(run, moment), (saying, moment)
                assert is_word or not moment.findings
                false, good = false + is_word, good + (not is_word)
    assert min(false, good) > 200


def by_motion(playback: Playback) -> Iterator[tuple[Moment, Saying]]:
    for moment, saying in told(playback):
        if isinstance(moment.event, ev.Confirm) and moment.event.rule == "motion":
            yield moment, saying


def confirmations(playback: Playback) -> Iterator[tuple[Moment, Saying]]:
    """Each unexplored dart, confirmed by motion at each moment at which an edge is in question."""
    for moment in playback.moments:
        if moment.edge is None or isinstance(moment.event, ev.Confirm):
            continue
        for dart in playback.map.phi:
            if dart != moment.edge and playback.map.is_open(dart, moment.number):
                confirm = ev.Confirm(moment.edge, dart, "motion")
                cut = Playback(playback.world, (*playback.trace[: moment.number + 1], confirm))
                yield cut.moments[-1], Narrator(cut).sayings[-1]


@pytest.mark.parametrize("world", WORLDS[1:])
def test_all_looked_as_it_should_only_where_the_confirmation_is_true(world: str) -> None:
    run = played(world, "basic")
    false = 0
    for moment, saying in confirmations(run):
        if is_true(run, moment):
            assert saying.title.endswith("is right")
        else:
            false += 1
            assert saying.title.endswith("is right, it says")
            assert LOOKED not in saying.text
    assert false


@pytest.mark.parametrize("fault", ["mirrors-the-direction", "ignores-direction-behind-e"])
def test_a_wrong_confirmation_of_a_fault_is_not_told_as_one_that_looked_right(fault: str) -> None:
    wrong = [
        saying
        for world in ("m2/5", "m3/20")
        for moment, saying in by_motion(played(world, EVERY[fault].mapper))
        if "no-false-confirm" in {finding.claim for finding in moment.findings}
    ]
    assert wrong
    assert not any(LOOKED in saying.text for saying in wrong)


@pytest.mark.parametrize("name", ["basic", "enhancement-ii", "enhancement-iii-all+i"])
def test_a_right_confirmation_is_told_as_a_walk_on_which_all_looked_right(name: str) -> None:
    said = [saying for world in WORLDS for _, saying in by_motion(played(world, name))]
    assert {(saying.kind, LOOKED in saying.text) for saying in said} == {("ok", True)}
    assert not any("it says" in saying.title for saying in said)


def test_a_confirmation_whose_percepts_differ_shows_both() -> None:
    run = played("m2/5", EVERY["mirrors-the-direction"].mapper)
    saying = Narrator(run).sayings[3]
    assert saying.text == "Behind the new road the marker would have to point another way."
    assert (saying.kind, saying.seen, saying.expected) == ("bad", Percept(3, 1), Percept(3, 2))


def test_a_confirmation_that_was_not_walked_says_so_even_if_it_is_right() -> None:
    saying = Narrator(played("m4/41", "enhancement-ii", confirms_at_once(5))).sayings[9]
    assert saying.title == "Guess 3 is right, it says"
    assert saying.text == "The way home from there takes 1 road, to the marker. It walked 0 roads."


def test_a_longer_way_home_is_a_way_home() -> None:
    def goes_round_the_loop(trace: ev.Trace) -> list[ev.Event]:
        last = max(k for k, event in enumerate(trace) if isinstance(event, ev.Confirm))
        assert trace[last - 1] == ev.Move(1, Percept(1, 0), "validate")
        round_it = ev.Move(2, Percept(5, None), "validate"), ev.Move(2, Percept(1, 0), "validate")
        return [*trace[: last - 1], *round_it, trace[last]]

    run = played("m3/8", "basic", goes_round_the_loop)
    assert not run.moments[-1].findings
    assert LOOKED in Narrator(run).sayings[-1].text
    assert "way home" not in "".join(lines(run, extent=Extent(0, to_end=True)))


def test_a_guess_that_is_tested_shows_what_would_be_seen() -> None:
    run = played("m3/8", "basic")
    tests = [(m, one) for m, one in told(run) if one.title.startswith("Testing guess")]
    assert tests
    for moment, saying in tests:
        decided = next(
            m.event
            for m in run.moments[moment.number :]
            if isinstance(m.event, ev.Reject | ev.Confirm)
        )
        following = run.trace[moment.number + 1]
        if isinstance(following, ev.Reject):
            assert decided == following
            assert (saying.seen, saying.expected) == (
                following.evidence.observed,
                following.evidence.expected,
            )
        elif isinstance(following, ev.Confirm):
            assert saying.seen == saying.expected


def test_a_test_whose_doors_leave_s_expects_nothing() -> None:
    texts = {
        saying.text
        for fault in ("sets-out-unturned", "counts-doors-anticlockwise", "forgets-to-turn-home")
        if fault in EVERY
        for world in WORLDS
        for _, saying in told(played(world, EVERY[fault].mapper))
    }
    assert "By these doors it would leave its map, which expects nothing there." in texts


def test_behind_a_door_that_is_not_there_the_robot_is_lost() -> None:
    def takes_door_9(trace: ev.Trace) -> list[ev.Event]:
        return [*trace[:9], ev.Move(9, Percept(5, None)), *trace[10:]]

    sayings = Narrator(played("m4/41", "enhancement-ii", takes_door_9)).sayings
    assert sayings[9].title == "No such door"
    assert sayings[9].text == "It takes door 9, but the place has 5 exits: doors 0 to 4."
    assert {saying.title for saying in sayings[10:]} == {"The robot is lost"}


def test_a_false_map_is_not_told_as_true() -> None:
    def joins_wrongly(trace: ev.Trace) -> list[ev.Event]:
        return [*trace[:15], ev.Augment(7, "loop", 4, 5), *trace[16:]]

    sayings = Narrator(played("m4/41", "enhancement-ii", joins_wrongly)).sayings
    assert sayings[15].title == "The road closes a circle, it says"
    assert sayings[15].text == "In the world it is not so."


def test_a_false_map_is_not_told_to_be_the_world_even_without_judgements() -> None:
    run = played("m2/4", "basic")
    other = explore(World.from_id("m2/5"), "basic").trace[-1]
    wrong = Playback(run.world, [*run.trace[:-1], other])
    assert Narrator(run).sayings[-1].title == "The map is complete"
    assert Narrator(wrong).sayings[-1].title == "It delivers its map"


def test_evidence_that_is_not_there_is_not_told_as_seen() -> None:
    def cites(**evidence: Any) -> str:
        def edit(trace: ev.Trace) -> list[ev.Event]:
            return [
                replace_reject(event, evidence) if isinstance(event, ev.Reject) else event
                for event in trace
            ]

        said = told(played("m3/8", "basic", edit))
        return next(one.text for moment, one in said if isinstance(moment.event, ev.Reject))

    assert cites(step=9) == "What it cites is not to be found in its walk."
    assert "It says that it saw 7 exits." in cites(observed=Percept(7, None))
    assert "It says that at the dashed ring it would see 7 exits." in cites(
        expected=Percept(7, None)
    )


def replace_reject(event: ev.Reject, evidence: dict[str, Any]) -> ev.Reject:
    cited = msgspec.structs.replace(event.evidence, **evidence)
    return msgspec.structs.replace(event, evidence=cited)
