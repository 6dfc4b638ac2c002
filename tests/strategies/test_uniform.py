"""Evenly drawn worlds: no rank is likelier than another, and Hypothesis can still shrink them."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import find, given, settings
from hypothesis import strategies as st

from topo_verify import World
from topo_verify.strategies import uniform_worlds
from topo_verify.strategies.draws import scaled
from topo_verify.world.enumeration import rank_order


@pytest.mark.parametrize("total", [1, 2, 10, 74, 255, 256, 706])
def test_every_rank_has_as_many_bytes_as_any_other_give_or_take_one(total: int) -> None:
    counts = Counter(scaled(total, *number.to_bytes(2)) for number in range(256**2))
    assert set(counts) == set(range(total))
    assert max(counts.values()) - min(counts.values()) <= 1


@given(one=st.binary(min_size=9, max_size=9), other=st.binary(min_size=9, max_size=9))
def test_greater_bytes_never_mean_a_lower_rank(one: bytes, other: bytes) -> None:
    low, high = sorted([one, other])
    assert 0 <= scaled(8162, *low) <= scaled(8162, *high) < 8162


@pytest.mark.long
def test_a_thousand_draws_of_74_worlds_are_spread_evenly() -> None:
    """The sum of (seen - expected)² / expected has mean 73 and standard deviation 12."""
    seen: Counter[str] = Counter()

    @settings(max_examples=1000, derandomize=True, database=None)
    @given(uniform_worlds(edges=3))
    def draw(world: World) -> None:
        seen[world.id] += 1

    draw()
    expected = seen.total() / 74
    assert sum((n - expected) ** 2 for n in seen.values()) / expected < 73 + 4 * 12
    assert len(seen) == 74


@pytest.mark.long
def test_they_have_the_edges_that_were_asked_for_and_shrink_towards_rank_0() -> None:
    assert find(uniform_worlds(edges=30), lambda _: True).id == "m30/0"
    world = find(uniform_worlds(edges=4), lambda w: w.genus == 2)
    first = next(t for t in rank_order.tables(4) if World.from_code(t).genus == 2)
    assert rank_order.rank(first) <= rank_order.rank(world.code) < 706
    assert len(world.edges) == 4
