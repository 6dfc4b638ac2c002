"""`topo-verify world`: show, list, convert, count, sample and draw worlds."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from operator import attrgetter
from random import Random
from typing import Any

import click
import msgspec

from topo_verify.cli import epilog, options
from topo_verify.cli.output import Live, Output, Result, Rows, entry_of, written
from topo_verify.cli.runs import NamedWorld, named_world, named_worlds
from topo_verify.cli.twins import TwinEntry, rotation_table, twin_blocks, twin_entry
from topo_verify.errors import InputError, plural
from topo_verify.report.blocks import Block, Cell, Raw, Text, TextTable
from topo_verify.studies.corpus import drawn as worlds_drawn
from topo_verify.world import unrooted
from topo_verify.world.enumeration import pruned
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.enumeration.pruned import ranked_tables
from topo_verify.world.enumeration.rank_order import MAX_ID_EDGES, require_id_edges
from topo_verify.world.formats import files
from topo_verify.world.io import WRITTEN, encoded, format_of_name, save, written_format
from topo_verify.world.rooted_map import Dart, World
from topo_verify.world.twins import MODELS, MarkerModel


class _Commands(click.Group):
    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        if args[0] not in self.commands and not args[0].startswith("-"):
            ctx.fail(f"no such command {args[0]!r}; to show a world: world show {args[0]}")
        return super().resolve_command(ctx, args)


@click.group(cls=_Commands, epilog=epilog("world show nyc", "world count --edges 6 --class planar"))
def world() -> None:
    """Show, list, convert, count, sample and draw worlds."""


_largest_part = click.option(
    "--largest-part",
    is_flag=True,
    help="Of a drawing in several parts keep the one with the most vertices, and say what is left"
    " out.",
)

# ---------------------------------------------------------------- show


class ShowEntry(msgspec.Struct, frozen=True):
    """One world and its properties.

    Attributes:
        id: null beyond 200 edges.
        rotation: `vertices` of the world file.
        edge_darts: `edges` of the world file.
        degrees: of the vertices.
        simple, loopless, planar: whether the world is in this class.
        dual: its id; null beyond 200 edges.
        automorphisms: of the map without its marker that keep its orientation; null beyond 200.
        unrooted: the least id with a marker at any dart, the unrooted map's; null beyond 200.
        source, licence, vertex_names: of the world's file; may be empty.
        twin: with --twin.
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
    dual: str | None
    automorphisms: int | None
    unrooted: str | None
    marker: int | None
    least_cost: int
    source: str
    licence: str
    rotation: tuple[tuple[int, ...], ...]
    edge_darts: tuple[tuple[int, int], ...]
    vertex_names: tuple[str, ...]
    twin: TwinEntry | None


@options.command(
    "world show nyc",
    "world show m5/17 --format json",
    "world show m2/7 --twin undirected -o twins.svg",
    group=world,
)
@click.argument("worlds", nargs=-1, required=True, metavar="WORLD...")
@_largest_part
@options.marker
@click.option(
    "--twin",
    "model",
    type=click.Choice(MODELS),
    help="Show a world that looks the same if the marker has no direction, or without it (none).",
)
@click.option(
    "-o", "file", metavar="FILE.svg", help="With --twin: draw both worlds side by side to FILE."
)
def show(
    output: Output,
    *,
    worlds: tuple[str, ...],
    marker: int | None,
    largest_part: bool,
    model: MarkerModel | None,
    file: str | None,
) -> int:
    """Show a world: its size, genus, degrees, id and rotation.

    Of two worlds, the last line says whether they are the same without their markers.
    """
    if file is not None and (model is None or len(worlds) > 1 or not file.endswith(".svg")):
        raise InputError(
            f"-o {file}: expected --twin MODEL, one WORLD, and a name that ends in .svg"
        )

    def shown() -> Iterator[Result[ShowEntry]]:
        for at in named_worlds(worlds, marker, largest_part=largest_part):
            yield Result(_shown(at, None if model is None else twin_entry(at.world, model, file)))

    return output.run("world-show", shown, _show)


