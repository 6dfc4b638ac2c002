"""The list of skipped tests that `.ci/run` ends with."""

from pathlib import Path

from tests.python import python

PROGRAM = Path(__file__).resolve().parent.parent / ".ci" / "skipped.py"


def printed(folder: Path, *runs: str) -> str:
    """What the program prints about runs, each given as the test cases of its JUnit file."""
    files = [folder / f"{number}.xml" for number in range(len(runs))]
    for file, cases in zip(files, runs, strict=True):
        file.write_text(f"<testsuites><testsuite>{cases}</testsuite></testsuites>")
    return python(PROGRAM, *files, check=True).stdout


def case(name: str, skipped: str | None = None) -> str:
    inside = "" if skipped is None else f'<skipped message="{skipped}"/>'
    return f'<testcase classname="tests.test_a" name="{name}">{inside}</testcase>'


def test_each_reason_has_its_tests_and_the_most_frequent_comes_first(tmp_path: Path) -> None:
    run = case("one", "no gcc") + case("two", "no node") + case("three", "no node") + case("four")
    assert printed(tmp_path, run).splitlines() == [
        "Skipped tests: 3",
        "  2 x no node",
        "      tests.test_a::two",
        "      tests.test_a::three",
        "  1 x no gcc",
        "      tests.test_a::one",
    ]


def test_what_another_run_executes_is_not_listed(tmp_path: Path) -> None:
    assert printed(tmp_path, case("one", "no coqc"), case("one")) == "No test was skipped.\n"
