"""The exhaustive search, for use from Python: `tv.search`.

`print(entry)` shows the report of the command line, and so does a notebook.
"""

from __future__ import annotations

from collections.abc import Iterator
from io import StringIO
from typing import TYPE_CHECKING, Any

from topo_verify.studies.search.choices import Choices
from topo_verify.studies.search.search import (
    ByEdges,
    CostComparison,
    CostPair,
    Counterexample,
    FailingClaim,
    Search,
    SearchEntry,
    SearchInterrupted,
    search,
)

if TYPE_CHECKING:
    from topo_verify.report.blocks import Block

__all__ = [
    "ByEdges",
    "Choices",
    "CostComparison",
    "CostPair",
    "Counterexample",
    "FailingClaim",
    "Search",
    "SearchEntry",
    "SearchInterrupted",
    "search",
]


def _blocks(entry: SearchEntry) -> Iterator[Block]:
    from topo_verify.cli.search import shown
    from topo_verify.report.blocks import Command

    yield from shown(entry)
    first = entry.counterexample
    if first is not None and not first.replay:
        name = entry.target.removeprefix("<").removesuffix(">")
        mapper = name if name.isidentifier() and name != "lambda" else "your mapper"
        yield Command(f'tv.examine({mapper}, "{first.world}")', "look closer: ")


def _as_text(entry: SearchEntry) -> str:
    from topo_verify.report.terminal import pretty

    return pretty(_blocks(entry), StringIO(), plain=True).rstrip()


def _as_html(entry: SearchEntry) -> str:
    from topo_verify.pictures.drawing import notebook
    from topo_verify.report.html import blocks_as_html
    from topo_verify.world.rooted_map import World

    first = entry.counterexample
    picture = "" if first is None else notebook(World.from_id(first.world))
    return "".join(blocks_as_html(_blocks(entry))) + picture


def _to_printer(entry: SearchEntry, printer: Any, _: bool) -> None:  # noqa: FBT001  by IPython
    printer.text(str(entry))


for _name, _form in (
    ("__str__", _as_text),
    ("_repr_html_", _as_html),
    ("_repr_pretty_", _to_printer),
):
    setattr(SearchEntry, _name, _form)  # the report's blocks lie above the entry's room
