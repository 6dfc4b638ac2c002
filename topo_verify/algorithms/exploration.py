"""The exploration loop, which listings 1, 2 and 3 of the paper share.

    the paper's name   here
    S, U               chart, chart.unexplored
    e = (vk, vu)       e: the dart that leaves vk
    e', e''            h: a hypothesis, the dart by which vu would have been entered
    H                  remaining, in the order of the order policy
    PE, P              h.expected, pilot.percepts

`# A2.7` marks line 7 of listing 2 (1: the basic algorithm, 2: Enhancement I, 3: Enhancement III
all-level). An algorithm is this loop with a *rule*, which rejects hypotheses without motion, and a
*motion* between hypotheses.

Source: H. Wang, M. Jenkin, P. Dymond, on enhancing topological exploration with a single
    directional immovable marker, listings 1-3; after G. Dudek, M. Jenkin, E. Milios, D. Wilkes,
    "Robotic exploration as graph construction", IEEE Trans. Robotics and Automation 7(6), 1991.
    Differs: docs/semantics.md says which e, which path and which order.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol

from topo_verify.algorithms.chart import Chart, Survey
from topo_verify.algorithms.motion import Executed, Hypothesis, Motion, Pilot
from topo_verify.algorithms.policies import Order, Pick
from topo_verify.robot.events import (
    Augment,
    Confirm,
    Evidence,
    MapDart,
    Pose,
    Reject,
    Robot,
    RuleName,
)
from topo_verify.robot.percept import Percept


class Refutation(NamedTuple):
    """Why a hypothesis is false: the rule that shows it, and the evidence."""

    rule: RuleName
    evidence: Evidence


class Rule(Protocol):
    """Rejects hypotheses without motion, for one run; may remember percepts."""

    def arrive(self, chart: Chart, e: MapDart, percept: Percept) -> None:
        """Called when the robot has crossed e and senses this percept at vu."""
        ...

    def observe(self, sequence: Executed) -> None:
        """Called for each executed sequence that ended in a mismatch."""
        ...

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        """Why the hypothesis is false by the last sequence; None if it may be true.

        The loop asks before any motion and after each mismatch, so earlier sequences are judged
        already.
        """
        ...

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        """The hypothesis that must be true because no alternative is left, if any."""
        ...

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        """Called when S has grown: the robot crossed e and came in by dart `entry`."""
        ...


def explore(robot: Robot, *, rule: Rule, motion: Motion, pick: Pick, order: Order) -> Survey:
    """Map the robot's world in O(m²n) edge traversals."""
    chart = Chart(robot.percept)  # A1.1 A1.2 A2.1 A2.2 A3.1 A3.2
    pilot = Pilot(robot)
    at: MapDart = 0  # the robot's reference dart, on S
    while chart.unexplored:  # A1.3 A2.3 A3.4
        e = pick(chart, at)  # A1.4 A2.4 A3.5
        # no edge ends in its own dart
        del chart.unexplored[e]
        at = pilot.walk(chart, at, chart.vertex[e])  # A1.5 A2.5 A3.6
        percept = pilot.cross(chart, at, e)
        remaining = hypotheses(chart, percept, order)  # A1.6 A2.6 A3.7
        robot.declare(Pose(e, tuple([h.dart for h in remaining])))
        rule.arrive(chart, e, percept)
        sequences: list[Executed] = []
        h = validate(pilot, chart, e, remaining, sequences, rule=rule, motion=motion)
        if h is not None:  # A1.16 A2.24 A3.25
            chart.join(e, h.dart)  # loop augmentation: A1.17 A2.25 A3.26
            robot.declare(Augment(e, "loop", h.dart, percept.degree))
            entry = h.dart
        else:  # A1.18 A2.26 A3.27
            pilot.back(0)  # A1.15 A3.24
            entry = chart.add_vertex(percept)
            chart.join(e, entry)  # non-loop augmentation: A1.19 A2.27 A3.28
            robot.declare(Augment(e, "new", entry, percept.degree))
        rule.learn(chart, e, entry, sequences)
        at = localise(pilot, chart, entry)
    return chart.survey(pilot.cost)  # A1.20 A2.28 A3.30


