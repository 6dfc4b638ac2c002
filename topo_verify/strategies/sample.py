"""Draws worlds from a strategy outside of any test: the same ones for the same seed, everywhere.

Hypothesis draws no two equal examples in one run and stops when a strategy has no more. If one run
yields too few, another follows under the next seed, and worlds occur twice.

What this does not show: the worlds are not evenly spread. Hypothesis draws simple ones first and
then variants of those it has drawn; draw `uniform_worlds` for an even spread. Another version of
Hypothesis may draw other worlds.
"""

from __future__ import annotations

import os
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis.configuration import set_hypothesis_home_dir, storage_directory
from hypothesis.internal.observability import observability_enabled
from hypothesis.strategies import SearchStrategy

from topo_verify.world.rooted_map import World


def sample(strategy: SearchStrategy[World], number: int, *, start: int = 0) -> list[World]:
    """This many worlds of the strategy.

    Args:
        start: the seed.
    Raises:
        hypothesis.errors.Unsatisfiable: the strategy draws nothing at all.
    """
    drawn: list[World] = []
    with leaving_no_folder():
        while len(drawn) < number:
            drawn += _one_run(strategy, number - len(drawn), start)
            start += 1
    return drawn


@contextmanager
def leaving_no_folder() -> Generator[None]:
    """Within the block Hypothesis writes no `.hypothesis` into the current folder.

    Even without a database of examples it keeps the literals of the modules of a source tree there.
    With its observability switched on, the folder is what the user asks for.
    """
    if observability_enabled():
        yield
        return
    place: Any = storage_directory(intent_to_write=False)
    # No folder can be made in the null device, and Hypothesis goes on where it cannot write.
    set_hypothesis_home_dir(Path(os.devnull, "hypothesis"))
    try:
        yield
    finally:
        set_hypothesis_home_dir(getattr(place, "path", place))  # a path in older versions


def _one_run(strategy: SearchStrategy[World], number: int, start: int) -> list[World]:
    """The worlds of one run of Hypothesis: 1 to `number`, all of different choices."""
    drawn: list[World] = []

    @seed(start)
    @settings(
        max_examples=number,
        phases=[Phase.generate],
        database=None,  # or examples of earlier runs would come first
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
