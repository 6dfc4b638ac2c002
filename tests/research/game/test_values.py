"""The values of the games: against plain recursion, least costs, mappers and each other."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from functools import cache

import pytest

import topo_verify as tv
from research.game import values as gv
from tests.research.game.plain import plain_value
from topo_verify.algorithms import CATALOGUE
from topo_verify.world.rooted_map import World

KNOWN = cache(gv.game_value)


def totals(value: gv.GameValue) -> tuple[int, int]:
    """The worst case, and the sum over all worlds."""
    return value.value.worst, round(value.value.mean * value.worlds)


MORE: tuple[tuple[gv.DrawnClass, gv.Knowledge, gv.Knowledge], ...] = (
    ("any", "nothing", "n"),
    ("any", "nothing", "m"),
    ("any", "n", "m and n"),
    ("any", "m", "m and n"),
    ("planar", "nothing", "planar"),
    ("planar", "nothing", "m"),
    ("planar", "planar", "m and planar"),
    ("planar", "m", "m and planar"),
)
"""What is drawn, what is known, and more."""


def plain_games(
    edges: int, drawn: gv.DrawnClass, knows: gv.Knowledge, most: int = 4
) -> Iterator[tuple[list[World], list[World]]]:
    """The games by the worlds that are drawn and those to exclude, of up to `most` edges."""
    worlds = list(tv.worlds(edges=edges, cls=drawn))
    sizes = [edges] if "m" in knows.split() else range(1, most + 1)
    others = [w for m in sizes for w in tv.worlds(edges=m)]
    if "planar" in knows:
        others = [world for world in others if world.is_planar]
    if "n" not in knows.split():
        yield worlds, others
        return
    groups = defaultdict[int, list[World]](list)
    for world in worlds:
        groups[len(world.vertices)].append(world)
    for n, group in groups.items():
        yield group, [world for world in others if len(world.vertices) == n]


def plain(edges: int, drawn: gv.DrawnClass, knows: gv.Knowledge, depth: int) -> tuple[float, float]:
    """The worst case and the sum by plain recursion."""
    games = list(plain_games(edges, drawn, knows))
    worst = max(plain_value(*game, depth, mean=False) for game in games)
    return worst, sum(plain_value(*game, depth, mean=True) for game in games)


@pytest.mark.parametrize(("drawn", "knows"), gv.GAMES)
@pytest.mark.parametrize("edges", [1, 2])
def test_plain_recursion_finds_the_same_values(
    edges: int, drawn: gv.DrawnClass, knows: gv.Knowledge
) -> None:
    """Worlds of up to 4 edges refute every claim that a robot could make too early here."""
    value = KNOWN(edges, knows, drawn)
    assert totals(value) == plain(edges, drawn, knows, depth=4)


@pytest.mark.parametrize(
    ("drawn", "knows"), [(drawn, knows) for drawn, knows in gv.GAMES if "m" in knows.split()]
)
def test_plain_recursion_finds_the_same_values_where_three_edges_are_known(
    drawn: gv.DrawnClass, knows: gv.Knowledge
) -> None:
    value = KNOWN(3, knows, drawn)
    assert totals(value) == plain(3, drawn, knows, depth=4)


@pytest.mark.parametrize(
    ("drawn", "knows", "worst", "total"),
    [
        ("any", "nothing", 8, 282),
        ("any", "n", 5, 201),
        ("any", "m", 4, 167),
        ("any", "m and n", 4, 142),
        ("planar", "nothing", 7, 211),
        pytest.param("planar", "planar", 7, 211, marks=pytest.mark.long),
        ("planar", "m", 4, 123),
        ("planar", "m and planar", 3, 117),
    ],
)
def test_the_values_of_three_edges(
    drawn: gv.DrawnClass, knows: gv.Knowledge, worst: int, total: int
) -> None:
    value = KNOWN(3, knows, drawn)
    assert value.value == gv.CostsOfRobot(worst, total / value.worlds)


@pytest.mark.parametrize(("drawn", "less", "more"), MORE)
@pytest.mark.parametrize("edges", [1, 2, 3])
def test_to_know_more_never_costs_more(
    edges: int, drawn: gv.DrawnClass, less: gv.Knowledge, more: gv.Knowledge
) -> None:
    assert not undercut(KNOWN(edges, less, drawn), KNOWN(edges, more, drawn))


@pytest.mark.parametrize("drawn", ["any", "planar"])
@pytest.mark.parametrize("edges", [1, 2, 3])
def test_a_proof_costs_no_less_than_with_the_map_in_hand(edges: int, drawn: gv.DrawnClass) -> None:
    value = KNOWN(edges, "nothing", drawn)
    least = [world.least_cost() for world in tv.worlds(edges=edges, cls=drawn)]
    assert value.least == gv.CostsOfRobot(max(least), sum(least) / len(least))
    assert value.value.worst >= value.least.worst
    assert value.value.mean >= value.least.mean


@pytest.mark.parametrize("mapper", CATALOGUE)
def test_no_mapper_costs_less_than_the_value(mapper: str) -> None:
    for edges in (1, 2, 3):
        values = [KNOWN(edges, knows, drawn) for drawn, knows in gv.GAMES]
        costs = gv.mapper_costs(mapper, edges, values)  # it raises an error below the value
        assert costs.failing is None
        assert costs.value is not None


def undercut(first: gv.GameValue, second: gv.GameValue) -> bool:
    """Whether the first value is below the second one."""
    return any(a < b for a, b in zip(totals(first), totals(second), strict=True))


def test_a_search_that_is_cut_short_says_so_and_gives_a_lower_bound() -> None:
    value = gv.game_value(3, "nothing", most_states=60)
    assert not value.value.worst_is_value
    assert not value.value.mean_is_value
    worst, total = totals(value)
    assert 266 <= total < 282
    assert 6 <= worst <= 8


def test_two_calls_end_alike() -> None:
    assert gv.game_value(2, "nothing") == gv.game_value(2, "nothing")