def hypotheses(chart: Chart, percept: Percept, order: Order) -> list[Hypothesis]:
    """H: the unexplored darts at vertices that look like vu, in the order in which to try them."""
    signature = percept.signature
    alike = [h for h in chart.unexplored if chart.percepts[h].signature == signature]
    if not alike:
        return []
    tree = chart.tree(0)
    return [Hypothesis(h, chart, tree) for h in order(alike, chart, tree)]


def validate(
    pilot: Pilot,
    chart: Chart,
    e: MapDart,
    remaining: list[Hypothesis],
    sequences: list[Executed],
    *,
    rule: Rule,
    motion: Motion,
) -> Hypothesis | None:
    """The confirmed hypothesis, or None if all are rejected.

    Appends to `sequences` each executed sequence that ended in a mismatch.
    """
    declare = pilot.robot.declare
    # before any motion only `folding` and `planar` can reject
    remaining = sift(pilot, chart, e, remaining, sequences, rule=rule)
    while remaining:  # A1.7 A2.10 A2.20 A2.21 A3.8
        concluded = rule.conclude(remaining)
        if concluded is not None:
            declare(Confirm(e, concluded.dart, "folding"))
            return concluded
        h, shared = motion(remaining, sequences[-1] if sequences else None)
        remaining.remove(h)  # A1.8 A2.7 A3.9
        step = execute(pilot, h, shared)
        if step is None:  # A1.12 A2.12 A3.21
            declare(Confirm(e, h.dart, "motion"))  # A1.13 A2.13 A3.22
            return h
        # The percepts differ: A1.14 A2.14 A3.23. The robot stays: A2.15.
        declare(Reject(e, h.dart, "motion", Evidence(step, h.expected[step], pilot.percepts[step])))
        if not pilot.doors:  # vu shows the marker: no sequence was executed
            continue
        sequences.append(pilot.executed())
        rule.observe(sequences[-1])
        remaining = sift(pilot, chart, e, remaining, sequences, rule=rule)
    return None


def sift(
    pilot: Pilot,
    chart: Chart,
    e: MapDart,
    remaining: Sequence[Hypothesis],
    sequences: Sequence[Executed],
    *,
    rule: Rule,
) -> list[Hypothesis]:
    """The hypotheses that the rule does not refute, in their order."""
    kept: list[Hypothesis] = []
    for h in remaining:  # A2.16
        refutation = rule.refute(chart, h, sequences)
        if refutation is None:
            kept.append(h)  # A3.17
        else:
            pilot.robot.declare(Reject(e, h.dart, *refutation))  # A2.19 A3.16
    return kept


def execute(pilot: Pilot, h: Hypothesis, shared: int) -> int | None:
    """Walk the way home, but for the shared doors. Returns the first step that differs."""
    if shared < len(h.doors):
        pilot.back(shared)  # A1.15 A2.23 A3.24
    for step, expected in enumerate(h.expected):  # A1.9 A1.10 A2.8 A2.9 A3.18 A3.19
        # shared doors: compared, not walked
        if step > len(pilot.doors):
            pilot.forward(h.doors[step - 1])
        if pilot.percepts[step] != expected:  # A1.11 A2.11 A3.20
            return step
    return None


def localise(pilot: Pilot, chart: Chart, entry: MapDart) -> MapDart:
    """The robot's reference dart on S, once vu's entry dart is known.

    At v0 the marker tells it. Elsewhere the robot walks back to vu.
    """
    marker = pilot.robot.percept.marker
    if marker is not None:
        return chart.turn(0, -marker)
    pilot.back(0)
    return chart.turn(entry, pilot.turned)
