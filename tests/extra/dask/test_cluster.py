"""A Dask cluster: the same results as with workers here, whatever part of it is lost."""

# A test may look inside.
# pyright: reportPrivateUsage=false

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest

from tests.studies.search.searching import json, searched, shards_in, wait_for
from topo_verify import InputError, InternalError, errors, extras
from topo_verify.campaign import backend
from topo_verify.campaign.campaign import Campaign, Shard, ShardMemory, ShardResult
from topo_verify.campaign.examiner import MACHINES
from topo_verify.campaign.identity import own_hash
from topo_verify.campaign.store import Store
from topo_verify.campaign.targets import targets
from topo_verify.campaign.work import Work
from topo_verify.campaign.worker import WorkerFailed
from topo_verify.extra.dask import cluster as clusters
from topo_verify.extra.dask import worker as worker_side
from topo_verify.extra.dask.backend import clustered
from topo_verify.extra.dask.cluster import Cluster, ClusterPool, connected
from topo_verify.extra.dask.worker import ClusterTask, ClusterTaskDone, do
from topo_verify.programs import loaded
from topo_verify.programs.launcher import prepare
from topo_verify.robot.stopwatch import tasks_of
from topo_verify.studies.search.choices import SHARD
from topo_verify.studies.search.search import Search, SearchEntry, search, search_campaign
from topo_verify.world.enumeration.classes import WorldClass

distributed: Any = pytest.importorskip("distributed")

SIMPLE = WorldClass.parse("simple")

# The event loop of a cluster that is closed while others come and go leaves sockets to the
# collector of garbage.
pytestmark = pytest.mark.filterwarnings("ignore::ResourceWarning")


