"""The compiled algorithms are the reference: every event of every run, the cost and the map.

The whole comparison is marked nightly; -k "edges-5" and the like run a part of it.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import pytest

from tests.extra.fast.kernels.twins import difference, differences, uniform
from tests.helpers import EMPTY
from tests.marks import with_marks
from topo_verify import World, families, worlds
from topo_verify.algorithms import CATALOGUE
from topo_verify.extra.fast.kernels.explore import KERNELS
from topo_verify.world.enumeration import rank_order
from topo_verify.world.resolve import resolve_world


def test_every_algorithm_of_the_catalogue_has_a_kernel() -> None:
    assert list(KERNELS) == list(CATALOGUE)


@pytest.mark.parametrize("name", with_marks(CATALOGUE, long=["folding+planar"]))
def test_equal_events_in_every_world_to_4_edges(name: str) -> None:
    small = (world for edges in range(1, 5) for world in worlds(edges=edges))
    assert list(islice(differences(small, name), 3)) == []


@pytest.mark.parametrize("name", CATALOGUE)
def test_equal_events_in_the_world_without_a_dart(name: str) -> None:
    assert difference(EMPTY, name) is None


@pytest.mark.long
@pytest.mark.parametrize("name", with_marks(CATALOGUE, nightly=["folding+planar"]))
def test_equal_events_in_uniform_worlds_of_7_to_12_edges(name: str) -> None:
    some = (world for edges in range(7, 13) for world in uniform(edges, 20, seed=1))
    assert list(islice(differences(some, name), 3)) == []


@pytest.mark.long
@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize(
    "world",
    [
        families.lattice(4, 5),
        families.lattice(7, 7, holes=0.2, seed=3),
        families.lattice(10, 10, holes=0.2, seed=1),
        families.torus(3, 4),
        families.torus(6, 6),
        families.king(6, 6),
        families.random_genus(25, 2, seed=5),
    ],
    ids=["lattice", "holes", "more holes", "torus", "larger torus", "king", "genus 2"],
)
def test_equal_events_in_worlds_beyond_the_small_layout(name: str, world: World) -> None:
    assert difference(world, name) is None


DATA = Path(__file__).parents[3] / "data" / "worlds"
NETWORKS = ("nyc", f"{DATA}/pp_mv_oberrhein.json", f"{DATA}/sumo_A10KW.json")


@pytest.mark.long
@pytest.mark.parametrize("network", NETWORKS, ids=["nyc", "oberrhein", "A10KW"])
def test_equal_events_in_a_real_network(network: str) -> None:
    assert difference(resolve_world(network), "enhancement-iii-all+i") is None


SLICES = 10


def ranks(edges: int, part: int) -> Iterator[World]:
    """One of ten slices of all worlds of a size."""
    total = rank_order.count(edges)
    start, stop = total * part // SLICES, total * (part + 1) // SLICES
    for number, table in enumerate(rank_order.tables(edges, start, stop), start):
        yield World.from_code(table, name=f"m{edges}/{number}")


@pytest.mark.nightly
@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize("edges", range(1, 6), ids=lambda edges: f"edges-{edges}")
def test_equal_events_in_every_world_to_5_edges(edges: int, name: str) -> None:
    assert list(islice(differences(worlds(edges=edges), name), 3)) == []


@pytest.mark.nightly
@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize("part", range(SLICES), ids=lambda part: f"edges-6-part-{part}")
def test_equal_events_in_every_world_with_6_edges(part: int, name: str) -> None:
    assert list(islice(differences(ranks(6, part), name), 3)) == []


@pytest.mark.nightly
@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize("edges", range(7, 13), ids=lambda edges: f"edges-{edges}")
def test_equal_events_in_ten_thousand_uniform_worlds(edges: int, name: str) -> None:
    assert list(islice(differences(uniform(edges, 1667, seed=2), name), 3)) == []


@pytest.mark.nightly
@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize("side", [10, 20, 30], ids=lambda side: f"side-{side}")
@pytest.mark.parametrize("holes", [0.0, 0.2], ids=["whole", "holes"])
def test_equal_events_in_lattices_to_30x30(side: int, holes: float, name: str) -> None:
    assert difference(families.lattice(side, side, holes=holes, seed=1), name) is None


@pytest.mark.nightly
@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize("network", NETWORKS, ids=["nyc", "oberrhein", "A10KW"])
def test_equal_events_in_the_real_networks(network: str, name: str) -> None:
    assert difference(resolve_world(network), name) is None
