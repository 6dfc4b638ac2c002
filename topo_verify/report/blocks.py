"""What a command has to say to people: paragraphs, tables, commands to copy.

A command yields blocks and does not know in which form they appear: on a terminal (terminal.py), as
Markdown (markdown.py) or in a page (page.py). Texts may come from anywhere (a world's name, a
mapper's exception); each form escapes them in its own way.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from topo_verify.errors import LINE, shortened, shown
from topo_verify.report.style import TONES, VERDICTS, Tone, marked

WIDTH = 80
"""The columns of a view in a form that has none of its own."""


@dataclass(frozen=True)
class Text:
    """A paragraph of plain text; a verdict that it begins with has its colour."""

    text: str


@dataclass(frozen=True)
class Command:
    """A command line to copy; it is never wrapped, and nothing in it is shortened."""

    line: str
    label: str = ""


@dataclass(frozen=True)
class Bullets:
    """A list of short texts, one below the other."""

    items: tuple[str, ...]


@dataclass(frozen=True)
class Cell:
    """A cell of a table that is not to be taken as its text alone says.

    Attributes:
        tone: of a verdict, in place of the usual one: a REFUTED that was expected is `held`.
        whole: a long world id in it is not shortened.
    """

    text: str
    tone: Tone | None = None
    whole: bool = False


@dataclass(frozen=True)
class TextTable:
    """A table: rows of cells.

    Attributes:
        columns: the titles; a column whose title begins with `>` is flush right, for numbers.
        rows: each has as many cells as there are columns.
        title: what the rows have in common.
        widths: fixed widths, for tables printed a row at a time; 0: the rest of the line.
        headed: whether the titles are printed. (Markdown and pages always have them.)
    """

    columns: tuple[str, ...]
    rows: Sequence[tuple[str | Cell, ...]]
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


@dataclass(frozen=True)
class PictureBlock:
    """A picture; a page shows it, and forms made of letters leave it out.

    Attributes:
        svg: the picture, as a file of its own.
        alt: what it shows, for those who do not see it.
    """

    svg: str
    alt: str


Block = Text | Command | Bullets | TextTable | Raw | View | PictureBlock


def clean(text: str) -> str:
    """The text on one line, its control characters escaped and its long ids shortened."""
    return shortened(shown(text, limit=LINE))


def cell_tone(cell: str | Cell) -> Tone | None:
    """The tone of a cell: its own, else that of the word in it, if any."""
    return TONES.get(cell) if isinstance(cell, str) else cell.tone


def cell_text(cell: str | Cell) -> str:
    """What a cell says: its text, clean, behind the mark of its verdict."""
    if isinstance(cell, str):
        return marked(clean(cell), TONES.get(cell))
    text = shown(cell.text, limit=LINE) if cell.whole else clean(cell.text)
    return marked(text, cell.tone)


def opening_verdict(text: str) -> str:
    """The verdict that a paragraph begins with, as in `REFUTED: 3 of 86 worlds`; else nothing."""
    first = text.partition(":")[0]
    return first if first in VERDICTS and first != text else ""
