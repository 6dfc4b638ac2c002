"""Motion between hypotheses: retrace, and overlap with what was executed last."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.helpers import any_world, cited, doors, of_type, sketch, some, trace_of, variant, worlds
from topo_verify import World, examine
from topo_verify.algorithms import motion
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import localise
from topo_verify.algorithms.rules import NoRule
from topo_verify.robot.events import Confirm, Reject
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import SimulatedRobot

words = st.lists(st.integers(0, 15), min_size=1, max_size=6)


def hypothesis_with(*doors: int) -> motion.Hypothesis:
    """A hypothesis of which only the way home matters."""
    chart = Chart(Percept(1, 0))
    hypothesis = motion.Hypothesis(0, chart, chart.tree(0))
    vars(hypothesis)["doors"] = doors
    return hypothesis


def executed(*doors: int) -> motion.Executed:
    """A sequence of which only the doors matter."""
    return motion.Executed(doors, (Percept(16, None),) * (len(doors) + 1))


def test_retrace_takes_the_first_and_shares_nothing_even_where_all_was_executed() -> None:
    row = [hypothesis_with(3, 1), hypothesis_with(2, 1, 3)]
    assert motion.retrace(row, executed(2, 1, 3)) == (row[0], 0)


def test_overlap_takes_the_longest_common_prefix() -> None:
    row = [hypothesis_with(2), hypothesis_with(2, 1, 4), hypothesis_with(1, 1, 3)]
    assert motion.overlap(row, executed(2, 1, 3)) == (row[1], 2)


def test_overlap_breaks_ties_in_the_order_of_h() -> None:
    row = [hypothesis_with(1), hypothesis_with(2, 4), hypothesis_with(2, 1)]
    assert motion.overlap(row, executed(2, 3)) == (row[1], 1)
    # In m3/8, taking the last of equals instead would walk dart 5 before dart 4: 10 moves, not 8.
    (reject,) = of_type(Reject, trace_of("m3/8", "enhancement-i"))
    assert reject.hypothesis == 3
    assert of_type(Confirm, trace_of("m3/8", "enhancement-i"))[0].hypothesis == 4


def test_the_example_of_overlap_in_the_paper() -> None:
    # Section III-A; the world is one vertex with eight loops, so no door leads out of it.
    first, second = (2, 1, 3, 1, 2), (2, 1, 3, 3, 2, 4)
    choice = motion.overlap([hypothesis_with(*second)], executed(*first))
    loops = [(dart, dart + 1) for dart in range(0, 16, 2)]
    robot = SimulatedRobot(World.from_rotations([range(16)], loops, 0), 100)
    pilot = motion.Pilot(robot)
    for door in first:
        pilot.forward(door)
    pilot.back(choice.shared)
    for door in second[choice.shared :]:
        pilot.forward(door)
    assert doors(robot.events) == [2, 1, 3, 1, 2, 0, -2 % 16, (3 - 1) % 16, 2, 4]
    by_way_of_vu = len(first) + len(first) + len(second)
    assert pilot.cost == by_way_of_vu - 2 * choice.shared == 10


def test_overlap_with_nothing_executed_takes_the_first() -> None:
    row = [hypothesis_with(2), hypothesis_with(1, 2)]
    assert motion.overlap(row, None) == (row[0], 0)


def test_a_common_prefix_ends_where_the_shorter_one_ends() -> None:
    assert motion.common_prefix((1, 2), (1, 2, 3)) == 2
    assert motion.common_prefix((), (1,)) == 0


@pytest.mark.parametrize(
    ("world", "name", "first", "seen"),
    [
        # The whole executed sequence is shared.
        ("m4/16", "enhancement-i", 11, ["pose", "validate 1", "reject", "validate 2", "confirm"]),
        # Doors (1, 1) were executed, (1, 2, …) comes next: one move back, to the end of (1).
        ("m6/722", "enhancement-i", 20, [
            "pose", "validate 1", "validate 1", "reject", "retrace 0", "validate 1", "validate 1",
            "confirm",
        ]),
        # Retrace goes back to vu.
        ("m6/722", "basic", 20, [
            "pose", "validate 1", "validate 1", "reject", "retrace 0", "retrace 2", "validate 0",
        ]),
    ],
)  # fmt: skip
def test_overlap_goes_back_only_to_the_end_of_the_common_prefix_and_retrace_to_vu(
    world: str, name: str, first: int, seen: list[str]
) -> None:
    assert sketch(trace_of(world, name)[first : first + len(seen)]) == seen


def test_what_is_executed_already_is_confirmed_without_motion() -> None:
    # Darts 5 and 9 have the same way home, and differ in where they make the marker point at the
    # end. Walking it for dart 5 shows that it is dart 9; the robot stands at v0 and stays there.
    trace = trace_of("m5/1008", "enhancement-i")
    assert sketch(trace[16:22]) == [
        "pose", "validate 1", "reject", "confirm", "augment", "walk 1",
    ]  # fmt: skip
    reject, confirm = trace[18:20]
    assert isinstance(reject, Reject)
    assert (reject.hypothesis, cited(reject)[0].marker) == (5, 0)
    assert isinstance(confirm, Confirm)
    assert (confirm.hypothesis, cited(reject)[1].marker) == (9, 1)


@pytest.mark.long
@pytest.mark.no_cover
def test_the_marker_direction_counts_where_the_whole_way_is_executed_already() -> None:
    # Overlap with no rule in between: what the direction excludes is rejected when it is looked at.
    for world in worlds(range(1, 5)):
        report = examine(variant(NoRule, motion.overlap), world)
        assert report.ok, str(report)


@given(world=any_world(), word=words, other=words, keep=st.integers(0, 6))
def test_after_going_back_doors_mean_what_they_meant_before(
    world: World, word: list[int], other: list[int], keep: int
) -> None:
    robot, fresh = SimulatedRobot(world, 100), SimulatedRobot(world, 100)
    pilot = motion.Pilot(robot)
    for door in word:
        pilot.forward(door % robot.percept.degree)
    pilot.back(keep)
    kept = tuple(pilot.doors)
    assert kept == pilot.executed().doors == tuple(fresh_walk(fresh, word[:keep]))
    for door in other:
        assert pilot.forward(door % robot.percept.degree) == fresh.move(door % fresh.percept.degree)
    assert pilot.cost == robot.cost
    # The percepts of the kept doors and of the new ones are those of one walk from vu.
    straight = motion.Pilot(SimulatedRobot(world, 100))
    for door in pilot.doors:
        straight.forward(door)
    assert pilot.executed() == straight.executed()


def fresh_walk(robot: SimulatedRobot, word: list[int]) -> list[int]:
    """Walk, and return the doors as they are taken."""
    taken: list[int] = []
    for door in word:
        taken.append(door % robot.percept.degree)
        robot.move(taken[-1])
    return taken


def test_at_the_marker_the_robot_is_localised_by_its_direction_after_a_retrace() -> None:
    """The marker's door was another one at the entry: a retrace turns the reference dart."""
    robot = SimulatedRobot(
        World.from_rotations([[0, 1, 2], [3, 4, 5]], [[0, 3], [1, 4], [2, 5]], 0), 9
    )
    chart, pilot = Chart(robot.percept), motion.Pilot(robot)
    pilot.cross(chart, 0, 0)
    pilot.forward(1)
    pilot.forward(1)
    pilot.back(1)
    assert pilot.percepts[-1].marker != robot.percept.marker is not None
    assert localise(pilot, chart, 0) == chart.turn(0, -some(robot.percept.marker))
