"""What every test runs under: the Hypothesis profile, named by HYPOTHESIS_PROFILE.

`ci` (the default) tries the same examples on every machine and every run, so that a red test is
red for everyone; no deadline, because a slow machine is no fault of the code. `nightly` looks in
new places each time and for longer, and keeps what it found in Hypothesis's example database.

Coverage is measured by the `traced` tests alone, in a run of their own: those in the folder of a
traced room, less the long ones that are marked `no_cover` and run through lines that short tests
reach. A line that only a test of another room reaches counts as missing. (One run for all tests
took 2.6 times as long: coverage that is paused for a test still slows it down under xdist.)
"""

import os
import signal
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import HealthCheck, settings

from tests.browser import browser, show
from tests.small_rows import small_rows

if TYPE_CHECKING:
    from topo_verify.proofs.theorem import Theorem

__all__ = ["browser", "show", "small_rows"]  # fixtures, here for all tests: each made but once

ROOT = Path(__file__).resolve().parent.parent
TRACED = ("world", "robot", "checkers", "algorithms")
"""The rooms whose branch coverage must be 100 % (pyproject.toml, `source` of coverage)."""

TRACING = tuple(ROOT / folder / room for folder in ("tests", "topo_verify") for room in TRACED)
"""Where their tests are, doctests included. `make test` collects the traced tests there alone."""

# A shell begins a job in the background with these ignored, and the tests' processes inherit that.
for _number, _usual in (
    (signal.SIGINT, signal.default_int_handler),
    (signal.SIGQUIT, signal.SIG_DFL),
):
    if signal.getsignal(_number) == signal.SIG_IGN:
        signal.signal(_number, _usual)

settings.register_profile(
    "ci",
    derandomize=True,
    deadline=None,
    print_blob=True,
    # How fast examples are made depends on the machine and on coverage, not on the code's worth.
    suppress_health_check=[HealthCheck.too_slow],
)
settings.register_profile(
    "nightly",
    max_examples=5_000,
    deadline=None,
    print_blob=True,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "ci"))


@cache
def _is_traced(file: Path) -> bool:
    return any(folder in file.parents for folder in TRACING)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark tests whose place or fixture decides: `traced` measures coverage, `coq` compiles."""
    for item in items:
        if _is_traced(item.path) and item.get_closest_marker("no_cover") is None:
            item.add_marker("traced")
        if "library" in getattr(item, "fixturenames", ()):  # tests/proofs/mechanised/conftest.py
            item.add_marker("coq")


@cache
def _remembering(theorem: "Theorem") -> "Theorem":
    return replace(theorem, prove=cache(theorem.prove))


@pytest.fixture
def proved_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let a theorem be proved when it is asked for first, and be remembered from then on.

    For tests of `verify`: its part `proofs` has nothing to do with the mapper, and takes ten times
    as long as the rest of a quick run.
    """
    from topo_verify.proofs import catalogue

    choose: Callable[..., tuple[Theorem, ...]] = catalogue.choose

    def chosen(*args: Any, **options: Any) -> tuple["Theorem", ...]:
        return tuple(map(_remembering, choose(*args, **options)))

    monkeypatch.setattr(catalogue, "choose", chosen)
