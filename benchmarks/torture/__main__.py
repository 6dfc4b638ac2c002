"""Torture: what must hold for any input, and after any kill.

    make torture                                                  minutes on two cores
    .venv/bin/python benchmarks/torture --only readers --scale 20     more of one part
    .venv/bin/python benchmarks/torture --only opened       every single bit of a ledger
    .venv/bin/python benchmarks/torture --only "baseline of" --scale inf      and of a baseline

    readers.py      every format (formats.py), mutated: read, or refused with one sentence
    flips.py        single bits of ledgers and baselines: refused, or harmless
    caches.py       damaged machine code: the result of our sources, or refused
    programs.py     programs that misbehave in several ways: one report, nothing left over
    resumed.py      resumed runs with other options: refused, or as from the start
    forged.py       mappers that write messages of the protocol: always a finding
    intrusion.py    a mapper that attacks the processes that judge it
    endings.py      signals at random moments: every form of the end agrees with the exit code
    kills.py        signals at random moments: nothing lost, nothing wrong afterwards
    trial.py        a command line in a forked process, and objections to its end
    mutations.py    changes of bytes, lines, JSON, XML and numbers
    planted.py      commands with one fault each, which the torture must see before it begins
    processes.py    processes that a command left over
    hostile.py, replies.py, forger.py    the programs, and the mapper

It is a measurement with a seed, not a list of cases; a failure becomes a test in the suite. Files
that convict a reader are kept in `torture-failures/`. Exit code 1 if anything was wrong.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from time import monotonic

os.environ |= {"OPENBLAS_NUM_THREADS": "1", "NO_COLOR": "1"}  # before numpy is imported

import caches
import endings
import flips
import forged
import intrusion
import kills
import planted
import programs
import readers
import resumed
from formats import FORMATS
from processes import adopt
from readers import Count

KEEP = Path("torture-failures").resolve()
TRIALS = {"readers": 400, "bit flips": 3000, "programs": 40, "messages": 40}
TRIALS |= {"intrusion": 8, "kills": 9, "endings": 8, "resumed": 30, "caches": 100}
"""The trials of each row of a part with --scale 1."""

PIECE = {"readers": 50, "bit flips": 100, "programs": 2, "messages": 2}
PIECE |= {"intrusion": 2, "kills": 3, "endings": 4, "resumed": 3, "caches": 25}
"""Trials of a worker at a time; every third of a piece kills a helper."""


@dataclass(frozen=True)
class Row:
    """A part, what is tried, and the trials in pieces."""

    part: str
    what: str
    pieces: Sequence[Callable[[], Count]]


def rows(seed: int, scale: float) -> Iterator[Row]:
    """What is tried."""

    def cut(part: str, several: Sequence[object]) -> Iterator[list[object]]:
        size = PIECE[part]
        return (list(several[at : at + size]) for at in range(0, len(several), size))

    def seeds(part: str, what: str, most: float = 10**6) -> list[str]:
        return [f"{seed}:{what}:{n}" for n in range(int(min(most, TRIALS[part] * scale)))]

    for name in FORMATS:
        several = cut("readers", seeds("readers", name))
        yield Row("readers", name, [partial(readers.trials, name, one, KEEP) for one in several])
    for name in ("ledger", "baseline"):
        bits = flips.chosen(name, int(min(10**9, TRIALS["bit flips"] * scale)), seed)
        several = cut("bit flips", bits)
        what = f"{name} of {flips.bits(name)} bits"
        yield Row("bit flips", what, [partial(flips.trials, name, one, KEEP) for one in several])
    bits = flips.chosen("ledger", int(min(10**9, 50 * TRIALS["bit flips"] * scale)), seed)
    several = cut("bit flips", bits)
    what = f"opened: {len(bits)} of {flips.bits('ledger')} bits"
    yield Row("bit flips", what, [partial(flips.openings, one, KEEP) for one in several])
    several = cut("caches", seeds("caches", "kernels"))
    yield Row("caches", "kept machine code", [partial(caches.trials, one) for one in several])
    several = cut("programs", seeds("programs", "hostile", 10**4))
    yield Row("programs", "hostile programs", [partial(programs.trials, one) for one in several])
    for name in resumed.COMMANDS:
        several = cut("resumed", seeds("resumed", name, 10**3))
        yield Row("resumed", name, [partial(resumed.trials, name, one) for one in several])
    several = cut("messages", seeds("messages", "forged", 10**4))
    yield Row("messages", "forged messages", [partial(forged.trials, one) for one in several])
    several = cut("intrusion", seeds("intrusion", "intruder", 10**3))
    yield Row("intrusion", "an intruder", [partial(intrusion.trials, one) for one in several])
    for name in endings.COMMANDS:
        several = cut("endings", seeds("endings", name, 10**4))
        yield Row("endings", name, [partial(endings.trials, name, one) for one in several])
    for name in kills.COMMANDS:
        several = cut("kills", seeds("kills", name, 10**3))
        yield Row("kills", name, [partial(kills.trials, name, one) for one in several])


def main() -> int:
    """Run the chosen parts and print a line for each row."""
    parser = argparse.ArgumentParser(prog="torture", description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--scale", type=float, default=1.0, help="times as many trials")
    parser.add_argument("--only", metavar="TEXT", default="", help="rows with this in their name")
    parser.add_argument("--workers", type=int, default=os.cpu_count())
    asked = parser.parse_args()
    adopt()
    if missed := [*planted.unseen(), *intrusion.unseen(), *endings.unseen()]:
        sys.exit(f"the torture does not see these planted faults: {', '.join(missed)}")
    began = monotonic()
    fork = multiprocessing.get_context("fork")
    print(f"seed {asked.seed}")
    print(f"{'part':10} {'what':28} {'trials':>7} {'refused':>8} {'wrong':>6} {'MiB':>5} {'s':>6}")
    with ProcessPoolExecutor(asked.workers, mp_context=fork, initializer=adopt) as pool:
        wanted = [r for r in rows(asked.seed, asked.scale) if asked.only in f"{r.part} {r.what}"]
        begun = [[pool.submit(piece) for piece in row.pieces] for row in wanted]
        wrong = sum(_print(row, pieces) for row, pieces in zip(wanted, begun, strict=True))
    print(f"{wrong} wrong; {monotonic() - began:.0f} s on the clock")
    return 1 if wrong else 0


def _print(row: Row, pieces: Sequence[Future[Count]]) -> int:
    count = Count()
    for piece in pieces:
        count.add(piece.result())
    head = f"{row.part:10} {row.what:28} {count.trials:7} {count.refused:8} {len(count.wrong):6}"
    print(f"{head} {count.most_memory >> 20:5} {count.most_seconds:6.2f}", flush=True)
    for line in count.wrong[:20]:
        print(f"    {line}", flush=True)
    return len(count.wrong)


if __name__ == "__main__":
    sys.exit(main())
