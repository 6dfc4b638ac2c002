"""`topo-verify explore`: run algorithms in given worlds; cost and verdict of each run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import click

from topo_verify.campaign.run import Engine, on_engine
from topo_verify.campaign.run import explore as run_mapper
from topo_verify.cli import explored, options
from topo_verify.cli.options import Mappers
from topo_verify.cli.output import Output, Result
from topo_verify.cli.play import (
    player_option,
    require_one_world,
    svg_option,
    write_animation,
    write_page,
)
from topo_verify.cli.runs import (
    NamedWorld,
    claims_cell,
    finding_blocks,
    judged,
    named_worlds,
    unjudged,
)
from topo_verify.errors import InputError, plural
from topo_verify.player.recording import PlayedRun
from topo_verify.programs.loader import Target
from topo_verify.report.blocks import Block, Text, TextTable
from topo_verify.robot.events import write_trace
from topo_verify.robot.limits import Limits
from topo_verify.studies.search.states.every import ListedChoices
from topo_verify.world.formats import files


@dataclass(frozen=True)
class _ExploreOptions:
    """The options of one call."""

    limits: Limits
    trace: str | None
    player: str | None
    svg: str | None
    strict: bool
    gap: bool
    choices: ListedChoices | None = None


@options.command(
    "explore nyc",
    "explore m3/14 --target basic,enhancement-ii --trace FILE",
    "explore m2/8 --target folding+planar --choices 0,1",
    "explore nyc --target folding --marker all --svg heat.svg",
    "explore 'family:lattice(10,10,holes=0.2)' --target my_mapper.py:explore",
    reports=True,
)
@click.argument("worlds", nargs=-1, required=True, metavar="WORLD...")
@options.mappers(
    "all",
    meaning="Names of the catalogue, module:attribute or file.py:attribute, with commas."
    " May be repeated.",
    several=True,
    with_policies=True,
)
@click.option(
    "--choices",
    metavar="LIST",
    help="Choose by these numbers, as 0,2,1: which e, which h next (one run only).",
)
@options.engine
@explored.marker_option
@click.option("--trace", metavar="FILE", help="Write the trace as JSON Lines (one run only).")
@player_option
@svg_option
@options.strict
@click.option(
    "--gap", is_flag=True, help="Count the hypotheses that were walked although already refuted."
)
@options.limits
def explore(  # noqa: PLR0913  an argument an option
    output: Output,
    *,
    worlds: tuple[str, ...],
    mappers: Mappers,
    choices: str | None,
    engine: Engine,
    marker: int | Literal["all"] | None,
    trace: str | None,
    player: str | None,
    svg: str | None,
    strict: bool,
    gap: bool,
    limits: Limits,
) -> int:
    """Run algorithms in given worlds and show what each run costs and which claims hold.

    WORLD is a file, a world id (m5/17), family:lattice(10,10,holes=0.2,seed=7), nyc (a real street
    network) or - (world JSON on standard input).
    """

    def runs() -> Iterator[Result[explored.ExploreEntry]]:
        found = on_engine(engine, mappers.load(), limits)
        if marker == "all":
            explored.require_one_marker({"--trace": trace, "--player": player, "--gap": gap})
            starts = named_worlds(worlds)
            return explored.marker_results(output, starts, found, limits, strict=strict, svg=svg)
        starts = named_worlds(worlds, marker)
        for option, file in (("--trace", trace), ("--svg", svg)):
            if file is not None:
                _require_one_run(option, file, found, starts)
        require_one_world(player, len(starts))
        listed = None
        if choices is not None:
            _require_one_run("--choices", choices, found, starts)
            explored.require_no_policies(choices, mappers)
            listed = ListedChoices(found[0], choices)
            found = (listed.target,)
        asked = _ExploreOptions(limits, trace, player, svg, strict, gap, listed)
        return _results(output, starts, found, asked)

    table = explored.show_markers if marker == "all" else show
    return output.run(
        "explore",
        runs,
        table,
        account=explored.explore_account,
        in_process=mappers.in_process,
    )


def _require_one_run(
    option: str, file: str, found: Sequence[Target], starts: Sequence[NamedWorld]
) -> None:
    if file == "-":
        raise InputError(f"{option} -: standard output is for the results; name a file")
    if len(found) * len(starts) != 1:
        raise InputError(
            f"{option} {file}: expected one run, got {len(found) * len(starts)}; name one"
            " WORLD, and one mapper with --target"
        )


def _results(
    output: Output,
    starts: Sequence[NamedWorld],
    found: Sequence[Target],
    asked: _ExploreOptions,
) -> Iterator[Result[explored.ExploreEntry]]:
    total = len(starts) * len(found)
    played: list[PlayedRun] = []
    try:
        for number, (at, target) in enumerate((at, target) for at in starts for target in found):
            output.progress(f"{target.text} in {at.name}", number, total)
            run = run_mapper(at.world, target, limits=asked.limits)
            # Before the judging, so that the trace is kept even if a checker fails.
            if asked.trace is not None:
                files.write(asked.trace, write_trace(run.kept_trace).decode())
            if asked.choices is not None:
                run = asked.choices.made(run)
            report, incomplete = judged(run, at, asked.limits, strict=asked.strict)
            if asked.choices is not None:
                report = asked.choices.named(report, asked.limits)
            output.found.keep(report)
            played.append(PlayedRun(run.algorithm, run.trace, report.judgements, run.stopped))
            if asked.svg is not None:
                write_animation(asked.svg, at.world, played[0])
            yield explored.explore_result(run, at, report, incomplete=incomplete, gap=asked.gap)
    finally:  # an interrupt keeps the runs that are done
        if asked.player is not None and played:
            write_page(asked.player, starts[0].world, starts[0].name, played)


# ---------------------------------------------------------------- for people


def show(entries: Sequence[explored.ExploreEntry]) -> Iterator[Block]:
    """One table a world; for a single algorithm in many worlds, one table in all."""
    if len(entries) > 1 and len({entry.algorithm for entry in entries}) == 1:
        rows = [(entry.world, str(entry.edges), *_row(entry)) for entry in entries]
        yield TextTable(("world", ">edges", *_COLUMNS), rows, title=entries[0].algorithm)
    else:
        for number, group in enumerate(_by_world(entries)):
            if number:
                yield Text("")
            yield _world_table(group)
    for entry in entries:
        run = f"{entry.algorithm} in {entry.world}"
        if entry.findings:
            yield Text("")
        yield from finding_blocks(entry.findings, run)
        if entry.stopped is not None and not entry.findings:
            yield Text(f"{run} is not decided: {entry.stopped}")
    # Once, not for each world, where the sentence is the same.
    sentences = dict.fromkeys(
        sentence
        for entry in entries
        if not entry.findings and entry.stopped is None
        for sentence in unjudged(entry.algorithm, entry.world, entry.judgements)
    )
    for sentence in sentences:
        yield Text("")
        yield sentence
    yield from _gap_table(entries)


def _gap_table(entries: Sequence[explored.ExploreEntry]) -> Iterator[Block]:
    """The table of --gap: hypotheses that were walked although the history refuted them."""
    measured = [(entry, entry.gap) for entry in entries if entry.gap is not None]
    if not measured:
        return
    rows = [
        (e.algorithm, e.world, str(g.false), str(g.walked), str(g.refutable), f"{g.share:.1%}")
        for e, g in measured
    ]
    columns = ("algorithm", "world", ">false", ">walked", ">refutable", ">gap")
    yield Text("")
    yield TextTable(columns, rows, "false hypotheses: walked although the history refuted them")


_COLUMNS = (">cost", ">of least", ">rejected free", ">moving", "claims")


def _row(entry: explored.ExploreEntry) -> tuple[str, ...]:
    return (
        str(entry.cost),
        f"{entry.cost / entry.least_cost:.2f}" if entry.least_cost else "-",
        str(entry.rejected_free),
        str(entry.rejected_moving),
        claims_cell(entry.claims, incomplete=not entry.ok and not entry.findings),
    )


def _by_world(entries: Sequence[explored.ExploreEntry]) -> Iterator[list[explored.ExploreEntry]]:
    """The runs grouped by world.

    Runs come world by world, with the algorithms in the same order each time. Two worlds may have
    one name, so a group ends where the first algorithm comes again, not where the name changes.
    """
    group: list[explored.ExploreEntry] = []
    for entry in entries:
        if group and entry.algorithm == group[0].algorithm:
            yield group
            group = []
        group.append(entry)
    if group:
        yield group


def _world_table(group: Sequence[explored.ExploreEntry]) -> TextTable:
    """The cost of each algorithm in one world, relative to `basic` if that was run."""
    one = group[0]
    size = f"{plural(one.vertices, 'vertex', 'vertices')}, {plural(one.edges, 'edge')}"
    title = f"{one.world}: {size}, genus {one.genus}, least cost {one.least_cost}"
    basic = next((e.cost for e in group if e.algorithm == "basic" and len(group) > 1), 0)
    if not basic:
        return TextTable(("algorithm", *_COLUMNS), [(e.algorithm, *_row(e)) for e in group], title)
    rows: list[tuple[str, ...]] = []
    for entry in group:
        cost, *rest = _row(entry)
        rows.append((entry.algorithm, cost, f"{entry.cost / basic:.2f}", *rest))
    cost, *others = _COLUMNS
    return TextTable(("algorithm", cost, ">of basic", *others), rows, title)
