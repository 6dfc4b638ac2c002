"""How fast the oracle is: moves a second through the pipe, and replayed in batch mode.

The program is the one in C of `examples/`, compiled here, in a lattice of 20 x 20 with holes.
Through the pipe the clock on the wall counts, for two processes take turns; a busy machine is
slower. The replay is timed alone, without judging, in processor time.
"""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Callable
from pathlib import Path
from time import perf_counter, process_time

from topo_verify import explore, families
from topo_verify.harness.conform.batch import BatchReplay
from topo_verify.programs.program import Program
from topo_verify.programs.protocol import BatchRun
from topo_verify.robot.events import Move
from topo_verify.robot.simulator import SimulatedRobot

SOURCE = Path(__file__).resolve().parents[1] / "examples" / "mapper_c" / "mapper.c"

WORLD = families.lattice(20, 20, holes=0.2, seed=7)


def piped() -> float | None:
    """Moves a second through the pipe, the best of three; None without a C compiler."""
    compiler = shutil.which("cc")
    if compiler is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder) / "mapper"
        subprocess.run([compiler, "-O2", "-o", made, SOURCE], check=True)  # noqa: S603  our own
        with Program([str(made)]) as program:
            rates: list[float] = []
            for _ in range(3):
                start = perf_counter()
                run = explore(WORLD, program.target)
                rates.append(run.cost / (perf_counter() - start))
                assert run.map is not None, run.stopped
    return max(rates)


def replayed() -> float:
    """Moves a second that a run of the batch is replayed with."""
    doors = [event.door for event in explore(WORLD, "basic").trace if isinstance(event, Move)]
    player = BatchReplay(BatchRun("lattice", tuple(doors), map=explore(WORLD, "basic").map))
    robot = SimulatedRobot(WORLD, len(doors))
    start = process_time()
    player(robot)
    return robot.cost / (process_time() - start)


def table(row: Callable[[str, str, str], None]) -> None:
    """Two lines."""
    rate = piped()
    shown = "no C compiler" if rate is None else f"{rate:,.0f} /s"
    row("moves through the pipe, a program in C", shown, ">= 20,000 /s")
    row("moves replayed in batch mode", f"{replayed():,.0f} /s", ">= 200,000 /s")


if __name__ == "__main__":
    table(lambda *cells: print(f"{cells[0]:<58}{cells[1]:>18}{cells[2]:>18}"))
