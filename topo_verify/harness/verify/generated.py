"""The worlds of the part `generated-worlds`: drawn by every strategy of property tests.

Uniformly drawn worlds have few vertices and many handles. Lattices, trees and worlds in which many
places look alike are rare among them; the strategies draw these on purpose.

What this does not show: anything beyond these worlds. A property test draws as many as it is asked
to and shrinks a failing one; here the smaller worlds merely come first.
"""

from __future__ import annotations

from functools import cache

from topo_verify.harness.corpus import STRATEGIES
from topo_verify.world.rooted_map import World


@cache
def generated_worlds(each: int, seed: int) -> tuple[World, ...]:
    """`each` worlds of every strategy, smallest first."""
    from topo_verify.strategies.resolve import resolve_strategy
    from topo_verify.strategies.sample import sample

    worlds = [
        world for text in STRATEGIES for world in sample(resolve_strategy(text), each, start=seed)
    ]
    return tuple(sorted(worlds, key=lambda world: (len(world.edges), world.code)))
