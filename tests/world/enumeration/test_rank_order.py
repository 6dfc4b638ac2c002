"""The enumeration of rooted maps: its counts, its order, its ranks."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from random import Random
from unittest.mock import Mock

import pytest
from hypothesis import given
from hypothesis import strategies as st

from topo_verify.errors import InputError
from topo_verify.world import World
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.counts import count_genus

ALL_GENERA = (1, 2, 10, 74, 706, 8162, 110410, 1708394, 29752066, 576037442)
PLANAR = (1, 2, 9, 54, 378, 2916, 24057, 208494, 1876446)
GENUS_1 = (0, 0, 1, 20, 307, 4280)
GENUS_2 = (0, 0, 0, 0, 21, 966)


# ---------------------------------------------------------------- how many


@pytest.mark.parametrize(("edges", "total"), list(enumerate(ALL_GENERA)))
def test_both_formulas_give_the_known_number_of_worlds(edges: int, total: int) -> None:
    assert rank_order.count(edges) == total
    assert rank_order.count_by_recurrence(edges) == total


@pytest.mark.parametrize("edges", range(10, 41))
def test_the_two_formulas_agree_where_nobody_can_list(edges: int) -> None:
    assert rank_order.count(edges) == rank_order.count_by_recurrence(edges)


@pytest.mark.parametrize(("edges", "total"), list(enumerate(PLANAR)))
def test_tuttes_formula_gives_the_known_number_of_planar_worlds(edges: int, total: int) -> None:
    assert rank_order.count_planar(edges) == total


@pytest.mark.parametrize(("edges", "total"), list(enumerate(ALL_GENERA[:7])))
def test_the_list_has_as_many_worlds_as_the_formula_says_and_none_twice(
    edges: int, total: int
) -> None:
    # `tables` stops at the number that there should be; the walk itself ends where it ends.
    walk = list(rank_order._tables_from(edges, 0))  # pyright: ignore[reportPrivateUsage]
    assert len(walk) == len(set(walk)) == total
    assert walk == list(rank_order.tables(edges))


@pytest.mark.parametrize("edges", range(6))
def test_the_list_has_the_known_number_of_worlds_of_each_genus(edges: int) -> None:
    genera = Counter(World.from_code(table).genus for table in rank_order.tables(edges))
    assert (genera[0], genera[1], genera[2]) == (PLANAR[edges], GENUS_1[edges], GENUS_2[edges])
    assert genera == {g: n for g in range(edges + 1) if (n := count_genus(edges, g))}


@pytest.mark.no_cover
@pytest.mark.parametrize("edges", range(1, 31))
def test_the_numbers_by_genus_sum_up_to_all_worlds(edges: int) -> None:
    assert sum(count_genus(edges, genus) for genus in range(edges + 1)) == rank_order.count(edges)
    assert count_genus(edges, 0) == rank_order.count_planar(edges)


@pytest.mark.parametrize(
    "count", [rank_order.count, rank_order.count_by_recurrence, rank_order.count_planar]
)
def test_there_is_no_negative_number_of_edges(count: Callable[[int], int]) -> None:
    with pytest.raises(InputError, match="expected 0 or more edges, got -1"):
        count(-1)


@pytest.mark.parametrize(("edges", "genus"), [(-1, 0), (0, -1)])
def test_there_is_no_negative_genus(edges: int, genus: int) -> None:
    with pytest.raises(InputError, match="expected 0 or more edges and genus"):
        count_genus(edges, genus)


def test_an_odd_or_negative_number_of_darts_cannot_be_completed() -> None:
    assert rank_order.completions(1, 2) == 0
    assert rank_order.completions(-1, 3) == 0
    assert rank_order.completions(3, -1) == 0
    assert rank_order.completions(0, 2) == 0  # no open dart left while darts remain: a dead end
    assert rank_order.completions(0, 0) == 1


# ---------------------------------------------------------------- in which order


def test_the_order_is_the_promised_one() -> None:
    assert rank_order.unrank(2, 0) == ((1, 2, 1), (1, 0, 3, 2))
    assert rank_order.unrank(2, 9) == ((4,), (3, 2, 1, 0))
    assert list(rank_order.tables(1)) == [((1, 1), (1, 0)), ((2,), (1, 0))]
    assert list(rank_order.tables(0)) == [((0,), ())]


@pytest.mark.no_cover
@pytest.mark.parametrize("edges", range(6))
def test_the_list_is_in_the_order_of_the_ranks(edges: int) -> None:
    for rank, table in enumerate(rank_order.tables(edges)):
        assert rank_order.rank(table) == rank
        assert rank_order.unrank(edges, rank) == table


@pytest.mark.parametrize("edges", range(5))
def test_the_order_is_by_root_degree_then_joins_then_new_vertices(edges: int) -> None:
    assert list(rank_order.tables(edges)) == sorted(rank_order.tables(edges), key=_choices)


def _choices(table: rank_order.Table) -> list[int]:
    """The root's degree; then, per smallest open dart, its partner or 2m + the new degree."""
    degrees, alpha = table
    choices, created, vertices = [degrees[0]], degrees[0], 1
    for dart, partner in enumerate(alpha):
        if partner >= created:
            choices.append(len(alpha) + degrees[vertices])
            created, vertices = created + degrees[vertices], vertices + 1
        elif partner > dart:
            choices.append(partner)
    return choices


@pytest.mark.parametrize("edges", range(6))
def test_every_table_is_the_canonical_code_of_its_world(edges: int) -> None:
    assert all(World.from_code(table).code == table for table in rank_order.tables(edges))


# ---------------------------------------------------------------- shards


@given(edges=st.integers(0, 6), data=st.data())
def test_a_shard_is_the_same_stretch_of_the_list(edges: int, data: st.DataObject) -> None:
    start = data.draw(st.integers(0, rank_order.count(edges)))
    length = data.draw(st.integers(0, 50))
    ranks = range(start, min(start + length, rank_order.count(edges)))
    shard = list(rank_order.tables(edges, start, start + length))
    assert shard == [rank_order.unrank(edges, rank) for rank in ranks]


def test_a_shard_far_inside_a_list_that_nobody_could_walk_through_starts_at_once() -> None:
    start = rank_order.count(30) // 3
    (first, second) = rank_order.tables(30, start, start + 2)
    assert (rank_order.rank(first), rank_order.rank(second)) == (start, start + 1)


# ---------------------------------------------------------------- numbers of any length


@given(edges=st.integers(1, 60), data=st.data())
def test_rank_and_unrank_undo_each_other_at_any_size(edges: int, data: st.DataObject) -> None:
    rank = data.draw(st.integers(0, rank_order.count(edges) - 1))
    table = rank_order.unrank(edges, rank)
    assert rank_order.rank(table) == rank
    assert World.from_code(table).code == table


@pytest.mark.parametrize("rank", [-1, 10])
def test_a_rank_outside_the_list_is_refused(rank: int) -> None:
    with pytest.raises(InputError, match=r"no world m2/.* run from 0 to 9"):
        rank_order.unrank(2, rank)


# ---------------------------------------------------------------- drawing


def test_drawing_is_uniform_because_it_draws_a_rank_and_unranks_it() -> None:
    random = Mock(spec=Random)  # nothing statistical: that `unrank` is a bijection is tested above
    random.randrange.return_value = 7
    assert rank_order.sample(3, random) == rank_order.unrank(3, 7)
    random.randrange.assert_called_once_with(rank_order.count(3))
