"""`topo-verify world list`: every world of a size and a class, by its id."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import islice

import click
import msgspec

from topo_verify.cli import options
from topo_verify.cli.output import Live, Output, Result
from topo_verify.cli.output import options as output_options
from topo_verify.errors import InputError
from topo_verify.report.blocks import Block, Raw
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.enumeration.pruned import ranked_tables
from topo_verify.world.enumeration.rank_order import MAX_ID_EDGES, Table

MOST_LISTED = 250_000
"""The most ids in one list: all are kept until the end, since JSON is one object."""


class ListEntry(msgspec.Struct, frozen=True):
    """One world of a class: an entry of `results`; docs/commands.md."""

    id: str
    edges: int
    # `class` cannot be a name in Python.
    kind: str = msgspec.field(name="class")


@click.command(
    "list",
    epilog=options.epilog("world list --edges 3", "world list --edges 30 --class planar -n 5"),
)
@click.option(
    "--edges",
    type=click.IntRange(0, MAX_ID_EDGES),
    required=True,
    metavar="N",
    help="Number of edges.",
)
@options.world_class
@click.option(
    "-n",
    "number",
    type=click.IntRange(1, MOST_LISTED),
    metavar="N",
    help="The first N worlds only.  [default: all]",
)
@output_options
def list_worlds(output: Output, *, edges: int, kind: str, number: int | None) -> int:
    """List the ids of all worlds with N edges in their order: as they are found, one a line."""
    worlds = WorldClass.parse(kind)
    first = _first(worlds, edges, number)

    def listed() -> Iterator[Result[ListEntry]]:
        for rank, _ in first:
            yield Result(ListEntry(id=f"m{edges}/{rank}", edges=edges, kind=str(worlds)))

    return output.run("world-list", listed, _all, live=Live((), _one, lambda _: ()))


def _first(worlds: WorldClass, edges: int, number: int | None) -> Iterator[tuple[int, Table]]:
    """The worlds to list: the first `number`, or all.

    Raises:
        InputError: these are more than `MOST_LISTED`, or too many to be counted.
    """
    if number is None:
        mend = "or name the first of them with -n N"
        try:
            total = worlds.count(edges)
        except InputError as error:
            raise InputError(f"world list: {error}, {mend}") from error
        if total > MOST_LISTED:
            raise InputError(
                f"world list: expected at most {MOST_LISTED:,} worlds, got {total:,} of class"
                f" {worlds} with {edges} edges: ask for fewer edges or a narrower class, {mend}"
            )
    return islice(ranked_tables(edges, worlds), number)


def _all(entries: Iterable[ListEntry]) -> Iterator[Block]:
    return (Raw(entry.id) for entry in entries)


def _one(entry: ListEntry) -> Iterator[Block]:
    yield Raw(entry.id)