def _shown(at: NamedWorld, twin: TwinEntry | None) -> ShowEntry:
    world = at.world
    return entry_of(
        ShowEntry,
        world,
        name=at.name,
        id=world.known_id,
        vertices=len(world.vertices),
        edges=len(world.edges),
        faces=len(world.faces),
        simple=world.is_simple,
        loopless=world.is_loopless,
        planar=world.is_planar,
        dual=world.dual().known_id,
        automorphisms=unrooted.automorphisms(world) if world.known_id else None,
        unrooted=unrooted.unrooted_id(world) if world.known_id else None,
        least_cost=world.least_cost(),
        rotation=world.vertices,
        edge_darts=world.edges,
        twin=twin,
    )


def _show(entries: Sequence[ShowEntry]) -> Iterator[Block]:
    for entry in entries:
        degrees = sorted(Counter(entry.degrees).items())
        facts: dict[str, Any] = msgspec.structs.asdict(entry)
        facts["degrees"] = ", ".join(f"{number} of degree {d}" for d, number in degrees)
        facts["marker"] = "none" if entry.marker is None else f"at dart {entry.marker}"
        facts["least cost"] = plural(facts.pop("least_cost"), "edge traversal")
        for listed in ("rotation", "edge_darts", "vertex_names", "twin"):
            del facts[listed]
        rows = [
            (name, Cell(_word(fact), whole=True))
            for name, fact in facts.items()
            if fact not in ("", None)
        ]
        yield TextTable(("property", "value"), rows, headed=False)
        if entry.edges:
            yield Text("")
            if entry.edges <= MAX_ID_EDGES:
                yield rotation_table(entry.rotation, entry.edge_darts, entry.vertex_names)
            else:
                yield Text("The darts of a world this large: --format json.")
        if entry.twin is not None:
            yield from twin_blocks(entry.name, entry.twin)
    if len(entries) == 2:
        a, b = (World.from_rotations(it.rotation, it.edge_darts, it.marker) for it in entries)
        same = unrooted.same_unrooted(a, b)
        mirrored = not same and unrooted.same_unrooted(a, b.mirror())
        yield Text(f"same unrooted map: {'no, a mirror image' if mirrored else _word(same)}")


def _word(fact: object) -> str:
    # By type: 1 == True, but a genus of 1 is not "yes".
    return {True: "yes", False: "no"}[fact] if isinstance(fact, bool) else str(fact)


# ---------------------------------------------------------------- convert


class ConvertEntry(msgspec.Struct, frozen=True):
    """A world in another format.

    Attributes:
        to: the format.
        text: the world in it; null: it is in the file.
    """

    world: str
    to: str
    file: str | None
    text: str | None


@options.command(
    "world convert m5/17 --to nx-json", "world convert nyc -o nyc.graphml", group=world
)
@click.argument("world", metavar="WORLD")
@click.option(
    "--to",
    type=click.Choice([*WRITTEN]),
    help="The format.  [default: what the name of FILE says, else json]",
)
@click.option(
    "-o", "file", default="-", metavar="FILE", help="Write to FILE.  [default: standard output]"
)
@_largest_part
@options.marker
def convert(
    output: Output,
    *,
    world: str,
    to: str | None,
    file: str,
    marker: int | None,
    largest_part: bool,
) -> int:
    """Write a world in another format."""

    def converted() -> Iterator[Result[ConvertEntry]]:
        kind = to or ("json" if file == "-" else written_format(file))
        at = named_world(world, marker, largest_part=largest_part)
        content = None if file != "-" else encoded(at.world, kind)
        if content is None:
            save(at.world, file, kind)
            if kind != format_of_name(file):
                output.note(f"{file}: to read it again, let its name end in {WRITTEN[kind]}")
        elif not isinstance(content, str):
            raise InputError(
                f"--to {kind}: a binary format is written to a file; name one with -o FILE"
            )
        yield Result(ConvertEntry(at.name, kind, None if content else file, content))

    return output.run("world-convert", converted, _show_converted)


