"""`topo-verify world draw`: the picture of a world, with the true order at every vertex."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import click
import msgspec

from topo_verify.cli import options
from topo_verify.cli.output import Output, Result
from topo_verify.cli.output import options as output_options
from topo_verify.cli.runs import named_world
from topo_verify.errors import InputError
from topo_verify.report.blocks import Block, Raw, TextTable
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import Dart, World


class DrawEntry(msgspec.Struct, frozen=True):
    """One picture: an entry of `results`; docs/commands.md.

    Attributes:
        file: the file that was written; None without -o.
        layout: how the world is drawn: positions, planar, bridges, cell or ball.
        shown: how many of the vertices are shown: all of them but in a ball.
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


@click.command(
    epilog=options.epilog(
        "world draw nyc -o nyc.svg", "world draw m5/17 --doors --darts -o m5-17.png"
    )
)
@click.argument("world", metavar="WORLD")
@click.option(
    "-o",
    "file",
    default="-",
    metavar="FILE",
    help="Write to FILE: .svg, .png, .pdf or .html.  [default: SVG to standard output]",
)
@click.option("--doors", is_flag=True, help="Number the doors of each vertex, clockwise from 0.")
@click.option("--darts", is_flag=True, help="Write the number of each dart beside it.")
@click.option(
    "--around",
    type=click.IntRange(min=0),
    metavar="VERTEX",
    help="Of a world that is too large to be shown whole: show what is near this vertex."
    "  [default: that of the marker]",
)
@options.marker
@output_options
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
    from topo_verify.world.drawing import document, format_of, lay_out

    def drawn() -> Iterator[Result[DrawEntry]]:
        kind = "svg" if file == "-" else format_of(file)
        at = named_world(world, marker)
        layout = lay_out(at.world, centre=_dart_at(at.world, around))
        if around is not None and not layout.hidden:
            output.note(f"--around {around}: the world is shown whole")
        content = document(at.world, layout, kind, doors=doors, darts=darts)
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

    return output.run("world-draw", drawn, _show)


def _dart_at(world: World, vertex: int | None) -> Dart | None:
    """A dart of a vertex of the world; None for no vertex, or one without a dart.

    Raises:
        InputError: there is no such vertex.
    """
    if vertex is None:
        return None
    if vertex >= len(world.vertices):
        last = len(world.vertices) - 1
        raise InputError(f"--around {vertex}: expected a vertex of the world, 0 … {last}")
    return next(iter(world.vertices[vertex]), None)


def _show(entries: Sequence[DrawEntry]) -> Iterator[Block]:
    for entry in entries:
        if entry.text is not None:
            yield Raw(entry.text.rstrip("\n"))
            continue
        yield TextTable(("world", "layout", "file"), [(entry.world, entry.layout, str(entry.file))])
        if entry.shown < entry.vertices:
            yield Raw(f"{entry.shown} of {entry.vertices} vertices are shown; others: --around.")
