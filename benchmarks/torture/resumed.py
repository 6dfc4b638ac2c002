"""Resumed runs with other options: refused, or with the results of a run from the start.

A trial runs a command that keeps its work in a file, then runs it again with one to three options
changed. Either the file is refused, with exit code 2 and a sentence, or the results are those of
the second command on a new file. So no option that changes a result is forgotten.

The mapper `HERE` is right only in the checkers' process: the worst that an option can hide.
"""

# This may look inside.
# pyright: reportPrivateUsage=false

from __future__ import annotations

import json
import os
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

from readers import Count
from trial import Outcome, difference, objection, run

from topo_verify.campaign.campaign import Campaign, _Order
from topo_verify.extra.arena.suites import SUITES, Suite, drawn, every

SUITES["resumed"] = Suite("resumed", "small", (every(1), drawn("lattice(3,3,holes=0.1)", 2)))

HERE = """
import sys
from topo_verify.algorithms import algorithm

def explore(robot):
    survey = algorithm("basic")(robot)
    return survey if "topo_verify.checkers" in sys.modules else None
"""


@dataclass(frozen=True)
class Resumable:
    """A command that keeps its work.

    Attributes:
        words: the constant words, the kept file among them.
        options: for each option its variants.
        apart: fields of an entry that report earlier work.
    """

    words: tuple[str, ...]
    options: tuple[tuple[tuple[str, ...], ...], ...]
    apart: tuple[str, ...] = ()


PROCESS: tuple[tuple[str, ...], ...] = ((), ("--in-process",))
LIMITS: tuple[tuple[tuple[str, ...], ...], ...] = (
    ((), ("--budget", "3"), ("--budget", "1000")),
    ((), ("--move-timeout", "50")),
    ((), ("--world-timeout", "50")),
)
SEED: tuple[tuple[str, ...], ...] = ((), ("--seed", "1"))
SEARCH = (
    (("--edges", "1"), ("--edges", "2"), ("--edges", "3")),
    ((), ("--class", "planar"), ("--class", "loopless")),
    ((), ("--keep-going",)),
    SEED,
    *LIMITS,
)

COMMANDS = {
    "search of a mapper": Resumable(
        ("search", "here.py:explore", "--workers", "0", "--ledger", "kept"),
        (PROCESS, *SEARCH),
        ("from_ledger",),
    ),
    "search of an algorithm": Resumable(
        ("search", "--workers", "0", "--ledger", "kept"),
        (
            (("basic",), ("folding",), ("--compare", "basic,folding")),
            ((), ("--policies", "all")),
            *SEARCH,
        ),
        ("from_ledger",),
    ),
    "arena": Resumable(
        ("arena", "here.py:explore", "--suite", "resumed", "--workers", "0", "--out", "kept"),
        (PROCESS, ((), ("basic",)), SEED, *LIMITS),
        ("ms_per_move",),
    ),
}


def trial(name: str, seed: str) -> tuple[str | None, bool]:
    """An objection to a resumed run, or None; and whether it was refused."""
    options, draw = COMMANDS[name].options, Random(seed)
    first = [draw.choice(values) for values in options]
    second = list(first)
    for place in draw.sample(range(len(first)), draw.randint(1, 3)):
        second[place] = draw.choice(options[place])
    return resumed_after(COMMANDS[name], first, second)


def resumed_after(
    command: Resumable, first: Sequence[Sequence[str]], second: Sequence[Sequence[str]]
) -> tuple[str | None, bool]:
    """The same for a run with the second options on the file of the first."""
    with TemporaryDirectory() as one, TemporaryDirectory() as other, _unexamined():
        _played(one, command, first)
        resumed, new = _played(one, command, second), _played(other, command, second)
    changed = " ".join(word for words in second for word in words)
    wrong = objection(resumed, (0, 1, 2, 3)) or objection(new, (0, 1, 3))
    if wrong is None and resumed.code != 2:
        wrong = unlike(resumed, new, command.apart)
    before = " ".join(word for words in first for word in words)
    return wrong and f"{before!r}, then {changed!r}: {wrong}", resumed.code == 2


def _played(folder: str, command: Resumable, options: Sequence[Sequence[str]]) -> Outcome:
    os.chdir(folder)
    Path("here.py").write_text(HERE)
    return run([*command.words, *(w for words in options for w in words), "--format", "json"])


@contextmanager
def _unexamined() -> Generator[None]:
    """A ledger is believed without running some of its worlds again."""
    with _replaced(_Order, "_drawn_again", lambda _order, _store: iter(())):
        yield


@contextmanager
def _replaced(owner: object, name: str, replacement: Callable[..., object]) -> Generator[None]:
    known = getattr(owner, name)
    setattr(owner, name, replacement)
    try:
        yield
    finally:
        setattr(owner, name, known)


def forgets() -> bool:
    """Whether a ledger that forgets `--in-process` is convicted: a planted fault."""
    words = ("search", "here.py:explore", "--edges", "1", "--workers", "0", "--ledger", "kept")
    whole = Campaign.identity

    def forgetful(campaign: Campaign, sources: str) -> dict[str, str]:
        identity = whole(campaign, sources)
        return {name: value for name, value in identity.items() if name != "in-process"}

    with _replaced(Campaign, "identity", forgetful):
        wrong, _ = resumed_after(Resumable(words, ()), [("--in-process",)], [()])
    return wrong is not None


def unlike(resumed: Outcome, new: Outcome, apart: Sequence[str]) -> str | None:
    """Where the results of a resumed run and of a new one differ, or None."""
    one, other = _results(resumed, apart), _results(new, apart)
    return None if one == other else difference(one, other)


def _results(outcome: Outcome, apart: Sequence[str]) -> object:
    document = json.loads(outcome.stdout)
    document.pop("timing")
    for entry in document["results"]:
        for field in apart:
            entry.pop(field, None)
    return document


def trials(name: str, seeds: list[str]) -> Count:
    """Resume a command by these seeds."""
    count = Count()
    for seed in seeds:
        wrong, refused = trial(name, seed)
        count.trials += 1
        count.refused += refused
        if wrong is not None:
            count.wrong.append(f"{name}, seed {seed!r}: {wrong}")
    return count
