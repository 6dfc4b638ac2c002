"""A run that is told its choices: the list, and what is wrong with one."""

from __future__ import annotations

import pytest

from topo_verify import CATALOGUE, World
from topo_verify.campaign.run import Exploration, explore
from topo_verify.errors import InputError
from topo_verify.programs.loader import Target
from topo_verify.robot.events import Confirm, Pose, Reject
from topo_verify.studies.search.states.script import Listed, choices_of, choices_text, scripted


def run(world: str, name: str, *choices: int) -> Exploration:
    """The run that makes these choices."""
    listed = Listed(choices)
    found = explore(World.from_id(world), Target(name, scripted(CATALOGUE[name], listed)))
    listed.require_all()
    return found


def test_a_list_is_read_and_written() -> None:
    assert choices_of("0, 2,1") == (0, 2, 1)
    assert choices_of("") == ()
    assert choices_text((0, 2, 0, 0)) == "0,2"
    assert choices_text((0, 0)) == "0"


@pytest.mark.parametrize("text", ["a", "1,,2", "-1", "1.5", "1;2", "9999999"])
def test_another_text_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="expected numbers with commas, as 0,2,1"):
        choices_of(text)


def test_the_numbers_say_which_edge_comes_next_and_which_hypothesis() -> None:
    # Two loops at one vertex: dart 2 of 0 … 3 first, then the last of its three hypotheses.
    events = [e for e in run("m2/9", "basic", 2, 2).trace if not hasattr(e, "door")]
    pose = next(event for event in events if isinstance(event, Pose))
    assert (pose.edge, pose.hypotheses) == (2, (0, 1, 3))
    first = next(event for event in events if isinstance(event, (Reject, Confirm)))
    assert first.hypothesis == 3


def test_a_number_without_a_way_is_refused_after_the_run() -> None:
    with pytest.raises(InputError, match=r"number 2 is 3, and there are 3 ways there; give one"):
        run("m2/9", "basic", 2, 3)


def test_a_list_that_is_too_long_is_refused() -> None:
    with pytest.raises(InputError, match="expected at most 1 numbers in this run, got 2"):
        run("m1/1", "basic", 0, 0)
