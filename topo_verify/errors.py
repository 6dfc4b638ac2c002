"""Exceptions, grouped by who must act, and words for messages.

The command line exits with 2 for `InputError`, 1 for `ClaimFailed`, 3 for `ClaimUndecided` and
`HelperLost`, 70 for `InternalError`.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterable
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from traceback import FrameSummary

LINE = 4000
"""Most characters of a line in a report."""


def shown(text: str | PathLike[str], *, limit: int = 200) -> str:
    """The text on one line of a message: control characters escaped, cut after `limit`."""
    line = os.fspath(text)
    if not line.isprintable():
        line = "".join(c if c.isprintable() else ascii(c)[1:-1] for c in line)
    return line if len(line) <= limit else line[: limit - 1] + "…"


class TopoVerifyError(Exception):
    """Base of every exception that topo_verify raises on purpose."""


class ShortTraceback(BaseException):
    """An exception whose message says all: a notebook shows it with one line of your code."""

    def _render_traceback_(self) -> list[str]:  # called by IPython
        from traceback import extract_tb

        others = {Path(__file__).parent, Path(os.__file__).parent}  # this package, Python's own
        frames = extract_tb(self.__traceback__)
        yours = [
            frame
            for frame in frames
            if frame.filename != "<string>" and others.isdisjoint(Path(frame.filename).parents)
        ]
        return [*map(_place, yours[-1:]), f"{type(self).__name__}: {self}"]


def _place(frame: FrameSummary) -> str:
    # The name that IPython gives to a cell is no file.
    where = frame.filename if Path(frame.filename).is_file() else "cell"
    return f"{where}, line {frame.lineno}: {frame.line}"


class InputError(ShortTraceback, TopoVerifyError, ValueError):
    """The input cannot be used; one sentence names the input, the place and the mend.

    It may quote a file's name or content, so its control characters are escaped.
    """

    def __init__(self, sentence: str) -> None:
        super().__init__(shown(sentence, limit=LINE))


class WriteError(InputError):
    """A file or standard output cannot be written; results so far are still reported."""


class ExaminationInterrupted(ShortTraceback, KeyboardInterrupt):
    """Ctrl-C during `explore` or `examine`; a notebook shows where your code was."""


class ClaimFailed(TopoVerifyError, AssertionError):
    """At least one claim does not hold for the mapper; the text is the report."""


class ClaimUndecided(TopoVerifyError, AssertionError):
    """No claim fails, but one was neither proved nor refuted; the text names it, with the report.

    If that does not matter, catch it: `pytest.skip`, or `hypothesis.reject`.
    """


class HelperLost(TopoVerifyError):
    """A process of topo-verify was ended from outside, so nothing more is decided."""


class InternalError(TopoVerifyError):
    """topo_verify contradicts itself: please report it with the world and the command line."""


# ---------------------------------------------------------------- words of messages


def close_name(name: str, known: Iterable[str]) -> str:
    """`; did you mean 'explore'?`, or nothing if no known name is close."""
    from difflib import get_close_matches

    close = get_close_matches(name, list(known), n=1)
    return f"; did you mean {close[0]!r}?" if close else ""


def is_utf8(text: str) -> bool:
    """Whether the text can be written as UTF-8; a file's name may hold other bytes."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def plural(number: int, thing: str, things: str = "") -> str:
    """The number with its noun: `1 world`, `2 worlds`."""
    return f"{number} {thing if number == 1 else things or thing + 's'}"


def map_size(vertices: int, edges: int) -> str:
    """How large a map is: `1 vertex, 2 edges`."""
    return f"{plural(vertices, 'vertex', 'vertices')}, {plural(edges, 'edge')}"


_LONG_ID = re.compile(r"\b(m[0-9]+/[0-9]{5})[0-9]{5,}([0-9]{5})\b")


def shortened(text: str) -> str:
    """The text with long world ids cut in the middle, for reading only: `m30/13579…86420`."""
    return _LONG_ID.sub(r"\1…\2", text)
