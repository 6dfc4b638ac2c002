"""Other processes, as Linux shows them to tests."""

from __future__ import annotations

from pathlib import Path


def state(process: int) -> str:
    """The letter of a process: "R" runs, "T" is stopped, "Z" is only its remains."""
    return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]


def gone(process: int) -> bool:
    """Is there no such process, or only its remains?"""
    try:
        return state(process) == "Z"
    except FileNotFoundError:
        return True
