"""What a mapper costs in every world of a game, each run judged by every claim."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from topo_verify.algorithms import NAMED
from topo_verify.campaign.judge import judge
from topo_verify.campaign.run import explore
from topo_verify.studies.game.values import DrawnClass, Knowledge, drawn_worlds


@dataclass(frozen=True)
class MapperCosts:
    """The costs of a mapper in the worlds of a game.

    Attributes:
        mapper: a name of the catalogue.
        edges: of each world.
        knows: what the mapper assumes: nothing, or that the world is planar.
        drawn: the worlds in which it promises to be right.
        worlds: how many that are.
        worst, total: its cost in the worst of them, and in all together.
        failing: the id of the first world in which a claim fails, or None.
    """

    mapper: str
    edges: int
    knows: Knowledge
    drawn: DrawnClass
    worlds: int
    worst: int
    total: int
    failing: str | None

    @property
    def mean(self) -> float:
        """The cost in the mean over the worlds."""
        return self.total / self.worlds


def mapper_costs(mapper: str, edges: int) -> MapperCosts:
    """The costs of a mapper of the catalogue in the worlds with so many edges."""
    known = NAMED.get(mapper)
    planar = known is not None and known.assumes == "planar"
    drawn: DrawnClass = "planar" if planar else "any"
    runs = [explore(world, mapper) for world in drawn_worlds(edges, drawn)]
    costs = [run.cost for run in runs]
    failing = next((run.world.id for run in runs if not judge(run).ok), None)
    knows: Knowledge = "planar" if planar else "nothing"
    return MapperCosts(mapper, edges, knows, drawn, len(runs), max(costs), sum(costs), failing)


def least_costs(edges: int, drawn: DrawnClass) -> Sequence[int]:
    """The least cost of a proof in each world of a game, with the map in hand."""
    return [world.least_cost() for world in drawn_worlds(edges, drawn)]