def _show_converted(entries: Sequence[ConvertEntry]) -> Iterator[Block]:
    for entry in entries:
        yield written(entry.text, world=entry.world, to=entry.to, file=entry.file)


# ---------------------------------------------------------------- count


class CountEntry(msgspec.Struct, frozen=True):
    """The number of worlds of one size.

    Attributes:
        vertices: with --by vertices, of the worlds that are counted here.
        unrooted: the same without the marker; null where it would take too long.
    """

    edges: int
    kind: str = msgspec.field(name="class")
    total: int
    unrooted: int | None
    vertices: int | None = None


def _range(_context: click.Context, _option: click.Parameter, value: str) -> range:
    match = re.fullmatch(r"([0-9]{1,9})(?:\.\.([0-9]{1,9}))?", value)
    if not match:
        raise click.BadParameter(
            f"expected a number of edges as 6 or a range as 1..6, got {value!r}"
        )
    first, last = int(match[1]), int(match[2] or match[1])
    if not first <= last <= options.MAX_EDGES:
        raise click.BadParameter(
            f"expected ascending numbers of edges up to {options.MAX_EDGES}, got {value!r}"
        )
    return range(first, last + 1)


@options.command("world count --edges 6", "world count --edges 1..5 --class simple", group=world)
@click.option(
    "--edges", callback=_range, required=True, metavar="N", help="Number of edges, or a range A..B."
)
@options.world_class
@click.option(
    "--by", type=click.Choice(["vertices"]), help="Count the rooted maps by their vertices."
)
def count(output: Output, *, edges: range, kind: str, by: str | None) -> int:
    """Count the rooted maps with N edges, and the unrooted ones."""

    def counted() -> Iterator[Result[CountEntry]]:
        worlds = WorldClass.parse(kind)
        pruned.require_few(edges[-1], worlds, by_vertices=by is not None)
        for number, m in enumerate(edges):
            output.progress(f"{m} edges, class {worlds}", number, len(edges))
            if by is not None:
                for vertices, total in pruned.count_by_vertices(m, worlds).items():
                    yield Result(CountEntry(m, str(worlds), total, None, vertices))
            else:
                total, without_marker = pruned.count(m, worlds), unrooted.unrooted_count(m, worlds)
                yield Result(CountEntry(m, str(worlds), total, without_marker))

    return output.run("world-count", counted, _show_counted)


def _show_counted(entries: Sequence[CountEntry]) -> Iterator[Block]:
    by_vertices = any(entry.vertices is not None for entry in entries)
    columns = [(">edges", "edges"), ("class", "kind"), (">vertices", "vertices")]
    columns[2 + by_vertices :] = [(">worlds", "total"), (">unrooted", "unrooted")]
    yield Rows(entries).table(*((head, attrgetter(name)) for head, name in columns[:4]))
    if not by_vertices and any(entry.unrooted is None for entry in entries):
        yield Text(
            f"-: not counted. Unrooted counts: `any` to {unrooted.SIZES[-1]} edges, `planar` to"
            f" {options.MAX_EDGES:,}; other classes up to {unrooted.MOST_LISTED:,} worlds."
        )


class ListEntry(msgspec.Struct, frozen=True):
    """One world of a class."""

    id: str
    edges: int
    kind: str = msgspec.field(name="class")


@options.command(
    "world list --edges 3", "world list --edges 30 --class planar -n 5", group=world, name="list"
)
@options.number("--edges", most=MAX_ID_EDGES, required=True, meaning="Number of edges.")
@options.world_class
@options.number(
    "-n",
    "number",
    least=1,
    most=unrooted.MOST_LISTED,
    meaning="The first N worlds only.  [default: all]",
)
@click.option(
    "--unrooted",
    "unmarked",
    is_flag=True,
    help="Of worlds that differ in the marker alone, the first only.",
)
def list_worlds(
    output: Output, *, edges: int, kind: str, number: int | None, unmarked: bool
) -> int:
    """List the ids of all worlds with N edges, one a line."""
    worlds = WorldClass.parse(kind)
    first = _first(worlds, edges, number, unmarked=unmarked)

    def listed() -> Iterator[Result[ListEntry]]:
        for rank in first:
            yield Result(ListEntry(id=f"m{edges}/{rank}", edges=edges, kind=str(worlds)))

    return output.run(
        "world-list", listed, _ids, live=Live((), lambda entry: _ids((entry,)), lambda _: ())
    )


