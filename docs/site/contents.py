"""The table of contents of the site, read from the lists of index.md.

Each heading of the second level on index.md is a part of the sidebar; each item of its list that
begins with a link to a page is an entry, named as the link is. So the page needs no directive that
GitHub would show as code, and a page that no list names is a warning of Sphinx, which ends the
build.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from sphinx.application import Sphinx


def parts(index: str) -> Iterator[tuple[str, list[tuple[str, str]]]]:
    """Each heading of index.md with the names and pages that its list links."""
    for section in re.split(r"^## ", index, flags=re.MULTILINE)[1:]:
        heading, _, body = section.partition("\n")
        pages = re.findall(r"^- \[([^\]]+)\]\(([^)#:]+)\.md\)", body, re.MULTILINE)
        if pages:
            yield heading.strip(), pages


def toctrees(index: str) -> str:
    """The directives that say the same to Sphinx."""
    return "".join(
        f"\n```{{toctree}}\n:hidden:\n:caption: {heading}\n\n"
        + "".join(f"{name} <{page}>\n" for name, page in pages)
        + "```\n"
        for heading, pages in parts(index)
    )


def _append(_app: Sphinx, page: str, source: list[str]) -> None:
    if page == "index":
        source[0] += toctrees(source[0])


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.connect("source-read", _append)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
