"""Points of the figures: the runs that they need, means and standard errors, growth, CSV.

There is one campaign for each line. In worlds of more than `LARGE` edges the compiled engine
keeps no trace, so only the claims on map and cost are judged. A run that is out of time, or
whose worker was killed, is not kept.

**Growth.** `mean ≈ c·m^exponent` is fitted by least squares of log(mean) on log(mean m), one
observation a size. What this does not show: that the cost is a power of m.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import product
from math import log, sqrt
from statistics import mean, stdev
from typing import NamedTuple

import msgspec

from topo_verify.algorithms import Algorithm
from topo_verify.campaign.attempt import Attempt
from topo_verify.campaign.backend import MapperCampaign
from topo_verify.campaign.campaign import Campaign, ListedWorlds
from topo_verify.campaign.engine import REFERENCE_ENGINE
from topo_verify.campaign.row import Row
from topo_verify.campaign.run import EngineMapper
from topo_verify.campaign.store import Store
from topo_verify.checkers import Finding, Status
from topo_verify.checkers.claims import LARGE
from topo_verify.extra.figures import figures as fig
from topo_verify.programs.loader import Target
from topo_verify.report.csv_table import csv_text
from topo_verify.robot.limits import Limits
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import World


class GrowthFit(msgspec.Struct, frozen=True):
    """How the cost of a line grows with the number m of edges.

    Attributes:
        exponent: of m.
        stderr: its standard error; null for fewer than three points.
        points: number of sizes that it was fitted to.
    """

    exponent: float
    stderr: float | None
    points: int

    def __str__(self) -> str:
        error = "" if self.stderr is None else f" ± {self.stderr:.2f}"
        return f"{self.exponent:.2f}{error}"


class FigurePoint(msgspec.Struct, frozen=True):
    """A point of a figure: an entry of `results`.

    Attributes:
        figure: `3`, `6a` … `6f`.
        algorithm: a name of the catalogue, or `edges` (m), or `least-cost` (of a proof).
        size: the side of a lattice, or the nodes of a dense graph, before holes.
        graphs: number of graphs that the mean is over.
        mean, stderr: the cost in edge traversals, and its standard error (deviation over √graphs).
        paper, stated: the cost that the paper's text states, and its words.
        pick, order: the policies; null for a yardstick.
        edges: the mean of m.
        held: claims that held in each run; of: claims that were asked of each. 0 for a yardstick.
        undecided: runs that were out of time.
        growth: of the line that the point is on.
    """

    figure: str
    algorithm: str
    size: int
    graphs: int
    mean: float
    stderr: float | None
    paper: int | None
    stated: str | None
    pick: str | None
    order: str | None
    edges: float
    held: int
    of: int
    findings: tuple[Finding, ...] = ()
    undecided: int = 0
    growth: GrowthFit | None = None

    @property
    def pair(self) -> fig.PolicyPair | None:
        """The policies; None for a yardstick."""
        if self.pick is None or self.order is None:
            return None
        return fig.PolicyPair(self.pick, self.order)

    @property
    def is_reference(self) -> bool:
        """Whether its policies, if any, are the reference."""
        return self.pair in (None, fig.REFERENCE)


def figure_points(
    figure: fig.Figure, extent: fig.FigureExtent, runs: Mapping[PlannedRun, Row]
) -> list[FigurePoint]:
    """The points of a figure by lines, each in the order of sizes; yardsticks come last.

    A line with missing runs has no points.
    """
    points: list[FigurePoint] = []

    def draw(name: str, pair: fig.PolicyPair | None, runs_of: str, by: fig.PolicyPair) -> None:
        line = [
            _point(figure, name, size, pair, rows)
            for size in extent.sizes(figure.setting)
            if (rows := _rows(figure, extent, runs_of, size, by, runs))
        ]
        fit = growth([(point.edges, point.mean) for point in line if point.mean > 0])
        points.extend(msgspec.structs.replace(point, growth=fit) for point in line)

    for pair in extent.policies:
        for algorithm in figure.lines:
            draw(algorithm, pair, algorithm, pair)
    for name in fig.YARDSTICKS:
        draw(name, None, figure.lines[0], extent.policies[0])
    return points


def _rows(
    figure: fig.Figure,
    extent: fig.FigureExtent,
    algorithm: str,
    size: int,
    pair: fig.PolicyPair,
    runs: Mapping[PlannedRun, Row],
) -> list[Row]:
    """The runs of one point; none if one is missing."""
    wanted = [
        PlannedRun(world, algorithm, pair.pick, pair.order)
        for world in extent.worlds(figure.setting, size)
    ]
    return [runs[run] for run in wanted] if all(run in runs for run in wanted) else []


def _point(
    figure: fig.Figure, name: str, size: int, pair: fig.PolicyPair | None, rows: Sequence[Row]
) -> FigurePoint:
    stated = figure.stated.get((name, size)) if pair == fig.REFERENCE else None
    decided = [row for row in rows if row.undecided is None]
    number = {fig.EDGES: "edges", fig.LEAST: "least"}.get(name, "cost")
    average, error = _mean([getattr(row, number) for row in decided])
    asked = [] if pair is None else decided
    return FigurePoint(
        figure=figure.name,
        algorithm=name,
        size=size,
        graphs=len(decided),
        mean=average,
        stderr=error,
        paper=stated.cost if stated else None,
        stated=stated.words if stated else None,
        pick=None if pair is None else pair.pick,
        order=None if pair is None else pair.order,
        edges=_mean([row.edges for row in decided])[0],
        held=min((_claims(row, "ok") for row in asked), default=0),
        of=min((len(row.claims) - _claims(row, "not-asked") for row in asked), default=0),
        findings=tuple(finding for row in asked for finding in row.findings),
        undecided=0 if pair is None else len(rows) - len(decided),
    )


def _claims(row: Row, status: Status) -> int:
    return sum(judged.status == status for judged in row.claims)


def _mean(values: Sequence[int]) -> tuple[float, float | None]:
    """The mean, and its standard error, to two decimals."""
    if not values:
        return 0.0, None
    error = round(stdev(values) / sqrt(len(values)), 2) if len(values) > 1 else None
    return round(mean(values), 2), error


# ---------------------------------------------------------------- growth


def growth(points: Iterable[tuple[float, float]]) -> GrowthFit | None:
    """The growth of a line through points (m, cost); None for fewer than two sizes."""
    import numpy as np

    logs = [(log(edges), log(cost)) for edges, cost in points]
    if len({x for x, _ in logs}) < 2:
        return None
    x, y = zip(*logs, strict=True)
    slope = round(float(np.polyfit(x, y, 1)[0]), 4)
    if len(logs) < 3:
        return GrowthFit(slope, None, len(logs))
    _, covariance = np.polyfit(x, y, 1, cov=True)
    return GrowthFit(slope, round(float(np.sqrt(covariance[0, 0])), 4), len(logs))


# ---------------------------------------------------------------- CSV

COLUMNS = (
    *("figure", "algorithm", "pick", "order", "size", "graphs"),
    *("edges", "mean", "stderr", "paper"),
)

GROWTH_COLUMNS = ("graphs_of", "algorithm", "pick", "order", "exponent", "stderr", "points")


def points_csv(points: Iterable[FigurePoint]) -> str:
    """The points as CSV with a header; costs in edge traversals."""
    rows = [
        (
            *(point.figure, point.algorithm, point.pick, point.order, point.size, point.graphs),
            *(_cell(point.edges), _cell(point.mean), _cell(point.stderr), point.paper),
        )
        for point in points
    ]
    return csv_text(COLUMNS, rows)


def growth_csv(points: Iterable[FigurePoint], setting_of: Mapping[str, str]) -> str:
    """The growth of every line as CSV, each line once."""
    rows = [
        (
            setting_of[point.figure],
            *(point.algorithm, point.pick, point.order),
            f"{point.growth.exponent:.4f}",
            "" if point.growth.stderr is None else f"{point.growth.stderr:.4f}",
            point.growth.points,
        )
        for point in points
        if point.growth is not None
    ]
    return csv_text(GROWTH_COLUMNS, dict.fromkeys(rows))


def _cell(value: float | None) -> str:
    return "" if value is None else f"{value:.2f}"


# ---------------------------------------------------------------- runs

LIMITS = Limits(move_timeout=60.0, world_timeout=600.0)
"""The algorithms are ours: limits are for a machine that stands still."""


class PlannedRun(NamedTuple):
    """A run that a point needs; `world` is a WORLD argument."""

    world: str
    algorithm: str
    pick: str
    order: str


def line_campaigns(
    figures: Sequence[fig.Figure], extent: fig.FigureExtent, engine: str, store: Store
) -> list[MapperCampaign]:
    """A campaign for each algorithm, in all the graphs that the figures need it in."""
    name, ways = "{}", None
    if extent.policies != (fig.REFERENCE,):
        name, ways = "{}, every pair of policies", every_pair.__name__
    elif engine != REFERENCE_ENGINE.name:
        ways = without_large_traces.__name__
    worlds: dict[str, dict[str, None]] = defaultdict(dict)
    for figure in figures:
        for line, size in product(figure.lines, extent.sizes(figure.setting)):
            worlds[line] |= dict.fromkeys(extent.worlds(figure.setting, size))
    every = {graph for graphs in worlds.values() for graph in graphs}
    resolved = {graph: resolve_world(graph) for graph in every}
    campaigns: list[MapperCampaign] = []
    for line, graphs in worlds.items():
        campaign = Campaign(
            worlds=ListedWorlds(len(graphs)),
            mappers=(line,),
            engine=engine,
            limits=LIMITS if engine == REFERENCE_ENGINE.name else Limits(),
            ways=None if ways is None else f"{__name__}:{ways}",
        )
        kept = store.resumed(campaign, name=name.format(line), all_rows=True)
        named = [(graph, resolved[graph]) for graph in graphs]
        campaigns.append(MapperCampaign(campaign, named, kept))
    return campaigns


def every_pair(
    target: Target, _world: World, once: Callable[[Target], Attempt]
) -> Iterator[Attempt]:
    """Run an algorithm with each of `PAIRS`."""
    assert isinstance(target.mapper, Algorithm)
    for pair in fig.PAIRS:
        mapper = target.mapper.with_policies(pick=pair.pick, order=pair.order)
        yield once(Target(target.text, mapper))


def without_large_traces(
    target: Target, world: World, once: Callable[[Target], Attempt]
) -> Iterator[Attempt]:
    """Run an algorithm by another engine, without its trace in a large world."""
    assert isinstance(target.mapper, EngineMapper)
    mapper = replace(target.mapper, trace=len(world.edges) <= LARGE)
    yield once(Target(target.text, mapper))


def runs_of(row: Row) -> Iterator[PlannedRun]:
    """The runs that a row stands for; for a lost worker, those of each pair."""
    pairs = fig.PAIRS if row.policies is None else (row.policies,)
    for pair in pairs:
        yield PlannedRun(row.world, row.mapper, pair.pick, pair.order)
