"""An event in words: the sentence of each kind, brief and whole."""

from __future__ import annotations

import pytest

from topo_verify.robot import events as ev
from topo_verify.robot.event_words import door_words, event_words, listed, percept_words
from topo_verify.robot.percept import Percept

SEEN = ev.Evidence(2, Percept(4, 0), Percept(5, None))
RECORDED = ev.Evidence(0, None, Percept(1, None), sequence=1, at=7, record=ev.Record(3, (2, 0)))
CONTRADICTED = ev.Evidence(0, contradiction="a vertex would be itself, turned")


@pytest.mark.parametrize(
    ("event", "words"),
    [
        (ev.Start(percept=Percept(5, 0)), "starts and sees (5, marker 0)"),
        (ev.Move(1, Percept(3, None)), "takes door 1 and sees (3)"),
        (ev.Pose(2, ()), "asks where edge 2 leads: no hypothesis, so to a new vertex"),
        (ev.Pose(2, (3, 4)), "asks where edge 2 leads: to 3, 4 or to a new vertex"),
        (
            ev.Reject(2, 3, "motion", SEEN),
            "rejects that edge 2 leads to 3 (by motion): expects (4, marker 0), saw (5) at step 2",
        ),
        (
            ev.Reject(2, 3, "records", RECORDED),
            (
                "rejects that edge 2 leads to 3 (by records): expects nothing, saw (1) at step 0 of"
                " sequence 1, at dart 7, from the record behind dart 3, doors 2 0"
            ),
        ),
        (
            ev.Reject(2, 3, "folding", CONTRADICTED),
            "rejects that edge 2 leads to 3 (by folding): a vertex would be itself, turned",
        ),
        (ev.Confirm(2, 3, "motion"), "confirms that edge 2 leads to 3 (by motion)"),
        (ev.Augment(2, "loop", 3, 4), "S grows: edge 2 leads to 3, of degree 4"),
        (ev.Augment(2, "new", 5, 1), "S grows: edge 2 leads to a new vertex, dart 5"),
        (ev.Augment(2, "new", 5, 3), "S grows: edge 2 leads to a new vertex, darts 5 to 7"),
        (ev.Finish(None, ev.MapData(((),), (), None)), "delivers a map of 1 vertex and 0 edges"),
        (
            ev.Finish(3, ev.MapData(((0,), (1,)), ((0, 1),), 0)),
            "delivers a map of 2 vertices and 1 edge, and a cost of 3",
        ),
    ],
)
def test_each_kind_of_event_has_its_sentence(event: ev.Event, words: str) -> None:
    assert event_words(event) == words


def test_a_brief_sentence_cuts_the_list_and_leaves_out_the_degree_behind_a_loop() -> None:
    assert event_words(ev.Augment(2, "loop", 3, 4), brief=True) == "S grows: edge 2 leads to 3"
    posed = event_words(ev.Pose(0, tuple(range(1, 15))), brief=True)
    assert posed.endswith("to 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, and 2 more or to a new vertex")


def test_nothing_one_and_several_have_words() -> None:
    assert (percept_words(None), percept_words(Percept(2, 1))) == ("nothing", "2, marker 1")
    assert [door_words(doors) for doors in ((), (1,), (1, 0))] == ["no door", "door 1", "doors 1 0"]
    assert (listed([]), listed([], "no dart"), listed([1, 2])) == ("none", "no dart", "1, 2")
