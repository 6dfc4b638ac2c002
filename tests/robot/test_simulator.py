"""The simulated robot: what it meters, what it records, and what it refuses."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from topo_verify import World
from topo_verify.robot import events as ev
from topo_verify.robot import simulator
from topo_verify.robot.limits import BudgetExceeded, MapperStopped, WorldTimeout
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import Misuse, SimulatedRobot


@pytest.fixture
def robot() -> SimulatedRobot:
    """At the marker of m2/5: three doors, the outer two of them the ends of a loop."""
    return SimulatedRobot(World.from_id("m2/5"), 10)


def test_every_move_costs_one_and_is_recorded_with_what_was_sensed(robot: SimulatedRobot) -> None:
    seen = [robot.move(1, "cross"), robot.move(0)]
    assert robot.cost == 2
    assert robot.events == [ev.Move(1, seen[0], "cross"), ev.Move(0, seen[1])]
    assert robot.percept == seen[1] == Percept(3, 2)


def test_a_mapper_gets_a_handle_with_three_things_and_no_trace(robot: SimulatedRobot) -> None:
    handle = robot.handle
    assert [name for name in dir(handle) if name[0] != "_"] == ["declare", "move", "percept"]
    assert handle.percept == robot.percept
    assert handle.move(1, "cross") == robot.percept == handle.percept
    handle.declare(ev.Pose(0, (1, 2)))
    assert robot.events == [ev.Move(1, robot.percept, "cross"), ev.Pose(0, (1, 2))]
    assert robot.darts == 4


def test_looking_and_declaring_cost_nothing(robot: SimulatedRobot) -> None:
    robot.declare(ev.Pose(0, (1, 2)))
    assert (robot.cost, robot.percept, robot.stopped) == (0, Percept(3, 0), None)


@pytest.mark.parametrize("door", [3, -1, 10**30, 1.0, "1", None, True, False, [], float("nan")])
def test_a_door_that_is_not_there_stops_the_robot(robot: SimulatedRobot, door: Any) -> None:
    with pytest.raises(Misuse, match=r"the mapper asked for door .* at a vertex with 3 doors"):
        robot.move(door)
    assert (robot.cost, robot.events) == (0, [])


def test_a_world_without_a_dart_has_no_door_at_all() -> None:
    with pytest.raises(Misuse, match="at a vertex with 0 doors"):
        SimulatedRobot(World((), (), None), 10).move(0)


def test_a_door_may_be_any_integer_type_and_is_recorded_as_an_integer() -> None:
    # In eight bits the arithmetic of doors would run over: the vertex has 200 exits.
    robot = SimulatedRobot(World.from_code(((200, *[1] * 200), star(200))), 4)
    robot.move(np.int8(127))  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    robot.move(np.int8(0))  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    robot.move(np.int8(127))  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
    assert robot.move(0).marker == (200 - 127 - 127) % 200
    assert all(type(event.door) is int for event in robot.events if isinstance(event, ev.Move))


def star(leaves: int) -> tuple[int, ...]:
    """The other ends of the darts of a star: its centre's, then its leaves'."""
    return (*range(leaves, 2 * leaves), *range(leaves))


@pytest.mark.parametrize("purpose", ["fun", "", 1, object()])
def test_a_move_is_for_one_of_the_known_purposes(robot: SimulatedRobot, purpose: Any) -> None:
    with pytest.raises(Misuse, match="expected a purpose of walk, cross, validate, retrace, got"):
        robot.move(0, purpose)
    assert robot.cost == 0


@pytest.mark.parametrize("budget", [0, -1])
def test_one_move_more_than_the_budget_stops_the_robot(budget: int) -> None:
    with pytest.raises(BudgetExceeded, match=f"more than {budget} move"):
        SimulatedRobot(World.from_id("m1/0"), budget).move(0)


def test_the_whole_budget_can_be_used() -> None:
    robot = SimulatedRobot(World.from_id("m1/0"), 2)
    robot.move(0)
    robot.move(0)
    with pytest.raises(BudgetExceeded):
        robot.move(0)
    assert robot.cost == 2


def test_an_objection_to_a_decision_is_recorded_with_it_and_stops_the_robot() -> None:
    def objection(when: int, decision: ev.Decision) -> str:
        return f"no confirmation, {when}" * isinstance(decision, ev.Confirm)

    robot = SimulatedRobot(World.from_id("m2/5"), 10, objection)
    pose, confirm = ev.Pose(0, (2,)), ev.Confirm(0, 2, "motion")
    robot.declare(pose)
    with pytest.raises(MapperStopped, match="no confirmation, 2"):
        robot.declare(confirm)
    assert robot.events == [pose, confirm]
    with pytest.raises(MapperStopped, match="no confirmation, 2"):
        robot.move(0)


def test_once_stopped_it_does_nothing_more_and_always_says_the_first_reason(
    robot: SimulatedRobot,
) -> None:
    with pytest.raises(Misuse) as first:
        robot.move(7)
    for attempt in (
        lambda: robot.move(0),
        lambda: robot.declare(ev.Pose(0, ())),
        lambda: robot.move(9),
    ):
        with pytest.raises(Misuse) as again:
            attempt()
        assert again.value is first.value is robot.stopped
    assert robot.events == []


def test_a_move_that_a_time_limit_struck_before_it_was_recorded_is_taken_back(
    robot: SimulatedRobot, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot.move(0)

    def struck(*_: object) -> ev.Event:
        raise WorldTimeout("in the middle of a move")

    monkeypatch.setattr(simulator, "shared_move", struck)
    with pytest.raises(WorldTimeout):
        robot.move(0)
    assert (robot.cost, len(robot.events)) == (2, 1)
    robot.settle()
    assert (robot.cost, len(robot.events)) == (1, 1)
    robot.settle()
    assert robot.cost == 1


def test_more_than_one_move_that_is_not_recorded_is_somebody_s_doing(robot: SimulatedRobot) -> None:
    robot.move(0)
    robot.move(0)
    robot.events.clear()
    robot.settle()
    assert robot.cost == 2


def test_what_stops_a_mapper_is_no_exception_that_it_would_catch_by_accident() -> None:
    assert not issubclass(MapperStopped, Exception)


@pytest.mark.parametrize(
    ("told", "meant"),
    [
        ({"type": "pose", "edge": 0, "hypotheses": [1, 2]}, ev.Pose(0, (1, 2))),
        (
            {"type": "confirm", "edge": 0, "hypothesis": 2, "rule": "motion"},
            ev.Confirm(0, 2, "motion"),
        ),
        (
            {"type": "augment", "edge": 0, "kind": "loop", "dart": 2, "degree": 3},
            ev.Augment(0, "loop", 2, 3),
        ),
        (
            {
                "type": "reject", "edge": 0, "hypothesis": 1, "rule": "motion",
                "evidence": {
                    "step": 0,
                    "expected": {"degree": 3, "marker": 2},
                    "observed": {"degree": 3, "marker": 1},
                },
            },
            ev.Reject(0, 1, "motion", ev.Evidence(0, Percept(3, 2), Percept(3, 1))),
        ),
    ],
)  # fmt: skip
def test_a_decision_may_be_declared_as_an_event_or_as_its_json(
    robot: SimulatedRobot, told: dict[str, Any], meant: ev.Pose
) -> None:
    robot.declare(told)
    robot.declare(meant)
    assert robot.events == [meant, meant]


def test_the_darts_of_a_decision_may_be_of_any_integer_type(robot: SimulatedRobot) -> None:
    robot.declare({"type": "pose", "edge": np.int64(0), "hypotheses": (np.int8(1), 2)})
    (pose,) = robot.events
    assert pose == ev.Pose(0, (1, 2))
    assert isinstance(pose, ev.Pose)
    assert type(pose.edge) is int


@pytest.mark.parametrize(
    "nonsense",
    [
        None,
        7,
        "pose",
        object(),
        {},
        {"type": "pose"},
        {"type": "pose", "edge": "0", "hypotheses": []},
        {"type": "pose", "edge": 0.5, "hypotheses": []},
        {"type": "pose", "edge": True, "hypotheses": []},
        {"type": "pose", "edge": 10**30, "hypotheses": []},
        {"type": "pose", "edge": 0, "hypotheses": [object()]},
        {"type": "confirm", "edge": 0, "hypothesis": 1, "rule": "instinct"},
        {"type": "move", "door": 0, "percept": {"degree": 3, "marker": 0}},
        ev.Move(0, Percept(3, 0)),
        ev.Start(percept=Percept(3, 0)),
        ev.Pose(0, None),  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
        ev.Pose("0", ()),  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]
        ev.Finish,
    ],
)
def test_what_is_no_decision_stops_the_robot(robot: SimulatedRobot, nonsense: Any) -> None:
    with pytest.raises(Misuse, match=r"expected a decision \(pose, reject, confirm, augment\)"):
        robot.declare(nonsense)
    assert robot.events == []
    assert robot.stopped is not None


@pytest.mark.parametrize("evidence", [{}, {"evidence": {}}])
def test_a_reject_without_evidence_is_shown_one(robot: SimulatedRobot, evidence: Any) -> None:
    bare = {"type": "reject", "edge": 0, "hypothesis": 1, "rule": "motion"}
    with pytest.raises(Misuse, match="got reject: Object missing required field") as misuse:
        robot.declare({**bare, **evidence})
    example = json.loads("{" + str(misuse.value).partition("; as in ")[2] + "}")
    robot = SimulatedRobot(World.from_id("m2/5"), 1)
    robot.declare({**bare, **example})
    assert len(robot.events) == 1


def test_the_kinds_of_an_augmentation_are_named(robot: SimulatedRobot) -> None:
    event: Any = {"type": "augment", "edge": 0, "kind": "vertex", "dart": 1, "degree": 1}
    with pytest.raises(Misuse, match="new or loop"):
        robot.declare(event)


def test_a_robot_shows_what_it_senses() -> None:
    robot = SimulatedRobot(World.from_id("m1/0"), 1)
    assert repr(robot.handle) == "<Robot at (degree 1, marker at door 0)>"
