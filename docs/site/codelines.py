"""The lines of the code that explanation/paper.md names: `file.py:function` gets its line number.

In the Markdown there are no numbers, because every change of a file would make them wrong.
"""

from __future__ import annotations

import ast
import re
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx

PACKAGE = Path(__file__).resolve().parents[2] / "topo_verify"
PAGE = "explanation/paper"


def line_of(source: str, name: str) -> int | None:
    """The line at which a function, class, method or constant begins in a source; None if none."""
    scope: list[ast.stmt] = ast.parse(source).body
    line = None
    for part in name.split("."):
        found = next((node for node in scope if part in _names(node)), None)
        if found is None:
            return None
        line, scope = found.lineno, getattr(found, "body", [])
    return line


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


def _add_lines(_app: Sphinx, doctree: nodes.document, page: str) -> None:
    if page != PAGE:
        return
    for code in list(doctree.findall(nodes.literal)):
        if named := re.fullmatch(r"([\w/]+\.py):([\w.]+)", code.astext()):
            path = PACKAGE / named[1]
            if path.exists() and (line := line_of(path.read_text(encoding="utf-8"), named[2])):
                code.parent.insert(code.parent.index(code) + 1, nodes.Text(f" {line}"))


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.connect("doctree-resolved", _add_lines)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
