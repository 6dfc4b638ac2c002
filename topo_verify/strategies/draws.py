"""Draws what a world is grown from: one byte an edge, and the place of the marker.

Drawing costs more than growing, by the number of choices, so all edges are one string of bytes.
Hypothesis prefers short strings, so the first choice raises the least length. No two choices share
a strategy: Hypothesis would copy values.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import wraps
from typing import ParamSpec, TypeVar

from hypothesis import reject
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from topo_verify.strategies.growth import BALANCED, ONE_STRING, EdgeKinds, grow, nth
from topo_verify.strategies.shapes import MANY, MarkerPlace, Shape, edge_bounds, grown_shape
from topo_verify.world.rooted_map import Dart, World

P = ParamSpec("P")
T = TypeVar("T")


def shown_as_called(make: Callable[P, SearchStrategy[T]]) -> Callable[P, SearchStrategy[T]]:
    """The same function, whose strategies print as its calls, defaults left out."""
    signature = inspect.signature(make)
    draw = inspect.Parameter("draw", inspect.Parameter.POSITIONAL_ONLY)
    shown = inspect.Signature([draw, *signature.parameters.values()])

    @wraps(make)
    def called(*args: P.args, **kwargs: P.kwargs) -> SearchStrategy[T]:
        strategy = make(*args, **kwargs)

        def call(draw: st.DrawFn, /, *_: P.args, **__: P.kwargs) -> T:
            return draw(strategy)

        # how Hypothesis prints a composite
        call.__name__ = make.__name__
        vars(call)["__signature__"] = shown
        return st.composite(call)(*args, **kwargs)

    return called


_AT_LEAST = (0, 0, 0, 0, 0, 0, 1, 2, 3, 4, 5, 6, 8, 10, 12, 16)
"""Raises of the least number of edges."""

_FURTHER = 8
"""The least length of the second string, which is read in a circle."""

AT_MOST = (0, 6, 8, 8, 10, 10, 12, 12, 14, 16, 16, 20, 20, 24, 30, 40)
"""Bounds on the number of edges; 0: none."""


def worlds_of(
    strategy: str,
    *,
    min_edges: object,
    max_edges: object,
    marker: MarkerPlace,
    max_cycles: int = MANY,
    dense: bool = False,
    kinds: EdgeKinds = BALANCED,
    **bounds: object,
) -> SearchStrategy[World]:
    """Worlds within these bounds and those of `grown_shape`."""
    shape = grown_shape(strategy, marker=marker, **bounds)
    shape = replace(shape, max_cycles=max_cycles, dense=dense)
    edges = shape.edges_between(strategy, *edge_bounds(strategy, min_edges, max_edges))
    return _grown(shape, kinds, *edges, marker)


@st.composite
def _grown(
    draw: st.DrawFn, shape: Shape, kinds: EdgeKinds, least: int, most: int, marker: MarkerPlace
) -> World:
    steps = draw_bytes(draw, least, most)
    if not steps:
        return World((), (), None)
    # One range for all strings, so a shrunk string keeps the meaning of the place.
    place = 0 if marker == "leaf" else draw(st.integers(0, 2 * most - 1))
    further = b"\0"
    if len(steps) > ONE_STRING:  # drawn last, so that shrinking drops it
        further = draw(st.binary(min_size=_FURTHER, max_size=most))
    grown = grow(shape, kinds, steps, further)
    if grown is None:  # rare: tight bounds on degrees, loops or parallel edges
        reject()
    darts = marked_darts(grown.vertex, marker)
    return canonical(World(grown.alpha, grown.sigma, darts[nth(place, len(darts))]))


def draw_bytes(draw: st.DrawFn, least: int, most: int) -> bytes:
    """A string of `least` to `most` bytes."""
    if least < most:  # an empty choice would slow shrinking down
        least = min(least + draw(st.sampled_from(_AT_LEAST)), most)
    return draw(st.binary(min_size=least, max_size=most))


def at_most(most: int, bound: int) -> int:
    """The lesser of the two; a `bound` of 0 is none."""
    return min(most, bound) if bound else most


@dataclass(frozen=True, slots=True)
class Sizes:
    """Pairs of numbers: the first is drawn as often as it has partners."""

    firsts: SearchStrategy[int]
    seconds: dict[int, SearchStrategy[int]]

    @classmethod
    def of(cls, partners: dict[int, list[int]]) -> Sizes | None:
        """The pairs of each number with its partners; None without a pair."""
        firsts = [first for first, row in partners.items() for _ in row]
        seconds = {first: _one_of(partners[first]) for first in firsts}
        return cls(_one_of(firsts), seconds) if firsts else None

    def draw(self, draw: st.DrawFn) -> tuple[int, int]:
        """A number, and one of its partners."""
        first = draw(self.firsts)
        return first, draw(self.seconds[first])


def _one_of(row: list[int]) -> SearchStrategy[int]:
    # a choice even of one number: Hypothesis takes fewer choices for simpler
    return st.sampled_from(row if len(row) > 1 else 2 * row)


def scaled(length: int, *drawn: int) -> int:
    """The number below `length` that these bytes, a fraction of 256^n, stand for."""
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
    """One of these darts; Hypothesis keeps the choice below `bound` while their number changes."""
    return darts[nth(draw(st.integers(0, bound - 1)), len(darts))]


def canonical(world: World) -> World:
    """The same world, its darts numbered as in `World.from_id(world.id)`, which is its repr."""
    numbers = [0] * len(world.alpha)
    for number, dart in enumerate(world.discovery[0]):
        numbers[dart] = number
    return world.renumbered(numbers)
