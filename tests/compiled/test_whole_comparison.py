"""The whole comparison of the compiled algorithms with the reference: marked slow.

    .venv/bin/python -m pytest -m slow tests/compiled/test_whole_comparison.py -k "edges-5"

runs a part. Worlds of 6 edges are compared in ten slices.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice

import pytest

from tests.compiled.test_same_events import NETWORKS
from tests.compiled.twins import difference, differences, uniform
from topo_verify import World, families, worlds
from topo_verify.algorithms import CATALOGUE
from topo_verify.world.enumeration import rank_order
from topo_verify.world.resolve import resolve_world

pytestmark = pytest.mark.slow

SLICES = 10


def ranks(edges: int, part: int) -> Iterator[World]:
    """One of ten slices of all worlds of a size."""
    total = rank_order.count(edges)
    start, stop = total * part // SLICES, total * (part + 1) // SLICES
    for number, table in enumerate(rank_order.tables(edges, start, stop), start):
        yield World.from_code(table, name=f"m{edges}/{number}")


@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize("edges", range(1, 6), ids=lambda edges: f"edges-{edges}")
def test_equal_events_in_every_world_to_5_edges(edges: int, name: str) -> None:
    assert list(islice(differences(worlds(edges=edges), name), 3)) == []


@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize("part", range(SLICES), ids=lambda part: f"edges-6-part-{part}")
def test_equal_events_in_every_world_with_6_edges(part: int, name: str) -> None:
    assert list(islice(differences(ranks(6, part), name), 3)) == []


@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize("edges", range(7, 13), ids=lambda edges: f"edges-{edges}")
def test_equal_events_in_ten_thousand_uniform_worlds(edges: int, name: str) -> None:
    assert list(islice(differences(uniform(edges, 1667, seed=2), name), 3)) == []


@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize("side", [10, 20, 30], ids=lambda side: f"side-{side}")
@pytest.mark.parametrize("holes", [0.0, 0.2], ids=["whole", "holes"])
def test_equal_events_in_lattices_to_30x30(side: int, holes: float, name: str) -> None:
    assert difference(families.lattice(side, side, holes=holes, seed=1), name) is None


@pytest.mark.parametrize("name", CATALOGUE)
@pytest.mark.parametrize("network", NETWORKS, ids=["nyc", "oberrhein", "A10KW"])
def test_equal_events_in_the_real_networks(network: str, name: str) -> None:
    assert difference(resolve_world(network), name) is None
