"""Worlds of every kind: all rooted maps, or those of given genus, degree, simplicity.

    strategy           draws                               its simplest world
    worlds             every world within the bounds       m1/0: a single edge
    planar_worlds      those of genus 0                    m1/0
    nonplanar_worlds   those of genus 1 or more            m2/8: two loops that cross

Every world within the bounds can be drawn: `growth.py` says why.
"""

from __future__ import annotations

from hypothesis.strategies import SearchStrategy

from topo_verify.errors import InputError
from topo_verify.strategies.draws import worlds_of
from topo_verify.strategies.naming import shown_as_called
from topo_verify.strategies.shapes import WIDEST, MarkerPlace, grown_shape, integer
from topo_verify.world.rooted_map import World


@shown_as_called
def worlds(  # noqa: PLR0913  one argument a bound, and every one is optional
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
    """Every world within the bounds. Shrinks to few edges, genus 0, and stars.

    Args: see `topo_verify.strategies.shapes`.
    Raises:
        InputError: no world keeps all the bounds.
    Example:
        >>> from hypothesis import find
        >>> find(worlds(simple=True), lambda world: len(world.vertices) == 3)
        tv.World.from_id('m2/2')
    """
    shape = grown_shape(
        "worlds",
        min_genus=min_genus,
        max_genus=max_genus,
        simple=simple,
        loopless=loopless,
        max_degree=max_degree,
        marker=marker,
    )
    return worlds_of("worlds", shape, min_edges=min_edges, max_edges=max_edges, marker=marker)


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
    """Every world of genus 0 within the bounds. Shrinks to few edges, and stars.

    Args, Raises: as for `worlds`.
    """
    shape = grown_shape(
        "planar_worlds",
        max_genus=0,
        simple=simple,
        loopless=loopless,
        max_degree=max_degree,
        marker=marker,
    )
    return worlds_of(
        "planar_worlds", shape, min_edges=min_edges, max_edges=max_edges, marker=marker
    )


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

    Args:
        genus: 1 or more. The others: as for `worlds`.
    Raises:
        InputError: no world keeps all the bounds.
    """
    if genus is not None and integer("nonplanar_worlds", "genus", genus) == 0:
        raise InputError(
            "nonplanar_worlds: expected genus 1 or more, got 0: planar_worlds draws that"
        )
    shape = grown_shape(
        "nonplanar_worlds",
        min_genus=1 if genus is None else genus,
        max_genus=genus,
        simple=simple,
        loopless=loopless,
        max_degree=max_degree,
        marker=marker,
    )
    return worlds_of(
        "nonplanar_worlds", shape, min_edges=min_edges, max_edges=max_edges, marker=marker
    )
