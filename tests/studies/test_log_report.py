"""What a log shows of its world so far: places, in the order in which they were reached."""

from __future__ import annotations

import re
from pathlib import Path
from random import Random
from types import SimpleNamespace
from typing import Any

import pytest

import topo_verify as tv
from topo_verify.robot.events import Event, Move, Start
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.studies.map_check import check_map
from topo_verify.world.enumeration.classes import WorldClass


def strolls(world: tv.World, steps: int, random: Random) -> list[Event]:
    robot = SimulatedRobot(world, steps)
    log: list[Event] = [Start(percept=robot.percept)]
    for _ in range(steps):
        door = random.randrange(robot.percept.degree)
        log.append(Move(door, robot.move(door)))
    return log


def test_what_is_known_shows_the_log_and_has_an_end_for_each_open_door() -> None:
    random = Random(2026)
    for number in range(60):
        log = strolls(WorldClass().sample(random.randrange(1, 12), random), number, random)
        certificate = tv.certify(log)
        known = certificate.known
        assert check_map(known, log).verdict != "REFUTED"
        places = len(known.vertices) - certificate.open_darts
        seen = [event.percept.degree for event in log if isinstance(event, Start | Move)]
        assert [known.degrees[place] for place in certificate.places] == seen
        assert set(known.degrees[places:]) <= {1}
        if certificate.map is not None:
            assert known.code == certificate.map.code
        for door in certificate.open_doors():
            dart = known.vertices[door.place][door.door]
            assert known.vertex_of[known.alpha[dart]] >= places


def test_places_are_numbered_as_the_robot_reached_them() -> None:
    log: list[Event] = [
        Start(percept=Percept(2, 0)),
        Move(1, Percept(3, None)),
        Move(1, Percept(4, None)),
    ]
    certificate = tv.certify(log)
    assert certificate.known.degrees[:3] == (2, 3, 4)
    assert certificate.known.vertices[0][0] == certificate.known.root
    assert certificate.places == (0, 1, 2)
    assert [(door.event, door.place) for door in certificate.open_doors(4)] == [
        *[(2, 2)] * 3,
        (1, 1),
    ]


def test_the_words_of_a_picture_stand_below_its_places() -> None:
    svg = tv.certify([Start(percept=Percept(2, 0)), Move(0, Percept(2, None))]).draw(doors=True)
    (words,) = re.findall(r'font-size="([\d.]+)" x="[\d.]+" y="([\d.]+)">2 places, 2 open', svg)
    lowest = max(float(y) + float(r) for y, r in re.findall(r' cy="([\d.]+)" r="([\d.]+)"', svg))
    assert float(words[1]) - float(words[0]) >= lowest


def test_a_log_with_more_edges_than_a_picture_has_is_refused_at_once() -> None:
    log: list[Event] = [Start(percept=Percept(1001, 0)), Move(0, Percept(3, None))]
    with pytest.raises(tv.InputError, match=r"no picture of 1,003 edges, expected up to 1,000"):
        tv.certify(log).draw()


def test_of_a_robot_that_can_go_nowhere_its_only_place_is_known() -> None:
    certificate = tv.certify([Start(percept=Percept(0, None))])
    assert certificate.known == tv.World((), (), None)
    assert certificate.places == (0,)


def test_nothing_is_known_of_a_log_that_no_world_shows() -> None:
    log: list[Event] = [
        Start(percept=Percept(1, 0)),
        Move(0, Percept(2, None)),
        Move(0, Percept(1, None)),
    ]
    with pytest.raises(tv.InputError, match="no world shows this log, so nothing is known"):
        _ = tv.certify(log).known


def test_events_may_be_dictionaries_as_in_the_lines_of_a_file() -> None:
    log: list[dict[str, Any]] = [
        {"type": "start", "percept": {"degree": 1, "marker": 0}},
        {"type": "move", "door": 0, "percept": {"degree": 1, "marker": None}},
    ]
    assert tv.certify(log).verdict == "PROVED"
    with pytest.raises(tv.InputError, match="the list of events, line 2: expected an event of a"):
        tv.certify([log[0], {**log[1], "door": "left"}])


def test_a_table_in_memory_is_told_to_be_written() -> None:
    table: Any = SimpleNamespace(columns=("door", "degree", "marker"))
    with pytest.raises(tv.InputError, match=r"write it by to_csv\('log.csv', index=False\)"):
        tv.certify(table)


def test_a_cell_that_no_table_has_is_refused(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text("door,degree,marker\n,1," + "0" * 200_000)
    with pytest.raises(tv.InputError, match="row 2: expected cells of a table: field larger"):
        tv.certify(tmp_path / "log.csv")


def test_a_finding_names_the_row_of_the_file(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text("door,degree,marker\n,3,0\n5,2,\n")
    told = str(tv.certify(tmp_path / "log.csv"))
    assert "event 1 (row 3): " in told
    assert "degree 3 has no door 5" in told


def test_a_contradiction_of_other_readings_names_the_one_that_showed_it() -> None:
    log: list[Event] = [
        Start(percept=Percept(2, 0)),
        Move(0, Percept(2, None)),
        Move(1, Percept(3, None)),
        Move(0, Percept(2, 1)),  # the marker, where the robot was at event 1
    ]
    told = str(tv.certify(log))
    readings = "The readings of event 0 and event 1 would be of one place"
    assert f"{readings} by event 3: one of the three, or a door, is wrong." in told


def test_a_contradiction_names_the_two_readings_that_are_of_one_place() -> None:
    world = tv.World.from_id("m4/87")  # a ring of four
    robot = SimulatedRobot(world, 100)
    log: list[Event] = [Start(percept=robot.percept)]
    for door in (1, 1, 1, 1, 1, 1):
        seen = robot.move(door)
        log.append(Move(door, Percept(seen.degree, seen.marker)))
    assert tv.certify(log).apart is None
    log[5] = Move(1, Percept(3, None))  # the place of event 1, seen again
    refuted = tv.certify(log)
    assert (refuted.verdict, refuted.apart) == ("REFUTED", (1, 5))
    assert "The readings of event 1 and event 5 would be of one place." in str(refuted)
