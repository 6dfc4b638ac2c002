"""How fast the oracle is: through the pipe, in batch mode, and in a search with a child.

The program is the C example, in a lattice of 20 x 20 with holes. The pipe is timed by the clock,
since two processes take turns; the replay, without judging, by the processor. The search compares a
file that re-exports `basic` with and without `--in-process`.
"""

from __future__ import annotations

import resource
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from math import inf
from pathlib import Path
from time import perf_counter, process_time

from topo_verify import explore, families
from topo_verify.campaign.backend import here
from topo_verify.campaign.targets import one_target
from topo_verify.programs.program import Program
from topo_verify.programs.protocol import BatchRun
from topo_verify.robot.events import Move
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.studies.conform.batch import BatchReplay
from topo_verify.studies.search.search import Search, search_campaign

SOURCE = Path(__file__).resolve().parents[1] / "examples" / "mapper_c" / "mapper.c"

WORLD = families.lattice(20, 20, holes=0.2, seed=7)


MINE = """
import topo_verify
basic = topo_verify.CATALOGUE["basic"]
def explore(robot):
    return basic(robot)
"""


def piped() -> tuple[float, float] | None:
    """Moves a second through the pipe, the best of three, and wake-ups a move; None without cc."""
    compiler = shutil.which("cc")
    if compiler is None:
        return None
    with tempfile.TemporaryDirectory() as folder:
        program_file = Path(folder) / "mapper"
        subprocess.run([compiler, "-O2", "-o", program_file, SOURCE], check=True)  # noqa: S603  our own
        with Program([str(program_file)]) as program:
            rates: list[tuple[float, float]] = []
            for _ in range(3):
                woken, start = _wake_ups(), perf_counter()
                run = explore(WORLD, program.target)
                took = perf_counter() - start
                rates.append((run.cost / took, (_wake_ups() - woken) / run.cost))
                assert run.map is not None, run.stopped
    return max(rates)


def _wake_ups() -> int:
    return resource.getrusage(resource.RUSAGE_SELF).ru_nvcsw


def apart(edges: int) -> float:
    best = {True: inf, False: inf}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "mine.py"
        file.write_text(MINE)
        for in_process in (True, False) * 3:
            target = one_target(f"{file}:explore", in_process=in_process)
            campaign = search_campaign((target,), edges=edges, in_process=in_process)
            start = perf_counter()
            work = Search(campaign, (target,), here((target,)))
            work.work()
            best[in_process] = min(best[in_process], perf_counter() - start)
            if isinstance(target.mapper, Program):
                target.mapper.close()
    return best[False] / best[True]


def replayed() -> float:
    doors = [event.door for event in explore(WORLD, "basic").trace if isinstance(event, Move)]
    player = BatchReplay(BatchRun("lattice", tuple(doors), map=explore(WORLD, "basic").map))
    robot = SimulatedRobot(WORLD, len(doors))
    start = process_time()
    player(robot)
    return robot.cost / (process_time() - start)


def table(row: Callable[[str, str, str], None]) -> None:
    speed = piped()
    rate, woken = speed or (0.0, 0.0)
    shown = "no C compiler" if speed is None else f"{rate:,.0f} /s"
    row("moves through the pipe, a program in C", shown, ">= 30,000 /s")
    row("wake-ups of the harness a move", f"{woken:.2f}", "")
    row("search with --edges 4, mapper in a child / in-process", f"{apart(4):.2f}", "<= 2")
    row("moves replayed in batch mode", f"{replayed():,.0f} /s", ">= 200,000 /s")


if __name__ == "__main__":
    table(lambda *cells: print(f"{cells[0]:<58}{cells[1]:>18}{cells[2]:>18}"))
