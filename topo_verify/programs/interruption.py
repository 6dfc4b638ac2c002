"""Ctrl-C, SIGTERM and SIGHUP end a command early; what is done is kept.

A signal raises KeyboardInterrupt and is noted, since an exception in the wrong place is lost: in a
callback from C code, or in a mapper that catches everything. A run that ends after it is no result.
Once output begins, signals are ignored, so that exit code, standard output and files agree.
"""

from __future__ import annotations

import signal
import sys
from time import monotonic
from types import FrameType

SIGNALS = [n for n in signal.Signals if n.name in ("SIGINT", "SIGTERM", "SIGHUP")]
"""The signals that interrupt a command; Windows lacks some."""

FROM_OUTSIDE = [*SIGNALS, *(n for n in signal.Signals if n.name in ("SIGQUIT", "SIGKILL"))]
"""The signals that tell nothing of the process that they end: another one sent them."""

TOGETHER = 1.0
"""Seconds in which several signals count as one: a terminal signals a command and its parent."""


class _State:
    heard: tuple[signal.Signals, ...] = ()
    noted = False
    ended = False
    last = -TOGETHER


def listen() -> None:
    """Raise KeyboardInterrupt at `SIGNALS`, except those that the caller of the program ignores."""
    _State.heard = tuple(n for n in SIGNALS if signal.getsignal(n) != signal.SIG_IGN)
    for number in _State.heard:
        signal.signal(number, _note)
    sys.unraisablehook = _lost


def end_at_sigterm() -> None:
    """Let SIGTERM end this worker through its contexts, by SystemExit."""
    signal.signal(signal.SIGTERM, _leave)
    sys.unraisablehook = _lost


def end_at_once() -> None:
    """Let SIGTERM end this worker as it ends any process."""
    signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _leave(_number: int, _frame: FrameType | None) -> None:
    _State.noted = True
    raise SystemExit


def _note(_number: int, _frame: FrameType | None) -> None:
    if _State.ended:
        return
    _State.noted = True
    if monotonic() - _State.last >= TOGETHER:
        _State.last = monotonic()
        raise KeyboardInterrupt


def _lost(unraisable: sys.UnraisableHookArgs) -> None:
    """Print an exception that Python cannot raise, unless it came of a signal."""
    if not _State.noted:
        sys.__unraisablehook__(unraisable)


def is_noted() -> bool:
    """Whether a signal came before `end`."""
    return _State.noted


def check() -> None:
    """Raise KeyboardInterrupt if a signal was noted."""
    if _State.noted:
        raise KeyboardInterrupt


def end() -> None:
    """Ignore these signals from now on."""
    _State.ended = True
    for number in _State.heard:
        signal.signal(number, signal.SIG_IGN)  # Python's end would restore the default
    if _State.heard and sys.platform != "win32":
        signal.signal(signal.SIGQUIT, signal.SIG_IGN)
