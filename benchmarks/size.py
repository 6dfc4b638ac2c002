"""Lines of code and words of the main house by room, of each extra, and of documentation by page.

    .venv/bin/python benchmarks/size.py

A line of code holds a token and no docstring, comment or blank. The longest chain of imports is
that of the main house at load time, circles excluded. `docs` counts the words in docstrings of
modules, classes and functions; `words` also those in comments and in strings below constants. A
word of a page holds a letter or a digit.
"""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

import networkx as nx

ROOT = Path(__file__).resolve().parent.parent
EXTRA = ROOT / "topo_verify" / "extra"
MAIN = "the main house"
SILENT = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENDMARKER,
}


def docstrings(source: str) -> list[ast.Constant]:
    return [
        node.value
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
    ]


def code_lines(source: str) -> int:
    lines: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type not in SILENT:
            lines |= set(range(token.start[0], token.end[0] + 1))
    for text in docstrings(source):
        lines -= set(range(text.lineno, (text.end_lineno or text.lineno) + 1))
    return len(lines)


def import_lines(source: str) -> int:
    return sum(
        (node.end_lineno or node.lineno) - node.lineno + 1
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Import | ast.ImportFrom)
    )


def words(source: str) -> int:
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    comments = sum(len(t.string.split()) - 1 for t in tokens if t.type == tokenize.COMMENT)
    return comments + sum(len(str(text.value).split()) for text in docstrings(source))


def documented(source: str) -> int:
    kinds = ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef
    owners = [node for node in ast.walk(ast.parse(source)) if isinstance(node, kinds)]
    return sum(len((ast.get_docstring(node) or "").split()) for node in owners)


def longest_chain() -> list[str]:
    """The longest chain of modules of the main house that import each other at load time."""
    files = {
        ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"): path
        for path in (ROOT / "topo_verify").rglob("*.py")
        if EXTRA not in path.parents
    }
    arrows: dict[str, set[str]] = {}
    for module, path in files.items():
        names: set[str] = set()
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, ast.ImportFrom) and node.module:
                names |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
            elif isinstance(node, ast.Import):
                names |= {alias.name for alias in node.names}
        arrows[module] = (names & files.keys()) - {module}

    graph = nx.DiGraph((module, other) for module in arrows for other in arrows[module])
    whole = nx.condensation(graph)  # modules that import each other count as one
    path = nx.dag_longest_path(whole)
    return [min(whole.nodes[node]["members"]) for node in path]


BLOCKS = re.compile(r"^```.*?^```$|^    [^\n]*$", re.MULTILINE | re.DOTALL)
"""Code, commands and output on a page."""


def pages() -> dict[str, tuple[int, int]]:
    """The words of each page: all, and those outside of blocks."""
    paths = [*(ROOT / "docs").rglob("[!_]*.md"), *ROOT.glob("*.md")]
    texts = {str(path.relative_to(ROOT)): path.read_text(encoding="utf-8") for path in paths}
    return {
        name: (page_words(text), page_words(BLOCKS.sub("", text))) for name, text in texts.items()
    }


def page_words(text: str) -> int:
    return sum(any(map(str.isalnum, word)) for word in text.split())


def print_pages() -> None:
    print(f"{'page':<42}{'words':>9}{'prose':>9}")
    counts = pages()
    for name in sorted(counts, key=lambda name: (-counts[name][0], name)):
        print(f"{name:<42}{counts[name][0]:>9,}{counts[name][1]:>9,}")
    total, prose = (sum(count[part] for count in counts.values()) for part in (0, 1))
    print(f"{'all pages':<42}{total:>9,}{prose:>9,}")
    print()


def sums_of(path: Path) -> Iterator[str]:
    """The names of the sums in which a file counts: its tree, its room or extra, the main house."""
    top, *rooms, _ = path.relative_to(ROOT).parts
    yield top
    if EXTRA in path.parents:
        yield "/".join([top, *rooms[:2]])
        return
    if top == "topo_verify":
        yield MAIN
    yield f"{top}/{rooms[0]}" if rooms else f"{top}/*.py"


def main() -> None:
    print(f"{'room':<30}{'files':>7}{'code':>9}{'imports':>9}{'docs':>9}{'words':>9}")
    for top in ("topo_verify", "research", "tests", "benchmarks"):
        rooms: dict[str, list[int]] = defaultdict(lambda: [0] * 5)
        for path in sorted((ROOT / top).rglob("*.py")):
            source = path.read_text()
            counts = (code_lines, import_lines, documented, words)
            numbers = (1, *(count(source) for count in counts))
            for room in sums_of(path):
                rooms[room] = [a + b for a, b in zip(rooms[room], numbers, strict=True)]
        for room in sorted(rooms, key=lambda room: (room != top, room != MAIN, room)):
            print(
                f"{room:<30}"
                + "".join(f"{number:>9,}"[2 * (not k) :] for k, number in enumerate(rooms[room]))
            )
        print()
    print_pages()
    chain = longest_chain()
    print(f"longest chain of imports: {len(chain)} modules")
    print("  " + " > ".join(module.removeprefix("topo_verify.") for module in chain))


if __name__ == "__main__":
    main()
