"""The bar on stderr: for people who look at a terminal and wait."""

from __future__ import annotations

import sys
from collections.abc import Callable
from io import StringIO
from typing import ClassVar

import pytest

from topo_verify.cli import output as progress
from topo_verify.cli.output import ProgressBar


class Terminal(StringIO):
    def isatty(self) -> bool:
        return True


class TimerByHand:
    """Stands for the timer that shows the bar: its time comes when the test says so."""

    started: ClassVar[list[TimerByHand]] = []
    daemon = False

    def __init__(self, seconds: float, then: Callable[[], None]) -> None:
        assert seconds == progress.DELAY
        self.then = then

    def start(self) -> None:
        self.started.append(self)

    def cancel(self) -> None:
        self.started.remove(self)

    def join(self) -> None:
        pass


@pytest.fixture(autouse=True)
def timers(monkeypatch: pytest.MonkeyPatch) -> list[TimerByHand]:
    monkeypatch.setattr(TimerByHand, "started", [])
    monkeypatch.setattr(progress, "Timer", TimerByHand)
    return TimerByHand.started


def shown(monkeypatch: pytest.MonkeyPatch, stderr: StringIO | None, *, quiet: bool = False) -> str:
    """What work in two parts leaves on stderr, of which the first takes long."""
    monkeypatch.setattr(sys, "stderr", stderr)
    monkeypatch.setenv("TERM", "xterm")
    bar = ProgressBar(quiet=quiet)
    bar("first [part]", 0, 2)
    for timer in TimerByHand.started:
        timer.then()
    bar("second part", 1, 2)
    bar.clear()
    return "" if stderr is None else stderr.getvalue()


def test_long_work_is_shown_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    text = shown(monkeypatch, Terminal())
    assert "first [part]" in text
    assert "second part" in text


def test_no_terminal_no_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    assert shown(monkeypatch, StringIO()) == ""
    assert shown(monkeypatch, None) == ""


def test_quiet_means_no_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    assert shown(monkeypatch, Terminal(), quiet=True) == ""


def test_short_work_is_not_worth_a_bar(
    monkeypatch: pytest.MonkeyPatch, timers: list[TimerByHand]
) -> None:
    out = Terminal()
    monkeypatch.setattr(sys, "stderr", out)
    bar = ProgressBar(quiet=False)
    for done in range(5):
        bar("work", done, 5)
    assert len(timers) == 1
    bar.clear()
    assert not timers, "its timer was let go"
    bar.clear()
    assert out.getvalue() == ""
