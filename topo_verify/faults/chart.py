"""Mistakes in the chart S: how its darts are numbered, turned and joined."""

from __future__ import annotations

from functools import partial

from topo_verify.algorithms.chart import Chart
from topo_verify.faults.fault import planted
from topo_verify.robot.events import MapDart
from topo_verify.robot.percept import Door

fault = partial(planted, "chart")


@fault("basic", "Chart", claim="map-isomorphic")
class joins_by_the_second_dart(Chart):
    """a new vertex is joined one dart clockwise of the one by which it was entered"""

    def join(self, e: MapDart, other: MapDart) -> None:
        new = self.first[-1] == other > 0 and e < other
        super().join(e, self.turn(other, 1) if new else other)


@fault("basic", "Chart", claim="map-isomorphic")
class joins_a_loop_one_way(Chart):
    """on S, an edge to an older vertex can be crossed from one end only"""

    def join(self, e: MapDart, other: MapDart) -> None:
        # Not at the newest vertex, which the robot must leave.
        older = self.vertex[other] < len(self.first) - 1
        super().join(e, other)
        if older:
            self.alpha[other] = None


@fault("basic", "Chart", claim="map-isomorphic")
class counts_doors_anticlockwise(Chart):
    """the door from one dart to another is counted the wrong way round"""

    def door(self, dart: MapDart, exit_dart: MapDart) -> Door:
        return super().door(exit_dart, dart)


@fault("enhancement-ii", "Chart", claim="map-isomorphic")
class stops_at_the_last_dart(Chart):
    """a turn past the last dart of a vertex ends there and does not go on from the first"""

    def turn(self, dart: MapDart, door: Door) -> MapDart:
        first = self.first[self.vertex[dart]]
        return first + min(dart - first + door % self.degree[self.vertex[dart]], self._last(dart))

    def _last(self, dart: MapDart) -> int:
        return self.degree[self.vertex[dart]] - 1
