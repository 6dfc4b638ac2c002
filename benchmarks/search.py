"""How fast the exhaustive search is, and that its memory does not grow with the worlds.

`.venv/bin/python benchmarks/search.py` alone, or `make bench`. Seconds on the clock of two
processes, beside their processor seconds; the peak memory of any process.
"""

from __future__ import annotations

import resource
from collections.abc import Callable
from time import perf_counter

from topo_verify.studies.search.search import search

Row = Callable[[str, str, str], None]

WORKERS = 2


def _processor() -> float:
    mine, theirs = (resource.getrusage(who) for who in _WHO)
    return mine.ru_utime + mine.ru_stime + theirs.ru_utime + theirs.ru_stime


_WHO = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)


def table(row: Row) -> None:
    for edges, required in ((4, ""), (5, ""), (6, "< 60 s")):
        begin, processor = perf_counter(), _processor()
        entry = search("basic", edges=edges, workers=WORKERS)
        assert entry.verdict == "EXHAUSTED"
        took, used = perf_counter() - begin, _processor() - processor
        label = f"search basic --edges {edges}, {entry.total:,} worlds, {WORKERS} workers"
        row(label, f"{took:.1f} s", required)
        most = max(resource.getrusage(who).ru_maxrss for who in _WHO) // 1024
        row("  processor seconds; the most memory of a process", f"{used:.1f} s; {most} MB", "")


def main() -> None:
    table(lambda what, measured, required: print(f"{what:<58}{measured:>18}{required:>18}"))


if __name__ == "__main__":
    main()
