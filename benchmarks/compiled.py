"""The speed of the compiled engine beside what is promised.

    .venv/bin/python benchmarks/compiled.py                      # all rows, some minutes
    .venv/bin/python benchmarks/compiled.py --only enumeration
    .venv/bin/python benchmarks/compiled.py --only nine ten --whole   # all 31,579,824 worlds

Seconds are processor time, with kernels compiled before; rows for two cores also show the clock.
Without `--whole`, `nine` and `ten` extrapolate from one of sixteen slices of the worlds with 8
edges. The ratio to C compares with `compiled_twin.c` (cc -O2 -march=native).
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from itertools import repeat
from multiprocessing import get_context
from pathlib import Path
from time import perf_counter, process_time

import numpy as np

from topo_verify import CATALOGUE, examine, families
from topo_verify.extra.fast.kernels.enumeration import count_worlds, prepare
from topo_verify.extra.fast.kernels.explore import run_world
from topo_verify.extra.fast.kernels.kernel import compiled
from topo_verify.extra.fast.kernels.workspace import SMALL
from topo_verify.extra.fast.snapshots import examine_range
from topo_verify.world.enumeration import rank_order
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.rooted_map import World

Row = Callable[[str, str, str], None]

PAPER = [name for name in CATALOGUE if "folding" not in name]

SLICE = 20_000
PART = 16


def seconds(work: Callable[[], object]) -> float:
    start = process_time()
    work()
    return process_time() - start


# ---------------------------------------------------------------- one core


def listed(kind: str, edges: int) -> tuple[int, float]:
    """The number of worlds of a class, and the kernel's seconds to list them."""
    count, worlds = compiled(count_worlds, SMALL), WorldClass.parse(kind)
    space = np.zeros(SMALL.at("SIZE"), np.int64)
    count(space, prepare(2, worlds))
    state = prepare(edges, worlds)
    start = process_time()
    number = count(space, state)
    return number, process_time() - start


def enumeration(row: Row, _: bool) -> None:
    with tempfile.TemporaryDirectory() as folder:
        program = built(Path(folder))
        worlds, took = listed("any", 8)
        theirs = in_c(program, 8, worlds) if program else 0.0
    beside = f" ({theirs / took:.2f} x C)" if theirs else ""
    row(
        f"worlds listed, {worlds:,} with 8 edges{beside}",
        f"{worlds / took / 1e6:.1f} M/s",
        ">= 40 M/s",
    )
    for kind, edges in (("planar", 9), ("genus<=1", 8), ("genus:1", 8)):
        worlds, took = listed(kind, edges)
        row(
            f"  {kind}, {worlds:,} with {edges} edges",
            f"{worlds / took / 1e6:.1f} M/s",
            ">= 12 M/s",
        )
    worlds, took = listed("simple", 10)
    row(f"  simple, {worlds:,} with 10 edges", f"{took:.2f} s", "< 0.4 s")


def built(folder: Path) -> Path | None:
    program = folder / "compiled_twin"
    source = Path(__file__).with_name("compiled_twin.c")
    command = ["cc", "-O2", "-march=native", "-o", str(program), str(source)]
    try:
        subprocess.run(command, check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"no C twin: {error}", file=sys.stderr)
        return None
    return program


