"""Uniform worlds: all worlds with a given number of edges are equally likely.

    strategy         draws                                     its simplest world
    uniform_worlds   all worlds with so many edges, evenly     m<edges>/0: a path, the marker at
                                                               its end

Hypothesis does not draw large integers evenly: it prefers small ones, and those near the bounds. It
does draw bytes evenly. So a rank is drawn as bytes, 8 more than its own length, and scaled down:
rank = ⌊bytes · number of worlds / 256^length⌋. The bytes of two ranks differ in number by one at
most, so no world is more likely than another by more than one part in 2^64. (What Hypothesis does
besides is its own: it begins with the simplest, varies what it has seen, and repeats nothing.)
"""

from __future__ import annotations

from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

from topo_verify.errors import InputError
from topo_verify.strategies.naming import shown_as_called
from topo_verify.strategies.shapes import WIDEST, integer
from topo_verify.world.enumeration import rank_order
from topo_verify.world.rooted_map import World

_SPARE = 8
"""How many more bytes are drawn than the rank needs."""


@shown_as_called
def uniform_worlds(*, edges: int) -> SearchStrategy[World]:
    """Every world with this many edges, each as likely as any other. Shrinks towards rank 0.

    Args:
        edges: how many; 200 at most, as for ids.
    Raises:
        InputError: `edges` is not an integer from 0 to 200.
    """
    edges = integer("uniform_worlds", "edges", edges)
    if edges > WIDEST:
        raise InputError(f"uniform_worlds: expected at most {WIDEST} edges, got {edges}")
    total = rank_order.count(edges)
    # Bytes of a fixed length: Hypothesis draws these evenly, and 0 bytes are rank 0.
    length = (total.bit_length() + 7) // 8 + _SPARE

    def world(drawn: bytes) -> World:
        return World.from_code(rank_order.unrank(edges, rank(drawn, total)))

    return st.binary(min_size=length, max_size=length).map(world)


def rank(drawn: bytes, total: int) -> int:
    """The rank below `total` that these bytes stand for; it grows with them."""
    return int.from_bytes(drawn) * total >> 8 * len(drawn)
