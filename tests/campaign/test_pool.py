"""The pool: the same results in the same order, whatever a task does to its process."""

# A test may look inside.
# pyright: reportPrivateUsage=false

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from itertools import chain
from pathlib import Path

import msgspec
import pytest

from tests.helpers import some
from tests.processes import alive
from tests.studies.search.searching import json, search_of, wait_for
from topo_verify import InputError, InternalError, Limits
from topo_verify.campaign import backend
from topo_verify.campaign.campaign import Shard, ShardResult
from topo_verify.campaign.identity import source_hash
from topo_verify.campaign.pool import Pool
from topo_verify.campaign.store import Store
from topo_verify.campaign.targets import targets
from topo_verify.campaign.work import Division, Pieces, Work, WorkerLoss
from topo_verify.campaign.worker import WorkerProcess
from topo_verify.errors import HelperLost
from topo_verify.programs.launcher import prepare
from topo_verify.programs.loaded import Loaded
from topo_verify.robot.stopwatch import tasks_of
from topo_verify.studies.search import again
from topo_verify.studies.search.search import (
    LostWorker,
    Search,
    SearchEntry,
    search,
    search_campaign,
)
from topo_verify.world.enumeration.classes import WorldClass

SHORT = Limits(move_timeout=0.2, world_timeout=0.5)
LOOPED = Limits(move_timeout=0.8, world_timeout=5.0)  # a busy machine holds up no mapper so long


pytestmark = pytest.mark.usefixtures("small_shards")


# ---------------------------------------------------------------- the same results


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("target", "kind", "keep_going"),
    [
        ("basic", "planar", False),
        ("enhancement-ii,enhancement-i", "any", True),
        ("mappers.py:forgets", "any", False),
        ("mappers.py:guesses", "loopless", True),
    ],
)
def test_results_are_equal_byte_for_byte_however_many_work(
    target: str, kind: str, *, keep_going: bool
) -> None:
    results = {
        json(
            search(
                target,
                edges=4 if keep_going else 3,
                cls=WorldClass.parse(kind),
                keep_going=keep_going,
                workers=number,
            )
        )
        for number in (0, 1, 3)
    }
    assert len(results) == 1


def test_what_a_mapper_prints_and_reads_does_not_disturb_the_pipes(
    capfd: pytest.CaptureFixture[str],
) -> None:
    assert search("mappers.py:noisy", edges=1, workers=2).verdict == "EXHAUSTED"
    captured = capfd.readouterr()
    assert captured.out == ""
    assert captured.err.count("x") >= 200_000  # two worlds, which are also run again


def test_progress_is_told_while_workers_work() -> None:
    told: list[tuple[str, int, int]] = []

    def tell(what: str, done: int, total: int) -> None:
        told.append((what, done, total))

    search("basic", edges=3, workers=2, tell=tell)
    assert told[0] == ("basic", 0, 86)
    assert all(done <= total == 86 for _, done, total in told)


# ---------------------------------------------------------------- killers


@pytest.mark.nightly
@pytest.mark.parametrize(("name", "how"), [("exits", "exit code 3"), ("segfaults", "signal 11")])
@pytest.mark.parametrize("number", [1, 2])
def test_a_world_that_kills_its_worker_twice_is_a_finding(name: str, how: str, number: int) -> None:
    found = search(f"mappers.py:{name}", edges=3, workers=number)
    first = some(found.counterexample)
    assert (first.world, first.claim) == ("m3/21", "map-isomorphic")
    assert first.message == f"no map was delivered: it ended its process ({how})"
    assert first.replay == f"topo-verify replay m3/21 --target mappers.py:{name}"
    assert found.checked == 12 + 22


@pytest.mark.long
@pytest.mark.parametrize("number", [1, 2])
def test_a_world_whose_worker_is_killed_twice_by_sigkill_is_undecided(number: int) -> None:
    found = search("mappers.py:kills_itself", edges=3, workers=number)
    assert (found.verdict, found.counterexample) == ("UNKNOWN", None)
    assert (found.checked, found.by_edges[2].undecided) == (86 - 5, 5)
    assert found.lost[0] == LostWorker("m3/21", "its worker was killed each time (signal 9)")
    assert [one.how for one in found.lost] == [found.lost[0].how] * 5


