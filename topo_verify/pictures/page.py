"""The player: a run in the browser, as one self-contained file that makes no request.

A content security policy allows exactly the scripts of `page/`, by their hashes. What a mapper, a
world or a file name brings is data in JSON, with `<` escaped, and becomes text nodes.
"""

from __future__ import annotations

import base64
import hashlib
import html
import json
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from os import PathLike
from pathlib import Path

from topo_verify.errors import InputError, shown
from topo_verify.pictures.recording import PlayedRun, recording
from topo_verify.world.rooted_map import World

SCRIPTS = (
    "geometry.js",
    "model.js",
    "panes.js",
    "world_pane.js",
    "question.js",
    "map_pane.js",
    "chart.js",
    "frame.js",
    "player.js",
    "fold.js",
    "walk_world.js",
    "walk_model.js",
    "sketch.js",
    "walk.js",
    "start.js",
)


@dataclass(frozen=True)
class PageShell:
    """The page around a recording, the same for every run.

    Attributes:
        before, after: the text around the recording.
        style, script: the sources in its content security policy.
    """

    before: str
    after: str
    style: str
    script: str


def page_shell(title: str = "A run, step by step") -> PageShell:
    """The page without a run, for a page that holds several of them."""
    style = part("page.css") + part("walk.css")
    script = "".join(["'use strict';\n", *map(part, SCRIPTS)])
    policy = (
        f"default-src 'none'; style-src {source_hash(style)}; script-src {source_hash(script)};"
        " base-uri 'none'; form-action 'none'"
    )
    values = {
        "policy": policy,
        "title": html.escape(title),
        "style": style,
        "script": script,
    }
    whole = part("head.html") + part("page.html")
    before, after = (mark_up(half, values) for half in whole.split("{recording}"))
    return PageShell(before, after, source_hash(style), source_hash(script))


def mark_up(template: str, values: Mapping[str, str]) -> str:
    """The template with its names in braces replaced; inserted values are not searched."""
    return re.sub(r"\{([a-z]+)\}", lambda match: values[match[1]], template)


def json_in_page(data: object) -> str:
    """The data as JSON that can stand in a script element."""
    # Only "<" can end or open anything in a script; the JSON stays the same.
    return json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")


NO_PAGES = (".gif", ".jpeg", ".jpg", ".json", ".pdf", ".png", ".svg")


def require_page(path: str | PathLike[str]) -> None:
    """Raise InputError if the name promises something else than a page (HTML)."""
    if Path(path).suffix.lower() in NO_PAGES:
        raise InputError(f"{shown(path)}: a run is shown by a page; name a file that ends in .html")


def player_page(world: World, runs: Sequence[PlayedRun], *, name: str = "") -> str:
    """The page that shows these runs, the first one first; two side by side.

    Args:
        name: of the world; default: its own.
    """
    data = recording(world, runs, name=name)
    shell = page_shell(" beside ".join(shown(run.name) for run in runs[:2]) + f" in {data['name']}")
    return shell.before + json_in_page(data) + shell.after


def framed(world: World, run: PlayedRun) -> str:
    """The page of a run in a sandboxed frame, for notebooks.

    The frame cannot ask for the notebook's theme: a height of 641 pixels means dark (page.css).
    """
    from topo_verify.pictures.drawing import IN_NOTEBOOKS

    page = html.escape(player_page(world, [run]).replace("<html ", '<html class="framed" ', 1))
    style = IN_NOTEBOOKS.replace("{color-scheme:light}", "{height:640px}")
    style = style.replace("{color-scheme:dark}", "{height:641px}").replace("tv-themed", "tv-frame")
    return (
        f'{style}<iframe class="tv-frame" sandbox="allow-scripts" srcdoc="{page}"'
        ' title="A run, step by step" width="100%" height="640" style="border:0"></iframe>'
    )


@cache
def part(name: str, room: str = "pictures") -> str:
    """The squeezed text of a file in `page/` of a room."""
    path = resources.files(f"topo_verify.{room}") / "page" / name
    return squeezed(path.read_text(encoding="utf-8"), name)


def squeezed(text: str, name: str) -> str:
    """The text of a file of `page/` without comments and idle spaces.

    No text of a script may span lines, or hold two slashes with spaces around them.
    """
    if name.endswith((".js", ".css")):
        text = re.sub(r"^\s*/\*.*?\*/$\n?", "", text, flags=re.MULTILINE | re.DOTALL)
        text = re.sub(r"(^|[ \t]+)//[ \t].*", "", text, flags=re.MULTILINE)
    if name.endswith(".css"):
        text = re.sub(r"\s*([{};,])\s*|(?<=:)\s+", r"\1", text).replace(";}", "}")
    return re.sub(r"^\s+", "", text, flags=re.MULTILINE)


def source_hash(text: str) -> str:
    """The source by which a content security policy allows a style or a script."""
    digest = hashlib.sha256(text.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"
