"""Print which tests were skipped and why, from the JUnit files of these runs.

A test that one run skips and another passes is not listed.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Iterable
from xml.etree import ElementTree as ET


def skipped(files: Iterable[str]) -> dict[str, list[str]]:
    """For each reason the tests that no run executed, in the order of the runs."""
    reasons: dict[str, str] = {}
    executed: set[str] = set()
    for file in files:
        for case in ET.parse(file).iter("testcase"):  # noqa: S314  pytest wrote it just now
            test = f"{case.get('classname')}::{case.get('name')}"
            skip = case.find("skipped")
            if skip is None:
                executed.add(test)
            else:  # an expected failure stands here, too: it is not executed to its end
                reasons.setdefault(test, skip.get("message") or "no reason given")
    tests: dict[str, list[str]] = defaultdict(list)
    for test, reason in reasons.items():
        if test not in executed:
            tests[reason].append(test)
    return tests


def main(files: list[str]) -> None:
    """Print the reasons, the most frequent first, each with its tests."""
    tests = skipped(files)
    print(f"Skipped tests: {sum(map(len, tests.values()))}" if tests else "No test was skipped.")
    for reason, names in sorted(tests.items(), key=lambda one: -len(one[1])):
        print(f"  {len(names)} x {reason}")
        print(*(f"      {name}" for name in names), sep="\n")


if __name__ == "__main__":
    main(sys.argv[1:])
