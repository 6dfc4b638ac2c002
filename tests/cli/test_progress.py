"""The bar on stderr: for people who look at a terminal and wait."""

from __future__ import annotations

import sys
import time
from io import StringIO

import pytest

from topo_verify.cli import progress
from topo_verify.cli.progress import ProgressBar


class Terminal(StringIO):
    def isatty(self) -> bool:
        return True


def shown(monkeypatch: pytest.MonkeyPatch, stderr: StringIO | None, *, quiet: bool = False) -> str:
    """What one piece of work that takes 0.3 s leaves on stderr, with a delay of 0.05 s."""
    monkeypatch.setattr(sys, "stderr", stderr)
    monkeypatch.setattr(progress, "DELAY", 0.05)
    monkeypatch.setenv("TERM", "xterm")
    bar = ProgressBar(quiet=quiet)
    bar("first [part]", 0, 2)
    time.sleep(0.3)
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


def test_short_work_is_not_worth_a_bar(monkeypatch: pytest.MonkeyPatch) -> None:
    out = Terminal()
    monkeypatch.setattr(sys, "stderr", out)
    bar = ProgressBar(quiet=False)
    for done in range(5):
        bar("work", done, 5)
    bar.clear()
    bar.clear()
    assert out.getvalue() == ""
