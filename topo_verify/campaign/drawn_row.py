"""The worlds of a search that one process runs again in a row, drawn before the search begins.

So the digest of the first run in each of them is kept, and no second run stands alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from random import Random

from topo_verify.algorithms import Algorithm, Steered
from topo_verify.campaign import campaign as c
from topo_verify.programs.loader import Target

ROW = 1000
"""Number of worlds in the row; all of them, if the class has fewer."""


def drawn_row(campaign: c.Campaign) -> dict[str, None]:
    """The ids of the worlds in their order, drawn by the seed."""
    assert isinstance(campaign.worlds, c.Ranks)
    # The reference's shards, since the engine's are too large to list.
    return _drawn_row(campaign.worlds.edges, campaign.worlds.kind, campaign.seed)


@cache
def _drawn_row(edges: int, kind: str, seed: int) -> dict[str, None]:
    # Whole shards, since in a sparse class a rank alone is seldom a world.
    worlds, lots = c.Ranks(edges, kind), Random(f"{seed} row")
    sizes = [(size, ranks, width, -(-ranks // width)) for size, ranks, width in worlds.widths()]
    shards = sum(number for *_, number in sizes)
    row: list[str] = []
    for place in lots.sample(range(shards), min(shards, ROW)):
        if len(row) >= ROW:
            break
        at = place
        for size, ranks, width, number in sizes:
            if at < number:
                shard = c.Shard(size, at * width, min((at + 1) * width, ranks))
                row += [name for _, name, _ in worlds.worlds(shard)]
                break
            at -= number
    lots.shuffle(row)
    return dict.fromkeys(row[:ROW])


def is_run_again(campaign: c.Campaign, mappers: Sequence[Target]) -> bool:
    """Whether a search runs worlds of this campaign again: not for the catalogue."""
    is_search = isinstance(campaign.worlds, c.Ranks) and campaign.keep == "notable"
    return is_search and len(mappers) == 1 and not is_of_catalogue(mappers[0])


def is_of_catalogue(target: Target) -> bool:
    """Whether the mapper is an algorithm of the catalogue, which remembers nothing."""
    return isinstance(target.mapper, Algorithm | Steered)