def _first(worlds: WorldClass, edges: int, number: int | None, *, unmarked: bool) -> Iterator[int]:
    if number is None:
        mend = "or name the first of them with -n N"
        try:
            total = pruned.count(edges, worlds)
        except InputError as error:
            raise InputError(f"world list: {error}, {mend}") from error
        if total > unrooted.MOST_LISTED:
            raise InputError(
                f"world list: expected at most {unrooted.MOST_LISTED:,} worlds, got {total:,} of"
                f" class {worlds} with {edges} edges: ask for fewer or a narrower class, {mend}"
            )
    every = (rank for rank, _ in ranked_tables(edges, worlds))
    return islice(unrooted.ranks(edges, worlds) if unmarked else every, number)


def _ids(entries: Sequence[ListEntry | SampleEntry]) -> Iterable[Block]:
    lines = [getattr(entry, "file", None) or str(entry.id) for entry in entries]
    return [Raw("\n".join(lines))] if lines else []


# ---------------------------------------------------------------- sample


class SampleEntry(msgspec.Struct, frozen=True):
    """One world drawn at random.

    Attributes:
        id: null beyond 200 edges.
        kind: the class that it was drawn from, or null.
        strategy: the strategy that it was drawn from, or null.
        file: the file that was written; null without -o.
    """

    id: str | None
    edges: int
    kind: str | None = msgspec.field(name="class")
    strategy: str | None
    seed: int
    file: str | None


@options.command(
    "world sample --edges 20 -n 5",
    "world sample --strategy 'nonplanar_worlds(genus=2)' -n 5",
    group=world,
)
@options.number("--edges", most=options.MAX_EDGES, meaning="Number of edges.")
@options.world_class
@click.option(
    "--strategy",
    metavar="STRATEGY",
    help="Draw from this Hypothesis strategy instead, for example 'worlds(max_edges=20)'.",
)
@options.seed("Seed of the drawing.")
@click.option(
    "-n",
    "number",
    type=click.IntRange(min=1),
    default=1,
    show_default=True,
    help="Number of worlds.",
)
@click.option("-o", "folder", metavar="FOLDER", help="Write world files to FOLDER.")
def sample(
    output: Output,
    *,
    edges: int | None,
    kind: str,
    strategy: str | None,
    seed: int,
    number: int,
    folder: str | None,
) -> int:
    """Draw worlds at random and print their ids.

    With --edges each world of the class is equally likely.
    """
    worlds = WorldClass.parse(kind)
    if strategy is not None:
        drawn = _by_strategy(strategy, worlds, edges, number, seed)
    elif edges is None:
        raise InputError("world sample: expected --edges N or --strategy STRATEGY")
    else:
        random = Random(seed)
        drawn = (worlds.sample(edges, random) for _ in range(number))

    def sampled() -> Iterator[Result[SampleEntry]]:
        output.note(f"seed {seed}")
        output.progress("drawing worlds", 0, number)
        for index, world in enumerate(drawn):
            file = None
            if folder is None:
                require_id_edges(len(world.edges))
            else:
                target = options.make_folder(folder, "-o")
                file = str(target / f"m{len(world.edges)}-seed{seed}-{index}.json")
                files.write(file, world.to_json() + "\n")
            yield Result(
                SampleEntry(
                    id=world.known_id,
                    edges=len(world.edges),
                    kind=str(worlds) if strategy is None else None,
                    strategy=strategy,
                    seed=seed,
                    file=file,
                )
            )
            output.progress("drawing worlds", index + 1, number)

    return output.run("world-sample", sampled, _ids, seed=seed)


