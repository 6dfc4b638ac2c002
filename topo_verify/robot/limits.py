"""Limits for untrusted mappers: moves, seconds between two moves, seconds in all.

A mapper that exceeds one is stopped by a BaseException, which its own `except Exception` does not
swallow. From inside its process nothing stops a mapper that catches BaseException in a loop, or
sits in C code that never returns.

Seconds are those of robot/stopwatch.py. A clock ticks while the mapper runs and asks the robot for
its cost. In the main thread the tick is SIGALRM, which also interrupts a sleep. In other threads,
and on systems without SIGALRM, a second thread raises the exception asynchronously.
"""

from __future__ import annotations

import ctypes
import gc
import signal
import threading
from collections.abc import Callable, Generator
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass
from inspect import currentframe
from types import FrameType
from typing import Literal, TypeVar

from topo_verify.errors import InputError, plural
from topo_verify.robot.stopwatch import Heard, Stopwatch, tasks_of

T = TypeVar("T")

Limit = Literal["budget", "move-timeout", "world-timeout"]


class MapperStopped(BaseException):
    """The robot does not go on; the text says which limit was reached, or what was misused."""

    limit: Limit | None = None


class BudgetExceeded(MapperStopped):
    """The mapper asked for more moves than its budget."""

    limit = "budget"

    def __init__(self, budget: int) -> None:
        given = "its budget (claim cost-within-bound, --budget, or tv.Limits(budget=…))"
        more = f"the mapper asked for more than {plural(budget, 'move')}, {given}"
        super().__init__(f"{more}; a right mapper may need more")


class TimeLimitExceeded(MapperStopped):
    """The mapper took too long."""


class MoveTimeout(TimeLimitExceeded):
    """The mapper took too long between two moves."""

    limit = "move-timeout"


class WorldTimeout(TimeLimitExceeded):
    """The mapper took too long in all, though it moved on."""

    limit = "world-timeout"


MOVE_TIMEOUT, WORLD_TIMEOUT = 5.0, 60.0
"""The default limits, in seconds."""

MOST_SECONDS = 10**6
"""The longest time limit, about eleven days."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What a mapper may use up in one world.

    Attributes:
        budget: moves (edge traversals); None: the bound of claim 7.
        move_timeout: seconds between two moves, without those spent waiting for a processor.
        world_timeout: such seconds in all.
    Raises:
        InputError: seconds are no number in (0, MOST_SECONDS], or the budget no integer from 0 on.
    """

    budget: int | None = None
    move_timeout: float = MOVE_TIMEOUT
    world_timeout: float = WORLD_TIMEOUT

    def __repr__(self) -> str:
        return (
            f"tv.Limits(budget={self.budget}, move_timeout={self.move_timeout},"
            f" world_timeout={self.world_timeout})"
        )

    def __post_init__(self) -> None:
        if self.budget is not None and not (hasattr(self.budget, "__index__") and self.budget >= 0):
            raise InputError(f"budget: expected an integer of 0 or more, got {self.budget!r}")
        for name in ("move_timeout", "world_timeout"):
            seconds = getattr(self, name)
            if not (hasattr(seconds, "__float__") and 0 < seconds <= MOST_SECONDS):
                raise InputError(
                    f"{name}: expected seconds in (0, {MOST_SECONDS}], got {seconds!r}"
                )

    @property
    def options(self) -> tuple[str, ...]:
        """The words of the command line that set the limits that are not default."""
        words: list[str] = []
        if self.budget is not None:
            words += ["--budget", str(self.budget)]
        if self.move_timeout != MOVE_TIMEOUT:
            words += ["--move-timeout", f"{self.move_timeout:g}"]
        if self.world_timeout != WORLD_TIMEOUT:
            words += ["--world-timeout", f"{self.world_timeout:g}"]
        return tuple(words)


def given_limits(limits: object) -> Limits:
    """These limits, or the usual ones in the place of None.

    Raises:
        InputError: these are no limits.
    """
    if limits is None:
        return Limits()
    if not isinstance(limits, Limits):
        raise InputError(f"limits={limits!r}: expected tv.Limits, as in tv.Limits(budget=500)")
    return limits


TICK = 0.05
"""Least seconds between two looks at the clock."""

LOOKS = 20
"""Looks within each limit: a pause may be longer than the limit by two of these ticks."""


