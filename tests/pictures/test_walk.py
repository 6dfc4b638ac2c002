"""The text of a walk: what a reader finds in it, at any width, whatever the mapper is called."""

from __future__ import annotations

import re
from typing import Any

import msgspec
import pytest

from tests.helpers import some, trace_of, worlds
from tests.pictures.played import confirms_at_once
from tests.pictures.played import playback_of as played
from topo_verify import CATALOGUE, Percept, Robot, World, examine
from topo_verify.checkers import Finding, Judgement
from topo_verify.checkers.darts import KnownDart
from topo_verify.faults import FAULTS
from topo_verify.pictures.detours import circle, turns, way_home
from topo_verify.pictures.scenes import Playback
from topo_verify.pictures.walk import Extent, is_shown, lines, parting
from topo_verify.robot import events as ev
from topo_verify.world.families import lattice

ALL = Extent(0, to_end=True)


def text(playback: Playback, width: int = 200, extent: Extent | None = None) -> str:
    return "\n".join(lines(playback, width, extent or Extent()))


@pytest.fixture(scope="module")
def unturned() -> Playback:
    """A mapper that forgets, at the first door after a way back, that it is turned."""
    return played("m3/8", FAULTS["sets-out-unturned"].mapper)


def stands(_robot: Robot) -> None:
    pass


def walks(robot: Robot) -> object:
    while True:
        robot.move(0)


# ---------------------------------------------------------------- what is shown


def test_a_row_has_the_door_the_percept_the_true_place_and_the_cost(unturned: Playback) -> None:
    (row,) = [line for line in lines(unturned) if line.startswith("    6 ")]
    assert row.split() == ["6", "3", "v1:2", "5", "v1:4", "w1:4", "3", "validate"]


def test_a_rejection_has_its_reason_and_where_its_evidence_lies(unturned: Playback) -> None:
    assert (
        "rejects that edge 2 leads to 3 (by motion): behind door 3 from v1:3 it expects"
        " (1, marker 0), saw (5) at w1:4"
    ) in text(unturned)


def test_a_door_counted_from_the_wrong_dart_is_told(unturned: Playback) -> None:
    assert "came here by v1:4 and back by v1:2, so door 2 is door 0 counted from v1:4" in text(
        unturned
    )
    assert "the way home from v1:4 is by door 2" in text(unturned)


def test_an_edge_that_was_not_crossed_is_told_with_the_door_that_leads_to_it() -> None:
    run = played("m3/8", FAULTS["goes-on-as-if-just-come-in"].mapper)
    assert "door 4 at event 13 led out by v1:5; edge 3 (v1:3) was behind door 2 there" in text(run)


def test_a_mapper_that_no_command_line_finds_is_played_from_python() -> None:
    def lost(robot: Robot) -> None:
        robot.declare(ev.Pose(edge=0, hypotheses=()))
        robot.move(0)

    told = " ".join(str(examine(lost, "m3/5")).split())
    assert "1 more event: tv.explore(world, mapper).save('run.html') plays the whole run." in told


def test_the_view_ends_at_the_first_finding_and_all_shows_the_rest(unturned: Playback) -> None:
    assert some(unturned.first_finding).event == 10
    brief, whole = text(unturned), text(unturned, extent=ALL)
    assert "48 more events" in brief
    assert "\n   11 " not in brief
    assert f"\n   {len(unturned.trace) - 1} " in whole
    assert brief.count("!! true-hypothesis-kept") == 1 < whole.count("!! true-hypothesis-kept")


def test_the_view_begins_some_moves_before_the_finding() -> None:
    world = lattice(5, 5)
    run = played(world, "basic", edit=lambda trace: [*trace[:-1], wrong_cost(trace[-1])])
    rows = [line for line in lines(run) if re.match(r" *\d+ +\d+ ", line)]
    assert len(rows) == 10
    assert re.search(r"… \d+ events before, \d+ moves", text(run))


def wrong_cost(finish: ev.Finish) -> ev.Finish:
    return msgspec.structs.replace(finish, cost=1)


def test_the_view_begins_where_it_is_asked_to(unturned: Playback) -> None:
    shown = text(unturned, extent=Extent(9, to_end=True))
    assert "9 events before, 4 moves; it asks where edge 2 leads" in shown
    assert "\n    8 " not in shown


def test_each_finding_of_the_view_is_said_to_be_shown(unturned: Playback) -> None:
    brief, whole = text(unturned, 4000), text(unturned, 4000, ALL)
    shown = [f for f in unturned.findings if is_shown(unturned, f)]
    assert brief.count("!! ") == len(shown) < len(unturned.findings) == whole.count("!! ")
    assert all(f"!! {finding.claim}: {finding.message}" in brief for finding in shown)
    assert all(is_shown(unturned, finding, ALL) for finding in unturned.findings)


def test_s_is_listed_with_the_truth_in_brackets(unturned: Playback) -> None:
    assert text(unturned).endswith("  v0 (w0): 0-1\n  v1 (w1): 1-0  2-?[4]  3-?[5]  4-?[2]  5-?[3]")


