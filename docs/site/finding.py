"""The site's own search stands in find.html, because search.html is the page of docs/search.md.

Sphinx writes its search to search.html after all pages, and would put it over that page unseen.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.builders.html import StandaloneHTMLBuilder

PAGE = "find"


class SiteBuilder(StandaloneHTMLBuilder):
    """Pages as Sphinx makes them; its search under a name of its own."""

    def handle_page(
        self,
        pagename: str,
        addctx: dict[str, Any],
        templatename: str = "page.html",
        *,
        outfilename: Path | None = None,
        event_arg: Any = None,
    ) -> None:
        """Write one page."""
        name = PAGE if templatename == "search.html" else pagename
        super().handle_page(
            name, addctx, templatename, outfilename=outfilename, event_arg=event_arg
        )


def _lead_to_find(
    _app: Sphinx,
    _page: str,
    _template: str,
    context: dict[str, Any],
    _doctree: nodes.document | None,
) -> None:
    """Templates ask for `search` where they mean the site's search; pages link by other means."""
    path: Callable[..., str] = context["pathto"]

    def pathto(name: str, *rest: Any, **options: Any) -> str:
        return path(PAGE if name == "search" else name, *rest, **options)

    context["pathto"] = pathto


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.add_builder(SiteBuilder, override=True)
    app.connect("html-page-context", _lead_to_find)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
