"""Mappers that kill what is around them, or wait, in one world; copied into a folder of its own."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from topo_verify import CATALOGUE, Robot


def _explore(robot: Robot, at_three_doors: Callable[[], object]) -> Any:
    """The map by `basic`; something happens before where the marker stands at three doors.

    Of the simple worlds of up to three edges that is the star, with the marker at its centre.
    """
    if robot.percept.degree == 3:
        at_three_doors()
    return CATALOGUE["basic"](robot)


def _kill_the_dask_worker() -> None:
    launcher = Path(f"/proc/{os.getppid()}/stat").read_text(encoding="ascii")
    os.kill(int(launcher.rpartition(")")[2].split()[1]), signal.SIGKILL)  # its parent
    time.sleep(60)  # this process ends with the launcher, which ends with the Dask worker


def kills_its_dask_worker_once(robot: Robot) -> Any:
    """The first process that comes here takes the Dask worker with it."""

    def once() -> None:
        if not Path("killed").exists():
            Path("killed").touch()
            _kill_the_dask_worker()

    return _explore(robot, once)


def takes_two_gib(robot: Robot) -> Any:
    """Right, with room for two GiB; nothing is written there."""
    return _explore(robot, lambda: bytes(2**31))  # bytearray would write zeros


def kills_its_dask_worker(robot: Robot) -> Any:
    """Every process that comes here takes the Dask worker with it."""
    return _explore(robot, _kill_the_dask_worker)


def kills_the_scheduler(robot: Robot) -> Any:
    """The process whose number stands in the file `scheduler` is killed."""

    def kill() -> None:
        os.kill(int(Path("scheduler").read_text()), signal.SIGKILL)
        time.sleep(60)

    return _explore(robot, kill)


def waits_for_go(robot: Robot) -> Any:
    """It goes on when there is a file `go`."""

    def wait() -> None:
        while not Path("go").exists():
            time.sleep(0.01)

    return _explore(robot, wait)