@pytest.mark.long
def test_a_world_whose_worker_was_killed_is_not_run_again(monkeypatch: pytest.MonkeyPatch) -> None:
    """It would be killed there, too, and it did not pass before."""
    monkeypatch.setattr(again, "MOST", 20)
    monkeypatch.setattr(again, "ROW", 20)
    loopless = WorldClass.parse("loopless")
    found = search("mappers.py:kills_itself", edges=3, cls=loopless, workers=1)
    lost = len(found.lost)
    assert (found.verdict, found.total - found.checked) == ("UNKNOWN", lost)
    assert lost > 0
    assert found.run_again == again.RunAgain(found.checked, found.checked, same=found.checked)


@pytest.mark.nightly
def test_all_worlds_that_kill_their_workers_are_found() -> None:
    killed = search("mappers.py:exits", edges=3, workers=2, keep_going=True)
    looped = search("mappers.py:loops", edges=3, limits=LOOPED, keep_going=True)
    assert (killed.verdict, killed.checked) == ("REFUTED", 86)
    assert [size.failing for size in killed.by_edges] == [0, 0, 5]
    numbers = [{one.claim: one.failing for one in entry.claims} for entry in (killed, looped)]
    assert numbers[0]["map-isomorphic"] == numbers[1]["map-isomorphic"] == 5


@pytest.fixture
def stranger(monkeypatch: pytest.MonkeyPatch) -> Callable[..., list[Shard]]:
    """Lets workers be killed at shards of at least this size, so many times; says at which."""
    hears = Pool[Shard, ShardResult]._hear
    kills: list[Shard] = []

    def stranger(*, size: int = 1, most: int | None = None) -> list[Shard]:
        def hear(pool: Pool[Shard, ShardResult], worker: WorkerProcess) -> None:
            piece = pool._at.get(worker)
            large = piece is not None and piece.task.stop - piece.task.start >= size
            if piece is not None and large and worker.ready and len(kills) != most:
                os.kill(worker.process.pid, signal.SIGKILL)
                kills.append(piece.task)
                pool._lose(worker, None)
            else:
                hears(pool, worker)

        monkeypatch.setattr(Pool, "_hear", hear)
        return kills

    return stranger


def test_a_shard_that_a_stranger_kills_once_is_tried_again(
    stranger: Callable[..., list[Shard]],
) -> None:
    kills = stranger(most=1)
    assert undisturbed(search("basic", edges=3, workers=2)) == json(search("basic", edges=3))
    assert len(kills) == 1


def undisturbed(entry: SearchEntry) -> bytes:
    """The result, had no worker been lost."""
    assert entry.verdict == "UNKNOWN"
    assert {one.how for one in entry.lost} == {"signal 9"}
    assert entry.total - entry.checked == len(entry.lost)
    sizes = tuple(
        msgspec.structs.replace(size, checked=size.checked + size.undecided, undecided=0)
        for size in entry.by_edges
    )
    return json(
        msgspec.structs.replace(
            entry, verdict="EXHAUSTED", checked=entry.total, lost=(), by_edges=sizes
        )
    )


@pytest.mark.parametrize("keep_going", [False, True])
def test_a_crash_is_a_finding_even_if_the_world_passes_when_tried_again(
    *, keep_going: bool
) -> None:
    found = search("mappers.py:segfaults_once", edges=3, workers=1, keep_going=keep_going)
    first = some(found.counterexample)
    assert (found.verdict, first.world) == ("REFUTED", "m3/21")
    assert found.checked == (86 if keep_going else 12 + 40)
    assert first.message == (
        "no map was delivered: it ended its process (signal 11); at the second try it delivered one"
    )
    assert [size.failing for size in found.by_edges] == [0, 0, 1]
    assert [(one.claim, one.failing) for one in found.claims] == [("map-isomorphic", 1)]


