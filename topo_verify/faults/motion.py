"""Mistakes in walking: on a hypothesis' way home, back to vu, to the next edge."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property, partial

from topo_verify.algorithms.chart import Chart, Tree
from topo_verify.algorithms.motion import Choice, Executed, Hypothesis, Pilot, overlap
from topo_verify.faults.fault import Fault, crossed, mapper
from topo_verify.robot.events import MapDart
from topo_verify.robot.percept import Door, Percept

fault = partial(Fault, part="motion")


class _NotRestored(Pilot):
    def back(self, steps: int) -> None:
        while len(self.doors) > steps:
            super().back(len(self.doors) - 1)
            self.turned = 0


forgets_its_orientation = fault(
    name="forgets-its-orientation",
    why="back at a place, the robot takes the dart of return for the dart of entry",
    claim="map-isomorphic",
    mapper=mapper("basic", Pilot=_NotRestored),
)


class _WrongSign(Pilot):
    def back(self, steps: int) -> None:
        while len(self.doors) > steps:
            super().back(len(self.doors) - 1)
            self.turned = -self.turned


restores_with_the_wrong_sign = fault(
    name="restores-with-the-wrong-sign",
    why="back at a place, the robot assumes that it is turned by -k where it is turned by k",
    claim="map-isomorphic",
    mapper=mapper("basic", Pilot=_WrongSign),
)


class _TurnForgotten(Pilot):
    def forward(self, door: Door) -> Percept:
        self.turned = 0
        return super().forward(door)


sets_out_unturned = fault(
    name="sets-out-unturned",
    why="the first door after a way back is counted from the dart of return, not of entry",
    claim="map-isomorphic",
    theorem="motion-forgets-turning",
    mapper=mapper("basic", Pilot=_TurnForgotten),
)


class _FirstDoorFirst(Pilot):
    def back(self, steps: int) -> None:
        self.doors[steps:] = reversed(self.doors[steps:])
        super().back(steps)


retraces_in_the_wrong_order = fault(
    name="retraces-in-the-wrong-order",
    why="the doors k1 … kt are undone from k1 on, not from kt on",
    claim="map-isomorphic",
    mapper=mapper("basic", Pilot=_FirstDoorFirst),
)


class _OneStepShort(Pilot):
    def back(self, steps: int) -> None:
        super().back(max(steps, 1))


retraces_one_edge_short = fault(
    name="retraces-one-edge-short",
    why="the way back ends one edge before vu",
    claim="map-isomorphic",
    mapper=mapper("basic", Pilot=_OneStepShort),
)


def _as_it_came_in(pilot: Pilot, chart: Chart, entry: MapDart) -> MapDart:
    pilot.back(0)
    return entry


goes_on_as_if_just_come_in = fault(
    name="goes-on-as-if-just-come-in",
    why="after the last way back, the dart by which it came to vu is taken for its reference dart",
    claim="map-isomorphic",
    mapper=mapper("basic", localise=_as_it_came_in),
)


class _AbsoluteDoors(Hypothesis):
    @cached_property
    def doors(self) -> tuple[Door, ...]:
        chart, from_entry = self._chart, super().doors
        exits = [chart.turn(a, k) for a, k in zip(self.arrivals, from_entry, strict=False)]
        return tuple(exit_dart - chart.first[chart.vertex[exit_dart]] for exit_dart in exits)


counts_doors_from_dart_0 = fault(
    name="counts-doors-from-dart-0",
    why="the doors home are counted from each vertex' first dart, not from the dart of arrival",
    claim="map-isomorphic",
    mapper=mapper("basic", Hypothesis=_AbsoluteDoors),
)


class _OverTheEdge(Hypothesis):
    def __init__(self, dart: MapDart, chart: Chart, tree: Tree) -> None:
        super().__init__(dart, chart, tree)
        way = Hypothesis(crossed(chart), chart, tree)
        if dart != 0 and len(way.doors) < len(self.doors):
            self.arrivals, self.doors = (dart, *way.arrivals), (0, *way.doors)


walks_home_over_e_itself = fault(
    name="walks-home-over-e-itself",
    why="the way home crosses the edge from e to h, which is not on S yet",
    claim="map-entailed",
    mapper=mapper("basic", Hypothesis=_OverTheEdge),
)


class _WithoutTheLastDoor(Hypothesis):
    @cached_property
    def arrivals(self) -> tuple[MapDart, ...]:
        way = super().arrivals
        return way[:-1] if len(way) > 2 else way


stops_a_door_before_v0 = fault(
    name="stops-a-door-before-v0",
    why="if the way home has two doors or more, the last is not walked",
    claim="map-entailed",
    theorem="confirm-before-home",
    mapper=mapper("basic", Hypothesis=_WithoutTheLastDoor),
)


class _Shifted(Hypothesis):
    @cached_property
    def expected(self) -> tuple[Percept, ...]:
        first, *rest = super().expected
        return (first, *rest[1:], *rest[-1:])


expects_a_step_ahead = fault(
    name="expects-a-step-ahead",
    why="the percept behind each door is compared with what is expected behind the next one",
    claim="true-hypothesis-kept",
    theorem="words-trace-shifted",
    mapper=mapper("basic", Hypothesis=_Shifted),
)


def _one_door_more(hypotheses: Sequence[Hypothesis], last: Executed | None) -> Choice:
    h, shared = overlap(hypotheses, last)
    executed = 0 if last is None else len(last.doors)
    # A door beyond these would fail at once.
    return Choice(h, min(shared + 1, executed, len(h.doors)))


goes_back_one_door_too_few = fault(
    name="goes-back-one-door-too-few",
    why="the common prefix with the last sequence is taken for one door longer than it is",
    claim="true-hypothesis-kept",
    mapper=mapper("enhancement-i", motion=_one_door_more),
)
