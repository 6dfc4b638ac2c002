"""docs/proofs.md: the definitions that must be believed are all listed, and counted."""

from __future__ import annotations

import re

import pytest

from tests.docs.test_site import part
from topo_verify.proofs.mechanised import toolchain

MADE = part("statements.py")
PAGE: str = MADE.PAGE.read_text(encoding="utf-8")
CERTIFICATES, MAPPERS = PAGE.partition("## What must be believed")[2].split(
    "**For the theorems about mappers**"
)

UNREAD = {
    ("Certificate", "a_certificate"),  # how numbers are read is told apart
    ("Checker", "evidence"),  # a wrong one proves nothing
    ("Checker", "conflict"),
    ("Decisions", "reason"),
}
VARIABLES = {"fuel", "home", "judge", "own", "path"}
"""Names of definitions that the listed ones use as variables."""


def listed(text: str) -> set[tuple[str, str]]:
    """The definitions in the tables of a text, each with its file."""
    return {
        (row["file"], name)
        for row in MADE.ROW.finditer(text)
        for name in MADE.defined(row["names"], row["file"])
    }


def unlisted(text: str) -> set[tuple[str, str]]:
    """What the listed definitions use that is not listed."""
    items = [(file, name, lines) for file in toolchain.files() for _, name, lines in
             MADE.definitions(file)]  # fmt: skip
    files = {name: file for file, name, _ in items}
    there = listed(text)
    used = {
        (files[word], word)
        for file, name, lines in items
        if (file, name) in there
        for word in re.findall(r"[\w']+", " ".join(lines))
        if word in files and word != name
    }
    return used - there


def test_the_page_counts_theorems_and_lines_as_they_are() -> None:
    assert MADE.page(PAGE) == PAGE, "write the numbers anew: python docs/statements.py"
    assert not re.search(r"^\| .* \| 0 \|", PAGE, re.MULTILINE)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (r"\| mechanised \| \d+", "| mechanised | 7"),
        (r"(`World.v` \|) \d+", r"\1 7"),
        (r"(\*\*total\*\* \|  \|) \d+", r"\1 7"),
    ],
)
def test_a_wrong_number_is_seen(old: str, new: str) -> None:
    wrong = re.sub(old, new, PAGE, count=1)
    assert wrong != PAGE
    assert MADE.page(wrong) == PAGE


def test_a_certificate_needs_less_than_150_lines() -> None:
    (total,) = MADE.TOTAL.findall(CERTIFICATES)
    assert int(total) < 150


def test_every_definition_that_a_listed_one_uses_is_listed() -> None:
    assert unlisted(CERTIFICATES) == UNREAD
    rest = unlisted(CERTIFICATES + MAPPERS)
    assert {(file, name) for file, name in rest if name not in VARIABLES} == UNREAD
    assert ("Sound", "Strategy") in unlisted(CERTIFICATES + MAPPERS.replace("`Strategy`, ", ""))
