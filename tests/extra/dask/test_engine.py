"""The compiled engine on a Dask cluster: exact totals, whichever worker is lost, or lacks numba."""

# A test may look inside.
# pyright: reportPrivateUsage=false

from __future__ import annotations

import os
import signal
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import pytest

pytest.importorskip("numba")
pytest.importorskip("distributed")

from tests.extra.dask.test_cluster import address, started, worker
from tests.studies.search.searching import json, searched, wait_for
from topo_verify import InputError
from topo_verify.campaign.backend import job_of, work_of
from topo_verify.campaign.campaign import Campaign
from topo_verify.campaign.targets import targets
from topo_verify.extra.dask.backend import clustered
from topo_verify.extra.dask.cluster import Cluster, connected
from topo_verify.extra.fast.engine import COMPILING, CompiledEngine
from topo_verify.studies.search.search import Search, SearchEntry, search, search_campaign
from topo_verify.world.enumeration import rank_order

# The event loop of a cluster that is closed while others come and go leaves sockets to the
# collector of garbage.
pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning")


@pytest.fixture(autouse=True)
def small_shards(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Several shards a size, so that workers are at different ones."""
    monkeypatch.setattr(CompiledEngine, "shard", Mock(return_value=100))
    return folder


__all__ = ["address"]  # a fixture


def compiled() -> Campaign:
    return search_campaign(targets("basic"), edges=4, engine="compiled", keep_going=True)


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("target", "edges", "keep_going"),
    [("enhancement-ii,enhancement-i", 4, True), ("folding+planar", 3, False)],
)
def test_results_are_equal_byte_for_byte_to_those_of_workers_here(
    address: str, target: str, edges: int, *, keep_going: bool
) -> None:
    def found(**where: Any) -> SearchEntry:
        return search(target, edges=edges, keep_going=keep_going, engine="compiled", **where)

    assert json(found(cluster=address)) == json(found(workers=2))


@pytest.mark.nightly
def test_a_worker_that_is_killed_changes_no_total(address: str) -> None:
    killed: list[int] = []
    with connected(address) as cluster:
        client: Any = cluster.client
        at_first = set(client.nthreads())

        def kill_one(_what: str, done: int, _total: int) -> None:
            if done > 0 and not killed:
                pid, *_ = client.run(os.getpid).values()
                os.kill(pid, signal.SIGKILL)
                killed.append(pid)

        study = Search(compiled(), targets("basic"), clustered(cluster))
        study.work(kill_one)
        wait_for(lambda: set(client.nthreads()) != at_first)
    found = study.entry()
    assert len(killed) == 1
    assert (found.verdict, found.lost) == ("EXHAUSTED", ())
    assert [size.checked for size in found.by_edges] == [rank_order.count(m) for m in range(1, 5)]
    assert found.by_edges[3].total_cost == 4182
    assert study.seconds.engine > 0
    alone = searched("basic", edges=4, engine="compiled", keep_going=True)
    assert study.tallies == alone.tallies


@pytest.mark.long
def test_a_worker_without_numba_is_named_with_the_mend(folder: Path) -> None:
    hidden = folder / "hidden"
    hidden.mkdir()
    (hidden / "sitecustomize.py").write_text("import sys\nsys.modules['numba'] = None\n")
    words = (
        r"^worker tcp://.* of the cluster: .*the extra fast needs numba:"
        r" .* -m pip install 'topo-verify\[fast\]'"
    )
    with (
        started(0) as address,
        worker(address, PYTHONPATH=str(hidden)),
        pytest.raises(InputError, match=words),
    ):
        search("basic", edges=2, engine="compiled", cluster=address)


def test_a_worker_has_time_to_compile() -> None:
    usual = search_campaign(targets("basic"), edges=4)
    assert work_of(job_of(compiled(), None)).loading == COMPILING
    assert work_of(job_of(usual, None)).loading < COMPILING


@pytest.mark.parametrize(("where", "warmed"), [("local", 1), ("tcp://host:8786", 0)])
def test_the_client_compiles_only_for_workers_of_its_machine(
    monkeypatch: pytest.MonkeyPatch, where: str, warmed: int
) -> None:
    class Refused(Exception):
        """No pool is wanted."""

    def refuse(*_: object) -> None:
        raise Refused

    campaigns: list[Campaign] = []
    monkeypatch.setattr("topo_verify.extra.fast.shard.warm", campaigns.append)
    monkeypatch.setattr("topo_verify.extra.dask.backend.ClusterPool", refuse)
    nobody: Any = None
    with pytest.raises(Refused):
        Search(compiled(), targets("basic"), clustered(Cluster(where, nobody))).work()
    assert len(campaigns) == warmed
