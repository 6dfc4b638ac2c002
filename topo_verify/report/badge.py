"""A badge: the verdict's colour and letter, and how much was checked."""

from __future__ import annotations

from topo_verify.report.account import Account
from topo_verify.report.blocks import OF_TONE, PALETTE, TONES
from topo_verify.report.html import xml_text

LONGEST = 60

_NARROW, _WIDE = set(" ,.:;'!|()fijlrt1"), set("mwMW%@")
_STYLE = "font:11px Verdana,DejaVu Sans,sans-serif"


def badge(account: Account) -> str:
    """The badge as self-contained SVG."""
    extent = account.extent
    colour = PALETTE[OF_TONE[TONES[extent.verdict]]].light
    words = xml_text(extent.words, limit=LONGEST)
    whole = xml_text(f"topo-verify, {account.about}: {extent.verdict}, {extent.words}")
    name_width, words_width = 82, _width(extent.words[:LONGEST]) + 14
    letter, start = name_width + 9, name_width + 18
    width = start + words_width
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="20"'
        f' viewBox="0 0 {width} 20" role="img" aria-label="{whole}">\n'
        f"<title>{whole}</title>\n"
        f'<clipPath id="r"><rect width="{width}" height="20" rx="3"/></clipPath>\n'
        f'<g clip-path="url(#r)"><rect width="{width}" height="20" fill="#3b434b"/>'
        f'<rect x="{name_width}" width="{width - name_width}" height="20" fill="{colour}"/>'
        f'<rect x="{name_width}" width="18" height="20" fill="#000" fill-opacity=".22"/></g>\n'
        f'<g fill="#fff" text-anchor="middle" style="{_STYLE}">'
        f'<text x="{name_width / 2:g}" y="14" textLength="{name_width - 14}">topo-verify</text>'
        f'<text x="{letter}" y="14" font-weight="bold">{extent.verdict[0]}</text>'
        f'<text x="{start + words_width / 2:g}" y="14" textLength="{words_width - 12}">{words}'
        "</text></g>\n</svg>\n"
    )


def _width(text: str) -> int:
    return round(sum(4.2 if c in _NARROW else 10 if c in _WIDE else 7 for c in text))