@pytest.mark.parametrize(("keep_going", "failing"), [(False, 1), (True, 2)])
def test_a_loss_behind_the_counterexample_is_not_counted(*, keep_going: bool, failing: int) -> None:
    """Another worker was lost in m3/23 when m3/21 was convicted; whether it was is chance."""
    campaign = search_campaign(targets("mappers.py:exits"), edges=3, keep_going=keep_going)
    work = backend.work_of(backend.job_of(campaign, None))
    first = work.lost(Shard(3, 21, 22), WorkerLoss(3, None, loading=False))
    behind = WorkerLoss(3, None, loading=False)
    result = work.survived(first, [(Shard(3, 23, 24), behind)], [Shard(3, 21, 22)])
    assert result.tally.failing == failing


@pytest.mark.long
def test_a_lost_worker_is_remembered_by_a_store(folder: Path) -> None:
    mappers = targets("mappers.py:killed_once")
    identity = search_campaign(mappers, edges=3).identity(source_hash(mappers))
    for known in (0, 86):
        with Store("search.db") as store:
            memory = store.campaign(identity, Loaded())
            study = search_of("mappers.py:killed_once", edges=3, workers=1, store=memory)
            study.work()
            study.run_again()
            entry = study.entry()
            assert (entry.verdict, entry.checked, entry.from_ledger) == ("UNKNOWN", 85, known)
            assert [one.world for one in entry.lost] == ["m3/21"]
    assert (folder / "done").exists()


@pytest.mark.nightly
def test_a_shard_that_strangers_kill_again_and_again_is_cut_down_to_worlds_and_done(
    stranger: Callable[..., list[Shard]],
) -> None:
    kills = stranger(size=2)
    assert undisturbed(search("basic", edges=2, workers=1)) == json(search("basic", edges=2))
    assert kills
    assert all(kills.count(shard) <= 2 for shard in kills)


@pytest.mark.nightly
def test_a_mapper_that_cannot_be_interrupted_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(backend, "SILENCE_GRACE", 1.0 - Limits().world_timeout)
    found = search("mappers.py:holds", edges=3, workers=2, limits=SHORT)
    first = some(found.counterexample)
    assert first.world == "m3/21"
    assert "its process was ended, for it gave no sign of life for" in first.message


def test_a_note_names_the_world_of_a_mapper_that_loops_and_advises_nothing_given() -> None:
    mappers, notes = targets("mappers.py:loops"), list[str]()
    campaign = search_campaign(mappers, edges=3, limits=Limits(move_timeout=1))
    study = Search(campaign, mappers, backend.pooled(1, note=notes.append))
    study.work()
    (first,) = study.failing
    (note,) = notes
    assert note.startswith(f"{first.world}: no result of the mapper for ")
    assert note.endswith("more than once, before the verdict")


IDLES = """
import time
from pathlib import Path
from topo_verify import CATALOGUE
class Robot:
    def __init__(self, robot): self.robot = robot
    def __getattr__(self, name): return getattr(self.robot, name)
    def move(self, door, purpose=None):
        Path("moves").touch()
        time.sleep(0.5)
        return self.robot.move(door)
def explore(robot): return CATALOGUE["basic"](Robot(robot))
"""


@pytest.mark.nightly
@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="no /proc to look for processes")
@pytest.mark.parametrize("workers", [0, 1])
def test_a_machine_that_is_frozen_for_longer_than_a_limit_convicts_no_mapper(
    folder: Path, workers: int
) -> None:
    """All processes of the search stand still for twice the time that a move may take."""
    (folder / "idles.py").write_text(IDLES)
    words = f"search idles.py:explore --edges 1 --move-timeout 2 --workers {workers}"
    with subprocess.Popen(
        [sys.executable, "-m", "topo_verify", *words.split()],
        cwd=folder,
        stdout=subprocess.PIPE,
        text=True,
    ) as running:
        wait_for((folder / "moves").exists)
        for how in (signal.SIGSTOP, signal.SIGCONT):
            for process in {task.split("/")[0]: None for task in tasks_of(running.pid)}:
                os.kill(int(process), how)
            time.sleep(4 if how == signal.SIGSTOP else 0)
        out, _ = running.communicate(timeout=120)
    assert running.returncode == 0, out
    assert "EXHAUSTED: 2 of 2 worlds" in out


# ---------------------------------------------------------------- loading


