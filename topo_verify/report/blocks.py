"""What a command has to say to people: paragraphs, tables, commands to copy.

A command yields blocks and does not know in which form they appear: on a terminal (terminal.py), as
Markdown (markdown.py) or in a page (page.py). Texts may come from anywhere (a world's name, a
mapper's exception); each form escapes them in its own way.

A **tone** says what a verdict settles. It has a colour and, where something fails or stays open, a
mark. No statement rests on colour: the verdicts begin with five letters, P E S U R. The palette is
that of the player's page, so a report and the players in it look alike.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

from topo_verify.errors import LINE, shortened, shown

Tone = Literal["held", "sampled", "open", "failed"]
"""`held`: of everything there is; `sampled`: of what was tried; `open`: nothing was decided."""

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
"""The tones of words that fill a cell of a table; other words have none."""

VERDICTS = ("PROVED", "EXHAUSTED", "SAMPLED", "UNKNOWN", "REFUTED")

MARKS: dict[Tone, str] = {"failed": "!", "open": "?"}
"""What stands before a verdict that is no pass, for those who see no colour."""

ON_TERMINAL: dict[Tone, str] = {
    "held": "bold green",
    "sampled": "bold cyan",
    "open": "bold yellow",
    "failed": "bold red",
}
"""Rich's styles. With NO_COLOR they are bold alone."""


class Colour(NamedTuple):
    """A colour on light ground and on dark."""

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
"""The colours of pages and figures, by the names that the player's style sheet gives them."""

OF_TONE: dict[Tone, str] = {"held": "home", "sampled": "e", "open": "guess", "failed": "mark"}
"""The colour of the palette that each tone has."""


def marked(word: str, tone: Tone | None) -> str:
    """A verdict with its mark, if its tone has one; any other word unchanged."""
    mark = MARKS.get(tone, "") if tone is not None and word in VERDICTS else ""
    return f"{mark} {word}".lstrip()


WIDTH = 80
"""Columns of a view where the output has no width, as in pages."""


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
        svg: the picture, as a whole file.
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