def within(limits: Limits, cost: Callable[[], int], work: Callable[[], T]) -> T:
    """What `work()` returns; what it raises passes through.

    Args:
        cost: the number of moves so far.
    Raises:
        TimeLimitExceeded: a time limit was passed, even if `work` swallowed the exception.
    """
    limit = min(limits.move_timeout, limits.world_timeout)
    tick = max(TICK, limit / LOOKS)
    watch = _Watch(limits, cost, Stopwatch(tick=max(TICK, limit / 4)))
    outer: Stopwatch | None = getattr(_running, "watch", None)
    _running.watch = watch.clock
    try:
        if threading.current_thread() is threading.main_thread() and hasattr(signal, "setitimer"):
            result = _by_alarm(watch, tick, work)
        else:
            result = _by_thread(watch, tick, work)
    finally:
        _running.watch = outer
    if watch.struck is not None:
        raise watch.struck
    return result


_running = threading.local()
"""Per thread: `watch`, the stopwatch of the running mapper; `tell`, which receives its moves."""


@contextmanager
def telling_moves(tell: Callable[[int], None]) -> Generator[None]:
    """Within the block, tell the moves of a mapper that runs, several times within each limit."""
    _running.tell = tell
    try:
        yield
    finally:
        _running.tell = None


@contextmanager
def helped_by(process: int, heard: Heard | None = None) -> Generator[None]:
    """Within the block, excuse also the waits of a process that works for this thread's mapper."""
    watch: Stopwatch | None = getattr(_running, "watch", None)
    with nullcontext() if watch is None else watch.helped_by(lambda: tasks_of(process), heard):
        yield


class _Watch:
    """Remembers when the mapper last moved, and whether it was stopped, for one run."""

    def __init__(self, limits: Limits, cost: Callable[[], int], clock: Stopwatch) -> None:
        self.limits, self.cost = limits, cost
        self.clock = clock
        self.tell: Callable[[int], None] | None = getattr(_running, "tell", None)
        self.moved = 0.0
        self.seen = 0
        self.struck: TimeLimitExceeded | None = None

    def overdue(self) -> TimeLimitExceeded | None:
        """Why the mapper must stop now, if it must."""
        now, cost = self.clock.seconds(), self.cost()
        if self.tell is not None:
            with suppress(Exception):  # it would be raised in the mapper
                self.tell(cost)
        if cost != self.seen:
            self.seen, self.moved = cost, now
        if now > self.limits.world_timeout:
            seconds = self.limits.world_timeout
            self.struck = WorldTimeout(f"the mapper was stopped after {seconds:g} s in this world")
        elif now - self.moved > self.limits.move_timeout:
            seconds = self.limits.move_timeout
            self.struck = MoveTimeout(f"the mapper did not move for {seconds:g} s")
        return self.struck


def _by_alarm(watch: _Watch, tick: float, work: Callable[[], T]) -> T:
    working: FrameType | None = None

    def at_work() -> T:
        nonlocal working
        working = currentframe()
        return work()

    def look(_signal: int, struck: FrameType | None) -> None:
        if _called_by(struck, working) and (why := watch.overdue()) is not None:
            raise why

    handler = signal.signal(signal.SIGALRM, look)
    timer = signal.setitimer(signal.ITIMER_REAL, tick, tick)
    try:
        return at_work()
    finally:  # a tick from here on raises nothing
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, handler or signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, *timer)
        working = None  # frame and closure hold each other


def _called_by(frame: FrameType | None, caller: FrameType | None) -> bool:
    """Whether the frame is the caller's or one called by it, outside of hooks."""
    while frame is not None and frame is not caller and not _is_a_hook(frame):
        frame = frame.f_back
    return frame is not None and frame is caller


def _is_a_hook(frame: FrameType) -> bool:
    """Whether the interpreter calls this in the middle of other code.

    There exceptions of callbacks are swallowed, and a tracer torn out never gives back its lock.
    """
    callbacks = [getattr(callback, "__code__", None) for callback in gc.callbacks]
    package = str(frame.f_globals.get("__name__")).partition(".")[0]
    return frame.f_code in callbacks or package in ("coverage", "_weakrefset")


def _by_thread(watch: _Watch, tick: float, work: Callable[[], T]) -> T:
    mapper = threading.get_ident()
    done = threading.Event()

    def look() -> None:
        while not done.wait(tick):
            if watch.overdue() is not None and not done.is_set():
                _raise_in(mapper, TimeLimitExceeded)
                return

    watcher = threading.Thread(target=look, name="topo-verify time limit", daemon=True)
    watcher.start()
    try:
        return work()
    except TimeLimitExceeded as bare:
        raise (watch.struck or bare).with_traceback(bare.__traceback__) from None
    finally:
        done.set()
        watcher.join()


def _raise_in(thread: int, exception: type[BaseException]) -> None:
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread), ctypes.py_object(exception))
