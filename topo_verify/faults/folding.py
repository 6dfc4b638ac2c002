"""Mistakes in the complete rule: what it identifies, and what it keeps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.folding import FoldingRule, NodeDart, PartialFold
from topo_verify.algorithms.motion import Hypothesis
from topo_verify.faults.fault import Fault, mapper
from topo_verify.robot.events import MapDart
from topo_verify.robot.percept import Percept

fault = partial(Fault, part="folding")


def _folding(partial: type[PartialFold]) -> Callable[[], FoldingRule]:

    def rule() -> FoldingRule:
        folding = FoldingRule()
        folding.fold = partial()
        return folding

    return rule


class _StaysIdentified(PartialFold):
    def layer(self) -> PartialFold:
        layer = super().layer()
        layer.leader = self.leader
        return layer


keeps_an_assumption_for_good = fault(
    name="keeps-an-assumption-for-good",
    why="what was identified under a hypothesis stays identified when that is dropped",
    claim="map-entailed",
    mapper=mapper("folding", rule=_folding(_StaysIdentified)),
)


class _AllKnown(PartialFold):
    def add(self, percept: Percept, *, known: bool = True) -> NodeDart:
        return super().add(percept, known=known)


takes_each_place_for_known = fault(
    name="takes-each-place-for-known",
    why="a place that was only seen counts as a vertex of S, so no vertex of S can be that place",
    claim="true-hypothesis-kept",
    theorem="fold-ghost-known",
    mapper=mapper("folding", rule=_folding(_AllKnown)),
)


class _Unturned(PartialFold):
    def add(self, percept: Percept, *, known: bool = False) -> NodeDart:
        first = super().add(percept, known=known)
        # The reference identifies two nodes from any dart on.
        self.seen.around[first:] = [self.seen.clockwise(first)] * percept.degree
        return first


identifies_without_turning = fault(
    name="identifies-without-turning",
    why="two places that are one vertex are identified door 0 with door 0, without the turn",
    claim="true-hypothesis-kept",
    theorem="fold-without-offset",
    mapper=mapper("folding", rule=_folding(_Unturned)),
)


class _FromDoor0(FoldingRule):
    def arrive(self, chart: Chart, e: MapDart, percept: Percept) -> None:
        super().arrive(chart, e, percept)
        self.vu = self.fold.seen.node[self.vu]


enters_old_places_by_door_0 = fault(
    name="enters-old-places-by-door-0",
    why="if e leads to a place seen before, the rule assumes that the robot came in by door 0",
    claim="true-hypothesis-kept",
    mapper=mapper("folding", rule=_FromDoor0),
)


class _MarkerMirrored(FoldingRule):
    def _cross(self, exit_place: NodeDart, percept: Percept) -> NodeDart:
        if percept.marker is not None:
            percept = Percept(percept.degree, -percept.marker % percept.degree)
        return super()._cross(exit_place, percept)


lays_the_marker_on_mirrored = fault(
    name="lays-the-marker-on-mirrored",
    why="a place that shows the marker is identified with v0 turned the wrong way round",
    claim="true-hypothesis-kept",
    mapper=mapper("folding", rule=_MarkerMirrored),
)


class _Hasty(FoldingRule):
    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        return remaining[0] if len(remaining) == 1 else None


forgets_that_vu_may_be_new = fault(
    name="forgets-that-vu-may-be-new",
    why="the last hypothesis is concluded though vu is not known to be a vertex of S",
    claim="map-entailed",
    theorem="conclude-the-last",
    mapper=mapper("folding", rule=_Hasty),
)
