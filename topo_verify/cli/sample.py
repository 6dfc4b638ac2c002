"""`topo-verify world sample`: draw worlds uniformly from a class, or from a strategy."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from random import Random

import click
import msgspec

from topo_verify.cli import options
from topo_verify.cli.output import Output, Result
from topo_verify.cli.output import options as output_options
from topo_verify.errors import InputError
from topo_verify.report.blocks import Block, Raw
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.enumeration.rank_order import MAX_ID_EDGES
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import World


class SampleEntry(msgspec.Struct, frozen=True):
    """One drawn world: an entry of `results`; docs/commands.md.

    Attributes:
        id: None beyond 200 edges.
        kind: the class that it was drawn from; None if it was a strategy.
        strategy: the strategy that it was drawn from; None if it was a class.
        file: the file that was written; None without -o.
    """

    id: str | None
    edges: int
    # `class` cannot be a name in Python.
    kind: str | None = msgspec.field(name="class")
    strategy: str | None
    seed: int
    file: str | None


@click.command(
    epilog=options.epilog(
        "world sample --edges 20 -n 5", "world sample --strategy 'nonplanar_worlds(genus=2)' -n 5"
    )
)
@click.option(
    "--edges", type=click.IntRange(0, options.MAX_EDGES), metavar="N", help="Number of edges."
)
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
@output_options
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
    """Draw worlds and print their ids.

    With --edges each world of the class is equally likely. With --strategy worlds are drawn as in a
    property test.
    """
    worlds = WorldClass.parse(kind)
    if strategy is None:
        drawn = _uniform(worlds, _size(edges, folder), number, seed)
    else:
        drawn = _by_strategy(strategy, worlds, edges, number, seed)

    def sampled() -> Iterator[Result[SampleEntry]]:
        target = None if folder is None else options.make_folder(folder, "-o")
        output.note(f"seed {seed}")
        output.progress("drawing worlds", 0, number)
        for index, world in enumerate(drawn):
            file = None
            if target is None:
                _require_id(len(world.edges))
            else:
                file = str(target / f"m{len(world.edges)}-seed{seed}-{index}.json")
                files.write(file, world.to_json() + "\n")
            yield Result(
                SampleEntry(
                    id=world.id if len(world.edges) <= MAX_ID_EDGES else None,
                    edges=len(world.edges),
                    kind=str(worlds) if strategy is None else None,
                    strategy=strategy,
                    seed=seed,
                    file=file,
                )
            )
            output.progress("drawing worlds", index + 1, number)

    return output.run("world-sample", sampled, _show, seed=seed)


def _size(edges: int | None, folder: str | None) -> int:
    if edges is None:
        raise InputError("world sample: expected --edges N or --strategy STRATEGY")
    if folder is None:
        _require_id(edges)
    return edges


def _require_id(edges: int) -> None:
    if edges > MAX_ID_EDGES:
        raise InputError(
            f"world sample: a world with {edges} edges has no id to print (only worlds of up to"
            f" {MAX_ID_EDGES} edges have one); write worlds to files with -o FOLDER"
        )


def _uniform(worlds: WorldClass, edges: int, number: int, seed: int) -> Iterator[World]:
    random = Random(seed)  # one generator for all, so that -n 5 begins as -n 1 does
    for _ in range(number):
        yield worlds.sample(edges, random)


def _by_strategy(
    text: str, worlds: WorldClass, edges: int | None, number: int, seed: int
) -> Iterator[World]:
    if edges is not None or worlds != WorldClass():
        given = "--edges" if edges is not None else "--class"
        raise InputError(
            f"{given} beside --strategy: a strategy takes its bounds as arguments, as in"
            " --strategy 'worlds(min_edges=5, max_edges=9, simple=True)'"
        )
    from topo_verify.strategies.resolve import resolve_strategy
    from topo_verify.strategies.sample import sample as draw

    return iter(draw(resolve_strategy(text), number, start=seed))


def _show(entries: Sequence[SampleEntry]) -> Iterator[Block]:
    for entry in entries:
        yield Raw(entry.file or str(entry.id))
