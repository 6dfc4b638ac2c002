"""What a page of docs/ shows and a test can try: commands with their output, files, Python."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Literal

ROOT = Path(__file__).resolve().parents[1]
_BLOCK = re.compile(
    r"^```(?P<language>[\w{}]*)\n(?P<body>.*?)^```$|^    (?P<line>\S[^\n]*)$",
    re.MULTILINE | re.DOTALL,
)
_NAMED = re.compile(r"(?:#|//) ([\w.]+\.(?:py|js)): ")
_LINES = re.compile(r"# lines of ([\w.]+)\n")


@dataclass(frozen=True)
class Step:
    """One thing that a reader of a page does, in the order of the page.

    Attributes:
        kind: `command`: a line for the shell. `file`: a block that begins with its file's name.
            `python`: a block to be run. `lines`: a block with lines of a file. `other`: the rest.
        text: the line, or the block.
        name: of the file, for `file` and `lines`.
        shown: what the page says that the command prints; None if it does not say.
    """

    kind: Literal["command", "file", "python", "lines", "other"]
    text: str
    name: str = ""
    shown: str | None = None


def agrees(shown: str, printed: str) -> bool:
    """Whether a page shows what was printed; its line `…` stands for one line or more."""
    parts = re.split(r"^…\n", shown, flags=re.MULTILINE)
    return re.fullmatch(r"(?:.*\n)+?".join(map(re.escape, parts)), printed) is not None


def steps(text: str) -> list[Step]:
    """What a page asks its reader to do."""
    blocks = list(_BLOCK.finditer(text))
    found = list[Step]()
    for block, after in pairwise([*blocks, None]):
        assert block is not None
        if line := block["line"]:
            shown = None
            if after and after["line"] is None and not after["language"]:
                between = text[block.end() : after.start()]
                shown = after["body"] if not between.strip() else None
            found.append(Step("command", line, shown=shown))
        elif block["language"]:
            found.append(_step(block["language"], block["body"]))
    return found


def _step(language: str, body: str) -> Step:
    if named := _NAMED.match(body):
        return Step("file", body, named[1])
    if lines := _LINES.match(body):
        return Step("lines", body[lines.end() :], lines[1])
    return Step("python" if language == "python" else "other", body)


def links_on(text: str) -> Iterator[str]:
    """The targets of the links and pictures in a page's running text."""
    prose = re.sub(r"^```.*?^```$|`[^`\n]*`", "", text, flags=re.MULTILINE | re.DOTALL)
    for target in re.findall(r"\]\(([^)\s]+)\)", prose):
        yield str(target)
