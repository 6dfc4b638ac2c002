"""What a command says to people, before it takes a form: paragraphs, tables, commands to copy.

Each form escapes the texts, which may hold anything: a world's name, a mapper's exception. A
**tone** says what a verdict settles; it has a colour and, where something failed or is open, a
mark.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

from topo_verify.errors import LINE, shortened, shown

Tone = Literal["held", "sampled", "open", "failed"]
"""`held`: in everything there is; `sampled`: in what was tried; `open`: undecided."""

TONES: dict[str, Tone] = {
    "PROVED": "held",
    "EXHAUSTED": "held",
    "SAMPLED": "sampled",
    "UNKNOWN": "open",
    "REFUTED": "failed",
    "ok": "held",
    "failed": "failed",
    "not ok": "failed",
    "no": "failed",
    "partial": "open",
    "undecided": "open",
    "incomplete": "open",
    "?": "open",
}
"""The tone of a word that fills a cell."""

VERDICTS = ("PROVED", "EXHAUSTED", "SAMPLED", "UNKNOWN", "REFUTED")

MARKS: dict[Tone, str] = {"failed": "!", "open": "?"}

ON_TERMINAL: dict[Tone, str] = {
    "held": "bold green",
    "sampled": "bold cyan",
    "open": "bold yellow",
    "failed": "bold red",
}
"""Rich's styles; with NO_COLOR only the weight remains."""


class Colour(NamedTuple):
    """A colour on a light and on a dark ground."""

    light: str
    dark: str


PALETTE = {
    "card": Colour("#fdfcf9", "#14181c"),
    "bg": Colour("#f1f0ec", "#0c0f12"),
    "land": Colour("#eef0ee", "#20262c"),
    "line": Colour("#dcdcd6", "#2a3138"),
    "ink": Colour("#22282e", "#e8eaec"),
    "soft": Colour("#5c656e", "#9aa4ae"),
    "road": Colour("#8a939c", "#717c87"),
    "faint": Colour("#b3bac0", "#4a545e"),
    "e": Colour("#1f6feb", "#6cb0ff"),
    "guess": Colour("#c2510c", "#ff9d5c"),
    "home": Colour("#1a7f4b", "#56d090"),
    "mark": Colour("#b3261e", "#ff8078"),
    "back": Colour("#7a5cc4", "#b39ddb"),
}
"""Named as in the player's style sheet."""

OF_TONE: dict[Tone, str] = {"held": "home", "sampled": "e", "open": "guess", "failed": "mark"}


def marked(word: str, tone: Tone | None) -> str:
    """A verdict with the mark of its tone; other words unchanged."""
    mark = MARKS.get(tone, "") if tone is not None and word in VERDICTS else ""
    return f"{mark} {word}".lstrip()


WIDTH = 80
"""Columns of a view in an output without a width."""


@dataclass(frozen=True)
class Text:
    """A paragraph; an opening verdict is coloured."""

    text: str


@dataclass(frozen=True)
class Command:
    """A command line to copy, never wrapped or shortened."""

    line: str
    label: str = ""


@dataclass(frozen=True)
class Bullets:
    """A list of short texts."""

    items: tuple[str, ...]


@dataclass(frozen=True)
class Cell:
    """A cell of a table.

    Attributes:
        tone: in place of the word's usual one: an expected REFUTED is `held`.
        whole: long world ids are not shortened.
    """

    text: str
    tone: Tone | None = None
    whole: bool = False


@dataclass(frozen=True)
class TextTable:
    """A table of text, with one tuple of cells a row.

    Attributes:
        columns: titles; a leading `>` means flush right.
        widths: for tables printed row by row; 0: the rest of the line.
        headed: print the titles. Markdown and pages always do.
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
    """Lines laid out for a width in columns, without control characters."""

    lines: Callable[[int], Iterable[str]]


@dataclass(frozen=True)
class PictureBlock:
    """An SVG file for pages; forms made of text leave it out."""

    svg: str
    alt: str


Block = Text | Command | Bullets | TextTable | Raw | View | PictureBlock


def clean(text: str) -> str:
    """The text on one line, control characters escaped, long ids shortened."""
    return shortened(shown(text, limit=LINE))


def cell_tone(cell: str | Cell) -> Tone | None:
    """The cell's tone, else that of its word, if any."""
    return TONES.get(cell) if isinstance(cell, str) else cell.tone


def cell_text(cell: str | Cell) -> str:
    """The cell's clean text behind its mark."""
    if isinstance(cell, str):
        return marked(clean(cell), TONES.get(cell))
    text = shown(cell.text, limit=LINE) if cell.whole else clean(cell.text)
    return marked(text, cell.tone)


def opening_verdict(text: str) -> str:
    """The verdict that opens a paragraph, as in `REFUTED: 3 of 86 worlds`; else ""."""
    first = text.partition(":")[0]
    return first if first in VERDICTS and first != text else ""
