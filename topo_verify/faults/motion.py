"""Mistakes in walking: on a hypothesis' way home, back to vu, to the next edge."""

# A decorator hides that these classes are subclasses.
# pyright: reportPrivateUsage=false

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from topo_verify.algorithms.chart import Chart, Tree
from topo_verify.algorithms.motion import Choice, Executed, Hypothesis, Pilot, on_demand, overlap
from topo_verify.faults.fault import crossed, planted
from topo_verify.robot.events import MapDart
from topo_verify.robot.percept import Door, Percept

fault = partial(planted, "motion")


@fault("basic", "Pilot", claim="map-isomorphic")
class forgets_its_orientation(Pilot):
    """back at a place, the robot takes the dart of return for the dart of entry"""

    def back(self, steps: int) -> None:
        while len(self.doors) > steps:
            super().back(len(self.doors) - 1)
            self.turned = 0


@fault("basic", "Pilot", claim="map-isomorphic")
class restores_with_the_wrong_sign(Pilot):
    """back at a place, the robot assumes that it is turned by -k where it is turned by k"""

    def back(self, steps: int) -> None:
        while len(self.doors) > steps:
            super().back(len(self.doors) - 1)
            self.turned = -self.turned


@fault("basic", "Pilot", claim="map-isomorphic", theorem="motion-forgets-turning")
class sets_out_unturned(Pilot):
    """the first door after a way back is counted from the dart of return, not of entry"""

    def forward(self, door: Door) -> Percept:
        self.turned = 0
        return super().forward(door)


@fault("basic", "Pilot", claim="map-isomorphic")
class retraces_in_the_wrong_order(Pilot):
    """the doors k1 … kt are undone from k1 on, not from kt on"""

    def back(self, steps: int) -> None:
        self.doors[steps:] = reversed(self.doors[steps:])
        super().back(steps)


@fault("basic", "Pilot", claim="map-isomorphic")
class retraces_one_edge_short(Pilot):
    """the way back ends one edge before vu"""

    def back(self, steps: int) -> None:
        super().back(max(steps, 1))


@fault("basic", "localise", claim="map-isomorphic")
def goes_on_as_if_just_come_in(pilot: Pilot, chart: Chart, entry: MapDart) -> MapDart:
    """after the last way back, the dart by which it came to vu is taken for its reference dart"""
    pilot.back(0)
    return entry


@fault("basic", "Hypothesis", claim="map-isomorphic")
class counts_doors_from_dart_0(Hypothesis):
    """the doors home are counted from each vertex' first dart, not from the dart of arrival"""

    @on_demand
    def doors(self) -> tuple[Door, ...]:
        chart, from_entry = self._chart, super().doors
        exits = [chart.turn(a, k) for a, k in zip(self.arrivals, from_entry, strict=False)]
        return tuple(exit_dart - chart.first[chart.vertex[exit_dart]] for exit_dart in exits)


@fault("basic", "Hypothesis", claim="map-entailed")
class walks_home_over_e_itself(Hypothesis):
    """the way home crosses the edge from e to h, which is not on S yet"""

    def __init__(self, dart: MapDart, chart: Chart, tree: Tree) -> None:
        super().__init__(dart, chart, tree)
        way = Hypothesis(crossed(chart), chart, tree)
        if dart != 0 and len(way.doors) < len(self.doors):
            self.arrivals, self.doors = (dart, *way.arrivals), (0, *way.doors)


@fault("basic", "Hypothesis", claim="map-entailed", theorem="confirm-before-home")
class stops_a_door_before_v0(Hypothesis):
    """if the way home has two doors or more, the last is not walked"""

    @on_demand
    def arrivals(self) -> tuple[MapDart, ...]:
        way = super().arrivals
        return way[:-1] if len(way) > 2 else way


@fault("basic", "Hypothesis", claim="true-hypothesis-kept", theorem="words-trace-shifted")
class expects_a_step_ahead(Hypothesis):
    """the percept behind each door is compared with what is expected behind the next one"""

    @on_demand
    def expected(self) -> tuple[Percept, ...]:
        first, *rest = super().expected
        return (first, *rest[1:], *rest[-1:])


@fault("enhancement-i", "motion", claim="true-hypothesis-kept")
def goes_back_one_door_too_few(hypotheses: Sequence[Hypothesis], last: Executed | None) -> Choice:
    """the common prefix with the last sequence is taken for one door longer than it is"""
    h, shared = overlap(hypotheses, last)
    executed = 0 if last is None else len(last.doors)
    # A door beyond these would fail at once.
    return Choice(h, min(shared + 1, executed, len(h.doors)))
