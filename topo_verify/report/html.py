"""Blocks as HTML: escaped text, scrolling tables, commands to copy."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable, Iterator, Mapping
from html import escape
from itertools import repeat
from types import MappingProxyType

from topo_verify.errors import LINE, shown
from topo_verify.report import blocks as bl
from topo_verify.report.blocks import TONES, Tone, marked


def xml_text(text: str, *, limit: int = LINE) -> str:
    r"""The escaped text on one line, for XML content or attributes.

    >>> print(xml_text('a<b & "\x1b"'))
    a&lt;b &amp; &quot;\x1b&quot;
    """
    return escape(shown(text, limit=limit))


# ---------------------------------------------------------------- blocks

LONG_CELL = 40
"""Characters beyond which a cell is prose."""

MANY_COLUMNS = 5
"""The least number of columns of a table whose rows are stacked on a phone."""


def blocks_as_html(
    blocks: Iterable[bl.Block], places: Mapping[str, str] = MappingProxyType({})
) -> Iterator[str]:
    """The blocks as HTML, without empty paragraphs.

    Args:
        places: the ids of the page's elements that show more of what a cell names.
    """
    yield from filter(None, (_html(block, places) for block in blocks))


def code(line: str) -> str:
    """A command line to copy, selected by one click."""
    return f'<code class="copy">{xml_text(line)}</code>'


def picture(svg: str, alt: str) -> str:
    """A picture embedded in the page."""
    data = b64encode(svg.encode()).decode()
    return f'<img alt="{xml_text(alt)}" src="data:image/svg+xml;base64,{data}">'


IN_THE_DARK = {
    **{colour.light: colour.dark for colour in bl.PALETTE.values()},
    "#0072b2": "#56b4e9",
    "#00805f": "#2fc79b",
    "#9e4a86": "#e08bc4",
    "#946b00": "#e6b422",
    "#5b6b00": "#b5cc3f",
    "#6d7780": "#9aa4ae",
}


def with_dark_colours(svg: str) -> str:
    """The picture with a style for dark pages."""
    rules = "".join(
        f'[{place}="{light}"],[style*="{place}: {light}"]{{{place}:{dark}!important}}'
        for light, dark in IN_THE_DARK.items()
        if light in svg
        for place in ("fill", "stroke")
    )
    head, end, body = svg.partition(">" if svg.startswith("<svg") else "<defs>")
    style = f"<style>@media(prefers-color-scheme:dark){{{rules}}}</style>"
    return f"{head}{end}{style}{body}"


def toned(word: str, tone: Tone | None) -> str:
    """A table cell that holds a verdict or a status."""
    text = xml_text(marked(word, tone))
    return f'<td class="{tone}">{text}</td>' if tone else f"<td>{text}</td>"


def _html(block: bl.Block, places: Mapping[str, str]) -> str:  # noqa: PLR0911  one for each kind of block
    match block:
        case bl.Text(text):
            return _paragraph(text)
        case bl.Command(line, label):
            return f'<p class="again">{xml_text(label)}{code(line)}</p>'
        case bl.Bullets(items):
            return (
                "<ul>" + "".join(f"<li>{xml_text(bl.clean(item))}</li>" for item in items) + "</ul>"
            )
        case bl.Raw(text):
            return _lines(text.split("\n"))
        case bl.View():
            return _lines(block.lines(bl.WIDTH))
        case bl.PictureBlock(svg, alt):
            return f'<figure class="chart">{picture(svg, alt)}</figure>'
        case bl.TextTable():
            return _table(block, places)


def _paragraph(text: str) -> str:
    line = bl.clean(text)
    if verdict := bl.opening_verdict(text):
        rest = xml_text(line.removeprefix(verdict))
        return f'<p><strong class="{TONES[verdict]}">{verdict}</strong>{rest}</p>'
    return f"<p>{xml_text(line)}</p>" if line else ""


def _lines(lines: Iterable[str]) -> str:
    return "<pre>" + "\n".join(map(xml_text, lines)) + "</pre>"


def _table(table: bl.TextTable, places: Mapping[str, str]) -> str:
    titles = [xml_text(bl.clean(column.removeprefix(">"))) for column in table.columns]
    right = [column.startswith(">") for column in table.columns]
    head = "".join(
        f'<th class="number">{title}</th>' if number else f"<th>{title}</th>"
        for title, number in zip(titles, right, strict=True)
    )
    rows = "\n".join(
        f"<tr>{''.join(map(_cell, row, titles, right, repeat(places)))}</tr>" for row in table.rows
    )
    title = f'<p class="title">{xml_text(bl.clean(table.title))}</p>\n' if table.title else ""
    many = ' class="many"' if len(titles) >= MANY_COLUMNS else ""
    stacked = ' class="prose"' if 'class="say"' in rows else many
    return (
        f'{title}<div class="wide" tabindex="0"><table{stacked}><thead><tr>{head}</tr></thead>\n'
        f"<tbody>{rows}</tbody></table></div>"
    )


def _cell(
    cell: str | bl.Cell,
    title: str,
    right: bool,  # noqa: FBT001  given by map
    places: Mapping[str, str],
) -> str:
    tone, text = bl.cell_tone(cell), xml_text(bl.cell_text(cell))
    kind = tone or ("number" if right else "say" if len(text) > LONG_CELL else "")
    named = f' class="{kind}"' if kind else ""
    if isinstance(cell, str) and (place := places.get(cell)):
        text = f'<a href="#{place}">{text}</a>'
    return f'<td{named} data-title="{title}">{text}</td>'
