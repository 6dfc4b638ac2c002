"""`topo-verify world sample`: draw worlds, evenly from a class or from a Hypothesis strategy."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from random import Random

import click
import msgspec

from topo_verify.cli import options
from topo_verify.cli.layout import Block, Raw
from topo_verify.cli.output import Output, Result
from topo_verify.cli.output import options as output_options
from topo_verify.errors import InputError
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.enumeration.rank_order import MAX_ID_EDGES
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import World


class SampleEntry(msgspec.Struct, frozen=True):
    """A world that was drawn.

    Attributes:
        id: None beyond 200 edges.
        kind: its class; None where it was drawn from a strategy.
        strategy: where it was drawn from; None: evenly from the class.
        file: where it was written to; None where that was not asked for.
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
@click.option("--edges", type=click.IntRange(0, options.MAX_EDGES), metavar="N", help="How many.")
@options.world_class
@click.option(
    "--strategy",
    metavar="STRATEGY",
    help="Draw from this Hypothesis strategy instead, for example 'worlds(max_edges=20)'.",
)
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, metavar="N")
@click.option(
    "-n", "number", type=click.IntRange(min=1), default=1, show_default=True, help="Worlds."
)
@click.option("-o", "folder", metavar="FOLDER", help="Write world files there.")
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

    With --edges each world of the class is as likely as any other; with --strategy worlds come as
    property tests meet them.
    """
    worlds = WorldClass.parse(kind)
    if strategy is None:
        drawn = _evenly(worlds, _size(edges, folder), number, seed)
    else:
        drawn = _by_strategy(strategy, worlds, edges, number, seed)

    def sampled() -> Iterator[Result[SampleEntry]]:
        target = None if folder is None else _folder(folder)
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
        raise InputError("world sample: say with --edges how many, or with --strategy which worlds")
    if folder is None:
        _require_id(edges)
    return edges


def _require_id(edges: int) -> None:
    if edges > MAX_ID_EDGES:
        raise InputError(
            f"world sample: a world with {edges} edges has no id to print, those with more than"
            f" {MAX_ID_EDGES} have none; say with -o which folder to write them to"
        )


def _evenly(worlds: WorldClass, edges: int, number: int, seed: int) -> Iterator[World]:
    random = Random(seed)
    for _ in range(number):
        yield worlds.sample(edges, random)


def _by_strategy(
    text: str, worlds: WorldClass, edges: int | None, number: int, seed: int
) -> Iterator[World]:
    if edges is not None or worlds != WorldClass():
        given = "--edges" if edges is not None else "--class"
        raise InputError(
            f"{given} beside --strategy: a strategy is told by its own arguments which worlds,"
            " as in --strategy 'worlds(min_edges=5, max_edges=9, simple=True)'"
        )
    from topo_verify.strategies.resolve import strategy_from
    from topo_verify.strategies.sample import sample as draw

    return iter(draw(strategy_from(text), number, start=seed))


def _folder(name: str) -> Path:
    try:
        Path(name).mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"-o {name}: cannot make this folder: {error.strerror}") from error
    return Path(name)


def _show(entries: Sequence[SampleEntry]) -> Iterator[Block]:
    for entry in entries:
        yield Raw(entry.file or str(entry.id))
