"""The tests that take long, by name: `make test` runs none of them.

    long.txt      about a second or more: `make long`, and so `.ci/run`, runs them
    nightly.txt   several seconds: `make nightly` alone runs them; they are marked `nightly`

They are the largest sizes of statements whose smaller sizes `make test` runs, and whole commands
whose parts it runs one by one.
"""

import re
from collections import defaultdict
from functools import cache
from pathlib import Path

TESTS = Path(__file__).resolve().parent

Patterns = dict[str, list[str]]
"""Patterns of the names of tests, parameters included, by their file in tests/."""


def _patterns(name: str) -> Patterns:
    patterns = defaultdict[str, list[str]](list)
    for line in (TESTS / name).read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            file, _, pattern = line.partition("::")
            patterns[file].append(pattern)
    return dict(patterns)


LONG, NIGHTLY = _patterns("long.txt"), _patterns("nightly.txt")


@cache
def _file(path: Path) -> str | None:
    return path.relative_to(TESTS).as_posix() if path.is_relative_to(TESTS) else None


def is_named(patterns: Patterns, path: Path, name: str) -> bool:
    """Whether these patterns name the test."""
    of_file = patterns.get(_file(path) or "", ())
    return any(re.fullmatch(pattern, name) for pattern in of_file)
