"""Other processes, as Linux shows them to tests."""

from __future__ import annotations

import time
from pathlib import Path


def state(process: int) -> str:
    """The letter of a process: "R" runs, "T" is stopped, "Z" is only its remains."""
    return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]


def alive(process: int) -> bool:
    """Is there such a process, and is it more than its remains?"""
    try:
        return state(process) != "Z"
    except FileNotFoundError:
        return False


def gone(process: int, *, within: float = 5.0) -> bool:
    """Is it gone, perhaps after a moment?"""
    until = time.monotonic() + within
    while alive(process) and time.monotonic() < until:
        time.sleep(0.01)
    return not alive(process)
