"""Counts what docs/proofs.md says: python docs/statements.py writes the numbers into the page.

Theorems are counted by kind, and the lines of Coq that a reader has to believe by definition: lines
without comments and blanks. The definitions for certificates are a table of the page, with columns
read, in, lines; the others are a CSV file, of which the page has the sums.
tests/proofs/mechanised/test_reading.py compares the stored files with what this makes.
"""

from __future__ import annotations

import csv
import io
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from topo_verify.proofs.catalogue import catalogue
from topo_verify.proofs.mechanised import toolchain

PAGE = Path(__file__).parent / "proofs.md"
TABLE = Path(__file__).parent / "data" / "tables" / "definitions.csv"

ROW = re.compile(r"^\| (?P<names>.+?) \| `(?P<file>\w+)\.v` \| (?P<lines>\d+) \|", re.MULTILINE)
"""A row of a table of definitions."""

TOTAL = re.compile(r"^\| \*\*total\*\* \|  \| (\d+) \|", re.MULTILINE)
"""The last row of such a table."""

KIND = re.compile(r"^\| (?P<kind>\w+) \| (?P<count>\d+) \|", re.MULTILINE)
"""A row of the table of kinds."""

SUM = re.compile(r"^\| `(?P<theorems>\w+)` \| (?P<lines>\d+) \|", re.MULTILINE)
"""A row with the sum of the definitions in the CSV file that some theorems need."""

_ITEM = re.compile(r"(Definition|Fixpoint|Inductive|Record|Theorem|Lemma)\s+([\w']+)")
_PROVED = {"Theorem", "Lemma"}


def definitions(file: str) -> Iterator[tuple[str, str, list[str]]]:
    """The items of a source: kind, name, and the lines that are neither empty nor comment."""
    text = toolchain.without_comments((toolchain.SOURCES / f"{file}.v").read_text(encoding="utf-8"))
    for sentence in re.split(r"\.(?=\s)", text):
        lines = [line for line in sentence.splitlines() if line.strip()]
        if item := _ITEM.match(sentence.strip()):
            yield item[1], item[2], lines


def defined(names: str, file: str) -> dict[str, int]:
    """The definitions that a row lists, each with its lines; `all definitions` lists the file's."""
    lengths = {name: len(lines) for kind, name, lines in definitions(file) if kind not in _PROVED}
    listed = [] if names == "all definitions" else re.findall(r"[\w']+", names)
    return {name: lengths[name] for name in listed} if listed else lengths


def recounted(text: str) -> str:
    """The CSV file with every number as it is counted now."""
    made = io.StringIO()
    reader = csv.DictReader(io.StringIO(text))
    writer = csv.DictWriter(made, list(reader.fieldnames or ()), lineterminator="\n")
    writer.writeheader()
    for row in reader:
        lines = defined(row["read"], row["in"].removesuffix(".v")).values()
        writer.writerow({**row, "lines": sum(lines)})
    return made.getvalue()


def page(text: str) -> str:
    """The page with every number as it is counted now."""
    counts = Counter[str](theorem.kind for theorem in catalogue())
    sums = Counter[str]()
    for row in csv.DictReader(io.StringIO(recounted(TABLE.read_text(encoding="utf-8")))):
        sums[row["theorems"]] += int(row["lines"])
    text = SUM.sub(lambda row: f"| `{row['theorems']}` | {sums[row['theorems']]} |", text)
    text = KIND.sub(lambda row: f"| {row['kind']} | {counts[row['kind']]} |", text)
    parts: list[str] = []
    end = 0
    for total in TOTAL.finditer(text):
        table, lines = _counted(text[end : total.start()])
        parts += [table, f"| **total** |  | {lines} |"]
        end = total.end()
    return "".join(parts) + text[end:]


def _counted(text: str) -> tuple[str, int]:
    """A text with one table of definitions and its true numbers, and their sum."""
    sums: list[int] = []

    def count(row: re.Match[str]) -> str:
        sums.append(sum(defined(row["names"], row["file"]).values()))
        return f"| {row['names']} | `{row['file']}.v` | {sums[-1]} |"

    return ROW.sub(count, text), sum(sums)


if __name__ == "__main__":
    TABLE.write_text(recounted(TABLE.read_text(encoding="utf-8")), encoding="utf-8")
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
