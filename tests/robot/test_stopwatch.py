"""The stopwatch: it goes while a mapper sleeps or computes, and stands still while it waits."""

# A test may look inside.
# pyright: reportPrivateUsage=false

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from unittest.mock import Mock

import pytest

from topo_verify.robot import stopwatch
from topo_verify.robot.limits import Limits, MoveTimeout, _Watch, helped_by, within
from topo_verify.robot.stopwatch import Stopwatch, tasks_of

ACCOUNTS = Path("/proc/self/schedstat").exists() and hasattr(os, "sched_setaffinity")


class Machine:
    """A clock, and what the kernel has booked for tasks, as a test sets them."""

    now = 100.0
    own = 0.0
    waits: Mapping[str, float] = {}
    ran = 77.0

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr(stopwatch, "monotonic", lambda: self.now)
        monkeypatch.setattr(stopwatch, "_read", self.read)

    state = "S"

    def read(self, path: str) -> str:
        """The account of a task in /proc: nanoseconds on a processor and waiting, turns."""
        if path.endswith("/stat"):
            return f"7 (its (name)) {self.state} 1 7"
        task = path.removeprefix("/proc/").removesuffix("/schedstat")  # or …/children: none
        wait = self.own if task.startswith("self") else self.waits.get(task)
        return "" if wait is None else f"{round(self.ran * 1e9)} {round(wait * 1e9)} 5\n"


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch) -> Machine:
    return Machine(monkeypatch)


def test_it_stands_still_while_the_thread_waits_for_a_processor(machine: Machine) -> None:
    machine.own = 9
    watch = Stopwatch()
    machine.now, machine.own = 105, 12
    assert watch.seconds() == pytest.approx(2)
    machine.now = 106
    assert watch.seconds() == pytest.approx(3)


def test_a_wait_that_is_booked_late_is_made_good(machine: Machine) -> None:
    watch = Stopwatch()
    machine.now = 104
    assert watch.seconds() == pytest.approx(4)
    machine.now, machine.own = 105, 4
    assert watch.seconds() == pytest.approx(1)


def test_a_wait_of_a_helper_counts_before_the_kernel_books_it(machine: Machine) -> None:
    machine.waits, machine.state = {"a": 3}, "R"
    watch = Stopwatch(lambda: machine.waits)
    for machine.now in (101, 102, 103):
        assert watch.seconds() == pytest.approx(0)
    machine.now, machine.ran, machine.waits = 104, 78, {"a": 3 + 3}
    assert watch.seconds() == pytest.approx(1)


def test_a_helper_that_sleeps_waits_for_no_processor(machine: Machine) -> None:
    machine.waits = {"a": 3}
    watch = Stopwatch(lambda: machine.waits)
    machine.now = 101
    assert watch.seconds() == pytest.approx(1)


def test_the_waits_of_the_helpers_tasks_do_not_add_up_but_the_longest_counts(
    machine: Machine,
) -> None:
    machine.waits = {"a": 1, "b": 1, "ends": 1}
    watch = Stopwatch(lambda: machine.waits)
    machine.now, machine.own, machine.waits = 110, 1, {"a": 3, "b": 5, "new": 2}
    assert watch.seconds() == pytest.approx(10 - 1 - 4)


def test_what_ran_was_used_though_the_thread_and_its_helper_wait_at_the_same_time(
    machine: Machine,
) -> None:
    machine.waits = {"a": 0}
    watch = Stopwatch(lambda: machine.waits)
    for turn in range(1, 5):  # of ten seconds; the helper runs for one of them
        machine.now, machine.ran = 100 + 10 * turn, 77 + turn
        machine.own, machine.waits = 8 * turn, {"a": 9 * turn}
        assert watch.seconds() == pytest.approx(turn)


def test_nothing_runs_longer_than_the_clock(machine: Machine) -> None:
    machine.waits = {"a": 0}
    watch = Stopwatch(lambda: machine.waits)
    machine.now, machine.ran, machine.waits = 101, 90, {"a": 0.5, "known no more": 0}
    assert watch.seconds() == pytest.approx(1)


def test_a_helper_counts_only_as_long_as_it_helps(machine: Machine) -> None:
    machine.waits = {"a": 1}
    watch = Stopwatch()
    with watch.helped_by(lambda: machine.waits):
        machine.now, machine.waits = 105, {"a": 3}
        assert watch.seconds() == pytest.approx(3)
    machine.now, machine.waits = 110, {"a": 8}
    assert watch.seconds() == pytest.approx(8)


def test_of_the_waits_of_a_thread_that_looks_for_an_answer_only_the_last_is_excused(
    machine: Machine,
) -> None:
    heard = 0
    machine.waits = {"sleeps": 0}
    watch = Stopwatch(lambda: machine.waits, lambda: heard)
    for look in range(1, 5):  # one every ten seconds, and before each the thread waits for eight
        machine.now, machine.own = 100 + 10 * look, 8 * look
        assert watch.seconds() == pytest.approx(10 * look - 8)
    machine.now, machine.own, heard = 150, 40, 1
    assert watch.seconds() == pytest.approx(50 - 8 - 8)  # by the alarm, then by the answer itself


def test_a_wait_before_an_answer_is_not_charged_later(machine: Machine) -> None:
    heard = 0
    machine.waits = {"answers": 0}
    watch = Stopwatch(lambda: machine.waits, lambda: heard)
    machine.now, machine.own, heard = 110, 8, 1
    assert watch.seconds() == pytest.approx(2)
    machine.now = 120
    assert watch.seconds() == pytest.approx(12)


