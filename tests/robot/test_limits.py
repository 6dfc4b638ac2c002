"""Limits: what stops a mapper that moves too much, too slowly, or not at all."""

from __future__ import annotations

import gc
import signal
import sys
import threading
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager, suppress
from itertools import count
from math import inf, nan
from typing import Any, cast

import pytest

from topo_verify.errors import InputError
from topo_verify.robot import limits
from topo_verify.robot.limits import (
    BudgetExceeded,
    Limits,
    MapperStopped,
    MoveTimeout,
    TimeLimitExceeded,
    WorldTimeout,
    given_limits,
    telling_moves,
    within,
)

SHORT = Limits(move_timeout=0.15, world_timeout=600)


def still() -> int:
    """The cost of a mapper that does not move."""
    return 0


def loop() -> None:
    """Compute for ever."""
    while True:
        pass


def sleep() -> None:
    """Sleep for longer than any limit here."""
    time.sleep(30)


@contextmanager
def in_time(seconds: float = 25) -> Generator[None]:
    """Not a hang: the block is over soon (allowing for a machine that is busy)."""
    start = time.monotonic()
    yield
    assert time.monotonic() - start < seconds


def here(work: Callable[[], None]) -> None:
    """Do the work in the main thread."""
    work()


def elsewhere(work: Callable[[], None]) -> None:
    """Do the work in another thread than the main one; what it raises is raised here."""
    raised: list[BaseException] = []

    def body() -> None:
        try:
            work()
        except BaseException as error:  # noqa: BLE001  it is handed over
            raised.append(error)

    thread = threading.Thread(target=body)
    thread.start()
    thread.join()
    if raised:
        raise raised[0]


def guarded(mapper: Callable[[], None], bounds: Limits = SHORT) -> None:
    """Run a mapper that never moves under these limits."""
    within(bounds, still, mapper)


@pytest.mark.parametrize("mapper", [loop, sleep])
def test_a_mapper_that_does_not_move_is_stopped_in_the_main_thread(
    mapper: Callable[[], None],
) -> None:
    with in_time(), pytest.raises(TimeLimitExceeded, match=r"did not move for 0\.15 s"):
        guarded(mapper)


def test_a_mapper_that_does_not_move_is_stopped_in_another_thread() -> None:
    with in_time(), pytest.raises(TimeLimitExceeded, match=r"did not move for 0\.15 s"):
        elsewhere(lambda: guarded(loop))


@pytest.mark.parametrize("where", [here, elsewhere])
def test_a_mapper_that_moves_all_the_time_is_stopped_by_the_other_limit(
    where: Callable[[Callable[[], None]], None],
) -> None:
    moves = count()

    def work() -> None:
        within(Limits(move_timeout=600, world_timeout=0.2), lambda: next(moves), loop)

    with in_time(), pytest.raises(WorldTimeout, match=r"after 0\.2 s in this world"):
        where(work)


def test_the_clock_is_looked_at_twenty_times_within_each_limit() -> None:
    ticks: list[float] = []
    for move_timeout in (600, 2, 0.1):
        limits = Limits(move_timeout=move_timeout, world_timeout=40)
        guarded(lambda: ticks.append(signal.getitimer(signal.ITIMER_REAL)[1]), limits)
    assert ticks == pytest.approx([2, 0.1, 0.05])


def test_the_moves_of_a_mapper_that_runs_are_told_and_no_listener_can_disturb_it() -> None:
    told: list[int] = []

    def tell(moves: int) -> None:
        told.append(moves)
        raise OSError

    moves = count(1)
    bounds = Limits(move_timeout=600, world_timeout=0.2)
    with in_time(), pytest.raises(WorldTimeout), telling_moves(tell):
        within(bounds, lambda: next(moves), loop)
    assert told == [*range(1, len(told) + 1)] != []
    with in_time(), pytest.raises(WorldTimeout):
        within(bounds, lambda: next(moves), loop)
    assert len(told) < next(moves) - 1


@pytest.mark.parametrize("where", [here, elsewhere])
def test_a_mapper_in_time_notices_nothing(where: Callable[[Callable[[], None]], None]) -> None:
    def work() -> str:
        time.sleep(0.6)  # a tick or two pass
        return "a map"

    delivered: list[str] = []
    where(lambda: delivered.append(within(Limits(move_timeout=1, world_timeout=2), still, work)))
    assert delivered == ["a map"]


