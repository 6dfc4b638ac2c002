"""The code carries the line numbers of the paper's listings: all of them, and no others."""

from __future__ import annotations

import re
import tokenize
from collections.abc import Iterator
from io import StringIO
from pathlib import Path

import pytest

import topo_verify.algorithms

FILES = sorted(Path(topo_verify.algorithms.__file__).parent.rglob("*.py"))
LINES = {1: 20, 2: 28, 3: 30}
"""How many lines each listing has."""

HOMING = Path(__file__).parents[2] / "docs" / "homing.md"
"""It has a listing of its own, whose lines are cited as `# H.7`."""


def cited(source: str) -> Iterator[tuple[int, int]]:
    """Listing and line of every pointer in a comment, as `# A2.7`."""
    for token in tokenize.generate_tokens(StringIO(source).readline):
        if token.type == tokenize.COMMENT:
            for listing, line in re.findall(r"\bA(\d+)\.(\d+)\b", token.string):
                yield int(listing), int(line)


@pytest.mark.parametrize("listing", LINES)
def test_every_line_of_the_listing_stands_in_the_code_and_no_other_does(listing: int) -> None:
    found = {line for path in FILES for at, line in cited(path.read_text()) if at == listing}
    assert found == set(range(1, LINES[listing] + 1))


def test_no_other_listing_is_cited() -> None:
    assert {at for path in FILES for at, _ in cited(path.read_text())} == set(LINES)


def test_only_comments_count_as_citations() -> None:
    assert list(cited('"""`# A2.7` in words"""\nx = 1  # A1.3 A2.28: both\n')) == [(1, 3), (2, 28)]


def test_the_listing_of_homing_is_cited_line_by_line_by_the_files_that_make_it() -> None:
    listed = re.findall(r"^ {4}(\d+) {2,}\S", HOMING.read_text(), re.MULTILINE)
    homes = ("history.py", "homing.py", "steering.py")
    texts = [path.read_text() for path in FILES if path.name in homes]
    found = {int(line) for text in texts for line in re.findall(r"# .*?\bH\.(\d+)\b", text)}
    found |= {
        int(line) for text in texts for line in re.findall(r"\bH\.(\d+)$", text, re.MULTILINE)
    }
    assert sorted(found) == [int(line) for line in listed] == list(range(1, len(listed) + 1))
