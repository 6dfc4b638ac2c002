"""Links from the first use of each word on a page to its entry in glossary.md.

The words are the headings of the third level there; plurals are found, too. Only running text is
linked: no heading, table, code or text that is a link already.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx

PAGE = "glossary"
UNLINKED = {PAGE, "changelog"}
_CLOSED = (
    nodes.reference,
    nodes.title,
    nodes.literal,
    nodes.literal_block,
    nodes.table,
    nodes.caption,
    nodes.rubric,
)
"""In these nothing is linked."""

_NAMES = {"Hypothesis"}
"""Written so, a word is the name of something else: here of the library. (WORLD is an argument.)"""


def words_of(glossary: str) -> list[str]:
    """The words that the glossary explains."""
    return re.findall(r"^### (.+)$", glossary, re.MULTILINE)


def anchor(word: str) -> str:
    """The anchor of a word's heading, on the site and on GitHub."""
    return word.lower().replace(" ", "-")


def plural(word: str) -> str:
    """How several of it are called."""
    for ending, several in (("is", "es"), ("ex", "ices"), ("y", "ies"), ("s", "s")):
        if word.endswith(ending):
            return word.removesuffix(ending) + several
    return f"{word}s"


@cache
def _forms(words: tuple[str, ...]) -> tuple[re.Pattern[str], Mapping[str, str]]:
    forms = {form.lower(): word for word in words for form in (word, plural(word))}
    longest_first = sorted(forms, key=len, reverse=True)
    found = "|".join(re.escape(form) for form in longest_first)
    return re.compile(rf"(?<![\w-])(?:{found})(?![\w-])", re.IGNORECASE), forms


def uses(text: str, words: tuple[str, ...]) -> Iterator[tuple[int, int, str]]:
    """Where words of the glossary stand in a text: start, end, the word."""
    pattern, forms = _forms(words)
    for match in pattern.finditer(text):
        if match[0] not in _NAMES and not match[0].isupper():
            yield match.start(), match.end(), forms[match[0].lower()]


def _link(app: Sphinx, doctree: nodes.document, page: str) -> None:
    if page in UNLINKED or app.builder.format != "html":
        return
    words = tuple(words_of((Path(app.srcdir) / f"{PAGE}.md").read_text(encoding="utf-8")))
    target = app.builder.get_relative_uri(page, PAGE)
    linked: set[str] = set()
    for paragraph in list(doctree.findall(nodes.paragraph)):
        for text in list(paragraph.findall(nodes.Text)):
            if not any(isinstance(node, _CLOSED) for node in _around(text)):
                _link_text(text, words, target, linked)


def _around(node: nodes.Node) -> Iterator[nodes.Node]:
    while node.parent is not None:
        node = node.parent
        yield node


def _link_text(text: nodes.Text, words: tuple[str, ...], target: str, linked: set[str]) -> None:
    """Replace a text by its pieces, the first use of each word as a link."""
    whole, at, pieces = text.astext(), 0, list[nodes.Node]()
    for start, end, word in uses(whole, words):
        if word not in linked:
            linked.add(word)
            uri = f"{target}#{anchor(word)}"
            link = nodes.reference(
                "", whole[start:end], internal=True, refuri=uri, classes=["glossary-word"]
            )
            pieces += [nodes.Text(whole[at:start]), link]
            at = end
    if pieces:
        text.parent.replace(text, [*pieces, nodes.Text(whole[at:])])


def setup(app: Sphinx) -> dict[str, bool]:
    """Called by Sphinx."""
    app.connect("doctree-resolved", _link)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
