"""Blocks of output for people, printed on a terminal or written as Markdown.

A command yields blocks and does not know in which form they appear. Texts may come from anywhere (a
world's name, a mapper's exception), so control characters are escaped here.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import IO, TYPE_CHECKING

from topo_verify.text import LINE, shown

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table as RichTable

WIDTH = 80
"""The width in columns if the output is not a terminal."""

STYLES = {
    "PROVED": "bold green",
    "EXHAUSTED": "bold green",
    "SAMPLED": "bold cyan",
    "UNKNOWN": "bold yellow",
    "REFUTED": "bold red",
    "ok": "green",
    "failed": "bold red",
    "incomplete": "bold yellow",
}
"""The styles of words that fill a cell of a table on a terminal."""


@dataclass(frozen=True)
class Text:
    """A paragraph of plain text."""

    text: str


@dataclass(frozen=True)
class Command:
    """A command line to copy; it is never wrapped."""

    line: str
    label: str = ""


@dataclass(frozen=True)
class Bullets:
    """A list of short texts, one below the other."""

    items: tuple[str, ...]


@dataclass(frozen=True)
class TextTable:
    """A table: rows of cells.

    Attributes:
        columns: the titles; a column whose title begins with `>` is flush right, for numbers.
        rows: each has as many cells as there are columns.
        title: what the rows have in common.
        widths: fixed widths, for tables printed a row at a time; 0: the rest of the line.
        headed: whether the titles are printed. (Markdown always has them.)
    """

    columns: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]
    title: str = ""
    widths: tuple[int, ...] = ()
    headed: bool = True


@dataclass(frozen=True)
class Raw:
    """Text for another program, printed unchanged."""

    text: str


@dataclass(frozen=True)
class View:
    """Lines that are laid out for the width of the output.

    Attributes:
        lines: the lines for a width in columns; no control characters are left in them.
    """

    lines: Callable[[int], Iterable[str]]


Block = Text | Command | Bullets | TextTable | Raw | View


# ---------------------------------------------------------------- on a terminal


def pretty(blocks: Iterable[Block], out: IO[str]) -> None:
    """Print the blocks: in colour on a terminal, else 80 columns wide."""
    console = None
    for block in blocks:
        if isinstance(block, Raw):
            out.write(block.text + "\n")  # not by Rich, which would wrap it and takes its time
            continue
        console = console or _console(out)
        if isinstance(block, View):
            out.writelines(f"{line}\n" for line in block.lines(console.width))
            continue
        with console.capture() as printed:
            _print(block, console)
        # Rich fills its lines with spaces.
        out.writelines(f"{line.rstrip()}\n" for line in printed.get().splitlines())


def _console(out: IO[str]) -> Console:
    from rich.console import Console

    wide = None if out.isatty() else WIDTH
    return Console(file=out, width=wide, highlight=False, markup=False, emoji=False)


def _print(block: Text | Command | Bullets | TextTable, console: Console) -> None:
    from rich.padding import Padding
    from rich.text import Text as Line

    match block:
        case Text(text):
            console.print(Line(_clean(text)))
        case Command(line, label):
            console.print(Line(f"  {label}{_clean(line)}"), soft_wrap=True)
        case Bullets(items):
            for item in items:
                console.print(Padding(Line(_clean(item)), (0, 0, 0, 2)))
        case TextTable():
            if block.title:
                console.print(Line(_clean(block.title), style="bold"))
            console.print(_grid(block))


def _grid(block: TextTable) -> RichTable:
    from rich.table import Table as RichTable
    from rich.text import Text as Line

    grid = RichTable(box=None, show_header=block.headed, pad_edge=False, padding=(0, 2, 0, 0))
    for place, title in enumerate(block.columns):
        grid.add_column(
            _clean(title.removeprefix(">")),
            justify="right" if title.startswith(">") else "left",
            overflow="fold",
            # Rich takes None, not 0, for the rest of the line.
            width=block.widths[place] or None if block.widths else None,
        )
    for row in block.rows:
        grid.add_row(*(Line(_clean(cell), style=STYLES.get(cell, "")) for cell in row))
    return grid


def _clean(text: str) -> str:
    return shown(text, limit=LINE)


# ---------------------------------------------------------------- as Markdown


def markdown(blocks: Iterable[Block]) -> str:
    """The blocks as Markdown (with the tables of GitHub)."""
    return "\n\n".join(filter(None, map(_markdown, blocks))) + "\n"


def _markdown(block: Block) -> str:
    match block:
        case Text(text):
            return _paragraph(text)
        case Command(line, label):
            return _inline(label) + _code(line)
        case Bullets(items):
            return "\n".join(f"- {_paragraph(item)}" for item in items)
        case Raw(text):
            return _fenced(text)
        case View():
            return _fenced("\n".join(block.lines(WIDTH)))
        case TextTable(columns, rows, title):
            head = f"**{_inline(title)}**\n\n" if title else ""
            titles = [column.removeprefix(">") for column in columns]
            rule = ["---:" if column.startswith(">") else "---" for column in columns]
            lines = [map(_cell, titles), rule, *(map(_cell, row) for row in rows)]
            return head + "\n".join(f"| {' | '.join(line)} |" for line in lines)


_LINKED = re.compile(r"@|://|www\.|#\d|\bGH-\d", re.IGNORECASE)
"""What GitHub and GitLab make a mention or a link of, whether or not a backslash precedes it."""

_ACTIVE = re.compile(r"[\\`*|<\[\]~&$]|(?<![^\W_])_|_(?![^\W_])")
"""Characters that mean something within a line of Markdown; `_` does not within a word."""

_OPENING = re.compile(r"(\d*)([-+#>=.)])")
"""What may open a list, a title, a rule or a quotation at the start of a paragraph."""


def _paragraph(text: str) -> str:
    """The text as a paragraph of its own that begins nothing else."""
    line = _inline(text.lstrip())
    return _OPENING.sub(r"\1\\\2", line, count=1) if _OPENING.match(line) else line


def _cell(text: str) -> str:
    """The text as a cell of a table, where a `|` counts even within code."""
    return re.sub(r"(?<!\\)\|", r"\\|", _inline(text))


def _inline(text: str) -> str:
    """The text so that it appears as it is; a word that would be a link is set as code."""
    words = re.split(r"(\s+)", _clean(text))
    return "".join(
        _code(word) if _LINKED.search(word) else _ACTIVE.sub(r"\\\g<0>", word) for word in words
    )


def _code(text: str) -> str:
    text = _clean(text)
    fence = _fence(text, least=1)
    space = " " if "`" in text else ""
    return f"{fence}{space}{text}{space}{fence}"


def _fenced(text: str) -> str:
    fence = _fence(text, least=3)
    return f"{fence}\n{text}\n{fence}"


def _fence(text: str, *, least: int) -> str:
    """Backticks, more than stand anywhere in the text."""
    return "`" * max(least, *(len(run) + 1 for run in re.findall("`+", text)), 0)
