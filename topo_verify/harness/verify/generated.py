"""The worlds of the part `generated-worlds`: as property tests meet them, of every strategy.

Evenly drawn worlds have few vertices and many handles, so lattices, trees and worlds in which many
places look alike hardly ever come; the strategies see to it that they do.

What this does not show: anything beyond these worlds. A property test of one's own draws as many as
one likes, and shrinks what fails; here smaller worlds only come first.
"""

from __future__ import annotations

from functools import cache

from topo_verify.harness.corpus import STRATEGIES
from topo_verify.world.rooted_map import World


@cache
def generated_worlds(each: int, seed: int) -> tuple[World, ...]:
    """So many worlds of each strategy, smallest first."""
    from topo_verify.strategies.resolve import resolve_strategy
    from topo_verify.strategies.sample import sample

    worlds = [
        world for text in STRATEGIES for world in sample(resolve_strategy(text), each, start=seed)
    ]
    return tuple(sorted(worlds, key=lambda world: (len(world.edges), world.code)))
