"""One campaign for each mapper: how `arena`, `reproduce`, `record` and `compare` make their runs.

So mappers may join later, and each stops at its own first failing world. The store finds a world by
its name and its code: other calls may list it in another order, or beside other worlds.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from topo_verify.campaign.backend import here, pooled
from topo_verify.campaign.campaign import (
    Campaign,
    NamedWorlds,
    ShardMemory,
    listed_shards,
    results,
)
from topo_verify.campaign.engines import on_engine
from topo_verify.campaign.progress import Progress
from topo_verify.campaign.row import Row
from topo_verify.programs.loader import Target


@dataclass(frozen=True)
class MapperCampaign:
    """The runs of one mapper in a list of worlds.

    Attributes:
        store: where they are kept; None: nowhere.
        mapper: the mapper, if it is loaded already.
    """

    campaign: Campaign
    worlds: NamedWorlds
    store: ShardMemory | None = None
    mapper: Target | None = None

    @property
    def total(self) -> int:
        """The number of the worlds."""
        return sum(self.campaign.worlds.totals().values())

    @property
    def stored(self) -> int:
        """The number of these worlds that the store knows."""
        if self.store is None:
            return 0
        return sum(self.store.get(shard) is not None for shard in listed_shards(self.worlds))

    def rows(self, workers: int, tell: Progress | None = None) -> Iterator[Row]:
        """The rows, in the order of the worlds; those that the store lacks are made.

        Args:
            workers: the number of processes; 0: this one alone.
        """
        depends = None if self.store is None else ()
        backend = pooled(min(workers, self.total), depends)
        if self.mapper is not None and not workers:
            mappers = on_engine(self.campaign.engine, (self.mapper,), self.campaign.limits)
            backend = here(mappers, depends=depends)
        for _, result in results(self.campaign, backend, self.worlds, store=self.store, tell=tell):
            yield from result.rows
