"""The tests that take long: `make long` and `make nightly` run them, `make test` does not.

A test is named in long.txt if it takes more than about one second: the largest sizes of statements
whose smaller sizes `make test` runs, and whole commands whose parts it runs one by one. `.ci/run`
runs all of them, so that a change is asked everything before it is taken.
"""

import re
from collections import defaultdict
from pathlib import Path

TESTS = Path(__file__).resolve().parent

LONG = defaultdict[str, list[str]](list)
"""Patterns of the names of tests, parameters included, by their file in tests/."""

for _line in (TESTS / "long.txt").read_text(encoding="utf-8").splitlines():
    if _line and not _line.startswith("#"):
        _file, _, _pattern = _line.partition("::")
        LONG[_file].append(_pattern)


def is_long(path: Path, name: str) -> bool:
    """Whether a test is named in `LONG`."""
    if not path.is_relative_to(TESTS):
        return False
    patterns = LONG.get(path.relative_to(TESTS).as_posix(), ())
    return any(re.fullmatch(pattern, name) for pattern in patterns)
