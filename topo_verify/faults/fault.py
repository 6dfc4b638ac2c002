"""Plants a mistake: a reference algorithm in which one part is replaced.

A part is the rule, the motion, a policy, or a name that the exploration loop looks up, such as
`Chart`; mostly a subclass with one wrong method. The loop's functions are copied into a namespace
with the replacement, so the reference stays intact.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from types import FunctionType
from typing import Any, Literal

from topo_verify.algorithms import CATALOGUE, Rule, exploration
from topo_verify.algorithms.chart import Chart, Survey
from topo_verify.algorithms.motion import Executed, Motion
from topo_verify.algorithms.policies import Order, Pick, order_policy, pick_policy
from topo_verify.robot.events import Decision, MapDart, Robot
from topo_verify.robot.percept import Door, Percept, Purpose

PartName = Literal[
    "motion",
    "marker",
    "hypotheses",
    "prefix",
    "history",
    "records",
    "chart",
    "folding",
    "declarations",
    "report",
]
"""The part of the mapper that is replaced."""

Walks = Sequence[Executed]
"""What was executed behind one edge."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """A mapper: a reference algorithm with one mistake.

    Attributes:
        module: the name of the module in which it stands.
        why: what the mapper does wrong, in one sentence.
        claim: the claim that must catch it; None: the difference is no mistake.
        theorem: the theorem that has the same mistake in its rule.
    """

    name: str
    module: str
    part: PartName
    why: str
    claim: str | None
    mapper: Callable[[Robot], object]
    theorem: str | None = None

    def __call__(self, robot: Robot) -> object:
        """Explore the robot's world, with the mistake."""
        return self.mapper(robot)

    @property
    def target(self) -> str:
        """The TARGET that names it on a command line."""
        return f"{self.module}:{self.name.replace('-', '_')}"


def planted(
    part: PartName,
    base: str = "",
    replaced: str = "",
    *,
    claim: str | None = None,
    theorem: str | None = None,
    **others: Any,
) -> Callable[[Any], Fault]:
    """Decorate a mistake, whose docstring is the `why` of the fault.

    Args:
        base: the algorithm in which it is planted; empty: the mistake is a mapper.
        replaced: what it replaces: a parameter of `mapper`, or `robot`, which it wraps.
        others: further parts to replace.
    """

    def plant(mistake: Any) -> Fault:
        wrong = mistake
        if replaced == "robot":

            def wrapped(robot: Robot) -> Survey:
                return CATALOGUE[base](mistake(robot))

            wrong = wrapped
        elif base:
            wrong = mapper(base, **{replaced: mistake}, **others)
        return Fault(
            name=mistake.__name__.replace("_", "-"),
            module=mistake.__module__,
            part=part,
            why=mistake.__doc__,
            claim=claim,
            mapper=wrong,
            theorem=theorem,
        )

    return plant


def mapper(
    name: str,
    *,
    rule: Callable[[], Rule] | None = None,
    motion: Motion | None = None,
    pick: Pick | None = None,
    order: Order | None = None,
    **names: object,
) -> Callable[[Robot], Survey]:
    """The algorithm of this name with some parts replaced.

    Args:
        names: replacements of names that `algorithms/exploration.py` looks up.
    """
    base = CATALOGUE[name]
    loop = rebound(**names)["explore"]

    def explore(robot: Robot) -> Survey:
        survey: Survey = loop(
            robot,
            rule=(rule or base.rule)(),
            motion=motion or base.motion,
            pick=pick or pick_policy(base.policies.pick),
            order=order or order_policy(base.policies.order),
        )
        return survey

    return explore


def rebound(**names: object) -> dict[str, Any]:
    """A copy of the namespace of `algorithms/exploration.py` with some names replaced."""
    reference = vars(exploration)
    assert names.keys() <= reference.keys(), f"the loop knows no {names.keys() - reference.keys()}"
    space = dict(reference)
    for name, value in reference.items():
        if isinstance(value, FunctionType) and value.__module__ == exploration.__name__:
            space[name] = FunctionType(value.__code__, space, name, value.__defaults__)
            space[name].__kwdefaults__ = value.__kwdefaults__
    space.update(names)
    return space


class ForwardingRobot:
    """Passes every call on to a robot; subclasses change one."""

    def __init__(self, robot: Robot) -> None:
        self.robot = robot

    @property
    def percept(self) -> Percept:
        return self.seen(self.robot.percept)

    def seen(self, percept: Percept) -> Percept:
        """The percept in place of the robot's."""
        return percept

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:
        return self.seen(self.robot.move(door, purpose))

    def declare(self, event: Decision) -> None:
        self.robot.declare(event)


def crossed(chart: Chart) -> MapDart:
    """The dart e just crossed: not yet explored, no longer in U."""
    return next(d for d, o in enumerate(chart.alpha) if o is None and d not in chart.unexplored)


def one_late(sequences: Walks) -> list[Executed]:
    """The sequences with each percept one door late."""
    return [Executed(s.doors, (s.percepts[0], *s.percepts[:-1])) for s in sequences]
