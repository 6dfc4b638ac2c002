import re

import pytest

from tests.conftest import TRACED
from tests.long import LONG, NIGHTLY, TESTS, Patterns, is_named


@pytest.mark.parametrize(
    ("file", "patterns"),
    [(file, names[file]) for names in (LONG, NIGHTLY) for file in names],
)
def test_each_pattern_names_a_test_of_its_file(file: str, patterns: list[str]) -> None:
    tests = re.findall(r"^def (test_\w+)|^(Test\w+) =", (TESTS / file).read_text(), re.MULTILINE)
    names = {name for pair in tests for name in pair}
    for pattern in patterns:
        assert pattern.partition(r"\[")[0] in names


def test_what_no_pattern_names_is_not_long() -> None:
    file, name = "studies/test_gap.py", "test_the_largest"
    patterns: Patterns = {file: [name]}
    assert is_named(patterns, TESTS / file, name)
    assert not is_named(patterns, TESTS / file, name + "[1]")
    assert not is_named(patterns, TESTS / "campaign" / "test_tally.py", name)
    assert not is_named(patterns, TESTS.parent / file, name)


def test_make_collects_the_traced_tests_of_every_traced_room() -> None:
    assert f"foreach room,{' '.join(TRACED)}," in (TESTS.parent / "Makefile").read_text()