def _by_strategy(
    text: str, worlds: WorldClass, edges: int | None, number: int, seed: int
) -> Iterator[World]:
    if edges is not None or worlds != WorldClass():
        given = "--edges" if edges is not None else "--class"
        raise InputError(
            f"{given} beside --strategy: a strategy takes its bounds as arguments, as in"
            " --strategy 'worlds(min_edges=5, max_edges=9, simple=True)'"
        )
    return iter(worlds_drawn("--strategy", text, number, seed))


# ---------------------------------------------------------------- draw


class DrawEntry(msgspec.Struct, frozen=True):
    """One picture of a world.

    Attributes:
        file: null without -o.
        layout: positions, planar, bridges, cell or ball.
        shown: the number of vertices shown: all of them except in a ball.
        bridges: how many times an edge passes over another one.
        text: the SVG, if no file was written.
    """

    world: str
    file: str | None
    layout: str
    vertices: int
    shown: int
    bridges: int
    text: str | None


@options.command(
    "world draw nyc -o nyc.svg", "world draw m5/17 --doors --darts -o m5-17.png", group=world
)
@click.argument("world", metavar="WORLD")
@click.option(
    "-o",
    "file",
    default="-",
    metavar="FILE",
    help="Write to FILE: .svg, .html; with the extra `draw` .png, .pdf."
    "  [default: SVG to standard output]",
)
@click.option("--doors", is_flag=True, help="Number the doors of each vertex, clockwise from 0.")
@click.option("--darts", is_flag=True, help="Write the number of each dart beside it.")
@options.number(
    "--around",
    metavar="VERTEX",
    meaning="Show what is near this vertex, and ring it.  [default: all, to about 1,000 edges]",
)
@options.marker
def draw(
    output: Output,
    *,
    world: str,
    file: str,
    doors: bool,
    darts: bool,
    around: int | None,
    marker: int | None,
) -> int:
    """Draw a world. The order of the edges at every vertex is read back from the picture."""
    from topo_verify.pictures.drawing import WHOLE, document, format_of, lay_out

    def drawn() -> Iterator[Result[DrawEntry]]:
        kind = "svg" if file == "-" else format_of(file)
        at = named_world(world, marker)
        layout = lay_out(at.world, centre=_dart_at(at.world, around))
        if around is not None and not layout.hidden:
            output.note(f"--around {around}: the world is shown whole")
        if around is None and layout.hidden:
            large = len(at.world.edges) > WHOLE
            why = f"it has over {WHOLE:,} edges" if large else "no whole picture was read back true"
            output.note(f"{at.name} is drawn around its marker: {why}")
        content = document(at.world, layout, kind, doors=doors, darts=darts, here=around)
        if file != "-":
            files.write(file, content)
        yield Result(
            DrawEntry(
                world=at.name,
                file=None if file == "-" else file,
                layout=layout.kind,
                vertices=len(at.world.vertices),
                shown=len(at.world.vertices) - len(layout.hidden),
                bridges=len(layout.bridges),
                text=content.decode() if file == "-" else None,
            )
        )

    return output.run("world-draw", drawn, _show_drawn)


def _dart_at(world: World, vertex: int | None) -> Dart | None:
    if vertex is None:
        return None
    if vertex >= len(world.vertices):
        last = len(world.vertices) - 1
        raise InputError(f"--around {vertex}: expected a vertex of the world, 0 … {last}")
    return next(iter(world.vertices[vertex]), None)


def _show_drawn(entries: Sequence[DrawEntry]) -> Iterator[Block]:
    for entry in entries:
        text = None if entry.text is None else entry.text.rstrip("\n")
        yield written(text, world=entry.world, layout=entry.layout, file=entry.file)
        if text is None and entry.shown < entry.vertices:
            yield Raw(f"{entry.shown} of {entry.vertices} vertices are shown; others: --around.")