def test_what_s_has_wrong_is_marked() -> None:
    def joins_wrongly(trace: ev.Trace) -> list[ev.Event]:
        return [*trace[:15], ev.Augment(7, "loop", 4, 5), *trace[16:]]

    shown = text(played("m4/41", "enhancement-ii", edit=joins_wrongly))
    assert "3-?[4]  4-7![3]  5-?[7]" in shown
    assert "7-4![5]" in shown


def test_a_vertex_that_the_world_does_not_have_is_named() -> None:
    def draws_wrongly(trace: ev.Trace) -> list[ev.Event]:
        return [*trace[:15], ev.Augment(7, "new", 8, 2**60), *trace[16:]]

    assert "v3 (no such vertex): 8-7  9-?" in text(
        played("m4/41", "enhancement-ii", edit=draws_wrongly)
    )


def test_of_a_large_s_the_vertices_are_listed_that_the_moment_is_about() -> None:
    run = played(lattice(6, 6), "basic", edit=lambda trace: [*trace[:-1], wrong_cost(trace[-1])])
    assert "and 35 vertices more" in text(run)


def test_a_circle_is_shown_once() -> None:
    run = played("m3/8", walks)
    found = some(circle(run))
    assert (found.first, found.last, found.period, found.moves) == (1, 2, 2, 36)
    shown = text(run)
    assert "Events 1 to 2 repeat to the end of the run, 18 times in all." in shown
    assert "\n    3 " not in shown
    assert "asked for more than 36 moves" in shown


def test_a_walk_that_does_not_repeat_is_no_circle() -> None:
    cut = trace_of("m4/41")[:-1]
    assert circle(Playback(World.from_id("m4/41"), cut)) is None
    assert circle(played("m4/41", "basic")) is None


def test_before_a_door_that_is_not_there_the_vertex_is_shown_with_its_doors() -> None:
    def leaves_by_9(robot: Robot) -> object:
        robot.move(0)
        return robot.move(9)

    shown = text(played("m3/8", leaves_by_9))
    assert "asked for door 9 at a vertex with 5 doors" in shown
    assert (
        "The robot stands at w1:1, a vertex with 5 doors:\n  door 0: back, to v0:0 (w0:0)" in shown
    )


def test_an_illegal_move_in_a_trace_is_shown_with_the_doors_that_are_there() -> None:
    def takes_door_9(trace: ev.Trace) -> list[ev.Event]:
        return [*trace[:9], ev.Move(9, Percept(5, None)), *trace[10:]]

    shown = text(played("m4/41", "enhancement-ii", edit=takes_door_9))
    assert "there is no door 9 at a vertex of degree 5" in shown
    assert "The robot stands at v1:5 (w1:5), a vertex with 5 doors:" in shown
    (row,) = [line for line in shown.splitlines() if line.startswith("    9 ")]
    assert row.split() == ["9", "9", "?", "5", "?", "?", "4"]


def test_a_false_map_is_shown_where_it_differs_first() -> None:
    def mirrored(robot: Robot) -> dict[str, Any]:
        found: Any = CATALOGUE["basic"](robot)
        return {
            "vertices": [row[::-1] for row in found.vertices],
            "edges": found.edges,
            "marker": 0,
        }

    def delivers_another(_robot: Robot) -> World:
        return World.from_id("m2/6")

    shown = text(played("m2/4", mirrored))
    assert "The map is the world's mirror image: list the darts of each vertex clockwise." in shown
    shown = text(played("m2/4", delivers_another))
    assert "from the marker on: dart 0 leads to 1 in the world and to 3 in the map." in shown


def test_what_was_never_crossed_is_listed_where_the_map_is_not_proved() -> None:
    def guesses(robot: Robot) -> dict[str, Any]:
        robot.move(0)
        return {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}

    shown = text(played("m3/8", guesses))
    assert "Never crossed: w1:2 to w1:4, w1:3 to w1:5." in shown
    assert "vertex 1 has degree 5 in the world and 1 in the map" in shown
    assert "The mapper has declared nothing about its map S." in shown


def test_a_confirmation_that_was_not_walked_says_what_the_way_home_is() -> None:
    shown = text(played("m4/41", "enhancement-ii", edit=confirms_at_once(5)))
    assert "(the way home from v1:5 is by door 1; the robot took no door)" in shown


@pytest.mark.parametrize(
    ("world", "seen", "confirmed", "remark"),
    [
        ("m2/1", Percept(1, 0), ev.Confirm(2, 3, "motion"), ""),
        (
            "m4/105",
            Percept(2, 1),
            ev.Confirm(3, 4, "motion"),
            "(behind door 1 from v1:4 the robot would see (2, marker 0); it saw (2, marker 1))",
        ),
    ],
)
def test_a_confirmation_after_going_back_rests_on_the_walk_that_was_taken_back(
    world: str, seen: Percept, confirmed: ev.Confirm, remark: str
) -> None:
    def goes_back(trace: ev.Trace) -> list[ev.Event]:
        there_and_back = ev.Move(1, seen), ev.Move(0, Percept(3, None))
        return [*trace[:6], *there_and_back, confirmed]

    shown = text(played(world, "basic", edit=goes_back))
    assert f"confirms that edge {confirmed.edge}" in shown
    assert "took no door" not in shown
    assert remark in shown


