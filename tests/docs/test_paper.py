"""docs/explanation/paper.md: every name on the page exists, and says what the page says it does."""

from __future__ import annotations

import ast
import re
from collections import Counter, defaultdict
from collections.abc import Iterator
from functools import cache

import pytest

from tests.algorithms.test_listings import FILES, LINES, cited
from tests.docs.test_site import part
from tests.pages import ROOT
from topo_verify.checkers import CLAIMS
from topo_verify.proofs.catalogue import catalogue

Row = tuple[str, ...]

CODELINES = part("site/codelines.py")

PAGE = (ROOT / "docs" / "explanation" / "paper.md").read_text(encoding="utf-8")


def rows(page: str, heading: str) -> list[Row]:
    """The rows of the table under a heading, without its head."""
    section = page.split(f"## {heading}\n")[1].split("\n## ", maxsplit=1)[0]
    lines = [line for line in section.splitlines() if line.startswith("| ")]
    return [tuple(cell.strip() for cell in line.split("|")[1:-1]) for line in lines[2:]]


SENTENCES = rows(PAGE, "Sentence by sentence")
LISTINGS = rows(PAGE, "The listings, line by line")


@cache
def source(path: str) -> str:
    """The text of a file of the repository; empty if there is none."""
    file = ROOT / path
    return file.read_text(encoding="utf-8") if file.is_file() else ""


def text_of(path: str, name: str) -> str:
    """The lines of what a file defines by this name."""
    node = CODELINES.definition(source(path), name)
    assert node is not None, f"{path} has no {name}"
    return "\n".join(source(path).splitlines()[node.lineno - 1 : node.end_lineno])


def found(name: str, folder: str) -> bool:
    """Whether a file of the folder defines what this name on the page means."""
    line = CODELINES.line_named(name)
    return line is not None and line.file.startswith(folder)


def lost(row: Row) -> list[str]:
    """The names in a row of the first table that do not exist."""
    _, _, code, claims, z3, coq, tests, _ = (re.findall(r"`([^`]+)`", cell) for cell in row)
    theorems = {theorem.name for theorem in catalogue()}
    return [
        *(name for name in code if not found(name, "topo_verify/")),
        *(name for name in claims if name not in CLAIMS),
        *(name for name in z3 if name not in theorems),
        *(name for name in coq if not found(name, "topo_verify/proofs/coq/")),
        *(name for name in tests if not found(name, "tests/")),
    ]


def test_every_name_of_a_sentence_exists() -> None:
    assert {row[1]: names for row in SENTENCES if (names := lost(row))} == {}


STATEMENTS = [
    ("I", "requires a marking aid"),
    ("I", "undirected is not enough"),
    ("I, II-C", "mapped deterministically"),
    ("I", "worst case is O(m²n)"),
    ("I", "up to 60 %"),
    ("I, II-B", "trivial lower bound"),
    ("II-A", "embedded graph"),
    ("II-A", "leaves by an exit"),
    ("II-A", "senses the marker"),
    ("II-A", "future research"),
    ("II-B", "number of edge traversals"),
    ("II-C", "map S grows"),
    ("II-C", "traverses S to vk"),
    ("II-C", "signature of vu is a hypothesis"),
    ("II-C", "motion sequence"),
    ("II-C", "expected perception"),
    ("II-C", "hypothesis is confirmed"),
    ("II-C", "first mismatch"),
    ("II-C", "is a loop"),
    ("II-C", "vu is new"),
    ("II-C", "U is empty"),
    ("III", "more than 10,000"),
    ("III", "do not improve O(m²n)"),
    ("III-A", "Stage 1"),
    ("III-A", "Stage 2"),
    ("III-A", "after (2,1,3,1,2)"),
    ("III-A", "Pnon-overlap"),
    ("III-A", "Two traversals"),
    ("III-A", "greedy"),
    ("III-A", "no movement"),
    ("III-B", "traced on S from the hypothesis"),
    ("III-B", "(3,2,1,4) saw"),
    ("III-B", "stops at an unexplored edge"),
    ("III-B", "incorporates stage 1"),
    ("III-C", "behind unexplored edges"),
    ("III-C", "One level"),
    ("III-C", "All levels: every"),
    ("III-C", "must then see [6,A] [4,A]"),
    ("III-C", "Example, all levels"),
    ("III-C", "more memory"),
    ("III-C", "comes from S"),
    ("IV", "reduces the cost of the one before it"),
    ("IV", "densely connected"),
    ("IV", "from 14000 to about 4500"),
    ("V", "no extra motions"),
]
"""What the paper states, section by section: each is one row of the page, and no row is another."""


