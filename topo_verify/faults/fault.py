"""Plants a mistake: a reference algorithm in which one part is replaced.

A part is the rule, the motion, a policy, or a name that the exploration loop looks up: `Chart`,
`Pilot`, `Hypothesis`, `validate` and so on. Wherever possible, a subclass replaces it in which one
method has one mistake. The loop itself is the reference's own code: its functions are copied and
look names up in another namespace, in which some are replaced. The reference itself stays intact.
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
"""The part of a mapper that a mistake is in: also the file in which it stands."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """A reference algorithm with one mistake in it; call it with a robot, as any mapper.

    Attributes:
        name: what the command line calls it.
        part: where the mistake is.
        why: what the mapper does wrong, in one sentence.
        claim: the claim that must catch it, or None: it is harmless.
        mapper: the algorithm with the mistake.
        theorem: the theorem of `topo-verify prove` that has the same mistake in its rule.
    """

    name: str
    part: PartName
    why: str
    claim: str | None
    mapper: Callable[[Robot], object]
    theorem: str | None = None

    def __call__(self, robot: Robot) -> object:
        """Explore the robot's world, with the mistake."""
        return self.mapper(robot)

    @property
    def harmless(self) -> bool:
        """Does the difference change no more than the cost, so that every claim must hold?"""
        return self.claim is None

    @property
    def target(self) -> str:
        """The TARGET under which the command line finds the mapper."""
        room = "harmless" if self.harmless else self.part
        return f"topo_verify.faults.{room}:{self.name.replace('-', '_')}"


def mapper(
    name: str,
    *,
    rule: Callable[[], Rule] | None = None,
    motion: Motion | None = None,
    pick: Pick | None = None,
    order: Order | None = None,
    **names: object,
) -> Callable[[Robot], Survey]:
    """The algorithm of this name with some of its parts replaced.

    Args:
        rule, motion, pick, order: the part that replaces the algorithm's own.
        names: by name, what replaces a name that `algorithms/exploration.py` looks up.
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
    """The namespace of `algorithms/exploration.py` with some of its names replaced.

    Its functions are copied into this namespace, so they call each other and the replacements.
    """
    reference = vars(exploration)
    assert names.keys() <= reference.keys(), f"the loop knows no {names.keys() - reference.keys()}"
    # A function finds names in the namespace that it was made with. So copies of the functions see
    # the replacements, and the module itself, which every other mapper uses, is not touched.
    space = dict(reference)
    for name, value in reference.items():
        if isinstance(value, FunctionType) and value.__module__ == exploration.__name__:
            space[name] = FunctionType(value.__code__, space, name, value.__defaults__)
            space[name].__kwdefaults__ = value.__kwdefaults__
    space.update(names)
    return space


# ---------------------------------------------------------------- shared by several mistakes


class ForwardingRobot:
    """A robot that passes every call on to another; subclasses change one of them."""

    def __init__(self, robot: Robot) -> None:
        self.robot = robot

    @property
    def percept(self) -> Percept:
        """The percept that the mapper gets."""
        return self.seen(self.robot.percept)

    def seen(self, percept: Percept) -> Percept:
        """The percept that the mapper gets for this one of the robot."""
        return percept

    def move(self, door: Door, purpose: Purpose | None = None) -> Percept:
        """Leave by a door."""
        return self.seen(self.robot.move(door, purpose))

    def declare(self, event: Decision) -> None:
        """Put a decision on record."""
        self.robot.declare(event)


def crossed(chart: Chart) -> MapDart:
    """The dart e that the robot has just crossed: not yet explored, and not in U any more."""
    return next(d for d, o in enumerate(chart.alpha) if o is None and d not in chart.unexplored)


def one_late(sequences: Sequence[Executed]) -> list[Executed]:
    """The sequences with each percept shifted by one, behind the door after its own."""
    return [Executed(s.doors, (s.percepts[0], *s.percepts[:-1])) for s in sequences]
