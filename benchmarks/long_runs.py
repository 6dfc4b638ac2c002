"""Long runs: logs of a million moves without a world, and mappers in large lattices.

    .venv/bin/python benchmarks/long_runs.py          # the lattice of 1,984 edges
    .venv/bin/python benchmarks/long_runs.py 32 50 71 # also 4,900 and 9,940 edges: an hour or so
    .venv/bin/python benchmarks/long_runs.py --growth # exponents of time and memory, some minutes

Processor seconds and peak memory of separate processes; Python and the modules take some 30 MB.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Callable, Sequence
from math import log
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
    """The processor time and peak memory of a process."""

    seconds: float
    megabytes: int


MEASURE = """
import os, subprocess, sys
process = subprocess.Popen(sys.argv[1:], stdout=subprocess.DEVNULL)
_, status, usage = os.wait4(process.pid, 0)
print(os.waitstatus_to_exitcode(status), usage.ru_utime + usage.ru_stime, usage.ru_maxrss)
"""
"""A process between this one and the command: a parent's memory counts as the child's own."""


def used(*words: str) -> Used:
    return measured("-m", "topo_verify", *words, "--quiet")


def measured(*words: str) -> Used:
    command = [sys.executable, "-c", MEASURE, sys.executable, *words]
    output = subprocess.run(command, capture_output=True, check=True, text=True).stdout  # noqa: S603  our own command
    code, seconds, kilobytes = output.split()
    assert code in ("0", "3"), f"{' '.join(words)}: exit {code}"
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
    """Seconds of an algorithm and its simulated robot, with nothing judged."""
    robot = SimulatedRobot(world, world.cost_bound)
    begin = process_time()
    CATALOGUE[name](robot.handle)
    return process_time() - begin


def table(row: Row, sides: Sequence[int] = (32,)) -> None:
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
            took = used("explore", where, "--target", name, "--world-timeout", "100000")
            row(f"  explore --target {name}, judged", f"{took.seconds:.1f} s", "")
            row("    memory", f"{took.megabytes} MB", "")


RUN = """
import sys
from topo_verify import explore, families
side = int(sys.argv[1])
explore(families.lattice(side, side + 1), sys.argv[2], engine=sys.argv[3])
"""


def growth(row: Row, small: int = 15, large: int = 50) -> None:
    """Print what runs in two lattices take beyond a tiny one, and the exponents."""
    worlds = [families.lattice(side, side + 1) for side in (small, large)]
    edges = [len(world.edges) for world in worlds]
    for engine in ("reference", "compiled"):
        for name in ("basic", "folding", "enhancement-iii-all+i"):
            measured("-c", RUN, "2", name, engine)  # kernels are compiled once
            start, *took = (
                measured("-c", RUN, str(side), name, engine) for side in (2, small, large)
            )
            seconds = [max(0.01, use.seconds - start.seconds) for use in took]
            memory = [max(1, use.megabytes - start.megabytes) for use in took]
            for what, unit, used_up in (("time", "s", seconds), ("memory", "MB", memory)):
                cells = " / ".join(f"{amount:.2f}" for amount in used_up)
                power = log(used_up[1] / used_up[0]) / log(edges[1] / edges[0])
                where = f"{engine} {name}, {edges[0]:,} / {edges[1]:,} edges: {what}"
                row(where, f"{cells} {unit}", f"m^{power:.1f}")


def print_row(*cells: str) -> None:
    print(f"{cells[0]:<66}{cells[1]:>20}{cells[2]:>12}", flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--growth"]:
        growth(print_row, *map(int, sys.argv[2:]))
    else:
        table(print_row, [*map(int, sys.argv[1:])] or (32,))
