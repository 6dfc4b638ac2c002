"""The runs that figures need: one campaign for each line, judged by every claim, as rows.

A run by the compiled engine is judged like any other, as long as the world has at most `LARGE`
edges. In a larger one it keeps no trace, which would have millions of events: then two claims are
judged, those on map and cost.

A run that is out of time, or whose worker was killed, is not kept: the next call tries it again.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from topo_verify.algorithms import Algorithm
from topo_verify.campaign.campaign import Campaign, ListedWorlds
from topo_verify.campaign.engines import CompiledAlgorithm, Engine
from topo_verify.campaign.identity import source_hash
from topo_verify.campaign.row import Attempt, Row
from topo_verify.campaign.store import Store
from topo_verify.checkers.claims import LARGE
from topo_verify.programs.loaded import Loaded
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits
from topo_verify.studies.by_mapper import MapperCampaign
from topo_verify.studies.reproduce.figures import PAIRS, REFERENCE, Figure, FigureExtent
from topo_verify.world.resolve import resolve_world
from topo_verify.world.rooted_map import World

LIMITS = Limits(move_timeout=60.0, world_timeout=600.0)
"""Of each run. The algorithms are ours: limits are there for a machine that stands still."""


class PlannedRun(NamedTuple):
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


def line_campaigns(
    figures: Sequence[Figure], extent: FigureExtent, engine: Engine, store: Store
) -> list[MapperCampaign]:
    """A campaign for each algorithm of the figures, in all the graphs that they need it in.

    Raises:
        InputError: the store has runs of other sources, or of another engine.
    """
    name, ways = "{}", None
    if extent.policies != (REFERENCE,):
        name, ways = "{}, every pair of policies", every_pair.__name__
    elif engine == "compiled":
        ways = without_large_traces.__name__
    worlds = {
        line: dict.fromkeys(_graphs(line, figures, extent))
        for figure in figures
        for line in figure.lines
    }
    every = {graph for graphs in worlds.values() for graph in graphs}
    resolved = {graph: resolve_world(graph) for graph in every}
    campaigns: list[MapperCampaign] = []
    for line, graphs in worlds.items():
        campaign = Campaign(
            worlds=ListedWorlds(len(graphs)),
            mappers=(line,),
            engine=engine,
            limits=Limits() if engine == "compiled" else LIMITS,
            ways=None if ways is None else f"{__name__}:{ways}",
        )
        identity = campaign.identity(source_hash(()))
        kept = store.campaign(identity, Loaded(), name=name.format(line), all_rows=True)
        named = [(graph, resolved[graph]) for graph in graphs]
        campaigns.append(MapperCampaign(campaign, named, kept))
    return campaigns


def _graphs(line: str, figures: Sequence[Figure], extent: FigureExtent) -> Iterator[str]:
    """The graphs in which the figures need a line."""
    for figure in figures:
        if line in figure.lines:
            for size in extent.sizes(figure.setting):
                yield from extent.worlds(figure.setting, size)


def every_pair(
    target: Target, _world: World, once: Callable[[Target], Attempt]
) -> Iterator[Attempt]:
    """Runs of an algorithm with each of `PAIRS`."""
    assert isinstance(target.mapper, Algorithm)
    for pair in PAIRS:
        mapper = target.mapper.with_policies(pick=pair.pick, order=pair.order)
        yield once(Target(target.text, mapper))


def without_large_traces(
    target: Target, world: World, once: Callable[[Target], Attempt]
) -> Iterator[Attempt]:
    """The run of an algorithm by the compiled engine; in a large world without its trace."""
    assert isinstance(target.mapper, CompiledAlgorithm)
    mapper = replace(target.mapper, trace=len(world.edges) <= LARGE)
    yield once(Target(target.text, mapper))


def runs_of(row: Row) -> Iterator[PlannedRun]:
    """The runs that a row is about: of a lost worker that of each pair of policies."""
    pairs = PAIRS if row.policies is None else (row.policies,)
    for pair in pairs:
        yield PlannedRun(row.world, row.mapper, pair.pick, pair.order)