@pytest.mark.parametrize("where", [here, elsewhere])
def test_what_the_mapper_raises_passes_through(where: Callable[[Callable[[], None]], None]) -> None:
    def fail() -> None:
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        where(lambda: guarded(fail))


def test_without_an_alarm_clock_the_main_thread_is_watched_by_another(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delattr(signal, "setitimer")
    with in_time(), pytest.raises(TimeLimitExceeded, match="did not move"):
        guarded(loop)


def test_no_watching_thread_is_left_behind() -> None:
    before = threading.active_count()
    elsewhere(lambda: guarded(lambda: None))
    assert threading.active_count() == before


def test_the_callers_own_alarm_and_handler_are_restored() -> None:
    rung: list[int] = []

    def mine(number: int, _frame: object) -> None:
        rung.append(number)

    before = signal.signal(signal.SIGALRM, mine)
    signal.setitimer(signal.ITIMER_REAL, 0.5)
    try:
        with pytest.raises(TimeLimitExceeded):
            guarded(loop)
        assert signal.getsignal(signal.SIGALRM) is mine
        assert 0 < signal.getitimer(signal.ITIMER_REAL)[0] <= 0.5
        signal.pause()
        assert rung == [signal.SIGALRM]
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_limits_within_limits_stop_the_inner_mapper_and_leave_the_outer_running() -> None:
    def outer() -> None:
        with pytest.raises(TimeLimitExceeded, match=r"0\.15 s"):
            guarded(loop)
        assert signal.getitimer(signal.ITIMER_REAL)[0] > 0

    guarded(outer, Limits(move_timeout=600, world_timeout=600))


@pytest.mark.parametrize("call", [1, 2, 3])
def test_a_tick_before_or_after_the_mapper_raises_nothing_and_leaves_no_clock(
    monkeypatch: pytest.MonkeyPatch, call: int
) -> None:
    before = signal.getsignal(signal.SIGALRM)
    real, calls = signal.setitimer, list[float]()

    def late(which: int, seconds: float, interval: float = 0.0) -> tuple[float, float]:
        calls.append(seconds)
        if len(calls) == call:  # the clock is set, stopped, and given back to the caller
            time.sleep(0.1)
            signal.raise_signal(signal.SIGALRM)
        return real(which, seconds, interval)

    def rings(_signal: int, _frame: object) -> None:
        """The caller's own alarm: from the third call on the handler is the caller's again."""

    signal.signal(signal.SIGALRM, rings)
    try:
        monkeypatch.setattr(signal, "setitimer", late)
        guarded(lambda: None, Limits(move_timeout=0.05, world_timeout=600))
        assert signal.getsignal(signal.SIGALRM) is rings
        assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)
    finally:
        signal.signal(signal.SIGALRM, before)
    assert len(calls) == 3


def test_a_mapper_whose_clean_up_is_slow_is_struck_again_and_leaves_no_clock() -> None:
    strikes = 0

    def slow_to_end() -> None:
        nonlocal strikes
        while strikes < 3:
            try:
                loop()
            except TimeLimitExceeded:
                strikes += 1

    before = signal.getsignal(signal.SIGALRM)
    with in_time(), pytest.raises(MoveTimeout):
        guarded(slow_to_end)
    assert strikes == 3
    assert signal.getsignal(signal.SIGALRM) == before
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)


