"""Commands with one fault each: the torture must convict every one, or it shows nothing."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable

import resumed
import trial
from trial import MEMORY, Outcome, difference, objection, run


def refuses(words: list[str]) -> None:
    """A refusal that every command may make."""
    print(f"topo-verify: expected a world, got {words[0]!r}", file=sys.stderr)
    sys.exit(2)


def raises(words: list[str]) -> None:
    """An unexpected exception."""
    raise ValueError(words)


def admits(_words: list[str]) -> None:
    """A bug that is admitted."""
    sys.exit(70)


def chats(words: list[str]) -> None:
    """A refusal of two lines."""
    print("topo-verify: dear user,", file=sys.stderr)
    refuses(words)


def paints(_words: list[str]) -> None:
    """A refusal with a control character."""
    print("topo-verify: \x1b[31m", file=sys.stderr)
    sys.exit(2)


def hoards(_words: list[str]) -> None:
    """Too much memory."""
    hoard = b"x" * (MEMORY + (16 << 20))
    sys.exit(len(hoard) == 0)


def spins(_words: list[str]) -> None:
    """A loop without an end."""
    while True:
        pass


def sleeps(_words: list[str]) -> None:
    """A wait without an end."""
    time.sleep(3600)


def leaves(_words: list[str]) -> None:
    """A process in a session of its own that stays."""
    if not os.fork():
        os.setsid()
        time.sleep(3600)
    sys.exit(0)


def prints(words: list[str]) -> None:
    """A refusal, and results as well."""
    print("[]")
    refuses(words)


def dies(_words: list[str]) -> None:
    """An end by a signal."""
    os.abort()


FAULTS: tuple[Callable[[list[str]], None], ...] = (
    *(raises, admits, chats, paints, hoards, spins, sleeps, leaves, prints, dies),
)


def unseen() -> list[str]:
    """The faults that the torture does not see."""
    seconds, trial.SECONDS = trial.SECONDS, 1
    try:
        found = [fault.__name__ for fault in FAULTS if not _wrong(fault)]
    finally:
        trial.SECONDS = seconds
    if _wrong(refuses):
        found.append("refuses, which is no fault")
    if difference({"a": 0, "b": [1, 2]}, {"a": 0, "b": [1, 3]}) != "$.b[1]: 2 and 3":
        found.append("a difference of two results")
    if not resumed.forgets():
        found.append("a ledger that forgets an option")
    return found


def _wrong(command: Callable[[list[str]], None]) -> str | None:
    outcome: Outcome = run(["x"], program=command)
    return objection(outcome, (0, 2))
