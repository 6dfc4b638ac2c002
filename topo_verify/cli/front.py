"""The process that the user starts: it forks, waits, and exits with what its child reported.

The command, and with --in-process the user's mapper, runs in the child. A child that ends without
a report, say by `os._exit(0)` in a mapper, is exit code 3. The report is in shared memory, which
no mapper closes with its files.

    SIGINT, SIGTERM, SIGHUP    the child gets SIGINT, which Z3 heeds as well; if that is ignored, as
                               in a background job of a shell script, it gets the signal itself
    SIGQUIT                    the child ends at once, without a result: exit code 3
    SIGTSTP                    both processes stop, and go on together

What this does not show: elsewhere than on Linux, or beside another thread, a fork is not safe, so
the command runs in this process.
"""

from __future__ import annotations

import mmap
import os
import signal
import sys
import threading
from collections.abc import Callable, Collection

from topo_verify.programs import interruption, isolation

INCOMPLETE = 3


def run(work: Callable[[], int], say: Callable[[str], None]) -> int:
    """In a child, what `work` returns; this process exits with that, or with 3 and a sentence."""
    if sys.platform != "linux" or threading.active_count() > 1:
        interruption.listen()
        return work()
    isolation.shield()
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)  # a parent may have had it ignored
    asked = (*interruption.SIGNALS, signal.SIGQUIT, signal.SIGTSTP, signal.SIGCHLD)
    heard = {number for number in asked if signal.getsignal(number) != signal.SIG_IGN}
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, heard)
    here = os.getpid()
    report = mmap.mmap(-1, mmap.PAGESIZE)
    try:
        child = os.fork()
    except OSError as error:
        say(f"topo-verify: cannot start a process: {error.strerror}; end others, or wait")
        return INCOMPLETE
    if child:
        status = _awaited(child, heard)
        os._exit(_reported(report, status, say))  # the child leaves what this process entered
    isolation.end_with(here)
    here = os.getpid()
    interruption.listen()
    signal.pthread_sigmask(signal.SIG_SETMASK, mask)
    try:
        code = work()
    except KeyboardInterrupt:  # between two statements
        code = INCOMPLETE
    if os.getpid() == here:  # a mapper may have forked
        report.write(b"%d" % code)
    return code


def _awaited(child: int, heard: Collection[int]) -> int:
    """The status of the child at its end; until then it gets the signals."""
    while True:
        number = signal.sigwaitinfo(heard).si_signo
        if number == signal.SIGCHLD:
            process, status = os.waitpid(child, os.WNOHANG)
            if process:
                return status
            continue
        is_interrupt = signal.SIGINT in heard and number in interruption.SIGNALS
        os.kill(child, signal.SIGINT if is_interrupt else number)
        if number == signal.SIGTSTP:
            _stop()
            os.kill(child, signal.SIGCONT)


def _stop() -> None:
    """Stop this process as SIGTSTP does, until it is continued."""
    signal.raise_signal(signal.SIGTSTP)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGTSTP})
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTSTP})


def _reported(report: mmap.mmap, status: int, say: Callable[[str], None]) -> int:
    try:
        return int(report.read().rstrip(b"\0"))
    except ValueError:
        code = os.waitstatus_to_exitcode(status)
        how = signal.Signals(-code).name if code < 0 else f"exit code {code}"
        say(
            f"topo-verify: the process of the command ended ({how}) before its result, so nothing"
            " is decided; a mapper with --in-process may have ended it: leave --in-process out"
        )
        return INCOMPLETE
