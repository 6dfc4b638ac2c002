"""The commands that a page of docs/ shows, each with the output that stands behind it."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
_COMMAND = r"^    \.venv/bin/topo-verify ([^\n]*)\n\n```\n(.*?)```$"


def commands_on(page: str) -> list[tuple[str, str]]:
    """The command lines on a page of docs/, without the program's name, and what each prints."""
    text = (ROOT / "docs" / page).read_text()
    return re.findall(_COMMAND, text, re.MULTILINE | re.DOTALL)
