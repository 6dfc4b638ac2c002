"""Blocks as GitHub-flavoured Markdown, for the summaries of continuous integration."""

from __future__ import annotations

import re
from collections.abc import Iterable

from topo_verify.errors import LINE, shown
from topo_verify.report import blocks as bl


def markdown(blocks: Iterable[bl.Block]) -> str:
    """The blocks as Markdown."""
    return "\n\n".join(filter(None, map(_markdown, blocks))) + "\n"


def _markdown(block: bl.Block) -> str:  # noqa: PLR0911  one for each kind of block
    match block:
        case bl.Text(text):
            verdict = bl.opening_verdict(text)
            return (
                f"**{verdict}**{_inline(text.removeprefix(verdict))}"
                if verdict
                else _paragraph(text)
            )
        case bl.Command(line, label):
            return _inline(label) + _code(line)
        case bl.Bullets(items):
            return "\n".join(f"- {_paragraph(item)}" for item in items)
        case bl.Raw(text):
            return _fenced(text)
        case bl.PictureBlock():
            return ""
        case bl.View():
            return _fenced("\n".join(block.lines(bl.WIDTH)))
        case bl.TextTable(columns, rows, title):
            head = f"**{_inline(title)}**\n\n" if title else ""
            titles = [column.removeprefix(">") for column in columns]
            rule = ["---:" if column.startswith(">") else "---" for column in columns]
            lines = [map(_cell, titles), rule, *(map(_cell, row) for row in rows)]
            return head + "\n".join(f"| {' | '.join(line)} |" for line in lines)


_LINKED = re.compile(r"@|://|www\.|#\d|\bGH-\d", re.IGNORECASE)
"""Becomes a mention or a link even behind a backslash."""

_ACTIVE = re.compile(r"[\\`*|<\[\]~&$]|(?<![^\W_])_|_(?![^\W_])")
"""Markup within a line; `_` is none within a word."""

_OPENING = re.compile(r"(\d*)([-+#>=.)])")
"""May open a list, title, rule or quotation."""


def _paragraph(text: str) -> str:
    line = _inline(text.lstrip())
    return _OPENING.sub(r"\1\\\2", line, count=1) if _OPENING.match(line) else line


def _cell(cell: str | bl.Cell) -> str:
    return re.sub(r"(?<!\\)\|", r"\\|", _escaped(bl.cell_text(cell)))


def _inline(text: str) -> str:
    return _escaped(bl.clean(text))


def _escaped(line: str) -> str:
    words = re.split(r"(\s+)", line)
    return "".join(
        _code(word) if _LINKED.search(word) else _ACTIVE.sub(r"\\\g<0>", word) for word in words
    )


def _code(text: str) -> str:
    text = shown(text, limit=LINE)
    fence = _fence(text, least=1)
    space = " " if "`" in text else ""
    return f"{fence}{space}{text}{space}{fence}"


def _fenced(text: str) -> str:
    fence = _fence(text, least=3)
    return f"{fence}\n{text}\n{fence}"


def _fence(text: str, *, least: int) -> str:
    return "`" * max(least, *(len(run) + 1 for run in re.findall("`+", text)), 0)
