"""One run of a figure, judged by every claim, as a row; many of them, in worker processes.

A run by the compiled engine is judged like any other, as long as the world has at most `LARGE`
edges. In a larger one two claims are judged, `MAP_CLAIMS`: they need no trace, which would have
millions of events.

A row that convicts or decides nothing is a result like any other, except that a run which was out
of time, or whose worker was killed, is not kept: the next call tries it again.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable, Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache

import msgspec

from topo_verify.checkers import Finding
from topo_verify.checkers.claims import LARGE
from topo_verify.errors import InputError
from topo_verify.harness.engines import Engine
from topo_verify.harness.judge import judge, replay_line, undecided
from topo_verify.harness.pool import Pool
from topo_verify.harness.reproduce.figures import Figure, FigureExtent, PolicyPair
from topo_verify.harness.run import explore
from topo_verify.harness.work import Loss, Work
from topo_verify.harness.worker import Beat, Handler
from topo_verify.robot.events import MapData
from topo_verify.robot.limits import Limits
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import World

MAP_CLAIMS = ("map-isomorphic", "cost-within-bound")
"""The claims that are judged without a trace."""

LIMITS = Limits(move_timeout=60.0, world_timeout=600.0)
"""Of each run. The algorithms are ours: limits are there for a machine that stands still."""

SILENCE = 2 * LIMITS.world_timeout
"""Seconds until a worker is given up: a run, and its judging."""


class PlannedRun(msgspec.Struct, frozen=True):
    """A run that a point needs: what to run, and where.

    Attributes:
        world: a WORLD argument that makes the graph again.
        algorithm: a name of the catalogue.
        pick, order: its policies.
    """

    world: str
    algorithm: str
    pick: str
    order: str


class MeasuredRun(msgspec.Struct, frozen=True):
    """A run and what came of it.

    Attributes:
        vertices, edges: of the world.
        least: the least cost of a proof in it, in edge traversals.
        cost: of the run, in edge traversals.
        held: how many claims held in it, of `claims` that were asked.
        engine: what made the run.
        findings: what convicts the algorithm.
        undecided: why nothing was decided, or None.
    """

    run: PlannedRun
    vertices: int
    edges: int
    least: int
    cost: int
    held: int
    claims: int
    findings: tuple[Finding, ...] = ()
    undecided: str | None = None
    engine: Engine = "reference"


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


def measured(planned: PlannedRun, engine: Engine = "reference") -> MeasuredRun:
    """The run, made here and judged."""
    world = _world(planned.world)
    pick, order = planned.pick, planned.order
    if engine == "compiled":
        if len(world.edges) > LARGE:
            return _measured_map(planned, world)
        made = explore(world, planned.algorithm, pick=pick, order=order, engine=engine)
    else:
        made = explore(world, planned.algorithm, pick=pick, order=order, limits=LIMITS)
    report = judge(made, where=planned.world)
    why = None
    if undecided(made, report):
        names = [name for name, status in report.claims.items() if status == "undecided"]
        why = made.stopped or f"undecided: {', '.join(names)}"
    return MeasuredRun(
        run=planned,
        vertices=len(world.vertices),
        edges=len(world.edges),
        least=world.least_cost(),
        cost=made.cost,
        held=sum(status == "ok" for status in report.claims.values()),
        claims=len(report.claims),
        findings=() if why else report.findings,
        undecided=why,
        engine=engine,
    )


def _measured_map(planned: PlannedRun, world: World) -> MeasuredRun:
    """A run of the compiled engine without its trace, judged by `MAP_CLAIMS`."""
    made = explore(
        world,
        planned.algorithm,
        pick=planned.pick,
        order=planned.order,
        engine="compiled",
        trace=False,
    )
    right = made.map is not None and _is_world(made.map, world)
    held = {"map-isomorphic": right, "cost-within-bound": made.cost <= world.cost_bound}
    where, line = planned.world, replay_line(planned.world, planned.algorithm, None, ())
    findings = [
        Finding(claim, None, "it holds", None, made.stopped or "it fails", None, where, line)
        for claim in MAP_CLAIMS
        if not held[claim]
    ]
    return MeasuredRun(
        run=planned,
        vertices=len(world.vertices),
        edges=len(world.edges),
        least=world.least_cost(),
        cost=made.cost,
        held=sum(held.values()),
        claims=len(held),
        findings=tuple(findings),
        engine="compiled",
    )


def _is_world(found: MapData, world: World) -> bool:
    """Whether a map is isomorphic to a world, the marker on the marker."""
    try:
        return World.from_map(found).code == world.code
    except InputError:
        return False


@lru_cache(maxsize=64)  # the lines of a point share their graphs
def _world(text: str) -> World:
    return resolve_world(text)


def measured_runs(
    planned: Iterable[PlannedRun], workers: int, engine: Engine = "reference"
) -> Iterator[MeasuredRun]:
    """The runs as they are finished; made in this process if `workers` is 1."""
    if engine == "compiled":
        # Here, before the workers start: they find the kernels in the cache.
        explore(World.from_id("m1/0"), engine=engine)
    if workers == 1:
        yield from (measured(one, engine) for one in planned)
        return
    work = Work(
        serve=f"{__name__}:serve_measured",
        job=engine,
        result=MeasuredRun,
        lost=_lost,
        silence=SILENCE,
    )
    with Pool(work, workers) as pool:
        for _, made in pool.run(planned):
            yield made


def _lost(planned: PlannedRun, loss: Loss) -> MeasuredRun:
    return MeasuredRun(planned, 0, 0, 0, 0, 0, 0, undecided=f"its worker was lost: {loss.cause}")


@contextmanager
def serve_measured(job: bytes) -> Generator[Handler]:
    """Make the runs that come; see `topo_verify.harness.worker`."""
    engine: Engine = msgspec.json.decode(job, type=Engine)

    def handle(task: bytes, _beat: Beat) -> MeasuredRun:
        return measured(msgspec.json.decode(task, type=PlannedRun), engine)

    yield handle


def pair_of(run: PlannedRun) -> PolicyPair:
    """The policies of a run."""
    return PolicyPair(run.pick, run.order)
