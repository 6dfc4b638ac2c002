"""Resolves a strategy on a command line, such as `planar_worlds(max_edges=20, simple=True)`.

A name alone is the strategy with its widest arguments; only `uniform_worlds` needs an argument, the
number of edges. `topo_verify.world.calls` parses the text; it is never run as Python.
"""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType

from hypothesis.strategies import SearchStrategy

from topo_verify.strategies.dense import dense_worlds
from topo_verify.strategies.general import nonplanar_worlds, planar_worlds, worlds
from topo_verify.strategies.grids import lattices
from topo_verify.strategies.symmetric import symmetric_worlds
from topo_verify.strategies.trees import tree_worlds
from topo_verify.strategies.uniform import uniform_worlds
from topo_verify.world import calls
from topo_verify.world.rooted_map import World

WORLDS: MappingProxyType[str, Callable[..., SearchStrategy[World]]] = MappingProxyType(
    {
        make.__name__: make
        for make in (
            worlds,
            planar_worlds,
            nonplanar_worlds,
            tree_worlds,
            lattices,
            dense_worlds,
            symmetric_worlds,
            uniform_worlds,
        )
    }
)
"""Every strategy that draws worlds, by its name."""

_KIND = calls.CallSyntax("strategy", "", "'planar_worlds(max_edges=20)'", words=True)


def resolve_strategy(text: str) -> SearchStrategy[World]:
    """The strategy that the text names.

    Raises:
        InputError: no strategy has that name, or its arguments do not fit or admit no world.
    Example:
        >>> from hypothesis import find
        >>> find(resolve_strategy("nonplanar_worlds(genus=2)"), lambda world: True).genus
        2
    """
    return calls.call(text, WORLDS, _KIND, bare=True)
