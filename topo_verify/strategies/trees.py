"""Trees: worlds in which no hypothesis is ever true.

    strategy      draws                                        its simplest world
    tree_worlds   every plane tree within the bounds           m1/0: a single edge

So whatever a mapper confirms in a tree is false.
"""

from __future__ import annotations

from dataclasses import replace

from hypothesis.strategies import SearchStrategy

from topo_verify.strategies.draws import worlds_of
from topo_verify.strategies.naming import shown_as_called
from topo_verify.strategies.shapes import WIDEST, MarkerPlace, grown_shape
from topo_verify.world.rooted_map import World


@shown_as_called
def tree_worlds(
    *,
    min_edges: int = 1,
    max_edges: int = WIDEST,
    max_degree: int | None = None,
    marker: MarkerPlace = "any",
) -> SearchStrategy[World]:
    """Every plane tree within the bounds. Shrinks to few edges, and stars.

    Args: see `topo_verify.strategies.shapes`.
    Raises:
        InputError: no tree keeps all the bounds.
    """
    shape = grown_shape("tree_worlds", max_degree=max_degree, marker=marker)
    shape = replace(shape, max_cycles=0)
    return worlds_of("tree_worlds", shape, min_edges=min_edges, max_edges=max_edges, marker=marker)
