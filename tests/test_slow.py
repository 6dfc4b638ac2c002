import re

import pytest

from tests.slow import SLOW, TESTS, is_slow


@pytest.mark.parametrize("file", SLOW)
def test_each_pattern_names_a_test_of_its_file(file: str) -> None:
    tests = re.findall(r"^def (test_\w+)|^(Test\w+) =", (TESTS / file).read_text(), re.MULTILINE)
    names = {name for pair in tests for name in pair}
    for pattern in SLOW[file]:
        assert pattern.partition(r"\[")[0] in names


def test_what_no_pattern_names_is_not_slow() -> None:
    file, name = "harness/test_gap.py", "test_the_basic_algorithm_has_the_largest"
    assert is_slow(TESTS / file, name)
    assert not is_slow(TESTS / file, name + "[1]")
    assert not is_slow(TESTS / "harness" / "test_tally.py", name)
    assert not is_slow(TESTS.parent / file, name)