def test_no_tick_strikes_in_a_callback_of_the_garbage_collector(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    torn: list[object] = []
    rounds = count()

    def torn_out(told: sys.UnraisableHookArgs) -> None:
        torn.append(told.object)

    monkeypatch.setattr(sys, "unraisablehook", torn_out)

    def late(_phase: str, _info: dict[str, int]) -> None:
        """Take so long that the first ticks that are overdue come here."""
        start = time.monotonic()
        while time.monotonic() - start < 0.5:
            pass
        next(rounds)

    def collect() -> None:
        gc.collect()
        assert next(rounds) == 2  # before and after the collection
        loop()

    gc.disable()
    gc.callbacks.append(late)
    try:
        with in_time(), pytest.raises(MoveTimeout):
            guarded(collect)
    finally:
        gc.callbacks.remove(late)
        gc.enable()
    assert late not in torn


@pytest.mark.parametrize("module", ["coverage.collector", "_weakrefset"])
def test_no_tick_strikes_in_a_tracer_or_in_the_callback_of_a_weak_reference(module: str) -> None:
    """A tracer holds a lock, and torn out of there would never give it back."""
    source = """
def trace(rings):
    for _ in range(2):
        rings()
    return True
"""
    traced: list[bool] = []
    tracer: dict[str, Any] = {"__name__": module}
    exec(source, tracer)  # noqa: S102  a function of that module

    def work() -> None:
        traced.append(tracer["trace"](rings))
        loop()

    def rings() -> None:
        time.sleep(0.1)
        signal.raise_signal(signal.SIGALRM)

    with in_time(), pytest.raises(MoveTimeout):
        guarded(work, Limits(move_timeout=0.05, world_timeout=600))
    assert traced == [True]


@pytest.mark.parametrize("where", [here, elsewhere])
def test_a_mapper_that_swallows_the_exception_and_returns_is_stopped_all_the_same(
    where: Callable[[Callable[[], None]], None],
) -> None:
    def swallow() -> None:
        with suppress(BaseException):
            loop()

    with in_time(), pytest.raises(MoveTimeout, match="did not move"):
        where(lambda: guarded(swallow))


@pytest.mark.parametrize(
    ("stop", "limit"),
    [
        (MapperStopped, None),
        (BudgetExceeded, "budget"),
        (MoveTimeout, "move-timeout"),
        (WorldTimeout, "world-timeout"),
    ],
)
def test_an_exception_names_the_option_whose_limit_was_reached(
    stop: type[MapperStopped], limit: str | None
) -> None:
    assert stop.limit == limit


def test_what_is_no_limits_is_refused() -> None:
    assert given_limits(None) == Limits()
    assert given_limits(Limits(budget=3)).budget == 3
    with pytest.raises(InputError, match=r"limits=3: expected tv.Limits, as in tv.Limits\(budget"):
        given_limits(3)


def test_a_mapper_out_of_moves_is_told_its_budget_and_what_sets_it() -> None:
    told = str(BudgetExceeded(1))
    assert "more than 1 move, its budget" in told
    assert "claim cost-within-bound" in told
    assert "--budget" in told
    assert told.endswith("; a right mapper may need more")


@pytest.mark.parametrize(
    ("bounds", "words"),
    [
        (Limits(), ()),
        (Limits(budget=0), ("--budget", "0")),
        (Limits(move_timeout=0.5), ("--move-timeout", "0.5")),
        (Limits(7, 1, 2), ("--budget", "7", "--move-timeout", "1", "--world-timeout", "2")),
    ],
)
def test_limits_know_their_options_on_the_command_line(
    bounds: Limits, words: tuple[str, ...]
) -> None:
    assert bounds.options == words


@pytest.mark.parametrize("budget", [-1, "x", 2.5])
def test_a_budget_is_a_number_of_moves(budget: Any) -> None:
    message = f"budget: expected an integer of 0 or more, got {budget!r}"
    with pytest.raises(InputError, match=message):
        Limits(budget=budget)


def test_the_default_limits_are_those_of_the_command_line() -> None:
    assert Limits() == Limits(budget=None, move_timeout=5.0, world_timeout=60.0)
    assert limits.TICK < 0.1


@pytest.mark.parametrize("seconds", [inf, nan, 0, -1.0, 10**6 + 1, "x"])
@pytest.mark.parametrize("name", ["move_timeout", "world_timeout"])
def test_a_time_limit_is_a_number_of_seconds(name: str, seconds: object) -> None:
    with pytest.raises(InputError, match=rf"{name}: expected seconds in \(0, 1000000\], got "):
        Limits(None, **cast("Any", {name: seconds}))


def test_limits_are_shown_as_they_are_written() -> None:
    shown = repr(limits.Limits(budget=3))
    assert shown == "tv.Limits(budget=3, move_timeout=5.0, world_timeout=60.0)"
