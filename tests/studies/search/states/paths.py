"""Every run of an algorithm in a world, one by one, as an order of H settles it: to compare with.

The script tells the policies, choice by choice, what to take, and notes how many ways there were.
The next run differs in the last choice that has a way left (backtracking, with no memory of
states). H is put in an order before any of it is tried, as the paper says. What stands in the order
behind the hypothesis that is confirmed is never tried, so under `retrace` it is no choice.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import replace

from topo_verify.algorithms import Algorithm, exploration
from topo_verify.algorithms.chart import Chart, Survey, Tree
from topo_verify.algorithms.motion import retrace
from topo_verify.campaign.judge import judge
from topo_verify.campaign.run import explore
from topo_verify.programs.loader import Target
from topo_verify.robot.events import Confirm, MapDart, Pose, Robot, Trace
from topo_verify.world.rooted_map import World


class Script:
    """Choices for one run after the other, until all are made."""

    def __init__(self) -> None:
        self._taken: list[int] = []
        self._ways: list[int] = []
        self._next = 0
        self._orders: list[tuple[int, list[MapDart]]] = []  # where each H begins, and its order

    def choose(self, ways: int) -> int:
        """The number of the way to take, of so many; beyond the script's end the first."""
        if self._next == len(self._taken):
            self._taken.append(0)
            self._ways.append(ways)
        assert self._taken[self._next] < ways, "the same choices lead to the same choice"
        self._next += 1
        return self._taken[self._next - 1]

    def settle(self, trace: Trace) -> None:
        """Count the order of the hypotheses that were never tried as no choice."""
        confirmed = {event.edge: event.hypothesis for event in trace if isinstance(event, Confirm)}
        poses = (event for event in trace if isinstance(event, Pose) and event.hypotheses)
        for (begin, row), pose in zip(self._orders, poses, strict=False):
            if pose.edge in confirmed:
                tried = row.index(confirmed[pose.edge]) + 1
                for place in range(begin + tried, begin + len(row)):
                    self._ways[place] = self._taken[place] + 1

    def advance(self) -> bool:
        """Go to the next script; False: all were made."""
        while self._taken and self._taken[-1] + 1 >= self._ways[-1]:
            self._taken.pop()
            self._ways.pop()
        if self._taken:
            self._taken[-1] += 1
        self._next, self._orders = 0, []
        return bool(self._taken)

    def pick(self, chart: Chart, _at: MapDart) -> MapDart:
        """A pick policy that takes the dart that the script says."""
        row = list(chart.unexplored)
        return row[self.choose(len(row))]

    def order(self, darts: Iterable[MapDart], _chart: Chart, _tree: Tree) -> list[MapDart]:
        """An order policy that takes the order that the script says."""
        left, begin = sorted(darts), self._next
        row = [left.pop(self.choose(len(left))) for _ in range(len(left))]
        self._orders.append((begin, row))
        return row


def all_runs(algorithm: Algorithm, world: World) -> Iterator[tuple[int, frozenset[str]]]:
    """The cost of every run, and the claims that fail in it."""
    script = Script()

    def mapper(robot: Robot) -> Survey:
        rule, motion = algorithm.rule(), algorithm.motion
        return exploration.explore(
            robot, rule=rule, motion=motion, pick=script.pick, order=script.order
        )

    more = True
    while more:
        run = explore(world, Target(algorithm.name, mapper))
        report = judge(replace(run, mapper=None))
        yield run.cost, frozenset(finding.claim for finding in report.findings)
        if algorithm.motion is retrace:
            script.settle(run.trace)
        more = script.advance()
