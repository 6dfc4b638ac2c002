"""Tries the choices that the paper leaves open: which e comes next, in which order H is tried.

A claim must hold for all of them. A search goes through

    reference    the reference policies alone (and a mapper that has no policies as it is)
    all          every named pick policy with every named order policy, `random` with a few seeds
    every        every choice that any policy could make

`every` runs the algorithm again and again. A script tells its policies, choice by choice, what to
take, and notes how many ways there were. The next run differs in the last choice that has a way
left (backtracking with no memory but one list). With motion `retrace`, what stands in H behind the
hypothesis that is confirmed is never tried, so its order is no choice. The runs of a world are
finitely many, but they grow beyond all bounds that matter: a vertex with three loops has some ten
thousand, with four over a hundred million. Hence `MOST_EDGES`.

What this does not show: other ways to walk. Which of several shortest paths is taken stays that of
docs/semantics.md, section 5.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import cache
from itertools import product

import msgspec

from topo_verify.algorithms import Algorithm, exploration
from topo_verify.algorithms.chart import Chart, Survey, Tree
from topo_verify.algorithms.motion import retrace
from topo_verify.algorithms.policies import ORDERS, PICKS
from topo_verify.checkers import Finding
from topo_verify.errors import InputError
from topo_verify.harness.judge import Report, judge
from topo_verify.harness.run import Exploration
from topo_verify.harness.search.plan import Plan
from topo_verify.harness.second_try import Tried, tried
from topo_verify.programs.loader import Target
from topo_verify.robot.events import Confirm, MapDart, Pose, Robot, Trace
from topo_verify.robot.limits import Limits
from topo_verify.world.rooted_map import World

SEEDS = 3
"""How many seeds of `random` are among all policies."""

MOST_EDGES = 3
"""The largest worlds in which every choice is tried."""


def examinations(
    target: Target, plan: Plan, world: World, beat: Callable[[], None]
) -> Iterator[Tried]:
    """The mapper's runs in a world, one for each way of choosing, each with its report.

    Args:
        beat: called before anything that may take long.
    """
    if plan.choices == "every":
        yield from _every(target, plan, world, beat)
    else:
        for variant in _variants(target, named=plan.choices == "all"):
            yield _examined(variant, plan.limits, world, beat)


def require_choices(targets: Iterable[Target], plan: Plan) -> None:
    """Raise an InputError unless each mapper has these choices and the worlds are small enough."""
    if plan.choices == "reference":
        return
    for target in targets:
        if not isinstance(target.mapper, Algorithm):
            raise InputError(
                f"{target.text} has no policies: --policies {plan.choices} is for algorithms of the"
                " catalogue; leave it out"
            )
    if plan.choices == "every" and plan.edges > MOST_EDGES:
        raise InputError(
            f"--policies every, --edges {plan.edges}: some worlds of {MOST_EDGES + 1} edges have"
            f" over a hundred million ways to choose; ask for {MOST_EDGES} edges, or --policies all"
        )


def _examined(target: Target, limits: Limits, world: World, beat: Callable[[], None]) -> Tried:
    def judged(run: Exploration) -> Report:
        beat()
        return judge(run, options=limits.options)

    beat()
    return tried(world, target, limits, judged)


# ---------------------------------------------------------------- named policies


def _variants(target: Target, *, named: bool) -> tuple[Target, ...]:
    """The mapper with each pair of named policies; without `named`, as it is."""
    if not named or not isinstance(target.mapper, Algorithm):
        return (target,)  # not from a cache, which would keep the process of a program alive
    return _named(target.text, target.mapper)


@cache
def _named(text: str, mapper: Algorithm) -> tuple[Target, ...]:
    """An algorithm with each pair of named policies."""
    random = [f"random({seed})" for seed in range(SEEDS)]
    pairs = product([*PICKS, *random], [*ORDERS, *random])
    return tuple(
        Target(text, mapper.with_policies(pick=pick, order=order)) for pick, order in pairs
    )


# ---------------------------------------------------------------- every choice


class Script:
    """Choices for one run after the other, until all are made.

    Life cycle: `choose` during a run, `advance` behind it; it says whether there is a further run.

    Attributes:
        words: the choices of this run, to be shown.
    """

    def __init__(self) -> None:
        self._taken: list[int] = []
        self._ways: list[int] = []
        self._next = 0
        self._orders: list[tuple[int, list[MapDart]]] = []  # where each H begins, and its order
        self.words: list[str] = []

    def choose(self, ways: int) -> int:
        """The number of the way to take, of so many; beyond the script's end the first."""
        if self._next == len(self._taken):
            self._taken.append(0)
            self._ways.append(ways)
        assert self._taken[self._next] < ways, "the same choices lead to the same choice"
        self._next += 1
        return self._taken[self._next - 1]

    def settle(self, trace: Trace) -> None:
        """Count the order of the hypotheses that were never tried as no choice.

        Args:
            trace: of this run, whose motion is `retrace`.
        """
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
        self._next = 0
        self._orders = []
        self.words = []
        return bool(self._taken)

    def pick(self, chart: Chart, _at: MapDart) -> MapDart:
        """A pick policy that takes the dart that the script says."""
        row = list(chart.unexplored)
        e = row[self.choose(len(row))]
        self.words.append(f"e = {e}")
        return e

    def order(self, darts: Iterable[MapDart], _chart: Chart, _tree: Tree) -> list[MapDart]:
        """An order policy that takes the order that the script says."""
        left, begin = sorted(darts), self._next
        row = [left.pop(self.choose(len(left))) for _ in range(len(left))]
        self._orders.append((begin, row))
        self.words.append(f"H = {row}")
        return row

    def mapper(self, algorithm: Algorithm) -> Callable[[Robot], Survey]:
        """The algorithm with the script for its policies."""

        def explore(robot: Robot) -> Survey:
            rule, motion = algorithm.rule(), algorithm.motion
            return exploration.explore(
                robot, rule=rule, motion=motion, pick=self.pick, order=self.order
            )

        return explore


def _every(target: Target, plan: Plan, world: World, beat: Callable[[], None]) -> Iterator[Tried]:
    assert isinstance(target.mapper, Algorithm), "require_choices has seen to it"
    script = Script()
    command = f"topo-verify search {target.text} --edges {len(world.edges)} --policies every"
    scripted = Target(target.text, script.mapper(target.mapper))
    more = True
    while more:
        run, report, _ = _examined(scripted, plan.limits, world, beat)
        chosen = f" (choices: {', '.join(script.words)})"
        findings = tuple(_with_choices(finding, chosen, command) for finding in report.findings)
        yield Tried(run, report.with_findings(findings))
        if target.mapper.motion is retrace:
            script.settle(run.trace)
        more = script.advance()


def _with_choices(finding: Finding, chosen: str, command: str) -> Finding:
    return msgspec.structs.replace(finding, message=finding.message + chosen, replay=command)
