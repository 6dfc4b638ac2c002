"""What a sceptic reads: the definitions that docs/explanation/sceptic.md lists, and how long."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from topo_verify.proofs.mechanised import toolchain

PAGE = Path(__file__).parents[3] / "docs" / "explanation" / "sceptic.md"

ROW = re.compile(r"^\| (.+?) \| `(\w+)\.v` \| (\d+) \|", re.MULTILINE)
"""A row of the table: what to read, the file, its lines."""

ITEM = re.compile(r"(Definition|Fixpoint|Inductive|Record|Theorem|Lemma)\s+([\w']+)")


def definitions(file: str) -> Iterator[tuple[str, str, list[str]]]:
    """The items of a source: kind, name, and the lines that are not empty and no comment."""
    text = toolchain.without_comments((toolchain.SOURCES / f"{file}.v").read_text())
    for sentence in re.split(r"\.(?=\s)", text):
        lines = [line for line in sentence.splitlines() if line.strip()]
        if found := ITEM.match(sentence.strip()):
            yield found[1], found[2], lines


def lines_to_read(what: str, file: str) -> int:
    """The number of lines of the definitions that a row names."""
    items = list(definitions(file))
    if what == "everything":
        assert {kind for kind, _, _ in items} <= {"Definition", "Fixpoint", "Inductive", "Record"}
        return sum(len(lines) for _, _, lines in items)
    names = re.findall(r"`([\w']+)`", what)
    found = {name: len(lines) for kind, name, lines in items if kind not in {"Theorem", "Lemma"}}
    return sum(found[name] for name in names)


def test_the_page_counts_the_lines_to_read_and_they_are_less_than_150() -> None:
    rows = ROW.findall(PAGE.read_text())
    assert [int(lines) for _, _, lines in rows] == [lines_to_read(w, f) for w, f, _ in rows]
    total = sum(int(lines) for _, _, lines in rows)
    assert f": {total} lines without their comments" in PAGE.read_text()
    assert total < 150


def needed_by(file: str, name: str) -> set[str]:
    """The words of a definition."""
    text = {item: " ".join(lines) for _, item, lines in definitions(file)}
    return set(re.findall(r"[\w']+", text[name]))


def test_every_definition_that_a_listed_one_uses_is_listed() -> None:
    listed: set[tuple[str, str]] = set()
    for what, file, _ in ROW.findall(PAGE.read_text()):
        names = re.findall(r"`([\w']+)`", what)
        listed |= {(file, name) for _, name, _ in definitions(file) if not names or name in names}
    known = {name: file for file in toolchain.files() for _, name, _ in definitions(file)}
    used = {
        (known[word], word)
        for file, name in listed
        for word in needed_by(file, name)
        if word in known and word != name
    }
    # How numbers are read is told apart; evidence and conflicts need not be understood.
    apart = {("Certificate", "a_certificate")}
    evidence = {("Checker", "evidence"), ("Checker", "conflict"), ("Decisions", "reason")}
    assert used - listed == apart | evidence
