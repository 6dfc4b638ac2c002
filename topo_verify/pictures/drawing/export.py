"""Pictures as SVG, PNG, PDF or HTML."""

from __future__ import annotations

import os
import sys
from base64 import b64encode
from hashlib import sha256
from html import escape
from os import PathLike
from typing import Literal

from topo_verify.errors import InputError, shown
from topo_verify.pictures.drawing.choice import WHOLE, lay_out
from topo_verify.pictures.drawing.layout import Layout
from topo_verify.pictures.drawing.svg import STYLE, caption, text, to_svg
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import World

Format = Literal["svg", "png", "pdf", "html"]

FORMATS: tuple[Format, ...] = ("svg", "png", "pdf", "html")

DENSITY = 144.0
"""Pixels of a PNG per 72 units of the picture."""

MOST_PIXELS = 5000

_TYPST = b"""#set document(date: none)
#let size = json(bytes(sys.inputs.size))
#set page(width: size.at(0) * 1pt, height: size.at(1) * 1pt, margin: 0pt)
#image(bytes(sys.inputs.svg), format: "svg", width: 100%, height: 100%)
"""


def format_of(name: str) -> Format:
    """The format that the file's name asks for."""
    for ending in FORMATS:
        if name.lower().endswith(f".{ending}"):
            return ending
    raise InputError(f"{shown(name)}: expected a name that ends in .{', .'.join(FORMATS)}")


def document(
    world: World,
    layout: Layout,
    kind: Format,
    *,
    doors: bool = False,
    darts: bool = False,
    here: int | None = None,
) -> bytes:
    """The picture as the content of a file; arguments as of `to_svg`.

    Raises:
        InputError: PNG or PDF, and the extra `draw` is not installed.
    """
    svg = to_svg(world, layout, doors=doors, darts=darts, here=here)
    match kind:
        case "svg":
            return svg.encode()
        case "html":
            return _page(world, layout, svg).encode()
        case "png" | "pdf":
            return _rendered(layout, svg, kind)


IN_NOTEBOOKS = (
    "<style>.tv-themed{color-scheme:light}"
    ":is([data-jp-theme-light=false],.vscode-dark,[theme=dark],[data-theme=dark]) .tv-themed"
    "{color-scheme:dark}"
    "@media(prefers-color-scheme:dark){[data-theme=auto] .tv-themed{color-scheme:dark}}</style>"
)
"""Pictures of the class follow the notebook's theme, not the system's."""


def image(svg: str, alt: str, style: str = "max-width:100%") -> str:
    """The picture as an image for notebooks, apart from the page's names and styles."""
    data = b64encode(svg.encode()).decode()
    return (
        f'<img class="tv-themed" alt="{text(alt)}" style="{style}"'
        f' src="data:image/svg+xml;base64,{data}">'
    )


def draw(
    world: World,
    path: str | PathLike[str] | None = None,
    *,
    doors: bool = False,
    darts: bool = False,
) -> str:
    """The picture as SVG; `World.draw` documents the arguments."""
    kind = None if path is None else format_of(os.fspath(path))
    layout = lay_out(world)
    if kind is not None and path is not None:
        files.write(path, document(world, layout, kind, doors=doors, darts=darts))
    return to_svg(world, layout, doors=doors, darts=darts)


def notebook(world: World) -> str:
    """The picture as HTML, in the notebook's light or dark theme; of a large world, a sentence."""
    if len(world.edges) > WHOLE:
        much = f"over {WHOLE:,} edges take long to draw"
        return f"<p>{escape(repr(world))}: {much}; <code>draw('world.svg')</code> does it.</p>"
    return IN_NOTEBOOKS + image(draw(world), world.name or "a world")


def _rendered(layout: Layout, svg: str, kind: Literal["png", "pdf"]) -> bytes:
    try:
        import typst
    except ImportError as error:
        raise InputError(
            f"a picture as {kind.upper()} needs typst: {sys.executable} -m pip install typst,"
            " or write .svg"
        ) from error
    content: bytes = typst.compile(
        _TYPST,
        format=kind,
        ppi=min(DENSITY, 72 * MOST_PIXELS / max(layout.width, layout.height)),
        sys_inputs={"svg": svg, "size": f"[{layout.width}, {layout.height}]"},
        ignore_system_fonts=True,  # for the same bytes everywhere
    )
    return content


def _page(world: World, layout: Layout, svg: str) -> str:
    """No requests, no scripts; the policy allows two styles by their hashes."""
    own = (
        "body{margin:0;background:#fdfcf9;color:#22282e;font:16px system-ui,sans-serif}"
        "main{display:flex;min-height:100vh;align-items:center;justify-content:center}"
        f"svg{{width:min(96vw,{3 * layout.width:.0f}px);height:auto;max-height:96vh}}"
        "@media(prefers-color-scheme:dark){body{background:#14181c;color:#e8eaec}}"
    )
    hashes = " ".join(
        f"'sha256-{b64encode(sha256(style.encode()).digest()).decode()}'" for style in (own, STYLE)
    )
    policy = f"default-src 'none'; style-src {hashes}; base-uri 'none'; form-action 'none'"
    # the policy forbids style attributes
    inside = svg.replace(' style="max-width:100%;height:auto"', "", 1)
    return (
        '<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>{text(caption(world, layout))}</title><style>{own}</style></head>"
        f"<body><main>{inside}</main></body></html>\n"
    )
