"""The trusted rooms stay small enough to be read and believed: lines, branches, and their sum.

Everything that topo-verify says rests on these rooms, so no function in them exceeds 40 lines or
12 branches, and the checkers together stay under 900 lines of code. A line of code is a line with
at least one token that is neither comment nor docstring: words that explain cost nothing.

What this does not show: that a short function is a plain one. That is for the reader to judge.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from benchmarks.size import code_lines

PACKAGE = Path(__file__).resolve().parent.parent / "topo_verify"

TRUSTED = (
    *("checkers", "robot", "world/rooted_map.py"),
    "world/enumeration",
)
"""Files and rooms in which a mistake would make a false verdict."""

MOST_LINES, MOST_BRANCHES, MOST_CODE = 40, 12, 900

Function = ast.FunctionDef | ast.AsyncFunctionDef


def trusted_files() -> Iterator[Path]:
    """Every Python file of the trusted rooms."""
    for name in TRUSTED:
        path = PACKAGE / name
        yield from [path] if path.is_file() else sorted(path.rglob("*.py"))


def functions(tree: ast.AST) -> list[Function]:
    """All functions, methods and nested functions in a tree."""
    return [node for node in ast.walk(tree) if isinstance(node, Function)]


def branches(function: ast.AST) -> int:
    """The number of places where a function, nested functions included, takes one of two ways.

    One each: `if`, `for`, `while`, `case`, `except`, a conditional expression, each operand of
    `and` and `or` beyond the first, each `for` and each `if` of a comprehension.
    """
    number = 0
    for node in ast.walk(function):
        match node:
            case ast.BoolOp(_, values):
                number += len(values) - 1
            case ast.comprehension(_, _, conditions):
                number += 1 + len(conditions)
            case (
                ast.If()
                | ast.For()
                | ast.AsyncFor()
                | ast.While()
                | ast.match_case()
                | ast.ExceptHandler()
                | ast.IfExp()
            ):
                number += 1
            case _:
                pass
    return number


def lines(function: Function) -> int:
    """The lines of a function from `def` to its end, docstring and comments included."""
    return (function.end_lineno or function.lineno) - function.lineno + 1


def excesses(source: str) -> list[str]:
    """A sentence on each function that is longer or more branched than a trusted one may be."""
    found: list[str] = []
    for function in functions(ast.parse(source)):
        if (length := lines(function)) > MOST_LINES:
            found.append(f"{function.name}: {length} lines, at most {MOST_LINES}")
        if (number := branches(function)) > MOST_BRANCHES:
            found.append(f"{function.name}: {number} branches, at most {MOST_BRANCHES}")
    return found


# ---------------------------------------------------------------- the trusted rooms


@pytest.mark.parametrize(
    "path", [*trusted_files()], ids=lambda path: str(path.relative_to(PACKAGE))
)
def test_no_trusted_function_is_too_long_or_too_branched(path: Path) -> None:
    found = excesses(path.read_text())
    assert not found, "let a part of it have a name"


def test_the_checkers_together_stay_small_enough_to_trust() -> None:
    code = sum(code_lines(path.read_text()) for path in (PACKAGE / "checkers").rglob("*.py"))
    assert 0 < code < MOST_CODE


# ---------------------------------------------------------------- the counter itself


@pytest.mark.parametrize(
    ("number", "body"),
    [
        (0, "return 1"),
        (1, "if x: pass"),
        (2, "if x: pass\n elif y: pass\n else: pass"),
        (1, "for i in x: pass\n else: pass"),
        (1, "while x: pass"),
        (3, "match x:\n  case 1: pass\n  case 2 | 3: pass\n  case _: pass"),
        (2, "try: pass\n except A: pass\n except (B, C): pass\n finally: pass"),
        (1, "return a and b"),
        (3, "return a and b and c or d"),
        (0, "return not a"),
        (1, "return a if x else b"),
        (1, "return [i for i in x]"),
        (5, "return {i: j for i in x if i if i > 1 for j in i if j}"),
        (2, "return any(i or j for i in x)"),
        (1, "def inner():\n  if x: pass"),
        (3, "async def g():\n  async for i in x:\n   yield lambda: 1 if i else 2\n return a or b"),
    ],
)
def test_the_counter_of_branches_counts(number: int, body: str) -> None:
    assert branches(ast.parse(f"def f():\n {body}")) == number


def test_a_function_of_13_branches_or_41_lines_is_seen() -> None:
    twelve = "def f(x):\n" + " if x: pass\n" * 12
    assert excesses(twelve) == []
    assert excesses(twelve + " return x or 1") == ["f: 13 branches, at most 12"]
    forty = "class A:\n async def f(x):\n" + "  x\n" * 39
    assert excesses(forty) == []
    assert excesses(forty + "  x") == ["f: 41 lines, at most 40"]


def test_lines_of_code_are_counted_without_words() -> None:
    source = '''"""A docstring
of two lines."""

# a comment
LIMIT = 3  # with a comment: counts
"""What it is for."""


def f(text="""two
lines"""):
    """Docstring."""
    return (
        text
    )
'''
    assert code_lines(source) == 1 + 2 + 3
