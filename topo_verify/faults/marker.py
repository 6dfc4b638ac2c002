"""Mistakes in reading the marker: its direction or its presence."""

from __future__ import annotations

from functools import partial

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import execute
from topo_verify.algorithms.motion import Hypothesis, Pilot, overlap
from topo_verify.faults.fault import Fault, mapper
from topo_verify.robot.events import MapDart
from topo_verify.robot.percept import Percept

fault = partial(Fault, part="marker")


class _Mirrored(Chart):
    def add_vertex(self, percept: Percept) -> MapDart:
        first = super().add_vertex(percept)
        if percept.marker is not None:
            # The reference subtracts the turn.
            turned = (Percept(percept.degree, d % percept.degree) for d in self.darts(0))
            self.percepts[first:] = turned
        return first


mirrors_the_direction = fault(
    name="mirrors-the-direction",
    why="turned clockwise by k, the robot is expected to see the marker k doors further clockwise",
    claim="true-hypothesis-kept",
    mapper=mapper("basic", Chart=_Mirrored),
)


def _alike(pilot: Pilot, h: Hypothesis, step: int) -> bool:
    return pilot.percepts[step].signature == h.expected[step].signature


def _any_direction_at_the_end(pilot: Pilot, h: Hypothesis, shared: int) -> int | None:
    step = execute(pilot, h, shared)
    return None if step and step == len(h.doors) and _alike(pilot, h, step) else step


ignores_direction_at_the_end = fault(
    name="ignores-direction-at-the-end",
    why="at the end of a way home the mapper checks that the marker is there, not its direction",
    claim="no-false-confirm",
    theorem="words-confirm-undirected",
    mapper=mapper("basic", execute=_any_direction_at_the_end),
)


def _any_direction_at_once(pilot: Pilot, h: Hypothesis, shared: int) -> int | None:
    step = execute(pilot, h, shared)
    return None if step == 0 and not h.doors and _alike(pilot, h, 0) else step


ignores_direction_behind_e = fault(
    name="ignores-direction-behind-e",
    why="where vu itself shows the marker, its direction is ignored: v0's first dart is confirmed",
    claim="no-false-confirm",
    theorem="confirm-undirected",
    mapper=mapper("basic", execute=_any_direction_at_once),
)


def _nothing_left_to_walk(pilot: Pilot, h: Hypothesis, shared: int) -> int | None:
    return None if 0 < shared == len(h.doors) else execute(pilot, h, shared)


ignores_direction_if_walked = fault(
    name="ignores-direction-if-walked",
    why="a hypothesis whose whole way was executed before is confirmed without a comparison",
    claim="no-false-confirm",
    mapper=mapper("basic", motion=overlap, execute=_nothing_left_to_walk),
)
