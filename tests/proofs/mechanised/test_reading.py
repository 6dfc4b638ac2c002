"""docs/proofs.md: the definitions that must be believed are all listed, and counted."""

from __future__ import annotations

import csv
import re

import pytest

from tests.docs.test_site import part
from topo_verify.proofs.mechanised import toolchain

MADE = part("statements.py")
PAGE: str = MADE.PAGE.read_text(encoding="utf-8")
TABLE: str = MADE.TABLE.read_text(encoding="utf-8")
Definition = tuple[str, str]

CERTIFICATES = {
    (row["file"], name)
    for row in MADE.ROW.finditer(PAGE)
    for name in MADE.defined(row["names"], row["file"])
}
"""What a reader of certificates must read: the file and the name of each definition."""

UNREAD = {
    ("Certificate", "a_certificate"),  # how numbers are read is told apart
    ("Checker", "evidence"),  # a wrong one proves nothing
    ("Checker", "conflict"),
    ("Decisions", "reason"),
}
VARIABLES = {"fuel", "home", "judge", "own", "path"}
"""Names of definitions that the listed ones use as variables."""


def listed(theorems: str) -> set[Definition]:
    """The definitions that the CSV file lists for some theorems, each with its file."""
    files = [
        (row["read"], row["in"].removesuffix(".v"))
        for row in csv.DictReader(TABLE.splitlines())
        if row["theorems"] == theorems
    ]
    return {(file, name) for names, file in files for name in MADE.defined(names, file)}


def unlisted(there: set[Definition]) -> set[Definition]:
    """What these definitions use beside themselves."""
    items = [(file, name, lines) for file in toolchain.files() for _, name, lines in
             MADE.definitions(file)]  # fmt: skip
    files = {name: file for file, name, _ in items}
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
    assert MADE.recounted(TABLE) == TABLE, "write the numbers anew: python docs/statements.py"
    assert not re.search(r"^\| .* \| 0 \|", PAGE, re.MULTILINE)
    assert len(MADE.SUM.findall(PAGE)) == 3


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (r"\| mechanised \| \d+", "| mechanised | 7"),
        (r"(`World.v` \|) \d+", r"\1 7"),
        (r"(\*\*total\*\* \|  \|) \d+", r"\1 7"),
        (r"(`mappers` \|) \d+", r"\1 7"),
    ],
)
def test_a_wrong_number_is_seen(old: str, new: str) -> None:
    wrong = re.sub(old, new, PAGE, count=1)
    assert wrong != PAGE
    assert MADE.page(wrong) == PAGE
    wrong = re.sub(r",4,a mapper", ",7,a mapper", TABLE)
    assert wrong != TABLE
    assert MADE.recounted(wrong) == TABLE


def test_a_certificate_needs_less_than_150_lines() -> None:
    (total,) = MADE.TOTAL.findall(PAGE)
    assert int(total) < 150


def test_every_definition_that_a_listed_one_uses_is_listed() -> None:
    assert unlisted(CERTIFICATES) == UNREAD
    whole = CERTIFICATES.union(*map(listed, ("mappers", "judge", "accepted")))
    rest = {(file, name) for file, name in unlisted(whole) if name not in VARIABLES}
    assert rest == UNREAD
    assert ("Sound", "Strategy") in unlisted(whole - {("Sound", "Strategy")})