def test_a_mapper_whose_source_changes_meanwhile_is_refused(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begins = WorkerProcess.__init__

    def begin(worker: WorkerProcess, serve: str, job: object, folder_: str | None = None) -> None:
        with (folder / "mappers.py").open("a") as file:
            file.write("changed = True\n")
        begins(worker, serve, job, folder_)

    monkeypatch.setattr(WorkerProcess, "__init__", begin)
    with pytest.raises(InputError, match="its source, or topo-verify's, has changed since"):
        search("mappers.py:right", edges=2, workers=1)


@pytest.mark.parametrize(
    ("deed", "words"),
    [
        ("os._exit(7)", r"a process that loads it ends \(exit code 7\)"),
        ("raise ValueError('no')", r"'shy\.py' fails: ValueError: no"),
    ],
)
def test_a_mapper_that_only_a_worker_cannot_load_is_refused(
    folder: Path, deed: str, words: str
) -> None:
    (folder / "shy.py").write_text(
        f"import os\nif os.getpid() != {os.getpid()}: {deed}\ndef explore(robot): ...\n"
    )
    with pytest.raises(InputError, match=words):
        search("shy.py:explore", edges=2, workers=2)


# ---------------------------------------------------------------- nobody is left behind


SEARCHER = """
from topo_verify.studies.search.search import search
search("mappers.py:{name}", edges=4, workers=2)
"""


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="no /proc to look for processes")
@pytest.mark.parametrize("name", ["tells_and_waits", "tells_and_holds"])
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_workers_end_with_their_parent_however_it_ends(
    folder: Path, name: str, how: signal.Signals
) -> None:
    parent = subprocess.Popen(
        [sys.executable, "-c", SEARCHER.format(name=name)],
        cwd=folder,
        stderr=subprocess.DEVNULL,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),  # noqa: PLW1509
    )
    pids: list[int] = []
    wait_for(lambda: len(pids_in(folder)) >= 2)
    pids = pids_in(folder)
    assert all(map(alive, pids))
    parent.send_signal(how)
    parent.wait(timeout=30)
    wait_for(lambda: not any(map(alive, pids)))


def pids_in(folder: Path) -> list[int]:
    file = folder / "pids"
    return [*map(int, file.read_text().split())] if file.exists() else []


@pytest.mark.long
@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="no /proc to look for processes")
def test_no_worker_is_left_when_a_search_is_over() -> None:
    prepare()  # what starts the workers stays
    before = {*tasks_of(os.getpid())}
    search("mappers.py:forgets", edges=4, workers=2)
    assert {*tasks_of(os.getpid())} <= before


# ---------------------------------------------------------------- tasks of any kind

TOY = """
import contextlib, os, signal, time
import msgspec
from topo_verify import errors

@contextlib.contextmanager
def serve(job):
    job = msgspec.json.decode(job)
    if job == "dies":
        os._exit(4)
    if job == "is killed" and not os.path.exists("killed"):
        open("killed", "w").close()
        os.kill(os.getpid(), 9)
    if job == "fails":
        raise ZeroDivisionError
    if job == "needs":
        raise errors.HelperLost("it was ended")
    def handle(task, beat):
        numbers = msgspec.json.decode(task)
        for done, number in enumerate(numbers):
            beat(done)
            if number == -1:
                os._exit(5)
            if number == -2:
                time.sleep(1000)
        return numbers
    yield handle
    with open("left", "a") as file:
        file.write("left\\n")
"""
"""Takes lists of numbers and returns them; some of them kill or hang."""

Numbers = list[int]


