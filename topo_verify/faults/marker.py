"""Mistakes in reading the marker: its direction or its presence."""

from __future__ import annotations

from functools import partial

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import execute
from topo_verify.algorithms.motion import Hypothesis, Pilot, overlap
from topo_verify.faults.fault import planted
from topo_verify.robot.events import MapDart
from topo_verify.robot.percept import Percept

fault = partial(planted, "marker")


@fault("basic", "Chart", claim="true-hypothesis-kept")
class mirrors_the_direction(Chart):
    """turned clockwise by k, the robot is expected to see the marker k doors further clockwise"""

    def add_vertex(self, percept: Percept) -> MapDart:
        first = super().add_vertex(percept)
        if percept.marker is not None:
            # The reference subtracts the turn.
            turned = (Percept(percept.degree, d % percept.degree) for d in self.darts(0))
            self.percepts[first:] = turned
        return first


def _alike(pilot: Pilot, h: Hypothesis, step: int) -> bool:
    return pilot.percepts[step].signature == h.expected[step].signature


@fault("basic", "execute", claim="no-false-confirm", theorem="words-confirm-undirected")
def ignores_direction_at_the_end(pilot: Pilot, h: Hypothesis, shared: int) -> int | None:
    """at the end of a way home the mapper checks that the marker is there, not its direction"""
    step = execute(pilot, h, shared)
    return None if step and step == len(h.doors) and _alike(pilot, h, step) else step


@fault("basic", "execute", claim="no-false-confirm", theorem="confirm-undirected")
def ignores_direction_behind_e(pilot: Pilot, h: Hypothesis, shared: int) -> int | None:
    """where vu itself shows the marker, its direction is ignored: v0's first dart is confirmed"""
    step = execute(pilot, h, shared)
    return None if step == 0 and not h.doors and _alike(pilot, h, 0) else step


@fault("basic", "execute", motion=overlap, claim="no-false-confirm")
def ignores_direction_if_walked(pilot: Pilot, h: Hypothesis, shared: int) -> int | None:
    """a hypothesis whose whole way was executed before is confirmed without a comparison"""
    return None if 0 < shared == len(h.doors) else execute(pilot, h, shared)
