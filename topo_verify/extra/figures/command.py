"""`topo-verify reproduce`: the paper's figures, beside the numbers that its text states."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from pathlib import Path

import click

from topo_verify import extras
from topo_verify.campaign.engine import REFERENCE_ENGINE, engine_of
from topo_verify.campaign.row import Row
from topo_verify.campaign.run import explore
from topo_verify.campaign.work import processors
from topo_verify.cli import options
from topo_verify.cli.output import Output, Result
from topo_verify.cli.runs import finding_blocks
from topo_verify.errors import InputError
from topo_verify.extra.figures import figures as fig
from topo_verify.extra.figures import points as pts
from topo_verify.extra.figures.pictures import picture
from topo_verify.extra.figures.words import PAGE, SHORT, judged_sentence, page, paragraph, stem
from topo_verify.report.blocks import Block, Text, TextTable
from topo_verify.robot.limits import Limits
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import World

_Found = list[tuple[fig.Figure, list[pts.FigurePoint]]]


@options.command(
    "reproduce --quick",
    "reproduce --figure 3,6d --out figures",
    "reproduce --figure 6d --policies --graphs 10 --format json",
)
@click.option(
    "--figure",
    default="all",
    show_default=True,
    metavar="F",
    help=f"all, 6, or some of {', '.join(fig.FIGURES)} with commas.",
)
@click.option(
    "--quick", is_flag=True, help=f"Small sizes, {fig.QUICK_GRAPHS} graphs a point: under a minute."
)
@click.option(
    "--policies",
    is_flag=True,
    help=f"Run {len(fig.PAIRS)} pairs of pick and order policies; show the spread of the means.",
)
@options.number(
    "--graphs",
    least=1,
    most=fig.SEEDS,
    meaning=f"Graphs a point.  [default: {fig.GRAPHS}, as in the paper]",
)
@click.option(
    "--out",
    default="figures",
    show_default=True,
    metavar="DIR",
    help="Write CSV, pictures and a page to DIR; resume from its runs.",
)
@options.seed("Of the graphs.")
@extras.options("reproduce", "engine")
@options.number("--workers", least=1, meaning="Processes.  [default: all processors]")
def reproduce(
    output: Output,
    *,
    figure: str,
    quick: bool,
    policies: bool,
    graphs: int | None,
    out: str,
    seed: int,
    engine: str,
    workers: int | None,
) -> int:
    """Draw the paper's Figures 3 and 6 a-f again: mean costs with standard errors.

    Each picture also shows the numbers in the paper's text, the least cost of a proof, and the
    complete rule, folding. Every run is judged by every claim. The same options give the same
    CSV bytes. With --engine compiled lattices grow to 100x100.
    """
    usual, other = fig.QUICK_GRAPHS if quick else fig.GRAPHS, engine != REFERENCE_ENGINE.name
    pairs, large = fig.PAIRS if policies else (fig.REFERENCE,), other and not quick
    extent = fig.FigureExtent(graphs or usual, quick, pairs, seed, large)
    words = ["topo-verify", "reproduce", *(["--figure", figure] if figure != "all" else [])]
    words += ["--quick"] * quick + ["--policies"] * policies
    words += ["--graphs", str(graphs)] if graphs else []
    words += ["--seed", str(seed)] if seed else []
    words += ["--engine", engine] if other else []

    def points() -> Iterator[Result[pts.FigurePoint]]:
        extras.require("figures")
        figures = fig.chosen_figures(figure)
        engine_of(engine).require((), Limits())
        if policies and other:
            raise InputError(
                f"--policies with --engine {engine}: that engine knows the reference policies"
                " only; leave one of the two out"
            )
        folder = options.make_folder(out, "--out")
        runs = _runs(output, figures, extent, engine, folder, workers or processors())
        drawn = [(chosen, pts.figure_points(chosen, extent, runs)) for chosen in figures]
        _write(folder, drawn, shlex.join([*words, "--out", out]))
        for _, line in drawn:
            for point in line:
                incomplete = point.undecided > 0
                yield Result(point, failed=bool(point.findings), incomplete=incomplete)

    return output.run(
        "reproduce",
        points,
        lambda entries: _show(entries, out, seed),
        seed=seed,
        quick=quick,
        graphs=extent.graphs,
    )


def _runs(
    output: Output,
    figures: Sequence[fig.Figure],
    extent: fig.FigureExtent,
    engine: str,
    folder: Path,
    workers: int,
) -> dict[pts.PlannedRun, Row]:
    if engine != REFERENCE_ENGINE.name:
        # Before the workers start, so that they find what the engine compiles in its cache.
        explore(World.from_id("m1/0"), engine=engine)
    with options.open_store(folder) as store:
        assert store is not None, "there is a folder"
        campaigns = pts.line_campaigns(figures, extent, engine, store)
        here = 0 if workers == 1 else workers
        rows = options.stored_rows(output, campaigns, here, store)
        return {run: row for row in rows for run in pts.runs_of(row)}


def _write(folder: Path, figures: _Found, command: str) -> None:
    for figure, points in figures:
        files.write(folder / f"{stem(figure)}.csv", pts.points_csv(points))
        for kind in ("svg", "png"):
            files.write(folder / f"{stem(figure)}.{kind}", picture(figure, points, kind))
    every = [point for _, points in figures for point in points]
    settings = {figure.name: figure.setting.name for figure, _ in figures}
    files.write(folder / "growth.csv", pts.growth_csv(every, settings))
    judged = judged_sentence(every)
    files.write(folder / PAGE, page(figures, command=command, judged=judged))


# ---------------------------------------------------------------- for people


def _show(entries: Sequence[pts.FigurePoint], out: str, seed: int) -> Iterator[Block]:
    for name in dict.fromkeys(point.figure for point in entries):
        figure = fig.FIGURES[name]
        points = [point for point in entries if point.figure == name]
        yield _table(figure, [point for point in points if point.is_reference])
        yield Text("")
        yield Text(paragraph(figure, points, entries))
        yield Text("")
    if not entries:
        return
    yield _growth_table(entries)
    yield Text("")
    yield Text(judged_sentence(entries))
    for point in entries:
        yield from finding_blocks(point.findings, f"{point.algorithm} in figure {point.figure}")
    yield Text(f"CSV, pictures and {PAGE} are in {out}; seed {seed}.")


def _table(figure: fig.Figure, points: Sequence[pts.FigurePoint]) -> TextTable:
    names = (*figure.lines, *fig.YARDSTICKS)
    cells = {(point.size, point.algorithm): point for point in points}
    rows = [
        (str(size), *(_cell(cells.get((size, name))) for name in names))
        for size in sorted({point.size for point in points})
    ]
    title = f"Figure {figure.name}: {figure.title} (edge traversals ± standard error)"
    return TextTable((">size", *(f">{SHORT[name]}" for name in names)), rows, title)


def _cell(point: pts.FigurePoint | None) -> str:
    if point is None:
        return "-"
    if point.stderr is None or point.algorithm in fig.YARDSTICKS:
        return f"{point.mean:.0f}"
    return f"{point.mean:.0f}±{point.stderr:.0f}"


def _growth_table(entries: Sequence[pts.FigurePoint]) -> TextTable:
    rows = dict.fromkeys(
        (
            fig.FIGURES[point.figure].setting.name,
            point.algorithm,
            f"{point.growth.exponent:.2f}",
            "-" if point.growth.stderr is None else f"{point.growth.stderr:.2f}",
            str(point.growth.points),
        )
        for point in entries
        if point.growth is not None and point.is_reference
    )
    columns = ("graphs", "line", ">exponent of m", ">± standard error", ">sizes")
    return TextTable(columns, list(rows), "Growth: cost ~ m^exponent, fitted to the means")
