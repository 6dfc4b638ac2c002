"""Draws worlds from a strategy outside of any test: the same ones for the same seed, everywhere.

Hypothesis draws no two equal examples in one run; if it yields too few, another follows under the
next seed. What this does not show: only `uniform_worlds` are evenly spread.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from contextlib import contextmanager
from types import MappingProxyType
from typing import Any

from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis.internal.cache import LRUCache
from hypothesis.internal.conjecture import providers
from hypothesis.internal.constants_ast import Constants
from hypothesis.strategies import SearchStrategy

from topo_verify import strategies
from topo_verify.world import resolve
from topo_verify.world.rooted_map import World

_NAMES = (
    *("worlds", "planar_worlds", "nonplanar_worlds", "tree_worlds", "lattices", "dense_worlds"),
    *("symmetric_worlds", "uniform_worlds"),
)

WORLDS: MappingProxyType[str, Callable[..., SearchStrategy[World]]] = MappingProxyType(
    {name: getattr(strategies, name) for name in _NAMES}
)

_KIND = resolve.CallSyntax("strategy", "", "'planar_worlds(max_edges=20)'", words=True)


def resolve_strategy(text: str) -> SearchStrategy[World]:
    """The strategy that a call or a name stands for.

    Example:
        >>> from hypothesis import find
        >>> find(resolve_strategy("nonplanar_worlds(genus=2)"), lambda world: True).genus
        2
    """
    return resolve.call(text, WORLDS, _KIND, bare=True)


def sample(strategy: SearchStrategy[World], number: int, *, start: int = 0) -> list[World]:
    """This many worlds of the strategy, with the seeds from `start` on."""
    drawn: list[World] = []
    with drawing_no_literals():
        while len(drawn) < number:
            drawn += _one_run(strategy, number - len(drawn), start)
            start += 1
    return drawn


@contextmanager
def drawing_no_literals() -> Generator[None]:
    """Within the block Hypothesis draws no literals of the loaded modules.

    Otherwise draws would depend on what is loaded and on a folder `.hypothesis`.
    """
    module: dict[str, Any] = providers.__dict__
    # other versions of Hypothesis lack these names
    exchanged: dict[str, Any] = {
        "_get_local_constants": Constants,
        "CONSTANTS_CACHE": LRUCache(1024),
    }
    kept = {name: module[name] for name in exchanged if name in module}
    module.update({name: exchanged[name] for name in kept})
    try:
        yield
    finally:
        module.update(kept)


def _one_run(strategy: SearchStrategy[World], number: int, start: int) -> list[World]:
    drawn: list[World] = []

    @seed(start)
    @settings(
        max_examples=number,
        phases=[Phase.generate],
        database=None,  # earlier examples would come first
        deadline=None,
        suppress_health_check=[
            HealthCheck.too_slow,
            HealthCheck.filter_too_much,
            HealthCheck.data_too_large,
        ],
    )
    @given(strategy)
    def draw(world: World) -> None:
        drawn.append(world)

    draw()
    return drawn[:number]
