"""Rows of runs of figures: made up, and made alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from topo_verify.campaign.attempt import attempt, row_of
from topo_verify.campaign.row import Judged, Row
from topo_verify.campaign.targets import one_target
from topo_verify.checkers import CLAIMS
from topo_verify.extra.figures.figures import Figure, FigureExtent
from topo_verify.extra.figures.points import LIMITS, PlannedRun
from topo_verify.robot.events import Policies
from topo_verify.world.resolve import resolve_world

HELD = tuple(Judged("ok", 3, 3) for _ in CLAIMS)


def planned_runs(figures: Sequence[Figure], extent: FigureExtent) -> list[PlannedRun]:
    """Every run that the figures need, once, in the order of figures, sizes, lines and graphs."""
    return list(
        dict.fromkeys(
            PlannedRun(world, algorithm, pair.pick, pair.order)
            for figure in figures
            for size in extent.sizes(figure.setting)
            for algorithm in figure.lines
            for pair in extent.policies
            for world in extent.worlds(figure.setting, size)
        )
    )


def made_up(run: PlannedRun, cost: int, edges: int = 10, least: int = 20) -> Row:
    """A row of a run in which every claim holds."""
    return Row(
        world=run.world,
        vertices=5,
        edges=edges,
        place=0,
        least=least,
        mapper=run.algorithm,
        policies=Policies(run.pick, run.order),
        cost=cost,
        claims=HELD,
    )


def rows_of(
    figure: Figure, extent: FigureExtent, make: Callable[[PlannedRun, int], Row]
) -> dict[PlannedRun, Row]:
    """A row for each run of a figure, given its number."""
    return {run: make(run, k) for k, run in enumerate(planned_runs([figure], extent))}


def measured(run: PlannedRun) -> Row:
    """The row of a run, made here and alone."""
    target = one_target(run.algorithm, pick=run.pick, order=run.order)
    return row_of(attempt(resolve_world(run.world), target, LIMITS, where=run.world), run.world, 0)
