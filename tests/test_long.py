import re

import pytest

from tests.long import LONG, TESTS, is_long


@pytest.mark.parametrize("file", LONG)
def test_each_pattern_names_a_test_of_its_file(file: str) -> None:
    tests = re.findall(r"^def (test_\w+)|^(Test\w+) =", (TESTS / file).read_text(), re.MULTILINE)
    names = {name for pair in tests for name in pair}
    for pattern in LONG[file]:
        assert pattern.partition(r"\[")[0] in names


def test_what_no_pattern_names_is_not_long() -> None:
    file, name = "studies/test_gap.py", "test_the_basic_algorithm_has_the_largest"
    assert is_long(TESTS / file, name)
    assert not is_long(TESTS / file, name + "[1]")
    assert not is_long(TESTS / "campaign" / "test_tally.py", name)
    assert not is_long(TESTS.parent / file, name)
