"""Forged messages: each seed is a mapper (forger.py) that writes into its process's pipe.

`conform`, and `search` with a ledger, try it in both worlds of one edge, twice. They must end with
0, 1 or 3, leave no process over, and say the same both times. Where it writes outside of a world,
exit code 2 with one sentence is allowed, too.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from tempfile import TemporaryDirectory

from forger import WORLDS, moments
from readers import Count
from trial import difference, objection, run

FORGER = Path(__file__).parent / "forger.py"
COMMANDS = (
    ("conform", "--worlds", "edges<=1", "--quiet"),
    ("search", "--edges", "1", "--keep-going", "--ledger", "l.db"),
)


def trials(seeds: list[str]) -> Count:
    """Try these mappers."""
    count = Count()
    for number, seed in enumerate(seeds):
        os.environ["FORGER"] = seed
        command, *options = COMMANDS[number % 2]
        words = [command, f"{FORGER}:explore", *options, "--workers", "0", "--budget", "30"]
        told: list[object] = []
        for _ in range(2):
            with TemporaryDirectory() as folder:
                os.chdir(folder)
                outcome = run([*words, "--move-timeout", "1", "--format", "json"])
            count.take(outcome)
            wrong = objection(outcome, (0, 1, 3) if moments(seed) <= {*WORLDS} else (0, 1, 2, 3))
            if wrong is not None:
                count.wrong.append(f"forger.py {seed}: {wrong}")
                break
            document = json.loads(outcome.stdout) if outcome.code != 2 else {"exit": 2}
            document.pop("timing", None)
            told.append(document)
        if len(told) == 2 and told[0] != told[1]:
            wrong = difference(*told)
            count.wrong.append(f"forger.py {seed}: two reports of one mapper: {wrong}")
    return count
