"""The code that two pages name: each name gets its line number, and a link to the line.

    `file.py:function`   of topo_verify/ or tests/
    `File.theorem`       of topo_verify/proofs/coq/

A page of the site shows each named file. In the Markdown there are no numbers, because every change
of a file would make them wrong.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from docutils import nodes
from sphinx.application import Sphinx

ROOT = Path(__file__).resolve().parents[2]
PAGES = ("explanation/paper", "explanation/run")
COQ = "topo_verify/proofs/coq"


class Line(NamedTuple):
    """A line of a file, which is named relative to the repository."""

    file: str
    number: int


def line_named(name: str) -> Line | None:
    """Where the code begins that a name on the page means; None if it is no such name."""
    if python := re.fullmatch(r"([\w/]+\.py):([\w.]+)", name):
        files, find = [f"topo_verify/{python[1]}", f"tests/{python[1]}"], line_of
    elif python := re.fullmatch(r"(\w+)\.(\w+)", name):
        files, find = [f"{COQ}/{python[1]}.v"], _line_in_coq
    else:
        return None
    for file in files:
        path = ROOT / file
        if path.exists() and (number := find(path.read_text(encoding="utf-8"), python[2])):
            return Line(file, number)
    return None


def line_of(source: str, name: str) -> int | None:
    """The line at which a function, class, method or constant begins in a source; None if none."""
    node = definition(source, name)
    return node and node.lineno


def definition(source: str, name: str) -> ast.stmt | None:
    """What a source defines by this dotted name: a function, class, method or constant."""
    scope: list[ast.stmt] = ast.parse(source).body
    found = None
    for part in name.split("."):
        found = next((node for node in scope if part in _names(node)), None)
        scope = getattr(found, "body", [])
    return found


def _names(node: ast.stmt) -> list[str]:
    match node:
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
            return [name]
        case ast.Assign(targets=targets):
            return [target.id for target in targets if isinstance(target, ast.Name)]
        case ast.AnnAssign(target=ast.Name(id=name)):
            return [name]
        case _:
            return []


def _line_in_coq(source: str, name: str) -> int | None:
    found = re.search(rf"^[A-Z][a-z]+ {re.escape(name)}\b", source, re.MULTILINE)
    return found and source[: found.start()].count("\n") + 1


def _add_links(app: Sphinx, doctree: nodes.document, page: str) -> None:
    if page not in PAGES or app.builder.format != "html":
        return
    for code in list(doctree.findall(nodes.literal)):
        if line := line_named(code.astext()):
            address = app.builder.get_relative_uri(page, _page(line.file))
            link = nodes.reference("", "", refuri=f"{address}#L-{line.number}", internal=True)
            code.replace_self([link, nodes.Text(f" {line.number}")])
            link += code


def _pages(app: Sphinx) -> Iterator[tuple[str, dict[str, Any], str]]:
    """A page for each file that the pages name, with an anchor at each line."""
    texts = [(ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8") for page in PAGES]
    lines = filter(None, map(line_named, re.findall(r"`([^`\n]+)`", "\n".join(texts))))
    for file in sorted({line.file for line in lines}):
        source = (ROOT / file).read_text(encoding="utf-8")
        language = "coq" if file.endswith(".v") else "python"
        builder: Any = app.builder
        body: str = builder.highlighter.highlight_block(
            source, language, force=True, linenos="inline", lineanchors="L"
        )
        yield _page(file), {"title": file, "body": f"<h1>{file}</h1>{body}"}, "page.html"


def _page(file: str) -> str:
    return f"code/{file}"


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.connect("doctree-resolved", _add_links)
    app.connect("html-collect-pages", _pages)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
