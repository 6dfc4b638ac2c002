"""`topo-verify world`: show, list, convert, count, sample and draw worlds."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import click
import msgspec

from topo_verify.cli import options
from topo_verify.cli.draw import draw
from topo_verify.cli.list_worlds import list_worlds
from topo_verify.cli.output import Output, Result
from topo_verify.cli.output import options as output_options
from topo_verify.cli.runs import NamedWorld, named_world, named_worlds
from topo_verify.cli.sample import sample
from topo_verify.errors import InputError
from topo_verify.report.blocks import Block, Cell, Raw, Text, TextTable
from topo_verify.text import plural
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.enumeration.rank_order import MAX_ID_EDGES
from topo_verify.world.formats import files, graphml, node_link, planar_code
from topo_verify.world.rooted_map import World

FORMATS: dict[str, tuple[Callable[[World], str | bytes], str]] = {
    "json": (World.to_json, ".json"),
    "planar_code": (planar_code.encode, ".pc"),
    "graphml": (graphml.encode, ".graphml"),
    "nx-json": (node_link.encode, ".nx.json"),
}
"""Each format of `convert --to`: its encoder, to text or (binary) to bytes, and the end of the name
by which a file of it is read again."""


@click.group(epilog=options.epilog("world show nyc", "world count --edges 6 --class planar"))
def world() -> None:
    """Show, list, convert, count, sample and draw worlds."""


world.add_command(sample)
world.add_command(list_worlds)
world.add_command(draw)


# ---------------------------------------------------------------- show


class ShowEntry(msgspec.Struct, frozen=True):
    """One world: an entry of `results`; docs/commands.md.

    Attributes:
        id: None beyond 200 edges.
        rotation, edge_darts: what a world file holds as `vertices` and `edges`; these two names are
            taken by their numbers here.
    """

    name: str
    id: str | None
    vertices: int
    edges: int
    faces: int
    genus: int
    degrees: tuple[int, ...]
    simple: bool
    loopless: bool
    planar: bool
    marker: int | None
    least_cost: int
    source: str
    licence: str
    rotation: tuple[tuple[int, ...], ...]
    edge_darts: tuple[tuple[int, int], ...]
    vertex_names: tuple[str, ...]


@world.command(epilog=options.epilog("world show nyc", "world show m5/17 --format json"))
@click.argument("worlds", nargs=-1, required=True, metavar="WORLD...")
@options.marker
@output_options
def show(output: Output, *, worlds: tuple[str, ...], marker: int | None) -> int:
    """Show a world: its size, genus, degrees and id, and its rotation as the world file has it."""

    def shown() -> Iterator[Result[ShowEntry]]:
        for at in named_worlds(worlds, marker):
            yield Result(_shown(at))

    return output.run("world-show", shown, _show)


def _shown(at: NamedWorld) -> ShowEntry:
    world = at.world
    return ShowEntry(
        name=at.name,
        id=_id(world),
        vertices=len(world.vertices),
        edges=len(world.edges),
        faces=len(world.faces),
        genus=world.genus,
        degrees=world.degrees,
        simple=world.is_simple,
        loopless=world.is_loopless,
        planar=world.is_planar,
        marker=world.marker,
        least_cost=world.least_cost(),
        source=world.source,
        licence=world.licence,
        rotation=world.vertices,
        edge_darts=world.edges,
        vertex_names=world.vertex_names,
    )


def _id(world: World) -> str | None:
    return world.id if len(world.edges) <= MAX_ID_EDGES else None


def _show(entries: Sequence[ShowEntry]) -> Iterator[Block]:
    for entry in entries:
        degrees = sorted(Counter(entry.degrees).items())
        facts: dict[str, Any] = msgspec.structs.asdict(entry)
        facts["degrees"] = ", ".join(f"{number} of degree {d}" for d, number in degrees)
        facts["marker"] = "none" if entry.marker is None else f"at dart {entry.marker}"
        facts["least cost"] = plural(facts.pop("least_cost"), "edge traversal")
        for listed in ("rotation", "edge_darts", "vertex_names"):
            del facts[listed]
        rows = [
            (name, Cell(_word(fact), whole=True))  # here one comes for the whole id
            for name, fact in facts.items()
            if fact not in ("", None)
        ]
        yield TextTable(("property", "value"), rows, headed=False)
        if entry.edges:
            yield Text("")
            yield _rotation(entry)


def _rotation(entry: ShowEntry) -> TextTable:
    """Each vertex with its darts clockwise, and in the same order where their edges lead."""
    other = {dart: end for a, b in entry.edge_darts for dart, end in ((a, b), (b, a))}
    vertex = {dart: v for v, darts in enumerate(entry.rotation) for dart in darts}
    named = bool(entry.vertex_names)
    rows = [
        (
            str(v),
            *(entry.vertex_names[v : v + 1]),
            " ".join(map(str, darts)),
            " ".join(str(other[dart]) for dart in darts),
            " ".join(str(vertex[other[dart]]) for dart in darts),
        )
        for v, darts in enumerate(entry.rotation)
    ]
    columns = (">vertex", *["name"] * named, "darts clockwise", "to darts", "at vertices")
    return TextTable(columns, rows)


def _word(fact: object) -> str:
    # By type, not by value: 1 == True, and a genus of 1 is not "yes".
    return {True: "yes", False: "no"}[fact] if isinstance(fact, bool) else str(fact)


# ---------------------------------------------------------------- convert


class ConvertEntry(msgspec.Struct, frozen=True):
    """A world in another format, either in `file` or as `text`."""

    world: str
    to: str
    file: str | None
    text: str | None


@world.command(
    epilog=options.epilog(
        "world convert m5/17 --to nx-json", "world convert nyc --to graphml -o nyc.graphml"
    )
)
@click.argument("world", metavar="WORLD")
@click.option(
    "--to", default="json", show_default=True, type=click.Choice([*FORMATS]), help="The format."
)
@click.option(
    "-o", "file", default="-", metavar="FILE", help="Write to FILE.  [default: standard output]"
)
@options.marker
@output_options
def convert(output: Output, *, world: str, to: str, file: str, marker: int | None) -> int:
    """Write a world in another format."""

    def converted() -> Iterator[Result[ConvertEntry]]:
        at = named_world(world, marker)
        encode, ending = FORMATS[to]
        content = encode(at.world)
        # Text on stdout goes through `Output` like any result; bytes cannot.
        if file != "-":
            files.write(file, content + "\n" if isinstance(content, str) else content)
            if to != "json" and not file.lower().endswith(ending):
                output.note(f"{file}: to read it again, let its name end in {ending}")
            yield Result(ConvertEntry(at.name, to, file, None))
        elif isinstance(content, str):
            yield Result(ConvertEntry(at.name, to, None, content))
        else:
            raise InputError(
                f"--to {to}: a binary format is written to a file; name one with -o FILE"
            )

    return output.run("world-convert", converted, _show_converted)


def _show_converted(entries: Sequence[ConvertEntry]) -> Iterator[Block]:
    for entry in entries:
        if entry.text is not None:
            yield Raw(entry.text)
        else:
            yield TextTable(("world", "to", "file"), [(entry.world, entry.to, str(entry.file))])


# ---------------------------------------------------------------- count


class CountEntry(msgspec.Struct, frozen=True):
    """The number of worlds of one size: an entry of `results`; docs/commands.md."""

    edges: int
    # `class` cannot be a name in Python.
    kind: str = msgspec.field(name="class")
    total: int


def _range(_context: click.Context, _option: click.Parameter, value: str) -> range:
    """The numbers of edges in `N` or `A..B`."""
    found = re.fullmatch(r"([0-9]{1,9})(?:\.\.([0-9]{1,9}))?", value)
    if not found:
        raise click.BadParameter(
            f"expected a number of edges as 6 or a range as 1..6, got {value!r}"
        )
    first, last = int(found[1]), int(found[2] or found[1])
    if not first <= last <= options.MAX_EDGES:
        raise click.BadParameter(
            f"expected ascending numbers of edges up to {options.MAX_EDGES}, got {value!r}"
        )
    return range(first, last + 1)


@world.command(
    epilog=options.epilog("world count --edges 6", "world count --edges 1..5 --class simple")
)
@click.option(
    "--edges", callback=_range, required=True, metavar="N", help="Number of edges, or a range A..B."
)
@options.world_class
@output_options
def count(output: Output, *, edges: range, kind: str) -> int:
    """Count the worlds with N edges, up to isomorphism (rooted maps)."""

    def counted() -> Iterator[Result[CountEntry]]:
        worlds = WorldClass.parse(kind)
        for number, m in enumerate(edges):
            output.progress(f"{m} edges, class {worlds}", number, len(edges))
            yield Result(CountEntry(edges=m, kind=str(worlds), total=worlds.count(m)))

    return output.run("world-count", counted, _show_counted)


def _show_counted(entries: Sequence[CountEntry]) -> Iterator[Block]:
    rows = [(str(e.edges), e.kind, str(e.total)) for e in entries]
    yield TextTable((">edges", "class", ">worlds"), rows)
