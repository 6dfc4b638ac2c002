"""How a grown world is drawn: how many edges, one byte for each, and where the marker lies.

Drawing costs more than growing, and it costs by the number of choices, not by their size: so all
edges are one string of bytes. Its length is the number of edges. Hypothesis draws short strings
unless it must draw long ones: so the first choice raises the least length. In its simplest case
every length is possible, so nothing else has to change when it shrinks to that.

No two choices come from the same strategy, two of `integers` or two of `binary`, say. Hypothesis
likes to copy a value to another place of the same strategy: here that would make no new worlds.
"""

from __future__ import annotations

from collections.abc import Sequence

from hypothesis import reject
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from topo_verify.strategies.growth import BALANCED, ONE_STRING, EdgeKinds, grow, nth
from topo_verify.strategies.shapes import MarkerPlace, Shape, edge_bounds
from topo_verify.world.rooted_map import Dart, World

_AT_LEAST = (0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 8, 10, 12, 16)
"""How many edges more than the least there are at least; one of these is drawn."""

_FURTHER = 8
"""How long the second string is at least; behind its last byte it goes on with the first."""

AT_MOST = (0, 6, 8, 8, 10, 10, 12, 12, 14, 16, 16, 20, 20, 24, 30, 40)
"""Where sizes are drawn as numbers: how many edges there are at most, 0 for no bound."""


def worlds_of(
    strategy: str,
    shape: Shape,
    *,
    min_edges: object,
    max_edges: object,
    marker: MarkerPlace,
    kinds: EdgeKinds = BALANCED,
) -> SearchStrategy[World]:
    """Worlds of this shape, for the strategy of this name.

    Raises:
        InputError: the numbers of edges are none, or no world of the shape has so many.
    """
    bounds = edge_bounds(strategy, min_edges, max_edges)
    return _grown(shape, kinds, *shape.edges_between(strategy, *bounds), marker)


@st.composite
def _grown(
    draw: st.DrawFn, shape: Shape, kinds: EdgeKinds, least: int, most: int, marker: MarkerPlace
) -> World:
    """Worlds that grow from bytes, with `least` to `most` edges."""
    steps = draw_bytes(draw, least, most)
    if not steps:
        return World((), (), None)
    place = 0 if marker == "leaf" else draw(st.integers(0, 2 * most - 1))
    further = b"\0"
    if len(steps) > ONE_STRING:  # drawn last: where it is not needed any more, it falls off
        further = draw(st.binary(min_size=_FURTHER, max_size=most))
    grown = grow(shape, kinds, steps, further)
    if grown is None:
        reject()
    darts = marked_darts(grown.vertex, marker)
    return World(grown.alpha, grown.sigma, darts[nth(place, len(darts))])


def draw_bytes(draw: st.DrawFn, least: int, most: int) -> bytes:
    """A string of bytes with a length from `least` to `most`, not only short ones."""
    if least < most:
        least = min(least + draw(st.sampled_from(_AT_LEAST)), most)
    return draw(st.binary(min_size=least, max_size=most))


def at_most(most: int, bound: int) -> int:
    """The least of the two, where a bound is set: see `AT_MOST`."""
    return min(most, bound) if bound else most


def one_of(row: list[int]) -> SearchStrategy[int]:
    """One of these numbers, and always a choice: what takes fewer choices counts as simpler."""
    return st.sampled_from(row if len(row) > 1 else 2 * row)


def scaled(length: int, *drawn: int) -> int:
    """A number below the length that bytes mean; never less for greater bytes."""
    return int.from_bytes(drawn) * length >> 8 * len(drawn)


def marked_darts(vertex: Sequence[int], marker: MarkerPlace) -> Sequence[Dart]:
    """The darts at which the marker may point, given the vertex of each dart."""
    if marker != "hub":
        return range(len(vertex))
    degree = [0] * (max(vertex) + 1)
    for v in vertex:
        degree[v] += 1
    most = max(degree)
    return [dart for dart, v in enumerate(vertex) if degree[v] == most]


def draw_dart(draw: st.DrawFn, darts: Sequence[Dart], bound: int) -> Dart:
    """One of these darts; `bound` is no less than there can be, whatever was drawn before."""
    return darts[nth(draw(st.integers(0, bound - 1)), len(darts))]
