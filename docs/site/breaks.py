"""Where a long name in a table may be broken: after / . : , _ ( and =, and not inside a word."""

from __future__ import annotations

import re

from docutils import nodes
from sphinx.application import Sphinx

PLACE = re.compile(r"(?<=[/.:,_(=])(?=\w)")

AFTER_ALL = 900
"""Others still read the names as they were written."""


def _offer_breaks(app: Sphinx, doctree: nodes.document, _page: str) -> None:
    if app.builder.format != "html":
        return
    for cell in doctree.findall(nodes.entry):
        for code in list(cell.findall(nodes.literal)):
            first, *more = PLACE.split(code.astext())
            code.clear()
            code.append(nodes.Text(first))
            for part in more:
                code.extend([nodes.raw("", "<wbr>", format="html"), nodes.Text(part)])


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.connect("doctree-resolved", _offer_breaks, priority=AFTER_ALL)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
