"""The bound O(m²n) of the paper is reached: in a double row `basic` needs about m²n / 6 moves.

Every vertex has degree 4. Two edges join each vertex with the next, and the marker is at one end.
The robot goes to the other end first; all places look alike, so each false hypothesis is walked to
the marker. Coq proves a lower bound (`BoundReached.basic_row`); here are the costs.
"""

from __future__ import annotations

import pytest

from topo_verify import World, explore


def double_row(n: int) -> World:
    """The world `double_row n` of Row.v."""
    vertices = [list(range(4 * i, 4 * i + 4)) for i in range(n)]
    loops = [(0, 2), (4 * n - 3, 4 * n - 1)]
    between = [(4 * i + k, 4 * i + k + 3) for i in range(n - 1) for k in (1, 3)]
    return World.from_rotations(vertices, loops + between, 1)


@pytest.mark.parametrize(
    ("n", "cost"), [(1, 2), (2, 8), (5, 102), (9, 554), (17, 3538), (33, 24994)]
)
def test_basic_needs_moves_of_the_order_of_the_bound(n: int, cost: int) -> None:
    world = double_row(n)
    assert (len(world.edges), len(world.vertices)) == (2 * n, n)
    assert explore(world, "basic").cost == cost
    assert 3 * cost >= 2 * n * (n - 1) * (n - 2)
    assert 12 * cost >= (2 * n) ** 2 * n


def test_other_policies_and_enhancement_i_grow_otherwise_in_this_family() -> None:
    rows = [double_row(n) for n in (9, 17, 33)]
    assert [row.genus for row in rows] == [5, 9, 17]
    assert [explore(row, "basic", pick="last").cost for row in rows] == [762, 5746, 44770]
    assert [explore(row, "basic", pick="first").cost for row in rows] == [234, 850, 3234]
    assert [explore(row, "enhancement-i").cost for row in rows] == [218, 818, 3170]


def test_rules_without_motion_save_nothing_in_a_double_row() -> None:
    world = double_row(17)
    for algorithm in ("enhancement-ii", "enhancement-iii-one", "enhancement-iii-all"):
        assert explore(world, algorithm).cost == 3538
