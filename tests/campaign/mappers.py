"""Mappers that workers find by `mappers.py:name`: right ones, wrong ones, and killers."""

from __future__ import annotations

import ctypes
import itertools
import os
import random
import signal
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from topo_verify import CATALOGUE, Robot

Killer = Callable[[Robot], Any]


def in_some_worlds(deed: Callable[[], object]) -> Killer:
    """Right, but in five worlds of three edges it does something; `m3/21` is the first."""

    def explore(robot: Robot) -> Any:
        survey = CATALOGUE["basic"](robot)
        if len(survey.edges) == 3 and survey.vertices[0] == (0, 1, 2) and len(survey.vertices) == 2:
            deed()
        return survey

    return explore


def forever() -> bool:
    return all(number >= 0 for number in itertools.count())  # one line: a finding names it


def hold_the_interpreter() -> None:
    """Sleep in C without letting another thread run, signal handlers included."""
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGALRM})
    sleep = ctypes.PyDLL(None).sleep
    while True:
        sleep(1000)


def once(deed: Callable[[], object]) -> Callable[[], object]:
    """Does it the first time only, whichever process it is in."""

    def did() -> None:
        if not Path("done").exists():
            Path("done").touch()
            deed()

    return did


def lack_memory() -> None:
    raise MemoryError


right = in_some_worlds(lambda: None)
lacks_memory = in_some_worlds(lack_memory)
lacks_memory_once = in_some_worlds(once(lack_memory))
exits = in_some_worlds(lambda: os._exit(3))
kills_itself = in_some_worlds(lambda: os.kill(os.getpid(), signal.SIGKILL))
segfaults_once = in_some_worlds(once(lambda: ctypes.string_at(0)))
stalls_once = in_some_worlds(once(lambda: time.sleep(600)))
killed_once = in_some_worlds(once(lambda: os.kill(os.getpid(), signal.SIGKILL)))
segfaults = in_some_worlds(lambda: ctypes.string_at(0))
loops = in_some_worlds(forever)
holds = in_some_worlds(hold_the_interpreter)


def errs_then_lacks_memory(robot: Robot) -> Any:
    """A wrong map in the 20th run of all processes, and a lack of memory after its witness."""
    runs = Path("runs")
    with runs.open("a") as file:
        file.write(".")
    number = runs.stat().st_size
    if number == 20:
        return guesses(robot)
    if number == 22:
        lack_memory()
    return CATALOGUE["basic"](robot)


def guesses(robot: Robot) -> dict[str, Any]:
    """That every world is one edge, after one move."""
    robot.move(0)
    return {"vertices": [[0], [1]], "edges": [[0, 1]], "marker": 0}


def forgets(robot: Robot) -> Any:
    """Right in worlds with less than three edges; then one is missing from the map."""
    survey = CATALOGUE["basic"](robot)
    return survey if len(survey.edges) < 3 else survey._replace(edges=survey.edges[1:])


def remembers(robot: Robot, worlds: list[int] = []) -> Any:  # noqa: B006  that is its fault
    """Right in the first worlds of its process."""
    worlds.append(1)
    return guesses(robot) if len(worlds) > 20 else CATALOGUE["basic"](robot)


def learns(robot: Robot, worlds: list[int] = []) -> Any:  # noqa: B006  that is its fault
    """Wrong in the first world of its process, unless that has one edge."""
    worlds.append(1)
    survey = CATALOGUE["basic"](robot)
    wrong = len(worlds) == 1 and len(survey.edges) > 1
    return survey._replace(edges=survey.edges[1:]) if wrong else survey


def shrinks(robot: Robot, sizes: list[int] = [0]) -> Any:  # noqa: B006  that is its fault
    """Wrong in a world that is smaller than the one before it in its process."""
    survey = CATALOGUE["basic"](robot)
    sizes.append(len(survey.edges))
    return survey if sizes[-1] >= sizes[-2] else survey._replace(edges=survey.edges[1:])


def draws(robot: Robot) -> Any:
    """Right, but which edge comes next is drawn by lot."""
    return CATALOGUE["basic"].with_policies(pick=f"random({random.randrange(10**6)})")(robot)


def tosses(robot: Robot) -> Any:
    """Wrong in half of its runs, in whichever process; the same runs each time."""
    runs = Path("runs")
    with runs.open("a") as file:
        file.write(".")
    survey = CATALOGUE["basic"](robot)
    wrong = random.Random(runs.stat().st_size).random() < 0.5
    return survey._replace(edges=survey.edges[1:]) if wrong else survey


def moody(robot: Robot) -> Any:
    """Right, unless a variable of the environment says otherwise."""
    return guesses(robot) if os.environ.get("MOOD") else CATALOGUE["basic"](robot)


def noisy(robot: Robot) -> Any:
    """Right, but it prints, and reads what is not for it."""
    print("x" * 100_000)  # noqa: T201  that is its fault
    assert sys.stdin.read() == ""
    return CATALOGUE["basic"](robot)


def strolls(robot: Robot) -> Any:
    """Right, but it takes its time."""
    survey = CATALOGUE["basic"](robot)
    time.sleep(60)
    return survey


def tells_and_waits(_robot: Robot) -> Any:
    """Tells a test which process it is in, and that this goes on."""
    with Path("pids").open("a") as file:
        file.write(f"{os.getpid()}\n")
    time.sleep(60)


def tells_and_holds(_robot: Robot) -> Any:
    with Path("pids").open("a") as file:
        file.write(f"{os.getpid()}\n")
    hold_the_interpreter()
