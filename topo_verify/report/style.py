"""One style for terminal, page, badge and figures: the tone of each verdict, and the palette.

A **tone** says what a verdict settles. It has a colour and, where something fails or stays open, a
mark. No statement rests on colour: the verdicts begin with five letters, P E S U R.

The palette is that of the player's page, so that a report and the players in it look alike.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

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
    """A verdict with its mark, if its tone has one; any other word as it is."""
    mark = MARKS.get(tone, "") if tone is not None and word in VERDICTS else ""
    return f"{mark} {word}".lstrip()
