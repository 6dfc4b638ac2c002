"""The standard error of a program: its end for the report, or all of it on ours, line by line."""

from __future__ import annotations

import sys
from contextlib import suppress

from topo_verify.text import shown

TAIL = 4096
"""How many bytes of standard error are kept: the last ones."""


class StandardError:
    """The standard error of a program: its end, and how much there was. Grows as it is read.

    Args:
        mark: what stands before each line on our own standard error; None: it does not appear.
    """

    def __init__(self, mark: str | None) -> None:
        self.bytes = 0
        self._mark, self._tail, self._rest = mark, bytearray(), b""

    @property
    def tail(self) -> str:
        """The last `TAIL` bytes."""
        return self._tail.decode(errors="backslashreplace")

    def take(self, chunk: bytes) -> None:
        """Note what was read; nothing means the end."""
        self.bytes += len(chunk)
        self._tail += chunk
        del self._tail[:-TAIL]
        if self._mark is None:
            return
        *lines, self._rest = (self._rest + chunk).split(b"\n")
        if self._rest and (not chunk or len(self._rest) > TAIL):
            lines, self._rest = [*lines, self._rest], b""
        for line in lines:
            with suppress(OSError, ValueError):  # ours is closed, or full
                text = shown(line.decode(errors="backslashreplace"), limit=TAIL)
                sys.stderr.write(f"{self._mark}: {text}\n")
                sys.stderr.flush()
