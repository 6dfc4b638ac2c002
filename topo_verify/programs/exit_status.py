"""How a child process ended, looked up without reaping it.

A process that is not reaped keeps its number, so that no other process can be taken for it before
`Child.end` has ended the rest of its group.
"""

from __future__ import annotations

import os
import signal
from contextlib import suppress
from typing import NamedTuple


class ExitStatus(NamedTuple):
    """How a process ended: a code of `waitid` (CLD_EXITED, …), and the exit code or the signal."""

    code: int
    number: int

    def __str__(self) -> str:
        """The exit status in words, as in "the program ended with exit code 1"."""
        if self.code == os.CLD_EXITED:
            return f"ended with exit code {self.number}"
        return f"was ended by {self.signal}"

    @property
    def signal(self) -> str | None:
        """The name of the signal that ended the process, as SIGSEGV; None: none did."""
        if self.code == os.CLD_EXITED:
            return None
        with suppress(ValueError):
            return signal.Signals(self.number).name
        return f"signal {self.number}"


def exit_status(process: int) -> ExitStatus | None:
    """The exit status of a child process; None while it runs."""
    found = os.waitid(os.P_PID, process, os.WEXITED | os.WNOWAIT | os.WNOHANG)
    return None if found is None else ExitStatus(found.si_code, found.si_status)
