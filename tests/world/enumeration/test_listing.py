"""`tv.worlds`: every world of a size and a class, in order, made when it is asked for."""

from __future__ import annotations

from itertools import islice
from typing import Any

import pytest

import topo_verify as tv
from topo_verify.errors import InputError
from topo_verify.world.enumeration.classes import WorldClass


@pytest.mark.parametrize("cls", ["any", "planar", "simple", "genus:1,loopless"])
@pytest.mark.parametrize("edges", range(4))
def test_they_are_the_worlds_of_the_class_in_the_order_of_their_ids(edges: int, cls: str) -> None:
    every = [tv.World.from_id(f"m{edges}/{rank}") for rank in range(WorldClass().count(edges))]
    inside = [world for world in every if WorldClass.parse(cls).contains(world)]
    listed = list(tv.worlds(edges=edges, cls=cls))
    assert listed == inside
    assert [world.name for world in listed] == [world.id for world in inside]


def test_the_class_is_any_unless_it_is_named() -> None:
    assert len(list(tv.worlds(edges=3))) == 74


@pytest.mark.parametrize("cls", ["any", "planar", "simple,max-degree:3"])
def test_the_first_of_a_number_of_worlds_that_nobody_could_list_come_at_once(cls: str) -> None:
    ids = [world.id for world in islice(tv.worlds(edges=40, cls=cls), 3)]
    assert len(set(ids)) == 3
    assert ids == [world.name for world in islice(tv.worlds(edges=40, cls=cls), 3)]


@pytest.mark.parametrize(
    ("edges", "sentence"),
    [
        (-1, "an integer from 0 to 200 .*, got another one"),
        (201, "got another one"),
        (10**5000, "got another one"),
        (True, "got a bool"),
        (3.0, "got a float"),
        ("3", "got a str"),
    ],
    ids=["negative", "201", "5001 digits", "bool", "float", "str"],
)
def test_a_number_of_edges_that_no_world_has_is_refused_at_the_call(
    edges: Any, sentence: str
) -> None:
    with pytest.raises(InputError, match=sentence):
        tv.worlds(edges=edges)


def test_an_unknown_class_is_refused_at_the_call() -> None:
    with pytest.raises(InputError, match="class 'flat': expected any, planar"):
        tv.worlds(edges=3, cls="flat")
