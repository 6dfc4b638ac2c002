"""Every world of a size and a class, one after the other: `tv.worlds`."""

from __future__ import annotations

from collections.abc import Iterator

from topo_verify.errors import InputError
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.enumeration.pruned import ranked_tables
from topo_verify.world.enumeration.rank_order import MAX_ID_EDGES
from topo_verify.world.rooted_map import World


def worlds(*, edges: int, cls: str = "any") -> Iterator[World]:
    """Every world with so many edges in a class, in the order of their ids.

    Lazy: each world is made when it is asked for, so `islice(tv.worlds(edges=30), 5)` is quick. A
    world's name is its id.

    Args:
        edges: how many edges each world has, 0 to 200.
        cls: a class as on the command line, such as `planar` or `simple,max-degree:4`.
    Raises:
        InputError: at the call, if the number is out of range or the class is unknown or empty.
    """
    if type(edges) is not int or not 0 <= edges <= MAX_ID_EDGES:
        # An integer too long to be shown makes Python raise, so none is shown.
        seen = "another one" if type(edges) is int else f"a {type(edges).__name__}"
        raise InputError(
            f"expected edges=N with an integer from 0 to {MAX_ID_EDGES} (larger worlds have no id),"
            f" got {seen}"
        )
    return (
        World.from_code(table, name=f"m{edges}/{rank}")
        for rank, table in ranked_tables(edges, WorldClass.parse(cls))
    )