@pytest.fixture(autouse=True)
def small_shards(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Several shards a size, so that workers are at different ones; and the mappers."""
    monkeypatch.setitem(SHARD, "reference", 20)
    shutil.copy(Path(__file__).parent / "cluster_mappers.py", folder)
    return folder


@contextmanager
def started(workers: int, **settings: Any) -> Generator[str]:
    """The address of a cluster on this machine, each worker in a process of its own."""
    dask: Any = pytest.importorskip("dask")
    with (
        dask.config.set({f"distributed.scheduler.{key}": value for key, value in settings.items()}),
        distributed.LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            processes=True,
            dashboard_address=":0",
            silence_logs="CRITICAL",
        ) as made,
    ):
        yield made.scheduler_address


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """A cluster of two workers, for tests that leave it as it is, or restart its workers."""
    with started(2) as made:
        yield made


@contextmanager
def worker(
    address: str, *, memory: str = "unlimited", **environment: str
) -> Generator[subprocess.Popen[bytes]]:
    """One more worker, which nothing starts again.

    Args:
        memory: the KiB of address space that it and each process of a mapper may have.
    """
    words = ["-m", "distributed.cli.dask_worker", address, "--nthreads", "1", "--no-nanny"]
    limited = ["sh", "-c", f'ulimit -v {memory}; exec "$@"', "sh"]
    with subprocess.Popen(
        [*limited, sys.executable, *words, "--no-dashboard"],
        env={**os.environ, **environment},
        stderr=subprocess.DEVNULL,
    ) as process:
        try:
            yield process
        finally:
            process.kill()


def on_cluster(
    target: str, edges: int, kind: str, cluster: Cluster, store: ShardMemory | None = None
) -> Search:
    """A search on a cluster that has gone to its end."""
    mappers = targets(target)
    campaign = search_campaign(mappers, edges=edges, kind=kind)
    study = Search(campaign, mappers, clustered(cluster), store)
    study.work()
    return study


def work_of(target: str, edges: int = 2) -> Work[Shard, ShardResult]:
    """What workers are to do in a search."""
    return backend.work_of(backend.job_of(campaign_of(target, edges), None))


def campaign_of(target: str, edges: int, kind: str = "any") -> Campaign:
    return search_campaign(targets(target), edges=edges, kind=kind)


# ---------------------------------------------------------------- the same results


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("target", "kind", "keep_going"),
    [
        ("basic", "planar", False),
        ("enhancement-ii,enhancement-i", "any", True),
        ("mappers.py:guesses", "loopless", True),
        ("mappers.py:exits", "any", False),
    ],
)
def test_results_are_equal_byte_for_byte_to_those_of_workers_here(
    address: str, target: str, kind: str, *, keep_going: bool
) -> None:
    def found(**where: Any) -> SearchEntry:
        kinds = WorldClass.parse(kind)
        return search(target, edges=3, cls=kinds, keep_going=keep_going, **where)

    assert json(found(cluster=address)) == json(found(workers=2))


@pytest.mark.nightly
def test_a_program_runs_on_the_cluster(address: str, folder: Path) -> None:
    (folder / "play.py").write_text(
        "from topo_verify import CATALOGUE\n"
        "from topo_verify.programs.serve import serve\n"
        "serve(CATALOGUE['basic'])\n"
    )
    target = f"--cmd {sys.executable} play.py"
    assert json(search(target, edges=2, cluster=address)) == json(
        search(target, edges=2, workers=2)
    )


# ---------------------------------------------------------------- losses


@pytest.mark.nightly
def test_a_lost_worker_changes_nothing(address: str, folder: Path) -> None:
    target = "cluster_mappers.py:kills_its_dask_worker_once"
    found = search(target, edges=4, cls=SIMPLE, cluster=address)
    assert (folder / "killed").exists()
    assert (found.verdict, found.checked, found.lost) == ("EXHAUSTED", 32, ())
    assert json(found) == json(search(target, edges=4, cls=SIMPLE))


@pytest.mark.nightly
def test_a_world_that_takes_every_worker_with_it_is_undecided_and_convicts_nobody() -> None:
    with started(2, **{"allowed-failures": 0}) as address:
        target = "cluster_mappers.py:kills_its_dask_worker"
        with connected(address) as cluster:
            found = on_cluster(target, 3, "simple", cluster).entry()
    assert (found.verdict, found.checked, found.total) == ("UNKNOWN", 8, 9)
    assert found.counterexample is None
    (lost,) = found.lost
    assert (lost.world.partition("/")[0], lost.how) == ("m3", MACHINES)


@pytest.mark.nightly
def test_a_mapper_that_lacks_memory_on_a_worker_alone_is_undecided() -> None:
    target = "cluster_mappers.py:takes_two_gib"
    two_gib = str(2**21)
    with started(0) as address, worker(address, memory=two_gib):
        found = search(target, edges=3, cls=SIMPLE, cluster=address)
    assert (found.verdict, found.checked, found.total) == ("UNKNOWN", 8, 9)
    assert found.counterexample is None
    (lost,) = found.lost
    assert (lost.world.partition("/")[0], lost.how) == ("m3", backend.SHORT_OF_MEMORY)


CLIENT = """
import sys
from topo_verify.campaign.backend import clustered
from topo_verify.extra.dask.cluster import connected
from topo_verify.campaign.store import Store
from topo_verify.campaign.targets import targets
from topo_verify.studies.search.choices import SHARD
from topo_verify.studies.search.search import Search, search_campaign
SHARD["reference"] = 20
mappers = targets("cluster_mappers.py:waits_for_go")
campaign = search_campaign(mappers, edges=4, kind="simple")
with Store("search.db") as store, connected(sys.argv[1]) as there:
    memory = store.resumed(campaign, mappers)
    Search(campaign, mappers, clustered(there), memory).work()
"""


@pytest.mark.nightly
def test_a_client_that_is_killed_resumes_from_its_store(address: str, folder: Path) -> None:
    with subprocess.Popen([sys.executable, "-c", CLIENT, address]) as client:
        wait_for(lambda: shards_in(folder / "search.db") >= 2)
        client.send_signal(signal.SIGKILL)
    (folder / "go").touch()
    target = "cluster_mappers.py:waits_for_go"
    mappers = targets(target)
    with Store("search.db") as store, connected(address) as cluster:
        memory = store.resumed(campaign_of(target, 4, "simple"), mappers)
        study = on_cluster(target, 4, "simple", cluster, memory)
    assert 0 < study.from_store < 32
    alone = searched(target, edges=4, kind="simple")
    assert study.tallies == alone.tallies
    assert (study.entry().verdict, study.entry().checked) == ("EXHAUSTED", 32)


@pytest.mark.nightly
def test_a_lost_scheduler_ends_the_search_with_a_sentence(folder: Path) -> None:
    words = ["-m", "distributed.cli.dask_scheduler", "--port", "0", "--no-dashboard"]
    with subprocess.Popen(
        [sys.executable, *words, "--scheduler-file", "where"], stderr=subprocess.DEVNULL
    ) as scheduler:
        wait_for(lambda: (folder / "where").exists() and (folder / "where").read_text() != "")
        (folder / "scheduler").write_text(str(scheduler.pid))
        address = msgspec.json.decode((folder / "where").read_bytes())["address"]
        with worker(address), pytest.raises(InputError, match="the scheduler was lost in the cou"):
            search("cluster_mappers.py:kills_the_scheduler", edges=3, cls=SIMPLE, cluster=address)


@pytest.mark.nightly
def test_a_cluster_whose_workers_are_all_lost_ends_the_search_with_a_sentence(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    target = "cluster_mappers.py:kills_its_dask_worker"
    with started(0) as address, worker(address), connected(address) as cluster:
        monkeypatch.setattr(clusters, "PATIENCE", 0.0)
        with pytest.raises(InputError, match="has had no worker for 0 s: start some with `dask w"):
            on_cluster(target, 3, "simple", cluster)


# ---------------------------------------------------------------- identity


@pytest.mark.long
@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("another version", "with other sources than the client, which has version"),
        ("none", r"cannot load topo-verify \("),
    ],
)
def test_a_worker_with_another_topo_verify_is_refused(
    folder: Path, change: str, words: str
) -> None:
    package = folder / "other" / "topo_verify"
    if change == "none":
        package.mkdir(parents=True)
        (package / "__init__.py").touch()
    else:
        shutil.copytree(Path(errors.__file__).parent, package)
        with (package / "errors.py").open("a") as file:
            file.write("# another version\n")
    with (
        started(0) as address,
        worker(address, PYTHONPATH=str(folder / "other")),
        pytest.raises(InputError, match=words),
    ):
        search("basic", edges=2, cluster=address)


@pytest.mark.long
def test_a_worker_with_another_mapper_or_with_none_is_refused(address: str, folder: Path) -> None:
    work = work_of("mappers.py:right")
    with (folder / "mappers.py").open("a") as file:  # what a worker finds there
        file.write("changed = True\n")
    worker_refuses(work, address, r"^worker tcp://.* of the cluster: .* or is another one on")
    (folder / "mappers.py").unlink()
    worker_refuses(work, address, r"of the cluster: .*there is no file 'mappers\.py'")


def worker_refuses(work: Work[Shard, ShardResult], address: str, words: str) -> None:
    """Require that a worker of the cluster refuses the work."""
    with (
        connected(address) as cluster,
        ClusterPool(cluster, work) as pool,
        pytest.raises(InputError, match=words),
    ):
        list(pool.run([Shard(1, 0, 2)]))


HELPED = """
import {first}
from topo_verify import CATALOGUE

def explore(robot):
    import {later}
    return CATALOGUE["basic"](robot)
"""


@pytest.fixture
def helper(folder: Path) -> str:
    """The name of a module that is in the folders `ours` and `theirs`, different in each."""
    name = f"helper_{folder.name}"
    for place in ("ours", "theirs"):
        (folder / place).mkdir()
        (folder / place / f"{name}.py").write_text(f"place = {place!r}\n")
    return name


def refused(folder: Path, words: str) -> None:
    """Search with a worker whose search path for modules leads to the folder `theirs`."""
    with (
        started(0) as address,
        worker(address, PYTHONPATH=str(folder / "theirs")),
        pytest.raises(InputError, match=r"^worker tcp://.* of the cluster: the mapper" + words),
    ):
        search("helped.py:explore", edges=2, cluster=address)


@pytest.mark.long
def test_a_worker_that_finds_another_helper_module_is_refused(
    folder: Path, helper: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "path", [str(folder / "ours"), *sys.path])
    (folder / "helped.py").write_text(HELPED.format(first=helper, later="math"))
    refused(folder, f"'s module {helper} is .*ours.* in one process and .*theirs.* in another")


@pytest.mark.long
def test_a_worker_with_another_helper_that_it_loads_late_is_refused(
    folder: Path, helper: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = loaded.file_hash
    (folder / "helped.py").write_text(HELPED.format(first="math", later=helper))

    def on_our_machine(path: str) -> str | None:
        return "another" if helper in path else real(path)

    monkeypatch.setattr(loaded, "file_hash", on_our_machine)
    refused(folder, rf" read .*theirs/{helper}\.py, which is another file here: give every machine")


# ---------------------------------------------------------------- no cluster


def test_an_address_where_nobody_answers_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clusters, "ANSWER", 0.5)
    with (
        pytest.raises(InputError, match="none answers there within 0 s: start one with `dask sch"),
        connected("tcp://127.0.0.1:9"),
    ):
        pass


@pytest.mark.parametrize("address", ["", "nonsense:xx", "there is no such host.invalid:1"])
def test_what_is_no_address_is_told_at_once(address: str) -> None:
    with pytest.raises(InputError, match="expected the address of a Dask"), connected(address):
        pass


@pytest.mark.long
def test_a_scheduler_without_workers_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clusters, "PATIENCE", 0.1)
    with (
        started(0) as address,
        pytest.raises(InputError, match="has had no worker for 0 s"),
        connected(address),
    ):
        pass


def test_without_dask_the_package_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def nothing(_name: str) -> None:
        return None

    monkeypatch.setattr(extras, "find_spec", nothing)
    words = r"the extra dask needs distributed: .* -m pip install 'topo-verify\[dask\]'"
    with pytest.raises(InputError, match=words), connected("local"):
        pass


def test_a_cluster_and_workers_here_are_not_both_had() -> None:
    with pytest.raises(InputError, match="--dask local with --workers 2: expected one of the two"):
        search("basic", edges=1, workers=2, cluster="local")


def test_work_that_is_not_for_other_machines_is_our_bug() -> None:
    work = work_of("basic")
    nobody: Any = None
    with pytest.raises(InternalError, match="is not for other machines"):
        ClusterPool(Cluster("tcp://a", nobody), replace(work, remote=None))


# ---------------------------------------------------------------- on a worker


def assignment(**changed: Any) -> bytes:
    work = work_of("basic")
    assert work.remote is not None
    usual = ClusterTask(
        worker_side.VERSION,
        "1",
        own_hash(),
        work.remote.remade,
        msgspec.Raw(msgspec.json.encode(work.job)),
        msgspec.Raw(msgspec.json.encode(Shard(2, 0, 10))),
        str(Path.cwd()),
    )
    return msgspec.json.encode(msgspec.structs.replace(usual, **changed))


def answer(sent: bytes) -> ClusterTaskDone | WorkerFailed:
    return msgspec.json.decode(do(sent), type=ClusterTaskDone | WorkerFailed)


def test_a_worker_does_a_task_in_a_process_that_ends_when_it_is_idle(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(worker_side, "IDLE", 0.01)
    before = descendants()
    done = answer(assignment())
    assert isinstance(done, ClusterTaskDone)
    assert msgspec.json.decode(done.result, type=ShardResult).tally.worlds == 10
    wait_for(lambda: descendants() <= before)


def test_the_process_is_kept_for_the_next_task_of_the_same_job() -> None:
    before = descendants()
    answer(assignment())
    kept = descendants() - before
    answer(assignment())
    assert len(kept) == 1
    assert descendants() - before == kept


def descendants() -> set[str]:
    """The processes that this one and the launcher have started; the launcher is there before."""
    prepare()
    return {task.partition("/")[0] for task in tasks_of(os.getpid())}


@pytest.mark.parametrize(
    ("sent", "words"),
    [
        (b"{}", "the client, which has another version: install the same"),
        (assignment(own="0"), "the client, which has version 1: install the same"),
        (assignment(version=1), "the client, which has version 1: install the same"),
        (assignment(folder="/nowhere"), ""),
    ],
)
def test_a_worker_refuses_what_is_not_for_it(sent: bytes, words: str) -> None:
    done = answer(sent)
    if words:
        assert isinstance(done, WorkerFailed)
        assert (words in done.text, done.bug) == (True, False)
    else:
        assert isinstance(done, ClusterTaskDone)


def test_a_bug_of_ours_on_a_worker_is_told_as_such() -> None:
    done = answer(assignment(remade="topo_verify.campaign.pool:nothing"))
    assert isinstance(done, WorkerFailed)
    assert (done.bug, "AttributeError" in done.text) == (True, True)


def test_the_work_is_made_again_of_its_job() -> None:
    work = work_of("basic")
    again = backend.remade(msgspec.json.encode(work.job))
    assert isinstance(again.job, backend.CampaignJob)
    assert again.job == work.job
