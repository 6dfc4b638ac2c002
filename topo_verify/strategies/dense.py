"""Dense worlds: many edges on few vertices, so that many hypotheses are posed for each edge.

    strategy       draws                                               its simplest world
    dense_worlds   every world with at least half as many edges as     m1/0: a single edge
                   there are pairs of vertices: 2m >= n(n-1)/2

They grow as all worlds do (`growth.py`), only with fewer leaves.
"""

from __future__ import annotations

from dataclasses import replace

from hypothesis.strategies import SearchStrategy

from topo_verify.strategies.draws import worlds_of
from topo_verify.strategies.growth import CROWDED
from topo_verify.strategies.naming import shown_as_called
from topo_verify.strategies.shapes import WIDEST, MarkerPlace, grown_shape
from topo_verify.world.rooted_map import World


@shown_as_called
def dense_worlds(  # noqa: PLR0913  one argument a bound, and every one is optional
    *,
    min_edges: int = 1,
    max_edges: int = WIDEST,
    min_genus: int = 0,
    max_genus: int | None = None,
    simple: bool = False,
    loopless: bool = False,
    max_degree: int | None = None,
    marker: MarkerPlace = "any",
) -> SearchStrategy[World]:
    """Every world within the bounds with 2m >= n(n-1)/2. Shrinks to few edges, then few handles.

    With `simple` these are the graphs in which every other pair of vertices, or more, is joined.

    Args, Raises: as for `worlds`.
    """
    shape = grown_shape(
        "dense_worlds",
        min_genus=min_genus,
        max_genus=max_genus,
        simple=simple,
        loopless=loopless,
        max_degree=max_degree,
        marker=marker,
    )
    shape = replace(shape, dense=True)
    return worlds_of(
        "dense_worlds",
        shape,
        min_edges=min_edges,
        max_edges=max_edges,
        marker=marker,
        kinds=CROWDED,
    )
