"""The trials of readers: a mutated file is read, or refused with one sentence and exit code 2.

A file with checksums (`sealed`) must give the results of the unchanged file, or be refused.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from typing import Any

from formats import FORMATS
from trial import Outcome, difference, objection, run


@dataclass
class Count:
    """The trials of one format."""

    trials: int = 0
    refused: int = 0
    most_memory: int = 0
    most_seconds: float = 0.0
    wrong: list[str] = field(default_factory=list[str])

    def take(self, outcome: Outcome) -> None:
        """Count a trial."""
        self.trials += 1
        self.refused += outcome.code == 2
        self.most_memory = max(self.most_memory, outcome.memory)
        self.most_seconds = max(self.most_seconds, outcome.seconds)

    def convict(self, name: str, data: bytes, wrong: str, keep: Path) -> None:
        """Keep a file that convicts a reader."""
        keep.mkdir(exist_ok=True)
        path = keep / re.sub(r"[^\w.]+", "-", name)
        path.write_bytes(data)
        self.wrong.append(f"{path}: {wrong}"[:400])

    def add(self, other: Count) -> None:
        """Add the count of another process."""
        self.trials += other.trials
        self.refused += other.refused
        self.most_memory = max(self.most_memory, other.most_memory)
        self.most_seconds = max(self.most_seconds, other.most_seconds)
        self.wrong += other.wrong


def mutant(name: str, seed: str) -> bytes:
    """The mutated file of this seed."""
    draw, kind = Random(seed), FORMATS[name]
    data = draw.choice(kind.seeds())
    for _ in range(draw.choice((1, 1, 1, 2))):
        data = draw.choice(kind.mutations)(draw, data)
    return data


def attempt(name: str, data: bytes) -> tuple[Outcome, str | None]:
    """How the reader ends on the data, and an objection or None."""
    kind = FORMATS[name]
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"file{kind.suffix}"
        path.write_bytes(data)
        os.chdir(folder)
        words = Random(data).choice(kind.words(str(path)))
        outcome = run((*words, "--format", "json") if kind.sealed else words)
    wrong = objection(outcome, kind.codes)
    if wrong is None and kind.sealed and outcome.code == 0:
        wrong = altered(outcome, _untouched(name))
    return outcome, wrong


@cache
def _untouched(name: str) -> Outcome:
    (data,) = FORMATS[name].seeds()
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"file{FORMATS[name].suffix}"
        path.write_bytes(data)
        return run((*FORMATS[name].words(str(path))[0], "--format", "json"))


def altered(outcome: Outcome, true: Outcome) -> str | None:
    """An objection if the results are not those of the unchanged file."""
    told, expected = (_results(one.stdout) for one in (outcome, true))
    return None if told == expected else f"changed in silence: {difference(told, expected)}"


def _results(text: str) -> Any:
    document = json.loads(re.sub(r"/[^\s\"']+/file", "FILE", text))
    document.pop("timing", None)
    return document


def trials(name: str, seeds: Sequence[str], keep: Path) -> Count:
    """Try the mutants of these seeds; each that convicts a reader is kept."""
    count = Count()
    for seed in seeds:
        data = mutant(name, seed)
        outcome, wrong = attempt(name, data)
        count.take(outcome)
        if wrong is not None:
            count.convict(f"{seed}{FORMATS[name].suffix}", data, wrong, keep)
    return count
