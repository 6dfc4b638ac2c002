"""Hostile programs: each seed is a program (hostile.py) that misbehaves in one to three ways.

`conform` tries it in both worlds of one edge, twice. It must end with 0, 1 or 3, leave no process
over, and say the same both times.
"""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from readers import Count
from trial import difference, objection, run

HOSTILE = Path(__file__).parent / "hostile.py"
LIMITS = ("--move-timeout", "0.6", "--world-timeout", "2", "--budget", "30")


def words(seed: str) -> list[str]:
    """The command line that tries the program of a seed."""
    command = f"{sys.executable} -I {HOSTILE} {seed}"
    worlds = ("--worlds", "edges<=1", "--workers", "0")
    return ["conform", "--cmd", command, *worlds, *LIMITS, "--format", "json"]


def trials(seeds: list[str]) -> Count:
    """Try the programs of these seeds."""
    count = Count()
    for seed in seeds:
        told: list[object] = []
        for _ in range(2):
            with TemporaryDirectory() as folder:
                os.chdir(folder)
                outcome = run(words(seed))
            count.take(outcome)
            wrong = objection(outcome, (0, 1, 3))
            if wrong is not None:
                count.wrong.append(f"hostile.py {seed}: {wrong}")
                break
            document = json.loads(outcome.stdout)
            document.pop("timing")
            told.append(document)
        if len(told) == 2 and told[0] != told[1]:
            count.wrong.append(
                f"hostile.py {seed}: two reports of one program: {difference(*told)}"
            )
    return count
