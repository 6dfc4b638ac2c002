"""What a user who misspelt a TARGET may have meant.

A file is parsed and not run: a hint must not have effects.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from pathlib import Path
from typing import cast

SHOWN = 5
"""So many names are listed where none is close."""


def close_name(name: str, known: Iterable[str]) -> str:
    """`; did you mean 'explore'?`, or nothing if no known name is close."""
    close = get_close_matches(name, list(known), n=1)
    return f"; did you mean {close[0]!r}?" if close else ""


def close_attribute(whole: object, name: str) -> str:
    """The attribute that was meant, else the first that could be; nothing if there is none."""
    known = [key for key in _callables(whole) if not key.startswith("_")]
    listed = f"; it has {', '.join(known[:SHOWN])}" if known else ""
    return close_name(name, known) or listed


def _callables(whole: object) -> list[str]:
    """The names of the callables in a mapping, or of those that a module defines itself."""
    if isinstance(whole, Mapping):
        return [
            key for key, value in cast("Mapping[str, object]", whole).items() if callable(value)
        ]
    entries: dict[str, object] = getattr(whole, "__dict__", {})
    # What a module has imported from elsewhere is no mapper of its own.
    home = getattr(whole, "__name__", None)
    return [
        key
        for key, value in entries.items()
        if callable(value) and getattr(value, "__module__", None) == home
    ]


def missing_attribute(name: str) -> str | None:
    """How to name a mapper in a file, if the name is that of a file or of a module beside us."""
    place = Path(name) if name.endswith(".py") else Path(f"{name.replace('.', '/')}.py")
    if not place.is_file():
        return f"there is no file {name!r}" if name.endswith(".py") else None
    try:
        body = ast.parse(place.read_bytes()).body
    except (SyntaxError, ValueError, OSError):
        body = []
    makers = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
    found = [node.name for node in body if isinstance(node, makers) and node.name[0] != "_"]
    first = found[0] if found else "explore"
    listed = f" (it has {', '.join(found[:SHOWN])})" if found else ""
    return f"{place} is a file; name a mapper in it, as {name}:{first}{listed}"
