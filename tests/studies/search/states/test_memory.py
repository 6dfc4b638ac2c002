"""What makes two moments one state, and what keeps them apart."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from inspect import currentframe

import pytest

from topo_verify import CATALOGUE, World
from topo_verify.algorithms.chart import Chart
from topo_verify.campaign.run import explore
from topo_verify.programs.loader import Target
from topo_verify.robot.events import Augment, Event, Start
from topo_verify.robot.percept import Percept
from topo_verify.studies.search.states import memory
from topo_verify.studies.search.states.memory import state
from topo_verify.studies.search.states.script import ChoicePoint, scripted

PERCEPT = Percept(4, 0)
TRACE: tuple[Event, ...] = (Start(percept=PERCEPT),)


def last_state(world: World, *choices: int) -> Hashable:
    """The state at the moment behind the last of these choices, of the basic algorithm."""
    states: list[Hashable] = []

    def chooser(moment: ChoicePoint) -> int:
        states.append(state(moment, world))
        return choices[len(states) - 1] if len(states) <= len(choices) else 0

    explore(world, Target("basic", scripted(CATALOGUE["basic"], chooser)))
    return states[len(choices)]


def test_what_was_tried_in_another_order_is_one_state_where_nothing_tells_the_order() -> None:
    # Two loops at v0, e is dart 0: 1 and 2 are rejected without a move, or 3 is tried first.
    world = World.from_id("m2/9")
    assert last_state(world, 0, 0, 0) == last_state(world, 0, 1, 0) == last_state(world, 0, 2)
    # By dart 3 the robot comes back by another dart, though S is the same.
    assert last_state(world, 0, 2) != last_state(world, 3, 0)


def test_a_false_map_has_no_state() -> None:
    moment = ChoicePoint(Chart(PERCEPT), None, (0,), (*TRACE, Augment(0, "loop", 1, 2)), 0, None)
    assert state(moment, World.from_id("m2/9")) is None
    assert state(moment._replace(trace=TRACE), World.from_id("m2/9")) is not None


def used(number: int) -> int:
    """A function of which one variable is read behind the call, and another is not."""
    early, late = number, 2 * number
    place = where(early)
    return late + place


def loops(number: int) -> int:
    """A function that reads a variable again when its loop begins anew."""
    early = number
    while early:
        where(early)
        number -= 1
    return 0


def guarded(number: int) -> int:
    """A function with an exception handler, for which everything is kept."""
    try:
        return where(number)
    except ValueError:
        return 0


def where(_number: int) -> int:
    """Ends the function that calls it, with the names that are kept of it."""
    frame = currentframe()
    assert frame is not None
    assert frame.f_back is not None
    code, place = frame.f_back.f_code, frame.f_back.f_lasti
    raise Kept(memory._read(code, place))  # pyright: ignore[reportPrivateUsage]


class Kept(Exception):
    """Carries the names that are kept."""


@pytest.mark.parametrize(
    ("function", "names"), [(used, {"late"}), (loops, {"early", "number"}), (guarded, {"number"})]
)
def test_variables_are_kept_that_may_still_be_read(
    function: Callable[[int], int], names: set[str]
) -> None:
    with pytest.raises(Kept) as kept:
        function(1)
    assert kept.value.args[0] == names
