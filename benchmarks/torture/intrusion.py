"""A mapper that attacks the processes that judge it: it may get hold of none.

A thread of tests/campaign/intruder.py tries to open the memory and the files of the search, of the
process that starts workers, and of each of one to three workers. Each trial must end with exit code
1, since the mapper delivers no map to workers, and leave nothing over.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from time import monotonic, sleep

from readers import Count
from trial import objection, run

INTRUDER = Path(__file__).resolve().parents[2] / "tests" / "campaign" / "intruder.py"

LIMITS = ("--move-timeout", "60", "--world-timeout", "120")
"""Each worker waits until it was attacked."""

SECONDS = 60.0


def words(seed: str) -> list[str]:
    """The command line of a seed."""
    draw = Random(seed)
    edges, workers = draw.randint(1, 2), draw.randint(1, 3)
    return [
        *("search", "intruder.py:explore", "--edges", str(edges), "--workers", str(workers)),
        *(*LIMITS, "--format", "json"),
    ]


def trials(seeds: list[str]) -> Count:
    """Let the mapper attack searches by these seeds."""
    count = Count()
    for seed in seeds:
        with TemporaryDirectory() as folder:
            os.chdir(folder)
            shutil.copy(INTRUDER, folder)
            outcome = run(words(seed))
            wrong = objection(outcome, (1,)) or _hold()
        count.take(outcome)
        if wrong is not None:
            count.wrong.append(f"intruder.py, seed {seed!r}: {wrong}")
    return count


def _hold() -> str | None:
    """What the mapper got hold of in the current folder, or None."""
    if (opened := Path("opened")).exists():
        return f"processes and how many of their files it opened: {opened.read_text()[:200]!r}"
    # The search, what starts workers, the worker that it kills, and the one behind it.
    tried = {*Path("refused").read_text().split()} if Path("refused").exists() else set[str]()
    return f"it tried {len(tried)} processes, expected 4" if len(tried) < 4 else None


def unseen() -> list[str]:
    """The planted fault, if it is not seen: a process that is not hidden, its parent."""
    with TemporaryDirectory() as folder:
        shutil.copy(INTRUDER, folder)
        load = f"import sys, time; sys.path.insert(0, {folder!r}); import intruder; time.sleep(99)"
        with subprocess.Popen([sys.executable, "-c", load], cwd=folder) as attacker:  # noqa: S603
            until = monotonic() + SECONDS
            while not (opened := (Path(folder) / "opened").exists()) and monotonic() < until:
                sleep(0.05)
            attacker.kill()
    return [] if opened else ["a process that is not hidden from a mapper"]
