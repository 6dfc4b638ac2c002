"""`topo-verify play`: runs to look at in the browser; `--player` and `--svg` of other commands."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import click
import msgspec

from topo_verify.campaign.run import explore as run_mapper
from topo_verify.cli import options
from topo_verify.cli.options import Mappers
from topo_verify.cli.output import Output, Result
from topo_verify.cli.runs import judged, named_world
from topo_verify.errors import InputError, plural
from topo_verify.player.recording import PlayedRun
from topo_verify.report.blocks import Block, Text
from topo_verify.robot.limits import Limits
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import World


class PlayEntry(msgspec.Struct, frozen=True):
    """A page that was written.

    Attributes:
        algorithms: whose runs it shows.
        findings: how many findings are marked in it.
    """

    world: str
    file: str
    algorithms: tuple[str, ...]
    findings: int


player_option = click.option(
    "--player", metavar="FILE", help="Write a page that shows the run in a browser, step by step."
)


svg_option = click.option(
    "--svg", metavar="FILE", help="Write an animated SVG of the run (one short run only)."
)


def require_one_world(file: str | None, number: int) -> None:
    """Raise InputError if the file is standard output, or the number of worlds is not 1."""
    if file is None:
        return
    if file == "-":
        raise InputError("--player -: standard output is for the results; name a file")
    if number != 1:
        raise InputError(f"--player {file}: expected one WORLD, got {number}; name one")


def write_page(file: str, world: World, name: str, runs: Sequence[PlayedRun]) -> None:
    """Write the page that shows these runs in a world of this name.

    Raises:
        InputError: the file cannot be written.
    """
    from topo_verify.player.page import player_page

    files.write(file, player_page(world, runs, name=name))


def write_animation(file: str, world: World, run: PlayedRun) -> None:
    """Write the run as an animated SVG.

    Raises:
        InputError: the run is too long, or the file cannot be written.
    """
    from topo_verify.player.animation import animated_svg
    from topo_verify.player.scenes import Playback

    playback = Playback(world, run.trace, run.judgements, run.stopped)
    files.write(file, animated_svg(playback, name=run.name))


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
@options.marker
@click.option("-o", "file", metavar="FILE", default="player.html", show_default=True)
@options.strict
@options.limits
def play(
    output: Output,
    *,
    world: str,
    mappers: Mappers,
    marker: int | None,
    file: str,
    strict: bool,
    limits: Limits,
) -> int:
    """Write one page that shows runs in a browser: the world, the robot, its map, each decision.

    The page needs no network and no other file. It opens at the first finding, else at the first
    question. A wrong run does not change the exit code (see explore and replay).
    """

    def played() -> Iterator[Result[PlayEntry]]:
        targets = mappers.load()
        at = named_world(world, marker)
        require_one_world(file, 1)
        runs: list[PlayedRun] = []
        for number, mapper in enumerate(targets):
            output.progress(f"{mapper.text} in {at.name}", number, len(targets))
            run = run_mapper(at.world, mapper, limits=limits)
            report, _ = judged(run, at, limits, strict=strict)
            runs.append(PlayedRun(run.algorithm, run.trace, report.judgements, run.stopped))
        write_page(file, at.world, at.name, runs)
        findings = sum(len(one.findings) for run in runs for one in run.judgements)
        yield Result(PlayEntry(at.name, file, tuple(run.name for run in runs), findings))

    return output.run("play", played, _show, in_process=mappers.in_process)


def _show(entries: Sequence[PlayEntry]) -> Iterator[Block]:
    for entry in entries:
        runs = ", ".join(entry.algorithms)
        found = f"; {plural(entry.findings, 'finding')}" if entry.findings else ""
        yield Text(f"{entry.file}: {runs} in {entry.world}{found}. Open it in a browser.")
