"""Every link of the finished pages: files and anchors exist, addresses elsewhere are well formed.

Every source has its page, which nothing that Sphinx adds has written over. No page names a folder
of the machine that built it.

Whether another server answers is not asked, since the build uses no network.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

from sphinx.application import Sphinx
from sphinx.errors import ExtensionError

ROOT = str(Path(__file__).resolve().parents[2])


class Page(HTMLParser):
    """The anchors of a page and what it links."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note one element."""
        of = dict(attrs)
        self.anchors |= {name for name in (of.get("id"), of.get("name")) if name}
        wanted = {"a": "href", "link": "href", "img": "src", "script": "src", "iframe": "src"}
        if link := of.get(wanted.get(tag, "")):
            self.links.append(link)


def broken(folder: Path) -> Iterator[str]:
    """What is wrong with the links of the pages in a folder, a sentence each."""
    for path in sorted(folder.rglob("*.html")):
        if ROOT in path.read_text(encoding="utf-8"):
            name = path.relative_to(folder)
            yield f"{name}: names the folder {ROOT}, which a reader does not have"
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in folder.rglob("*.html")}
    for path, page in sorted(pages.items()):
        for link in page.links:
            if why := _objection(path, link, pages):
                yield f"{path.relative_to(folder)}: {link} {why}"


def _objection(path: Path, link: str, pages: dict[Path, Page]) -> str | None:
    """Why a link on a page leads nowhere; None if it does not."""
    url = urlsplit(link)
    if url.scheme == "data":
        return None
    if url.scheme or url.netloc:
        whole = url.scheme in {"http", "https"} and "." in url.netloc and " " not in link
        return None if whole or url.scheme == "mailto" else "is no address of the web"
    file = (path.parent / unquote(url.path)).resolve() if url.path else path
    if not file.exists():
        return "names a file that is not there"
    if url.fragment and file in pages and unquote(url.fragment) not in pages[file].anchors:
        # The player reads what stands behind # as a moment of the run.
        return None if file.parent.name == "players" else "names an anchor that is not there"
    return None


def lost(folder: Path, sources: Iterable[str]) -> Iterator[str]:
    """Which sources have no page with a title: another page of that name stands there instead."""
    for source in sorted(sources):
        page = folder / f"{source}.html"
        if not page.exists() or "<h1" not in page.read_text(encoding="utf-8"):
            yield f"{source}.html: nothing of the source {source} stands there"


def _check(app: Sphinx, failure: Exception | None) -> None:
    if failure is not None or app.builder.name != "html":
        return
    folder = Path(app.outdir).resolve()
    if found := [*lost(folder, app.env.found_docs), *broken(folder)]:
        raise ExtensionError("broken pages and links:\n  " + "\n  ".join(found))


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.connect("build-finished", _check)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
