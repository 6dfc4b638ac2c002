"""Statements that look true and are not, each with the smallest worlds in which it fails.

They are kept so that nobody "mends" them. How many worlds there are, and how large the difference:
docs/findings.md.
"""

from __future__ import annotations

from collections import Counter
from functools import cache

import pytest

from tests.helpers import SURE, worlds
from topo_verify import CATALOGUE, explore
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import World


def cost(world: World, name: str, pick: str | None = None) -> int:
    mapper = CATALOGUE[name].with_policies(pick=pick)
    return mapper(SimulatedRobot(world, world.cost_bound)).cost


@cache
def costs(name: str, edges: int) -> list[int]:
    """The cost of one algorithm in each world of this size, in rank order."""
    return [cost(world, name) for world in worlds(range(edges, edges + 1))]


def dearer(name: str, than: str, edges: range) -> list[str]:
    """The worlds in which one algorithm costs more than another, smallest first."""
    return [
        f"m{size}/{rank}"
        for size in edges
        for rank, pair in enumerate(zip(costs(name, size), costs(than, size), strict=True))
        if pair[0] > pair[1]
    ]


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("stronger", "weaker", "first", "worlds_of_that_size"),
    [
        ("enhancement-ii", "enhancement-i", "m4/16", 2),
        ("enhancement-iii-all", "enhancement-i", "m4/16", 2),
        ("enhancement-iii-one", "enhancement-ii+i", "m4/16", 2),
        ("enhancement-i", "basic", "m5/177", 7),
        ("enhancement-iii-all+i", "basic", "m5/177", 7),
        ("enhancement-ii+i", "enhancement-ii", "m5/177", 7),
        ("folding", "basic", "m5/177", 4),
        ("folding", "enhancement-iii-all", "m5/177", 4),
    ],
)
def test_a_stronger_algorithm_may_cost_more(
    stronger: str, weaker: str, first: str, worlds_of_that_size: int
) -> None:
    """Motion `overlap` saves what no rule saves; its order may try the true hypothesis later."""
    size = int(first[1])
    assert not dearer(stronger, weaker, range(1, size))
    found = dearer(stronger, weaker, range(size, size + 1))
    assert (found[0], len(found)) == (first, worlds_of_that_size)


@pytest.mark.nightly
def test_rules_without_motion_save_more_or_less_than_enhancement_i_where_all_degrees_are_one() -> (
    None
):
    signs: Counter[int] = Counter()
    first = ""
    for world in worlds(range(3, 7)):
        if len(world.vertices) > 1 and len({len(darts) for darts in world.vertices}) == 1:
            saved = cost(world, "enhancement-i") - cost(world, "enhancement-ii")
            assert saved == cost(world, "enhancement-i") - cost(world, "enhancement-iii-all")
            signs[(saved > 0) - (saved < 0)] += 1
            first = first or (world.id if saved > 0 else "")
    assert (signs, first) == ({1: 566, 0: 1565, -1: 143}, "m5/3046")


def test_with_pick_first_enhancement_ii_costs_more_than_i() -> None:
    """In the lattices of the paper; with the reference policies it costs less in the mean."""
    lattices = [resolve_world(f"family:lattice(10,10,holes=0.2,seed={seed})") for seed in range(5)]
    excess = {
        pick: [
            cost(world, "enhancement-ii", pick) - cost(world, "enhancement-i", pick)
            for world in lattices
        ]
        for pick in ("first", "nearest")
    }
    assert min(excess["first"]) > 0 > sum(excess["nearest"])


@pytest.mark.parametrize("name", SURE)
def test_a_mirror_image_alone_may_cost_something_else(name: str) -> None:
    """Policies go by numbers, and numbers go clockwise. With mirrored doors it costs the same."""
    unlike = (
        world.id
        for world in worlds(range(1, 4))
        if cost(world, name) != explore(world.mirror(), name).cost
    )
    assert next(unlike) == "m3/38"