def in_c(program: Path, edges: int, stop: int) -> float:
    """Processor seconds of the C twin."""
    command = [str(program), str(edges), str(stop)]
    return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def speedup(row: Row, _: bool) -> None:
    """The same work, all ten claims, by the kernels and by the reference."""
    edges = 5
    examine_range(PAPER, 2)
    worlds, stretch = rank_order.count(edges), 200

    def by_reference() -> None:
        for start in range(0, worlds, worlds // 4):
            for table in rank_order.tables(edges, start, start + stretch // 4):
                for name in PAPER:
                    assert examine(name, World.from_code(table)).ok

    def by_kernel() -> None:
        for start in range(0, worlds, worlds // 4):
            for _ in range(40):
                examine_range(PAPER, edges, "any", start, start + stretch // 4)

    sampled = len(range(0, worlds, worlds // 4)) * (stretch // 4)
    ours = seconds(by_kernel) / 40 / sampled
    theirs = seconds(by_reference) / sampled
    row(
        f"all ten claims, 8 algorithms, {edges} edges: {ours * 1e6:.0f} us a world",
        f"{theirs / ours:.0f} x reference",
        ">= 100 x",
    )


# ---------------------------------------------------------------- two cores


def _examined(claims: int, shard: tuple[int, int, int]) -> tuple[int, int, float, int]:
    edges, start, stop = shard
    begin = process_time()
    tally = examine_range(PAPER, edges, "any", start, stop, claims=claims).tally
    used = process_time() - begin
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
    return tally.worlds, tally.failing, used, memory


def _shards(whole: bool) -> Iterator[tuple[int, int, int]]:
    for edges in range(1, 9):
        total = rank_order.count(edges)
        step = SLICE if whole or edges < 8 else SLICE * PART
        for start in range(0, total, step):
            yield edges, start, min(start + SLICE, total)


def everything(row: Row, claims: int, required: str, whole: bool) -> None:
    """Claims 1 to `claims`, the paper's algorithms, every world to 8 edges, two processes."""
    examine_range(PAPER, 1, claims=claims)
    shards = list(_shards(whole))
    expected = sum(rank_order.count(edges) for edges in range(1, 9))
    begin = perf_counter()
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        done = list(pool.map(_examined, repeat(claims), shards, chunksize=4))
    took = perf_counter() - begin
    worlds, used = sum(part[0] for part in done), sum(part[2] for part in done)
    assert not sum(part[1] for part in done), "a claim fails"
    assert not whole or worlds == expected
    scale = expected / worlds / 60
    name = "all ten claims" if claims == 10 else f"claims 1-{claims}"
    how = "all examined" if whole else f"from {worlds:,}"
    row(f"{name}, 8 algorithms, {expected:,} worlds, {how}", f"{took * scale:.1f} min", required)
    each = worlds * len(PAPER) / used / 1e6
    row(f"  processor {used * scale:.1f} min, {each:.2f} M runs/s a core", "", "")
    row("  the most memory of a worker", f"{max(part[3] for part in done)} MB", "< 500 MB")


def nine(row: Row, whole: bool) -> None:
    everything(row, 9, "< 3.5 min", whole)


def ten(row: Row, whole: bool) -> None:
    everything(row, 10, "< 4.5 min", whole)


# ---------------------------------------------------------------- one world, and the start


def lattice(row: Row, _: bool) -> None:
    world = families.lattice(100, 100, holes=0.2, seed=1)
    run_world(World.from_id("m1/0"), "enhancement-iii-all+i")
    took = seconds(lambda: run_world(world, "enhancement-iii-all+i"))
    row("lattice(100,100,holes=0.2), enhancement-iii-all+i", f"{took:.1f} s", "< 30 s")


def start(row: Row, _: bool) -> None:
    """A new process up to its first result, with a warm cache."""
    code = "from topo_verify.extra.fast.snapshots import examine_range as e; e(['basic'], 4)"
    took: list[float] = []
    for _again in range(3):
        begin = perf_counter()
        subprocess.run([sys.executable, "-c", code], check=True)
        took.append(perf_counter() - begin)
    row("first result of a new process, warm cache", f"{min(took):.2f} s", "< 1.5 s")


ROWS = {work.__name__: work for work in (enumeration, speedup, nine, ten, lattice, start)}


def table(row: Row, only: list[str] | None = None, *, whole: bool = False) -> None:
    for name in only or ROWS:
        ROWS[name](row, whole)


def main() -> None:
    parser = argparse.ArgumentParser(description=str(__doc__).splitlines()[0])
    parser.add_argument("--only", nargs="+", choices=list(ROWS), help="these rows alone")
    parser.add_argument("--whole", action="store_true", help="examine every world to 8 edges")
    asked = parser.parse_args()
    table(
        lambda what, measured, required: print(
            f"{what:<72}{measured:>18}{required:>14}", flush=True
        ),
        asked.only,
        whole=asked.whole,
    )


if __name__ == "__main__":
    main()
