"""How many worlds have a property of their graph: against the lists, and known numbers."""

from __future__ import annotations

import pytest

from topo_verify.errors import InputError
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.counts import MAX_EDGES, MAX_NARROW_EDGES, count_graphs

SIMPLE = (1, 1, 2, 6, 23, 108, 596, 3790, 27339, 220918)
LOOPLESS = (1, 1, 3, 14, 87, 672)


@pytest.mark.parametrize(("edges", "number"), list(enumerate(SIMPLE)))
def test_the_known_numbers_of_simple_worlds_come_out(edges: int, number: int) -> None:
    assert count_graphs(edges, simple=True) == number


@pytest.mark.parametrize(("edges", "number"), list(enumerate(LOOPLESS)))
def test_the_known_numbers_of_loopless_worlds_come_out(edges: int, number: int) -> None:
    assert count_graphs(edges, loopless=True) == number


@pytest.mark.parametrize("edges", range(11))
def test_without_a_property_all_worlds_are_counted(edges: int) -> None:
    assert count_graphs(edges) == rank_order.count(edges)


def test_paths_and_cycles_are_counted_at_any_size() -> None:
    # A path has 2m darts for the marker; all of them differ but for the path's symmetry.
    assert count_graphs(60, most_degree=2) == 60 + 1


def test_too_many_edges_are_refused() -> None:
    with pytest.raises(InputError, match=f"expected at most {MAX_EDGES} edges"):
        count_graphs(MAX_EDGES + 1, simple=True)
    with pytest.raises(InputError, match=f"expected at most {MAX_NARROW_EDGES} edges, got 101: wi"):
        count_graphs(MAX_NARROW_EDGES + 1, most_degree=2)
    with pytest.raises(InputError, match="expected 0 or more edges, got -1"):
        count_graphs(-1)
