"""Exit codes, and the sentence on stderr when a command cannot do its work.

    0    nothing found
    1    an unexpected counterexample, a claim that fails; nothing else ever exits 1
    2    bad usage or bad input
    3    incomplete: a time-out, an interruption, too little memory
    70   a bug of ours

Source: docs/semantics.md, section 16.
"""

from __future__ import annotations

import errno
import os
import platform
import shlex
import sys
import traceback
from collections.abc import Sequence
from contextlib import suppress
from enum import IntEnum
from pathlib import Path
from typing import IO

import click

from topo_verify.errors import LINE, InputError, shown

TRACEBACK = "TOPO_VERIFY_TRACEBACK"
"""If this environment variable is 1, a bug is reported with its traceback."""


class ExitCode(IntEnum):
    """The exit codes of every command."""

    NOTHING_FOUND = 0
    CLAIM_FAILED = 1
    BAD_INPUT = 2
    INCOMPLETE = 3
    OUR_BUG = 70


def epilog(*examples: str) -> str:
    """The end of a --help: examples, then the exit codes."""
    # \b tells click to keep the line breaks.
    lines = "\n".join(f"  topo-verify {example}" for example in examples)
    return f"""\b
Examples:
{lines}

\b
Exit codes: 0 nothing found; 1 a claim fails; 2 bad usage or input;
  3 incomplete (time-out, Ctrl-C, memory); 70 a bug of topo-verify."""


def version() -> str:
    """The version of the package; importlib.metadata takes as long to import as all of --help."""
    return str(sys.modules["topo_verify"].__version__)


def say(sentence: str) -> None:
    """Print a sentence as one line on stderr, control characters escaped."""
    line = shown(sentence, limit=LINE)
    try:
        # A file's name may hold bytes that are not UTF-8.
        click.echo(line.encode(errors="backslashreplace").decode(), err=True)
        sys.stderr.flush()
    except (OSError, ValueError):  # a full disk, a closed stream
        silence(sys.stderr)


def silence(stream: IO[str] | None) -> None:
    """Point a stream at the null device, so that Python's flush at exit cannot fail."""
    if stream is not None:
        with suppress(OSError, ValueError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def explain(error: Exception, arguments: Sequence[str]) -> ExitCode:
    """Print on stderr why a command ended and who can mend it; return the exit code."""
    if isinstance(error, InputError):
        say(f"topo-verify: {error}")
        return ExitCode.BAD_INPUT
    if isinstance(error, click.exceptions.NoArgsIsHelpError):
        click.echo(error.message, err=True)
        return ExitCode.BAD_INPUT
    if isinstance(error, click.ClickException):
        say(_usage(error))
        return ExitCode.BAD_INPUT
    if isinstance(error, MemoryError) or getattr(error, "errno", None) == errno.ENOMEM:
        say(
            "topo-verify: out of memory before the end: give it more (ulimit -v), a smaller input"
            " or fewer --workers"
        )
        return ExitCode.INCOMPLETE
    if (refusal := _refusal_by_the_system(error)) is not None:
        say(f"topo-verify: {refusal}")
        return ExitCode.BAD_INPUT
    return _our_bug(error, arguments)


def _refusal_by_the_system(error: Exception) -> str | None:
    if isinstance(error, FileNotFoundError) and not _has_working_folder():
        return "the working folder was removed: change to another folder"
    full = getattr(error, "errno", None) in (errno.ENOSPC, errno.EROFS, errno.EDQUOT)
    if full or (isinstance(error, OSError) and "temporary directory" in str(error)):
        return f"the system refuses: {error}; is the disk full, or TMPDIR no folder?"
    return None


def _has_working_folder() -> bool:
    try:
        return bool(Path.cwd())
    except FileNotFoundError:
        return False


def _usage(error: click.ClickException) -> str:
    context = error.ctx if isinstance(error, click.UsageError) else None
    path = context.command_path if context else "topo-verify"
    # Click ends with a full stop or a question; here the sentence continues.
    objection = " ".join(error.format_message().split()).removesuffix(".")
    objection = objection.replace("'. Did you", "', did you").removesuffix("?")
    return f"{path}: {objection[:1].lower()}{objection[1:]}; {path} --help shows the usage"


def _our_bug(error: Exception, arguments: Sequence[str]) -> ExitCode:
    if os.environ.get(TRACEBACK) == "1":
        click.echo("".join(traceback.format_exception(error)), err=True, nl=False)
    last = traceback.extract_tb(error.__traceback__)[-1:]
    file = "".join(frame.filename.replace(os.sep, "/") for frame in last)
    # Paths are cut at the package: a report must not reveal the user's folders.
    ours = "topo_verify" + file.rpartition("topo_verify")[2]
    place = "".join(f" ({ours if 'topo_verify' in file else file}:{f.lineno})" for f in last)
    command = shlex.join(["topo-verify", *arguments])
    say(
        f"topo-verify: a bug of topo-verify, not of your input: {type(error).__name__}: {error}"
        f"{place}; please report it with this line, the command line {command!r} and the versions"
        f" topo-verify {version()}, Python {platform.python_version()}, {sys.platform}"
        f" ({TRACEBACK}=1 adds the traceback)"
    )
    return ExitCode.OUR_BUG
