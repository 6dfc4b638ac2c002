"""Text in XML: escaped, and without the characters that XML 1.0 forbids."""

from __future__ import annotations

from html import escape

from topo_verify.text import LINE, shown


def xml_text(text: str, *, limit: int = LINE) -> str:
    r"""The text as content or attribute value, on one line; control characters are spelled out.

    >>> print(xml_text('a<b & "\x1b"'))
    a&lt;b &amp; &quot;\x1b&quot;
    """
    return escape(shown(text, limit=limit))