def test_a_confirmation_against_what_was_seen_says_what_it_should_have_been() -> None:
    def confirms_dart_1(trace: ev.Trace) -> list[ev.Event]:
        return [*trace[:3], ev.Confirm(0, 1, "motion")]

    shown = text(played("m2/5", "basic", edit=confirms_dart_1))
    assert "(at v0:1 the robot would see (3, marker 2); it saw (3, marker 1))" in shown
    assert "(v0:1 is at v0: the way home has no door, so this percept decides)" in shown


def test_behind_a_false_augmentation_nothing_is_held_against_the_true_map() -> None:
    wrong = played("m4/204", FAULTS["leaves-out-the-darts-of-vk"].mapper)
    shown = text(wrong, extent=ALL)
    spoiled = wrong.replayed.spoiled
    assert shown.count("(from here on the mapper's map is false;") == 1
    assert f"which is not looked for: the mapper's map is false since event {spoiled}" in shown
    assert "it leaves out" not in shown[shown.index("from here on") :]


def test_a_right_confirmation_needs_no_remark() -> None:
    assert "way home" not in text(played("m4/41", "enhancement-ii"), extent=ALL)


def test_a_pose_says_which_darts_it_leaves_out() -> None:
    def asks_about_3_alone(trace: ev.Trace) -> list[ev.Event]:
        return [*trace[:8], ev.Pose(7, (3,)), *trace[9:]]

    shown = text(played("m4/41", "enhancement-ii", edit=asks_about_3_alone))
    assert "(it leaves out 4, 5, unexplored too, at places that look like this one)" in shown


def test_a_pose_after_further_moves_is_said_to_come_late() -> None:
    def moves_first(trace: ev.Trace) -> list[ev.Event]:
        return [*trace[:8], trace[9], trace[8], *trace[10:]]

    shown = text(played("m4/41", "enhancement-ii", edit=moves_first))
    assert "(it asks late: it crossed edge 7 at event 7, and has moved on since)" in shown


def test_two_runs_are_shown_up_to_where_they_part() -> None:
    run = played("m4/41", "enhancement-ii")
    sides = [("one", "reject 4"), ("other\x1b[31m", "go back")]
    shown = "\n".join(parting(run, 11, sides))
    assert "rejects that edge 7 leads to 3" in shown
    assert (
        "Here they part:\n  one: reject 4\n  other\\x1b[31m: go back\n\nS after event 10" in shown
    )
    assert "\n   11 " not in shown


# ---------------------------------------------------------------- in every form


@pytest.mark.parametrize("width", [50, 64, 80, 120, 200])
def test_no_line_is_wider_than_the_reader_s_window(unturned: Playback, width: int) -> None:
    for extent in (Extent(), ALL):
        assert max(map(len, lines(unturned, width, extent))) <= width
    assert max(map(len, lines(played(lattice(5, 5), "basic"), width, ALL))) <= width


@pytest.mark.parametrize("name", ["basic", "folding", "enhancement-iii-all+i"])
def test_every_run_can_be_shown(name: str) -> None:
    for world in [World((), (), None), *worlds([1, 2, 3])]:
        shown = text(played(world, name), extent=ALL)
        assert "delivers a map" in shown
        assert shown.isprintable() or "\n" in shown


def test_what_a_mapper_says_controls_no_terminal() -> None:
    def raises(_robot: Robot) -> object:
        raise ValueError("\x1b[31m\u202eboom\n" * 3)

    shown = text(played("m3/8", raises))
    assert all(line.isprintable() for line in shown.splitlines())
    assert "\\x1b[31m" in shown


def test_a_judgement_without_an_event_is_shown() -> None:
    run = Playback(
        World.from_id("m1/0"),
        trace_of("m1/0"),
        [Judgement("cost-honest", "failed", 1, 1, (Finding("cost-honest", None, 1, 2, "a lie"),))],
    )
    assert "!! cost-honest: a lie" in text(run)


# ---------------------------------------------------------------- detours


def test_a_way_back_alone_is_no_turn() -> None:
    run = played("m4/41", "enhancement-ii")
    assert {number: turn.door for number, turn in turns(run).items()} == {13: 1}


def test_the_way_home_is_the_shortest_on_s() -> None:
    run = played("m4/41", "enhancement-ii")
    assert [way_home(run, KnownDart(dart), 10) for dart in (3, 4, 5, 0)] == [(3,), (2,), (1,), ()]


def test_names_of_places_are_explained_as_far_as_they_occur() -> None:
    declared, silent = text(played("m3/8", "basic"), extent=ALL), text(played("m3/8", walks))
    assert "v2:7 is dart 7 of the map S" in declared
    assert "w1:4 is dart 4 of the world" in silent
    assert "map S, at" not in silent
    assert "not on S" not in silent
    standing = played("m3/8", stands)
    assert "A place is named" not in text(standing)
