"""Worlds of a class, grown with pruning: the same as filtering all worlds, in their order."""

from __future__ import annotations

from collections import Counter
from itertools import islice
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import topo_verify as tv
from topo_verify.errors import InputError
from topo_verify.world.enumeration import pruned, rank_order
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.enumeration.pruned import ranked_tables

# A test may look inside.
# pyright: reportPrivateUsage=false


CLASSES = (
    *("any", "planar", "genus:1", "genus:2", "genus<=1", "loopless", "simple", "max-degree:1"),
    *("max-degree:3", "simple,planar", "simple,max-degree:3", "planar,loopless,max-degree:4"),
    *("genus:1,loopless", "min-degree:2", "regular:3", "planar,simple,min-degree:2"),
)


def filtered(kind: WorldClass, edges: int) -> list[tuple[int, rank_order.Table]]:
    return [pair for pair in enumerate(rank_order.tables(edges)) if kind.admits(pair[1])]


@pytest.mark.parametrize("text", CLASSES)
@pytest.mark.parametrize("edges", [*range(5), pytest.param(5, marks=pytest.mark.no_cover)])
def test_growing_gives_what_filtering_gives_with_the_ranks_and_in_their_order(
    text: str, edges: int
) -> None:
    kind = WorldClass.parse(text)
    assert list(ranked_tables(edges, kind)) == filtered(kind, edges)


@pytest.mark.parametrize("text", CLASSES)
def test_worlds_are_counted_as_they_are_listed(text: str) -> None:
    kind = WorldClass.parse(text)
    listed = Counter(len(table[0]) for _, table in filtered(kind, 5))
    assert pruned.count(5, kind) == listed.total()
    assert pruned.count_by_vertices(5, kind) == listed


@pytest.mark.no_cover
def test_a_genus_and_a_property_of_the_graph_are_counted_where_few_worlds_have_one_of_them() -> (
    None
):
    assert pruned.count(8, WorldClass.parse("planar,simple,max-degree:3")) > 0
    kind = WorldClass.parse("genus:1,loopless")
    assert pruned.count(6, kind) == kind.count(6)


def test_more_than_a_million_worlds_are_not_counted_one_by_one() -> None:
    kind = WorldClass.parse("genus:1,loopless")
    with pytest.raises(InputError, match="with 9 edges there may be 11370212: expected 1000000"):
        pruned.count(9, kind)
    with pytest.raises(
        InputError, match=r"with 12 edges there are 373537388: expected 1000000 at most"
    ):
        pruned.count_by_vertices(12, WorldClass.parse("planar,loopless"))


@pytest.mark.no_cover
@pytest.mark.parametrize("text", ["planar,loopless", "planar,simple"])
def test_the_formulas_for_planar_graphs_give_the_numbers_of_the_lists(text: str) -> None:
    kind = WorldClass.parse(text)
    for edges in range(8):
        assert kind.count(edges) == sum(pruned.count_by_vertices(edges, kind).values())


@given(text=st.sampled_from(CLASSES), edges=st.integers(1, 5), data=st.data())
def test_a_shard_is_the_stretch_of_the_list_with_these_ranks(
    text: str, edges: int, data: st.DataObject
) -> None:
    kind = WorldClass.parse(text)
    start = data.draw(st.integers(0, rank_order.count(edges)))
    stop = data.draw(st.integers(start, rank_order.count(edges) + 3))
    expected = [pair for pair in filtered(kind, edges) if start <= pair[0] < stop]
    assert list(ranked_tables(edges, kind, start, stop)) == expected


def test_a_shard_far_inside_a_list_that_nobody_could_walk_through_starts_at_once() -> None:
    planar, middle = WorldClass.parse("planar"), rank_order.count(20) // 2
    (rank, table), *_ = (next(ranked_tables(20, planar, middle)),)
    assert rank >= middle
    assert rank_order.rank(table) == rank
    assert planar.admits(table)


@pytest.mark.parametrize("text", ["planar", "genus<=1", "genus<=2", "loopless"])
@pytest.mark.parametrize("edges", [*range(1, 5), pytest.param(5, marks=pytest.mark.no_cover)])
def test_no_branch_ends_without_a_world(
    text: str, edges: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Every partial map must have a child: so a walk down any branch meets a world.
    children = pruned._children
    barren: list[object] = []

    def watched(partial: pruned._Partial, r: int) -> list[pruned._Partial]:
        found = list(children(partial, r))
        barren.extend([] if found else [partial])
        return found

    monkeypatch.setattr(pruned, "_children", watched)
    assert list(ranked_tables(edges, WorldClass.parse(text)))
    assert not barren
    assert all(
        rank_order.completions(len(root.opened), 2 * edges - len(root.alpha))
        for root in pruned._roots(edges, WorldClass.parse(text))
    )


# ---------------------------------------------------------------- `tv.worlds`


def test_without_a_class_all_worlds_are_listed() -> None:
    assert list(ranked_tables(3)) == list(enumerate(rank_order.tables(3)))
    assert list(tv.worlds(edges=3)) == list(tv.worlds(edges=3, cls="any"))


@pytest.mark.parametrize("cls", ["any", "planar", "simple", "genus:1,loopless"])
@pytest.mark.parametrize("edges", range(4))
def test_they_are_the_worlds_of_the_class_in_the_order_of_their_ids(edges: int, cls: str) -> None:
    every = [tv.World.from_id(f"m{edges}/{rank}") for rank in range(WorldClass().count(edges))]
    inside = [world for world in every if WorldClass.parse(cls).admits(world.code)]
    listed = list(tv.worlds(edges=edges, cls=cls))
    assert listed == inside
    assert [world.name for world in listed] == [world.id for world in inside]


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
