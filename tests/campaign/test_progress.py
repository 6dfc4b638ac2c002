"""Progress: how fast, how long still, and not too often."""

from __future__ import annotations

from pathlib import Path
from typing import cast

import pytest

from topo_verify.campaign import progress as module
from topo_verify.campaign.progress import Progress, ProgressRate, duration
from topo_verify.campaign.targets import one_target
from topo_verify.errors import InputError
from topo_verify.robot.limits import Limits
from topo_verify.studies.baseline.record import baseline_runs
from topo_verify.studies.corpus import CorpusWorlds, corpus_from

Report = tuple[str, int, int]


def listener(reports: list[Report]) -> Progress:
    """Keep what is reported."""

    def tell(what: str, done: int, total: int) -> None:
        reports.append((what, done, total))

    return tell


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    now = [100.0]
    monkeypatch.setattr(module, "monotonic", lambda: now[0])
    return now


def test_rate_and_time_left_are_those_of_what_was_done_now(clock: list[float]) -> None:
    reports: list[Report] = []
    progress = ProgressRate("basic", 10_000, listener(reports))
    progress.known(4_000)  # a ledger knew them: they say nothing of the rate
    clock[0] += 2
    progress.finished(1_000)
    clock[0] += 2
    progress.in_flight(1_000)
    assert reports == [
        ("basic", 4_000, 10_000),
        ("basic, 500 worlds/s, 10 s left", 5_000, 10_000),
        ("basic, 500 worlds/s, 8 s left", 6_000, 10_000),
    ]


def test_progress_goes_back_for_no_shard_that_is_still_open(clock: list[float]) -> None:
    reports: list[Report] = []
    progress = ProgressRate("basic", 1_000, listener(reports))
    clock[0] += 1
    progress.in_flight(700)
    clock[0] += 1
    progress.finished(400)  # what other shards have done is told a moment later
    assert [done for _, done, _ in reports] == [700, 700]
    progress.finished(600)
    assert reports[-1] == ("basic, 500 worlds/s, 0 s left", 1_000, 1_000)


def test_what_is_no_function_is_refused() -> None:
    with pytest.raises(InputError, match=r"^tell: expected a function .*print, got True$"):
        ProgressRate("basic", 10, cast("Progress", True))


def test_nobody_is_told_ten_times_in_a_moment(clock: list[float]) -> None:
    reports: list[Report] = []
    progress = ProgressRate("basic", 10, listener(reports))
    for done in range(10):
        progress.in_flight(done)
    assert len(reports) == 1
    clock[0] += module.INTERVAL
    progress.in_flight(9)
    assert len(reports) == 2


@pytest.mark.usefixtures("clock")
def test_the_end_is_told_however_soon() -> None:
    reports: list[Report] = []
    progress = ProgressRate("basic", 10, listener(reports))
    progress.known(4)
    progress.finished(6)
    assert [done for _, done, _ in reports] == [4, 10]


def test_without_a_listener_nothing_happens(clock: list[float]) -> None:
    progress = ProgressRate("basic", 10, None)
    clock[0] += 1
    progress.finished(3)
    assert progress.done == 3


@pytest.mark.parametrize(
    ("seconds", "words"),
    [(0, "0 s"), (99, "99 s"), (100, "2 min"), (7200, "2 h"), (10**6, "12 days")],
)
def test_durations_are_told_as_people_do(seconds: float, words: str) -> None:
    assert duration(seconds) == words


def test_a_world_that_holds_up_all_others_is_named_with_its_moves(clock: list[float]) -> None:
    reports: list[Report] = []
    progress = ProgressRate("basic", 10, listener(reports))
    clock[0] += 1
    progress.in_flight(9)
    clock[0] += 1
    progress.in_flight(9, "family:lattice(60,60)", 500)
    clock[0] += module.SLOW
    progress.in_flight(9, "family:lattice(60,60)", 1500)
    clock[0] += 1
    progress.in_flight(9)  # it is judged
    early, *late = (text for text, _, _ in reports[1:])
    assert "lattice" not in early
    for text in late:
        assert "family:lattice(60,60): 1500 moves" in text
        assert "left" not in text


SLOW_MAPPER = """
from time import sleep
from topo_verify import CATALOGUE

class Slow:
    def __init__(self, robot):
        self._robot, self.declare = robot, robot.declare
    percept = property(lambda self: self._robot.percept)
    def move(self, *given):
        sleep(0.2)
        return self._robot.move(*given)

def explore(robot):
    return CATALOGUE["basic"](Slow(robot))
"""


@pytest.mark.parametrize("workers", [0, 1])
def test_it_is_named_in_this_process_and_in_workers(
    workers: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "SLOW", 0.1)
    (tmp_path / "slow.py").write_text(SLOW_MAPPER)
    reports: list[Report] = []
    target = one_target(f"{tmp_path / 'slow.py'}:explore")
    runs = baseline_runs(target, CorpusWorlds(corpus_from(["m3/14"])), 1, limits=Limits())
    (row,) = runs.rows(workers, listener(reports))
    named = [text for text, _, _ in reports if "m3/14: " in text]
    assert named
    moves = [int(text.rpartition(": ")[2].split()[0]) for text in named]
    assert moves == sorted(moves)
    assert 0 < moves[-1] <= row.cost
