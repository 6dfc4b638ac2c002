"""`topo-verify play`: runs to look at in the browser; `--player` and `--svg` of other commands."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import click
import msgspec

from topo_verify.cli import options, runs
from topo_verify.cli.output import Output, Result
from topo_verify.errors import plural
from topo_verify.pictures.recording import PlayedRun
from topo_verify.report.blocks import Block, Text
from topo_verify.robot.limits import Limits


class PlayEntry(msgspec.Struct, frozen=True):
    """A page that was written.

    Attributes:
        algorithms: whose runs it shows.
        findings: the number of findings marked in it.
    """

    world: str
    file: str
    algorithms: tuple[str, ...]
    findings: int


@options.command(
    "play nyc -o nyc.html",
    "play 'family:lattice(6,6)' --target basic,enhancement-ii -o two.html",
    "play m5/17 --target my_mapper.py:explore",
)
@click.argument("world", metavar="WORLD")
@options.mappers(
    "enhancement-ii",
    meaning="Whose runs to show; of several, two stand side by side. May be repeated.",
    several=True,
    with_policies=True,
)
@options.titles
@options.marker
@click.option("-o", "file", metavar="FILE", default="player.html", show_default=True)
@options.strict
@options.limits
def play(
    output: Output,
    *,
    world: str,
    mappers: options.Mappers,
    titles: tuple[str, ...],
    marker: int | None,
    file: str,
    strict: bool,
    limits: Limits,
) -> int:
    """Write one page that shows runs in a browser: the world, the robot, its map, each decision.

    The page needs no network. It opens at the first finding, else at the first question. A wrong
    run does not change the exit code (see explore and replay).
    """

    def played() -> Iterator[Result[PlayEntry]]:
        targets = mappers.load()
        names = options.names_of(titles, [mapper.text for mapper in targets])
        at = runs.named_world(world, marker)
        runs.require_one_world(file, 1)
        recorded: list[PlayedRun] = []
        for number, mapper in enumerate(targets):
            output.progress(f"{mapper.text} in {at.name}", number, len(targets))
            run, report, _ = runs.judged(mapper, at, limits, strict=strict)
            name = names.get(mapper.text, run.algorithm)
            recorded.append(PlayedRun(name, run.trace, report.judgements, run.stopped))
        runs.write_page(file, at.world, at.name, recorded)
        findings = sum(len(j.findings) for run in recorded for j in run.judgements)
        yield Result(PlayEntry(at.name, file, tuple(run.name for run in recorded), findings))

    return output.run("play", played, _show, in_process=mappers.in_process)


HOW = "Open it in a browser; with #walk behind its address, you are the robot."


def _show(entries: Sequence[PlayEntry]) -> Iterator[Block]:
    for entry in entries:
        names = ", ".join(entry.algorithms)
        marked = f"; {plural(entry.findings, 'finding')}" if entry.findings else ""
        yield Text(f"{entry.file}: {names} in {entry.world}{marked}. {HOW}")