def missing(rows: list[Row]) -> list[tuple[str, str]]:
    """The statements that are not exactly one row."""
    return [
        (section, words)
        for section, words in STATEMENTS
        if sum(row[0] == section and words in row[1] for row in rows) != 1
    ]


def test_no_statement_of_the_paper_is_missing() -> None:
    assert missing(SENTENCES) == []
    assert len(SENTENCES) == len(STATEMENTS)
    assert {section for section, _ in missing(SENTENCES[:-1])} == {"V"}


def test_the_page_counts_its_outcomes() -> None:
    counts = Counter(row[7] for row in SENTENCES)
    in_part = "measured for II and III; open for I"
    outcomes = ("followed", "proved", "measured", in_part, "on average", "not reproduced")
    assert set(counts) == {*outcomes}
    (said,) = re.findall(
        r"Of its (\d+) statements (\d+) are followed .* (\d+) are proved, (\d+) are measured, "
        r"(\d+) is measured for II and III and open for I, (\d+) hold on average only, "
        r"and (\d+) are not reproduced\.",
        PAGE,
    )
    assert [*map(int, said)] == [
        len(SENTENCES),
        *(counts[outcome] for outcome in outcomes),
    ]
    assert all("`" in row[5] for row in SENTENCES if row[7] == "proved")


def test_each_sentence_has_code_and_a_test() -> None:
    assert all("`" in row[2] and "`" in row[6] for row in SENTENCES)


@pytest.mark.parametrize("column", [2, 3, 4, 5, 6])
def test_a_name_that_was_changed_is_seen(column: int) -> None:
    row = next(row for row in SENTENCES if all("`" in cell for cell in row[2:7]))
    changed = [re.sub(r"`$", "x`", cell) if at == column else cell for at, cell in enumerate(row)]
    assert not lost(row)
    assert len(lost(tuple(changed))) == 1


@pytest.mark.parametrize("listing", LINES)
def test_every_line_of_a_listing_is_on_the_page_once(listing: int) -> None:
    lines = [int(line) for row in LISTINGS for line in re.findall(r"\d+", row[listing - 1])]
    assert sorted(lines) == list(range(1, LINES[listing] + 1))


def carriers() -> dict[tuple[int, int], set[str]]:
    """The functions whose code carries the number of a line, by listing and line."""
    found = defaultdict[tuple[int, int], set[str]](set)
    for path in FILES:
        file = f"algorithms/{path.name}"
        for name in functions(ast.parse(source(f"topo_verify/{file}")).body):
            for line in cited(_whole(text_of(f"topo_verify/{file}", name))):
                found[line].add(f"{file}:{name}")
    return found


def functions(scope: list[ast.stmt], prefix: str = "") -> Iterator[str]:
    """The dotted names of the functions and methods in a scope."""
    for node in scope:
        if isinstance(node, ast.ClassDef):
            yield from functions(node.body, f"{prefix}{node.name}.")
        elif isinstance(node, ast.FunctionDef):
            yield prefix + node.name


def test_a_line_stands_beside_every_function_that_carries_its_number() -> None:
    carry = carriers()
    for *numbers, what, code in LISTINGS:
        lines = [
            (listing, int(line))
            for listing, cell in enumerate(numbers, 1)
            for line in re.findall(r"\d+", cell)
        ]
        assert {*re.findall(r"`([^`]+)`", code)} == {n for at in lines for n in carry[at]}, what


def test_a_line_under_the_wrong_function_is_seen() -> None:
    found = set(cited(_whole(text_of("topo_verify/algorithms/exploration.py", "execute"))))
    assert (1, 20) not in found
    assert (1, 9) in found


def _whole(text: str) -> str:
    """A definition as a file of its own: a method has its indent taken away."""
    lines = text.splitlines()
    indent = len(lines[0]) - len(lines[0].lstrip())
    return "\n".join(line[indent:] for line in lines) + "\n"
