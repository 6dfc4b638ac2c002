"""Progress on stderr: only on a terminal, only without --quiet, only on work over a second."""

from __future__ import annotations

import sys
from threading import Lock, Timer
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress as Bar

DELAY = 1.0
"""Seconds of work before the bar appears."""


class ProgressBar:
    """A bar that appears when work takes long, and that leaves no trace on the terminal.

    Life cycle: call it, as a progress callback, while work goes on; `clear` it before anything is
    printed, since results share the terminal with it. The next call begins anew.
    """

    def __init__(self, *, quiet: bool) -> None:
        self._wanted = not quiet and sys.stderr is not None and sys.stderr.isatty()
        self._state = ("", 0, 0)
        self._lock = Lock()
        self._timer: Timer | None = None
        self._bar: Bar | None = None

    def __call__(self, what: str, done: int, total: int) -> None:
        """Show what is being done, how much of it is done, and how much there is."""
        if not self._wanted:
            return
        self._state = (what, done, total)
        if self._timer is None:
            # A clock of its own: one long run would not call again for a while.
            self._timer = Timer(DELAY, self._appear)
            self._timer.daemon = True
            self._timer.start()
        with self._lock:
            self._show()

    def clear(self) -> None:
        """Remove the bar from the terminal."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer.join()  # it may be just about to show the bar
            self._timer = None
        if self._bar is not None:
            self._bar.stop()
            self._bar = None

    def _appear(self) -> None:
        with self._lock:
            self._bar = _bar()
            self._bar.add_task("")
            self._show()
            self._bar.start()

    def _show(self) -> None:
        if self._bar is not None:
            what, done, total = self._state
            self._bar.update(self._bar.task_ids[0], description=what, completed=done, total=total)


def _bar() -> Bar:
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
    from rich.progress import Progress as Bar

    return Bar(
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
        console=Console(stderr=True),
        transient=True,
        redirect_stdout=False,  # results are printed when the bar is off
        redirect_stderr=False,
    )
