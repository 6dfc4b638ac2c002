"""Long runs: logs of a million moves without a world, and mappers in large lattices.

    .venv/bin/python benchmarks/long_runs.py          # the lattice of 1,984 edges
    .venv/bin/python benchmarks/long_runs.py 32 50 71 # also 4,900 and 9,940 edges: an hour or so

Seconds are those of the processor. Each command runs in a process of its own, and memory is the
most that this process took; Python and the modules take some 30 MB of it.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from random import Random
from time import process_time
from typing import NamedTuple

from topo_verify import CATALOGUE, World, families
from topo_verify.robot.events import Event, Start, write_trace
from topo_verify.robot.percept import Door
from topo_verify.robot.simulator import SimulatedRobot

Row = Callable[[str, str, str], None]

MOVES = 1_000_000


class Used(NamedTuple):
    """What a command took: seconds of the processor, and megabytes at most."""

    seconds: float
    megabytes: int


MEASURE = """
import os, subprocess, sys
process = subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL)
_, status, usage = os.wait4(process.pid, 0)
print(os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime, usage.ru_maxrss)
"""
"""Between this process and the command: the memory of whoever starts a process counts as its own,
so it must be small."""


def used(*words: str) -> Used:
    """What a command of topo-verify takes, in a process of its own; it must not say REFUTED."""
    command = [sys.executable, "-c", MEASURE, sys.executable, "-m", "topo_verify", *words]
    told = subprocess.run([*command, "--quiet"], capture_output=True, check=True, text=True).stdout  # noqa: S603  our own command
    code, seconds, kilobytes = told.split()
    assert code in ("0", "3"), f"topo-verify {' '.join(words)}: exit {code}"
    return Used(float(seconds), int(kilobytes) // 1024)


def patrol(doors: Callable[[int], Door]) -> bytes:
    """A log of a million moves in a lattice of 20x20; `doors` chooses, given the degree."""
    robot = SimulatedRobot(families.lattice(20, 20), MOVES)
    log: list[Event] = [Start(percept=robot.percept)]
    for _ in range(MOVES):
        robot.move(doors(robot.percept.degree))
    return write_trace([*log, *robot.events])


PATROLS: dict[str, Callable[[int], Door]] = {
    "round one face, past the marker": lambda _: 1,
    "at random": Random(1).randrange,
}


def algorithm_alone(name: str, world: World) -> float:
    """Seconds of an algorithm and its simulated robot, with no trace judged."""
    robot = SimulatedRobot(world, world.cost_bound)
    begin = process_time()
    CATALOGUE[name](robot.handle)
    return process_time() - begin


def table(row: Row, sides: Sequence[int] = (32,)) -> None:
    """Print the rows; a lattice of each of these sides."""
    with tempfile.TemporaryDirectory() as folder:
        for kind, doors in PATROLS.items():
            log = Path(folder) / "log.jsonl"
            log.write_bytes(patrol(doors))
            took = used("certify", str(log))
            row(f"certify {MOVES:,} moves, {kind}", f"{took.seconds:.1f} s", "< 20 s")
            row("  memory", f"{took.megabytes} MB", "")
    for side in sides:
        world = families.lattice(side, side)
        basic, folding = (algorithm_alone(name, world) for name in ("basic", "folding"))
        what = f"{len(world.edges):,} edges: folding / basic, algorithm alone"
        row(what, f"{folding:.1f} / {basic:.1f} s", "")
        row("  ratio", f"{folding / basic:.1f}", "<= 5")
        for name in ("basic", "folding"):
            where = f"family:lattice({side},{side})"
            took = used("explore", where, "--algorithm", name, "--world-timeout", "100000")
            row(f"  explore --algorithm {name}, judged", f"{took.seconds:.1f} s", "")
            row("    memory", f"{took.megabytes} MB", "")


if __name__ == "__main__":
    table(
        lambda *cells: print(f"{cells[0]:<58}{cells[1]:>18}{cells[2]:>18}", flush=True),
        [*map(int, sys.argv[1:])] or (32,),
    )
