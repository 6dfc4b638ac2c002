"""Examines the shards of a campaign on a Dask cluster."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial

from topo_verify.campaign import backend as local
from topo_verify.campaign import campaign as c
from topo_verify.campaign.backend import Depends
from topo_verify.campaign.examiner import examiner_of
from topo_verify.campaign.identity import Identity
from topo_verify.errors import InputError
from topo_verify.extra.dask.cluster import Cluster, ClusterPool, connected


@dataclass(frozen=True)
class DaskBackend:
    """The cluster of the scheduler at `address`; it is `local` for one on this machine."""

    address: str

    @contextmanager
    def opened(self, workers: int | None = None) -> Generator[local.MakeBackend]:
        """Connect to the cluster, while the block lasts.

        Raises:
            InputError: `workers` is given, too; or as `cluster.connected`.
        """
        if workers is not None:
            raise InputError(
                f"--dask {self.address} with --workers {workers}: expected one of the two, for the"
                " cluster says how many workers it has; leave --workers out"
            )
        with connected(self.address) as cluster:
            yield partial(clustered, cluster)


def clustered(cluster: Cluster, depends: Depends = None) -> c.Backend:
    """The backend of a connected cluster."""

    def run(
        campaign: c.Campaign, shards: Iterator[c.Shard], in_flight: c.InFlight
    ) -> c.ShardResults:
        del in_flight  # a cluster reports finished shards only
        # Always ask what mappers load: other machines may have other files.
        depends_on = tuple(depends or ())
        mappers = campaign.load()
        try:
            ours = Identity(mappers, depends_on).loaded()
        finally:
            c.close(mappers)
        work = local.work_of(local.job_of(campaign, depends_on), ours)
        if cluster.is_local:
            examiner_of(campaign).prepare()
        with ClusterPool(cluster, work) as pool:
            for shard, result in pool.run(shards):
                yield shard, local.with_our_memory(work, shard, result)

    return run
