"""Mistakes in the complete rule: what it identifies, and what it keeps."""

# A decorator hides that these classes are subclasses.
# pyright: reportPrivateUsage=false

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from topo_verify.algorithms.beyond.folding import FoldingRule, NodeDart, PartialFold
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.motion import Hypothesis
from topo_verify.faults.fault import planted
from topo_verify.robot.events import MapDart
from topo_verify.robot.percept import Percept

fault = partial(planted, "folding")


class _StaysIdentified(PartialFold):
    def layer(self) -> PartialFold:
        layer = super().layer()
        layer.leader = self.leader
        return layer


@fault("folding", "rule", claim="map-entailed")
class keeps_an_assumption_for_good(FoldingRule):
    """what was identified under a hypothesis stays identified when that is dropped"""

    def __init__(self) -> None:
        super().__init__()
        self.fold = _StaysIdentified()


class _AllKnown(PartialFold):
    def add(self, percept: Percept, *, known: bool = True) -> NodeDart:
        return super().add(percept, known=known)


@fault("folding", "rule", claim="true-hypothesis-kept", theorem="fold-ghost-known")
class takes_each_place_for_known(FoldingRule):
    """a place that was only seen counts as a vertex of S, so no vertex of S can be that place"""

    def __init__(self) -> None:
        super().__init__()
        self.fold = _AllKnown()


class _Unturned(PartialFold):
    def add(self, percept: Percept, *, known: bool = False) -> NodeDart:
        first = super().add(percept, known=known)
        # The reference identifies two nodes from any dart on.
        self.seen.around[first:] = [self.seen.clockwise(first)] * percept.degree
        return first


@fault("folding", "rule", claim="true-hypothesis-kept", theorem="fold-without-offset")
class identifies_without_turning(FoldingRule):
    """two places that are one vertex are identified door 0 with door 0, without the turn"""

    def __init__(self) -> None:
        super().__init__()
        self.fold = _Unturned()


@fault("folding", "rule", claim="true-hypothesis-kept")
class enters_old_places_by_door_0(FoldingRule):
    """if e leads to a place seen before, the rule assumes that the robot came in by door 0"""

    def arrive(self, chart: Chart, e: MapDart, percept: Percept) -> None:
        super().arrive(chart, e, percept)
        self.vu = self.fold.seen.node[self.vu]


@fault("folding", "rule", claim="true-hypothesis-kept")
class lays_the_marker_on_mirrored(FoldingRule):
    """a place that shows the marker is identified with v0 turned the wrong way round"""

    def _cross(self, exit_place: NodeDart, percept: Percept) -> NodeDart:
        if percept.marker is not None:
            percept = Percept(percept.degree, -percept.marker % percept.degree)
        return super()._cross(exit_place, percept)


@fault("folding", "rule", claim="map-entailed", theorem="conclude-the-last")
class forgets_that_vu_may_be_new(FoldingRule):
    """the last hypothesis is concluded though vu is not known to be a vertex of S"""

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        return remaining[0] if len(remaining) == 1 else None
