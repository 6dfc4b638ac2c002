"""The saving of checking each distinct trace once: nine mappers in 800 worlds of 5 edges.

Each way is timed three times in turn; the least processor time is printed.
"""

from __future__ import annotations

from time import process_time
from unittest.mock import patch

from topo_verify import CATALOGUE
from topo_verify.campaign import campaign as campaigns
from topo_verify.campaign.campaign import Campaign, Ranks, examine
from topo_verify.campaign.judge import CheckedTraces
from topo_verify.campaign.tally import Tally
from topo_verify.campaign.targets import targets

MAPPERS = targets(",".join(name for name in CATALOGUE if name != "folding+planar"))

EDGES, EVERY, SHARDS = 5, 6, 2
"""The size of the worlds; every sixth shard of them, so many."""


def seconds(*, shared: bool) -> tuple[float, list[Tally]]:
    ranks = Ranks(EDGES)
    names = tuple(target.text for target in MAPPERS)
    campaign = Campaign(worlds=ranks, mappers=names, keep="notable")
    shards = [shard for shard in ranks.shards() if shard.edges == EDGES][::EVERY][:SHARDS]
    known = CheckedTraces if shared else lambda: None
    with patch.object(campaigns, "CheckedTraces", known):
        begun = process_time()
        tallies = [examine(campaign, MAPPERS, shard).tally for shard in shards]
        return process_time() - begun, tallies


def main() -> None:
    runs = [(seconds(shared=True), seconds(shared=False)) for _ in range(3)]
    assert all(one[1] == other[1] for one, other in runs)
    shared, each = (min(run[way][0] for run in runs) for way in (0, 1))
    print(f"once {shared:.2f} s, for each mapper {each:.2f} s: {each / shared:.2f} times as long")


if __name__ == "__main__":
    main()
