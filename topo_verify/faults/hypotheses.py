"""Mistakes in the hypotheses: left out, or decided without a test."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial

from topo_verify.algorithms.beyond.planar import PlanarRule
from topo_verify.algorithms.chart import Chart, Tree
from topo_verify.algorithms.exploration import hypotheses
from topo_verify.algorithms.motion import Executed, Hypothesis
from topo_verify.algorithms.policies import Order, shortest
from topo_verify.algorithms.rules import NoRule
from topo_verify.faults.fault import ForwardingRobot, crossed, mapper, planted
from topo_verify.robot.events import MapDart, Robot
from topo_verify.robot.percept import Percept

fault = partial(planted, "hypotheses")


@fault("basic", "hypotheses", claim="true-hypothesis-posed", theorem="posed-not-at-vk")
def leaves_out_the_darts_of_vk(chart: Chart, percept: Percept, order: Order) -> list[Hypothesis]:
    """H leaves out the darts of the vertex that the edge leaves, so loops are missed"""
    vk = chart.vertex[crossed(chart)]
    return [h for h in hypotheses(chart, percept, order) if chart.vertex[h.dart] != vk]


@fault("basic", "hypotheses", claim="true-hypothesis-posed")
def leaves_out_parallel_edges(chart: Chart, percept: Percept, order: Order) -> list[Hypothesis]:
    """H leaves out vertices that an edge joins already, so parallel edges are missed"""
    vk = chart.vertex[crossed(chart)]
    ends = [chart.alpha[d] for d in chart.darts(vk)]
    near = {chart.vertex[d] for d in ends if d is not None} - {vk}
    return [h for h in hypotheses(chart, percept, order) if chart.vertex[h.dart] not in near]


@fault("basic", "hypotheses", claim="true-hypothesis-posed")
def leaves_out_the_darts_of_v0(chart: Chart, percept: Percept, order: Order) -> list[Hypothesis]:
    """H leaves out the darts of the marker's vertex"""
    return [h for h in hypotheses(chart, percept, order) if chart.vertex[h.dart] != 0]


@fault("basic", "Chart", claim="true-hypothesis-posed")
class leaves_h_in_u(Chart):
    """the other end of an edge to an older vertex stays in U"""

    def join(self, e: MapDart, other: MapDart) -> None:
        super().join(e, other)
        # An edge to a new vertex would be posed again.
        if self.vertex[other] < len(self.first) - 1:
            self.unexplored[other] = None


class _Coarse(Percept, frozen=True, gc=False):
    """A percept that compares degrees modulo 3."""

    @property
    def signature(self) -> tuple[int, bool]:
        return self.degree % 3, self.marker is not None

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Percept):
            return False
        return (self.degree % 3, self.marker) == (other.degree % 3, other.marker)

    def __ne__(self, other: object) -> bool:  # a Struct defines its own, exact one
        return not self == other

    __hash__ = Percept.__hash__


class _CoarseSight(ForwardingRobot):
    def seen(self, percept: Percept) -> Percept:
        return _Coarse(percept.degree, percept.marker)


class _CoarseChart(Chart):
    def add_vertex(self, percept: Percept) -> MapDart:
        first = super().add_vertex(percept)
        self.percepts[first:] = [_Coarse(p.degree, p.marker) for p in self.percepts[first:]]
        return first


@fault(claim="rejection-justified")
def compares_degrees_modulo_3(robot: Robot) -> object:
    """degrees are compared modulo 3, in H and in every comparison"""
    return mapper("basic", Chart=_CoarseChart)(_CoarseSight(robot))


@fault("basic", "order", claim="true-hypothesis-posed")
def tries_only_the_nearest_two(darts: Iterable[MapDart], chart: Chart, tree: Tree) -> list[MapDart]:
    """only the two hypotheses with the shortest ways home are posed"""
    return shortest(darts, chart, tree)[:2]


@fault("basic", "rule", claim="map-entailed")
class concludes_by_elimination(NoRule):
    """when all hypotheses but one are rejected, that one is confirmed, though vu may be new"""

    def __init__(self) -> None:
        self.rejected = 0

    def arrive(self, chart: Chart, e: MapDart, percept: Percept) -> None:
        self.rejected = 0

    def observe(self, sequence: Executed) -> None:
        self.rejected += 1

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        return remaining[0] if self.rejected and len(remaining) == 1 else None


@fault("basic", "rule", claim="map-entailed", theorem="conclude-the-last")
class confirms_what_is_alone(NoRule):
    """a hypothesis without an alternative is confirmed without a walk"""

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        return remaining[0] if len(remaining) == 1 else None


@fault("basic", "rule", claim="true-hypothesis-kept", theorem="planar-keeps")
def assumes_a_plane_world() -> PlanarRule:
    """only darts on the face of e are walked, also where the world has handles"""
    return PlanarRule(NoRule())
