"""Worlds of every kind: all rooted maps, or those of given genus, degree, simplicity, density.

Every world within the bounds can be drawn (growth.py). Dense worlds pose many hypotheses for each
edge. **Uniform worlds**: Hypothesis prefers small integers, but draws bytes evenly. So a rank is
drawn as bytes, 8 more than its own length, and scaled down. The likelihoods of two worlds differ by
at most one part in 2^64.
"""

from __future__ import annotations

from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from topo_verify.errors import InputError
from topo_verify.strategies.draws import scaled, shown_as_called, worlds_of
from topo_verify.strategies.growth import CROWDED
from topo_verify.strategies.shapes import WIDEST, MarkerPlace, integer
from topo_verify.world.enumeration import rank_order
from topo_verify.world.rooted_map import World


@shown_as_called
def worlds(  # noqa: PLR0913  bounds are optional
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
    """Every world within the bounds (shapes.py). Shrinks to few edges, genus 0, and stars.

    Example:
        >>> from hypothesis import find
        >>> find(worlds(simple=True), lambda world: len(world.vertices) == 3)
        tv.World.from_id('m2/2')
    """
    return worlds_of("worlds", **locals())


@shown_as_called
def planar_worlds(
    *,
    min_edges: int = 1,
    max_edges: int = WIDEST,
    simple: bool = False,
    loopless: bool = False,
    max_degree: int | None = None,
    marker: MarkerPlace = "any",
) -> SearchStrategy[World]:
    """Every world of genus 0 within the bounds. Shrinks to few edges, and stars."""
    return worlds_of("planar_worlds", max_genus=0, **locals())


@shown_as_called
def nonplanar_worlds(
    *,
    genus: int | None = None,
    min_edges: int = 1,
    max_edges: int = WIDEST,
    simple: bool = False,
    loopless: bool = False,
    max_degree: int | None = None,
    marker: MarkerPlace = "any",
) -> SearchStrategy[World]:
    """Every world of this genus within the bounds; of any genus above 0 if None.

    Shrinks to few edges, the least genus, and stars with the handles at their hubs.
    """
    if genus is not None and integer("nonplanar_worlds", "genus", genus) == 0:
        raise InputError(
            "nonplanar_worlds: expected genus 1 or more, got 0: planar_worlds draws that"
        )
    bounds = {name: value for name, value in locals().items() if name != "genus"}
    least = 1 if genus is None else genus
    return worlds_of("nonplanar_worlds", min_genus=least, max_genus=genus, **bounds)


@shown_as_called
def tree_worlds(
    *,
    min_edges: int = 1,
    max_edges: int = WIDEST,
    max_degree: int | None = None,
    marker: MarkerPlace = "any",
) -> SearchStrategy[World]:
    """Every plane tree within the bounds. Shrinks to few edges, and stars."""
    return worlds_of("tree_worlds", max_cycles=0, **locals())


@shown_as_called
def dense_worlds(  # noqa: PLR0913  bounds are optional
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
    """Every world within the bounds with 2m >= n(n-1)/2. Shrinks to few edges, then few handles."""
    return worlds_of("dense_worlds", kinds=CROWDED, dense=True, **locals())


_SPARE = 8


@shown_as_called
def uniform_worlds(*, edges: int) -> SearchStrategy[World]:
    """Every world with this many edges (0 to 200), equally likely. Shrinks towards rank 0."""
    edges = integer("uniform_worlds", "edges", edges)
    if edges > WIDEST:
        raise InputError(f"uniform_worlds: expected at most {WIDEST} edges, got {edges}")
    total = rank_order.count(edges)
    length = (total.bit_length() + 7) // 8 + _SPARE

    def world(drawn: bytes) -> World:
        return World.from_code(rank_order.unrank(edges, scaled(total, *drawn)))

    return st.binary(min_size=length, max_size=length).map(world)
