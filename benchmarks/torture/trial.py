"""One trial: a command line in a forked process, within limits, and objections to its end.

The process is forked after all slow imports, so a trial takes milliseconds and has its own memory,
files and limits. It must keep the promises of every command (docs/semantics.md, section 16):

- it ends with exit code 0, 1, 2 or 3, by itself, within `SECONDS` of the processor;
- with 2, one printable sentence stands on standard error, and nothing on standard output;
- it never prints a traceback, and never says that topo-verify has a bug (70);
- it leaves no process over;
- it takes at most `MEMORY` more than the process had before.
"""

from __future__ import annotations

import os
import resource
import select
import signal
import sys
import traceback
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from tempfile import TemporaryFile
from typing import IO, Any

from processes import children, left_over

from topo_verify.cli import main

SECONDS = 20
"""Processor seconds of a trial; three times as many on the clock."""

MEMORY = 256 << 20
"""Bytes of a trial beyond what the process had."""

GUARD = 4 << 30
"""Bytes of address space beyond what there was; more gives a MemoryError."""

_PAGE = resource.getpagesize()


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a command line ended.

    Attributes:
        code: its exit code; negative: the signal that ended it; None: we ended it.
        memory: peak bytes beyond those at the start.
        seconds: of the processor.
        left: the number of processes left over.
    """

    code: int | None
    stdout: str
    stderr: str
    memory: int
    seconds: float
    left: int


def run(
    words: Sequence[str], *, stdin: bytes = b"", program: Callable[[list[str]], object] = main
) -> Outcome:
    """Run a program, by default `topo-verify`, in a process with these words."""
    with TemporaryFile() as given, TemporaryFile() as out, TemporaryFile() as err:
        given.write(stdin)
        given.seek(0)
        before = children()
        head, tail = os.pipe()
        child = os.fork()
        if not child:
            os.write(tail, str(_pages(1)).encode())
            _play(partial(program, list(words)), given, out, err)
        status, usage = _await(child)
        code = None if status is None else os.waitstatus_to_exitcode(status)
        memory = usage.ru_maxrss * 1024 - int(os.read(head, 99))
        os.close(head)
        os.close(tail)
        seconds = usage.ru_utime + usage.ru_stime
        return Outcome(code, _read(out), _read(err), memory, seconds, left_over(before))


def _play(program: Callable[[], object], given: IO[bytes], out: IO[bytes], err: IO[bytes]) -> None:
    code = 70
    try:
        os.setsid()
        for place, file in enumerate((given, out, err)):
            os.dup2(file.fileno(), place)
        sys.stdin, sys.stdout, sys.stderr = (
            os.fdopen(place, mode, encoding="utf-8", errors="backslashreplace", closefd=False)
            for place, mode in enumerate("rww")
        )
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        resource.setrlimit(resource.RLIMIT_AS, (_pages(0) + GUARD,) * 2)
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 1))
        program()
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else 70
    except BaseException:  # noqa: BLE001  whatever passes the command line is shown
        traceback.print_exc()
    finally:
        try:
            sys.stdout.flush()
            sys.stderr.flush()
        finally:
            os._exit(code)


def _await(child: int) -> tuple[int | None, resource.struct_rusage]:
    """The status and the usage of a process; its session is ended after its time."""
    watch = os.pidfd_open(child)
    try:
        ready, _, _ = select.select([watch], [], [], 3 * SECONDS)
    finally:
        os.close(watch)
    if not ready:
        os.killpg(child, signal.SIGKILL)
    _, status, usage = os.wait4(child, 0)
    return (status if ready else None), usage


def _pages(place: int) -> int:
    """Bytes of this process: 0 its address space, 1 its resident memory."""
    with open("/proc/self/statm", encoding="ascii") as file:  # noqa: PTH123  once a trial
        return int(file.read().split()[place]) * _PAGE


def _read(file: IO[bytes]) -> str:
    file.seek(0)
    return file.read(1 << 20).decode(errors="backslashreplace")


# ---------------------------------------------------------------- what is wrong with it


def objection(outcome: Outcome, codes: Sequence[int]) -> str | None:  # noqa: PLR0911  a promise each
    """An objection to the end of a trial that may end with these codes, or None."""
    if outcome.code is None:
        return f"hung: not at its end after {3 * SECONDS} s on the clock"
    if -outcome.code in {signal.SIGXCPU, signal.SIGKILL}:
        return f"took more than {SECONDS} s of the processor"
    if "Traceback (most recent call last)" in outcome.stderr:
        return f"printed a traceback: {outcome.stderr.strip().splitlines()[-1]}"
    if outcome.code not in codes:
        return f"exit code {outcome.code}, expected one of {codes}: {outcome.stderr.strip()}"
    if outcome.left:
        return f"left {outcome.left} processes over"
    if outcome.memory > MEMORY:
        return f"took {outcome.memory >> 20} MiB"
    return _unfit_refusal(outcome) if outcome.code == 2 else None


def _unfit_refusal(outcome: Outcome) -> str | None:
    lines = outcome.stderr.splitlines()
    if len(lines) != 1 or not lines[0].isprintable():
        return f"refused with {len(lines)} lines, or with control characters: {outcome.stderr!r}"
    if not lines[0].startswith("topo-verify"):
        return f"refused without its name: {outcome.stderr!r}"
    return f"refused, but printed {outcome.stdout!r}" if outcome.stdout.strip() else None


def difference(one: Any, other: Any, place: str = "$") -> str:
    """Where two documents differ first."""
    if isinstance(one, dict) and isinstance(other, dict):
        for key in {**one, **other}:
            if one.get(key) != other.get(key):
                return difference(one.get(key), other.get(key), f"{place}.{key}")
    if isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for number, pair in enumerate(zip(one, other, strict=True)):
            if pair[0] != pair[1]:
                return difference(*pair, f"{place}[{number}]")
    return f"{place}: {one!r} and {other!r}"
