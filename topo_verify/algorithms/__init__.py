"""The catalogue: algorithms (a rule, a motion, two policies, one loop) and steered mappers.

    chart.py          the map S                exploration.py    the loop of listings 1-3
    motion.py         retrace, overlap         policies.py       pick and order
    rules.py          the paper's four rules: `none`, `prefix`, `history`, `records`

What is ours, not the paper's, stands in beyond/:

    folding.py        rule `folding`           planar.py         rule `planar`
    history.py        the fold of a run        places.py         its places
    homing.py         mapper `homing`          planner.py        mapper `planner`
    steering.py       the loop of the two      next_edge.py      their next edge

No file here can see a world: a test limits the imports.
"""

from __future__ import annotations

if __name__ != "topo_verify.algorithms":
    raise ImportError(
        f"this package is topo_verify.algorithms; as {__name__!r} its classes would exist twice"
    )

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Literal

from topo_verify.algorithms import policies as choices
from topo_verify.algorithms.beyond.folding import FoldingRule
from topo_verify.algorithms.beyond.homing import homing
from topo_verify.algorithms.beyond.planar import PlanarRule, planar_homing, planar_planner
from topo_verify.algorithms.beyond.planner import planner
from topo_verify.algorithms.chart import Survey
from topo_verify.algorithms.exploration import Rule, explore
from topo_verify.algorithms.motion import Motion, overlap, retrace
from topo_verify.algorithms.rules import HistoryRule, NoRule, PrefixRule, RecordsRule
from topo_verify.robot.events import Policies, Robot

__all__ = [
    "CATALOGUE",
    "NAMED",
    "REFERENCE",
    "STEERED",
    "Algorithm",
    "Policies",
    "Rule",
    "Steered",
    "algorithm",
]

REFERENCE = Policies("nearest", "shortest")


@dataclass(frozen=True, slots=True, repr=False)
class Algorithm:
    """A mapper that runs the paper's loop: called with a robot, it returns map and cost.

    Attributes:
        rule: makes the rule of one run.
        motion: `retrace` or `overlap`.
        policies: which edge next, which hypothesis first.
        assumes: "planar" if its maps are right in planar worlds only.
    """

    name: str
    rule: Callable[[], Rule]
    motion: Motion
    policies: Policies = REFERENCE
    assumes: Literal["planar"] | None = None

    def __call__(self, robot: Robot) -> Survey:
        """Explore the robot's world."""
        return explore(
            robot,
            rule=self.rule(),
            motion=self.motion,
            pick=choices.pick_policy(self.policies.pick),
            order=choices.order_policy(self.policies.order),
        )

    def with_policies(self, *, pick: str | None = None, order: str | None = None) -> Algorithm:
        """The same algorithm with other policies.

        Raises:
            ValueError: no such policy.
        """
        policies = Policies(pick or self.policies.pick, order or self.policies.order)
        return replace(self, policies=choices.check(policies))

    def __repr__(self) -> str:
        if replace(self, policies=REFERENCE) != CATALOGUE.get(self.name):
            return f"<Algorithm {self.name!r}>"
        chosen = (("pick", self.policies.pick), ("order", self.policies.order))
        others = [f"{k}={v!r}" for k, v in chosen if v != getattr(REFERENCE, k)]
        policies = f".with_policies({', '.join(others)})" if others else ""
        return f"tv.CATALOGUE[{self.name!r}]{policies}"

    def _repr_pretty_(self, printer: Any, _: bool) -> None:  # noqa: FBT001  asked by Hypothesis
        printer.text(repr(self))


@dataclass(frozen=True, slots=True)
class Steered:
    """A mapper that steers by the fold of its history: docs/homing.md. No rule, no policies."""

    name: str
    run: Callable[[Robot], Survey]
    assumes: Literal["planar"] | None = None

    def __call__(self, robot: Robot) -> Survey:
        """Explore the robot's world."""
        return self.run(robot)

    def __repr__(self) -> str:
        return f"<Steered {self.name!r}>"


def _one_level() -> Rule:
    return RecordsRule(levels=1)


def _planar_folding() -> Rule:
    return PlanarRule(FoldingRule())


CATALOGUE: dict[str, Algorithm] = {
    algorithm.name: algorithm
    for algorithm in (
        Algorithm("basic", NoRule, retrace),
        Algorithm("enhancement-i", PrefixRule, overlap),
        Algorithm("enhancement-ii", HistoryRule, retrace),
        Algorithm("enhancement-ii+i", HistoryRule, overlap),
        Algorithm("enhancement-iii-one", _one_level, retrace),
        Algorithm("enhancement-iii-one+i", _one_level, overlap),
        Algorithm("enhancement-iii-all", RecordsRule, retrace),
        Algorithm("enhancement-iii-all+i", RecordsRule, overlap),
        Algorithm("folding", FoldingRule, overlap),
        Algorithm("folding+planar", _planar_folding, overlap, assumes="planar"),
    )
}
"""From the weakest rule to the strongest."""

STEERED: dict[str, Steered] = {
    mapper.name: mapper
    for mapper in (
        Steered("homing", homing),
        Steered("planner", planner),
        Steered("homing+planar", planar_homing, assumes="planar"),
        Steered("planner+planar", planar_planner, assumes="planar"),
    )
}
"""`all` leaves them out."""

NAMED: dict[str, Algorithm | Steered] = {**CATALOGUE, **STEERED}


def algorithm(name: str) -> Algorithm:
    """The algorithm of this name.

    Raises:
        ValueError: no such algorithm.
    """
    if name not in CATALOGUE:
        raise ValueError(f"no algorithm {name!r}: there are {', '.join(CATALOGUE)}")
    return CATALOGUE[name]