def test_of_a_time_without_a_look_one_tick_is_used(machine: Machine) -> None:
    watch = Stopwatch(tick=1)
    machine.now = 101.9  # late, but no look is missing
    assert watch.seconds() == pytest.approx(1.9)
    machine.now = 110
    assert watch.seconds() == pytest.approx(2.9)
    machine.now = 111
    assert watch.seconds() == pytest.approx(3.9)


def test_what_ran_without_a_look_was_used(machine: Machine) -> None:
    """A mapper in C code lets no alarm strike, and the harness may stand still without it."""
    machine.waits = {"a": 0}
    watch = Stopwatch(lambda: machine.waits, tick=1)
    machine.now, machine.ran, machine.waits = 110, 77 + 6, {"a": 2}
    assert watch.seconds() == pytest.approx(1 + 6)
    machine.now, machine.ran = 120, 77 + 16
    assert watch.seconds() == pytest.approx(1 + 6 + 10)


def test_waits_that_were_excused_in_vain_are_used_though_a_look_is_missing(
    machine: Machine,
) -> None:
    machine.waits = {"sleeps": 0}
    watch = Stopwatch(lambda: machine.waits, lambda: 0, tick=1)
    machine.now, machine.own = 105, 4
    assert watch.seconds() == pytest.approx(1)
    machine.now = 120
    assert watch.seconds() == pytest.approx(1 + 4 + 1)


def test_a_time_in_which_nobody_ran_exceeds_no_limit(machine: Machine) -> None:
    watch = _Watch(Limits(move_timeout=5, world_timeout=12), lambda: 0, Stopwatch(tick=1.25))
    for frozen in (8, 9, 1000):
        machine.now += frozen
        assert watch.overdue() is None
    machine.now += 1.25
    assert watch.overdue() is None
    machine.now += 1.25
    assert isinstance(watch.overdue(), MoveTimeout)


def test_without_accounts_it_is_the_wall_clock(
    machine: Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(stopwatch, "_read", Mock(return_value=""))
    watch = Stopwatch(lambda: ["a"])
    machine.now = 107
    assert watch.seconds() == pytest.approx(7)


def test_limits_excuse_the_waits_of_a_process_that_helps(
    machine: Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    def threads(folder: str) -> list[str]:
        return [folder.split("/")[2]]

    monkeypatch.setattr(stopwatch, "_entries", threads)
    machine.waits = {"7/task/7": 0}

    def work() -> str:
        with helped_by(7):
            for look in range(1, 5):
                machine.now, machine.waits = 100 + 2.4 * look, {"7/task/7": 2.0 * look}
                signal.raise_signal(signal.SIGALRM)
        return "a map"

    assert within(Limits(move_timeout=5), lambda: 0, work) == "a map"


def test_no_limits_need_no_help() -> None:
    with helped_by(os.getpid()):
        pass


# ---------------------------------------------------------------- the real machine


def test_it_goes_while_the_thread_sleeps() -> None:
    watch = Stopwatch()
    time.sleep(0.2)
    assert watch.seconds() > 0.15


@pytest.mark.skipif(not ACCOUNTS, reason="the kernel keeps no account of waits here")
def test_beside_a_busy_process_it_shows_the_processor_time() -> None:
    allowed = os.sched_getaffinity(0)
    busy = subprocess.Popen([sys.executable, "-c", "while True: pass"])
    try:
        os.sched_setaffinity(0, {min(allowed)})
        os.sched_setaffinity(busy.pid, {min(allowed)})
        watch, began, own = Stopwatch(), time.monotonic(), time.thread_time()
        while time.thread_time() - own < 0.5:
            pass
        used, passed = watch.seconds(), time.monotonic() - began
    finally:
        os.sched_setaffinity(0, allowed)
        busy.kill()
        busy.wait()
    assert 0.4 < used < 0.5 + (passed - 0.5) / 2


@pytest.mark.skipif(not ACCOUNTS, reason="the kernel keeps no account of waits here")
def test_a_program_that_waits_long_for_a_processor_uses_nothing() -> None:
    loop = [sys.executable, "-c", "while True: pass"]
    with subprocess.Popen(loop) as busy, subprocess.Popen(loop) as starved:
        try:
            shared = {max(os.sched_getaffinity(0))}
            for process in (busy, starved):
                os.sched_setaffinity(process.pid, shared)
            os.sched_setscheduler(starved.pid, os.SCHED_IDLE, os.sched_param(0))
            watch, began = Stopwatch(lambda: tasks_of(starved.pid)), time.monotonic()
            most = 0.0
            while (passed := time.monotonic() - began) < 1:
                time.sleep(0.05)
                most = max(most, watch.seconds())
        finally:
            busy.kill()
            starved.kill()
    assert most < passed / 2


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="no /proc here")
def test_the_tasks_of_a_process_are_its_threads_and_those_of_its_children() -> None:
    source = """
import subprocess, sys, threading
threading.Thread(target=sys.stdin.read).start()
child = subprocess.Popen(["sleep", "60"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
print(child.pid, flush=True)
child.wait()
"""
    command = [sys.executable, "-c", source]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as parent:
        assert parent.stdout is not None
        child = int(parent.stdout.readline())
        tasks = list(tasks_of(parent.pid))
        os.kill(child, 9)
    assert not list(tasks_of(parent.pid))
    assert f"{parent.pid}/task/{parent.pid}" in tasks
    assert f"{child}/task/{child}" in tasks
    assert len(tasks) == 3


def test_a_process_that_ends_while_it_is_read_has_no_account(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(os, "read", Mock(side_effect=ProcessLookupError))
    assert Stopwatch().seconds() < 5


def test_a_process_that_has_ended_has_no_account() -> None:
    assert Stopwatch(lambda: ["0/task/0"]).seconds() < 5