@pytest.fixture
def toy(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (folder / "toy.py").write_text(TOY)
    monkeypatch.setattr(sys, "path", [str(folder), *sys.path])
    return folder


def toy_work(*, job: str = "", silence: float = 60.0, attempts: int = 2) -> Work[Numbers, Numbers]:
    def cut(task: Numbers, at: int) -> list[Numbers]:
        return [part for part in (task[:at], task[at : at + 1], task[at + 1 :]) if part]

    def lost(_task: Numbers, loss: WorkerLoss) -> Numbers:
        return [-9 if loss.silence is not None else -5 - loss.loading]

    return Work(
        serve="toy:serve",
        job=job,
        result=Numbers,
        lost=lost,
        silence=silence,
        attempts=attempts,
        division=Division(
            cut, join=lambda parts: [*chain(*parts)], last=lambda parts, _losses: 99 in parts[-1]
        ),
    )


def results(work: Work[Numbers, Numbers], *tasks: Numbers, size: int = 2) -> list[Numbers]:
    with Pool(work, size) as pool:
        done = {id(task): result for task, result in pool.run(tasks)}
    return [done[id(task)] for task in tasks]


@pytest.mark.usefixtures("toy")
def test_a_worker_that_is_killed_while_it_loads_is_replaced() -> None:
    assert results(toy_work(job="is killed"), [1, 2], [3], size=1) == [[1, 2], [3]]


@pytest.mark.usefixtures("toy")
@pytest.mark.parametrize("attempts", [1, 2])
def test_the_item_that_kills_is_found_and_the_others_are_done(attempts: int) -> None:
    killed = results(toy_work(attempts=attempts), [1, 2, -1, 3], [4], [-1], [5, -1])
    assert killed == [[1, 2, -5, 3], [4], [-5], [5, -5]]


@pytest.mark.usefixtures("toy")
def test_a_task_that_lost_its_workers_has_one_result() -> None:
    tasks = [[1], [-1], [2, -1], [3]]
    with Pool(toy_work(), 2) as pool:
        assert sorted(pool.run(tasks)) == [([-1], [-5]), ([1], [1]), ([2, -1], [2, -5]), ([3], [3])]


@pytest.mark.nightly
@pytest.mark.usefixtures("toy")
def test_the_item_that_hangs_is_found() -> None:
    assert results(toy_work(silence=3.0, attempts=1), [1, -2, 3]) == [[1, -9, 3]]


@pytest.mark.usefixtures("toy")
def test_nothing_behind_the_last_piece_that_is_wanted_is_joined() -> None:
    assert results(toy_work(attempts=1), [1, 99, -1, 2, -1]) == [[1, 99]]


def test_the_pieces_of_an_earlier_task_come_first_and_in_order() -> None:
    pieces = Pieces(toy_work())
    tasks = iter([[1, 2], [3, 4], [5]])
    earlier, later = pieces.next(tasks), pieces.next(tasks)
    pieces.replace(some(earlier), [[1], [2]])
    pieces.replace(some(later), [[3], [4]])
    handed_out = [pieces.next(tasks) for _ in range(4)]
    assert [piece and piece.task for piece in handed_out] == [[1], [3], [5], None]
    for piece in handed_out[1::-1]:
        assert piece is not None
        pieces.finish(piece, piece.task)
    handed_out = [pieces.next(tasks) for _ in range(3)]
    assert [piece and piece.task for piece in handed_out] == [[2], [4], None]


@pytest.mark.usefixtures("toy")
def test_a_worker_that_dies_while_it_loads_is_lost_with_its_whole_task() -> None:
    assert results(toy_work(job="dies"), [1, 2]) == [[-6]]


@pytest.mark.usefixtures("toy")
def test_a_second_worker_is_started_after_the_first_result(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[WorkerProcess] = []

    def counted(serve: str, job: object, folder: str | None) -> WorkerProcess:
        started.append(WorkerProcess(serve, job, folder))
        return started[-1]

    monkeypatch.setattr("topo_verify.campaign.pool.WorkerProcess", counted)
    with Pool(toy_work(), 2) as pool:
        done = pool.run([1] for _ in range(9))
        next(done)
        assert len(started) == 1
        next(done)
        assert len(started) == 2


@pytest.mark.usefixtures("toy")
def test_our_bug_in_a_worker_is_told_as_such() -> None:
    with pytest.raises(InternalError, match=r"(?s)in a worker: Traceback.*ZeroDivisionError"):
        results(toy_work(job="fails"), [1])


@pytest.mark.usefixtures("toy")
def test_a_process_that_a_worker_needs_and_that_was_ended_is_told_as_such() -> None:
    with pytest.raises(HelperLost, match="it was ended"):
        results(toy_work(job="needs"), [1])


def test_an_idle_worker_leaves_its_context_before_it_ends(toy: Path) -> None:
    assert results(toy_work(), [1], [2], size=1) == [[1], [2]]
    assert (toy / "left").read_text() == "left\n"
