"""Worlds drawn from a strategy outside of any test: the same ones for the same seed, everywhere.

Hypothesis draws no two equal examples in one go and ends when a strategy has no more; so where more
are wanted than one go yields, it is asked again under the next seed, and worlds come twice.

What this does not show: the worlds are what Hypothesis makes of the strategy, simple ones first and
variants of those it has drawn. They are not evenly spread: for that, draw `uniform_worlds`. Another
version of Hypothesis may draw others.
"""

from __future__ import annotations

from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis.strategies import SearchStrategy

from topo_verify.world.rooted_map import World


def sample(strategy: SearchStrategy[World], number: int, *, start: int = 0) -> list[World]:
    """So many worlds of the strategy.

    Args:
        start: the seed.
    Raises:
        hypothesis.errors.Unsatisfiable: the strategy draws nothing at all.
    """
    drawn: list[World] = []
    while len(drawn) < number:
        drawn += _go(strategy, number - len(drawn), start)
        start += 1
    return drawn


def _go(strategy: SearchStrategy[World], number: int, start: int) -> list[World]:
    """At most so many worlds, all different choices, one at least."""
    drawn: list[World] = []

    @seed(start)
    @settings(
        max_examples=number,
        phases=[Phase.generate],
        database=None,
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
