"""The harness's side of reaper.py: starts it, and tells it which programs live."""

from __future__ import annotations

import subprocess
import sys
from contextlib import suppress
from pathlib import Path

from topo_verify.programs import reaper


class ReaperProcess:
    """The process of reaper.py; one serves any number of programs. Lives until `close`."""

    def __init__(self) -> None:
        self._process = subprocess.Popen(  # noqa: S603  our own file
            [sys.executable, "-I", "-S", str(Path(reaper.__file__))],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
            bufsize=0,
        )

    def started(self, group: int, mark: str) -> None:
        """Put a program on the list of those to kill."""
        self._write(f"+ {group} {mark}\n")

    def ended(self, group: int, mark: str) -> None:
        """Take a program off the list."""
        self._write(f"- {group} {mark}\n")

    def _write(self, line: str) -> None:
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.write(line.encode())

    def close(self) -> None:
        """End the reaper, which first kills every program that is still on its list."""
        assert self._process.stdin is not None
        with suppress(OSError):
            self._process.stdin.close()
        self._process.wait()
