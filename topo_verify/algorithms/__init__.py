"""The catalogue: algorithms (a rule, a motion, two policies, one loop), and the steered mappers.

    chart.py            the map S                        exploration.py     the loop of listings 1-3
    motion.py           excursions: retrace, overlap     policies.py        pick and order
    basic.py            rule `none`                      enhancement_i.py   rule `prefix`
    enhancement_ii.py   rule `history`                   enhancement_iii.py rule `records`
    folding.py          rule `folding`                   planar.py          rule `planar`
    history.py          the fold of all that was seen    places.py          places of a fold
    homing.py           the mapper `homing`              planner.py         the mapper `planner`
    steering.py         the loop of the two

Nothing here can see a world: these files import `robot.percept`, `robot.events` and the standard
library, and a test holds them to it.

Source: docs/semantics.md, section 7.
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
from topo_verify.algorithms.basic import NoRule
from topo_verify.algorithms.chart import Survey
from topo_verify.algorithms.enhancement_i import PrefixRule
from topo_verify.algorithms.enhancement_ii import HistoryRule
from topo_verify.algorithms.enhancement_iii import RecordsRule
from topo_verify.algorithms.exploration import Rule, explore
from topo_verify.algorithms.folding import FoldingRule
from topo_verify.algorithms.homing import homing
from topo_verify.algorithms.motion import Motion, overlap, retrace
from topo_verify.algorithms.planar import PlanarRule, planar_homing, planar_planner
from topo_verify.algorithms.planner import planner
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
"""The policies that define the reference costs."""


@dataclass(frozen=True, slots=True, repr=False)
class Algorithm:
    """A mapper of the catalogue: called with a robot, it returns its map and its cost.

    Attributes:
        name: as in the catalogue.
        rule: makes the rule for one run.
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
        """Explore the robot's world. Deterministic: the same world gives the same run."""
        return explore(
            robot,
            # A rule remembers its run, so each run gets one of its own.
            rule=self.rule(),
            motion=self.motion,
            pick=choices.pick_policy(self.policies.pick),
            order=choices.order_policy(self.policies.order),
        )

    def with_policies(self, *, pick: str | None = None, order: str | None = None) -> Algorithm:
        """The same algorithm with other policies.

        Raises:
            ValueError: no such policy; the sentence lists them.
        """
        ours = self.policies
        theirs = Policies(pick or ours.pick, order or ours.order)
        return replace(self, policies=choices.check(theirs))

    def __repr__(self) -> str:
        """As code below `import topo_verify as tv`; of an algorithm of one's own only the name."""
        if replace(self, policies=REFERENCE) != CATALOGUE.get(self.name):
            return f"<Algorithm {self.name!r}>"
        chosen = (("pick", self.policies.pick), ("order", self.policies.order))
        others = [f"{k}={v!r}" for k, v in chosen if v != getattr(REFERENCE, k)]
        made = f".with_policies({', '.join(others)})" if others else ""
        return f"tv.CATALOGUE[{self.name!r}]{made}"

    def _repr_pretty_(self, printer: Any, _: bool) -> None:  # noqa: FBT001  asked by Hypothesis
        printer.text(repr(self))


@dataclass(frozen=True, slots=True)
class Steered:
    """A mapper of the catalogue that steers by the fold of its whole history: docs/homing.md.

    It has neither a rule nor policies to choose, and there is no compiled twin of it.

    Attributes:
        name: as in the catalogue.
        run: maps the world of one robot.
        assumes: "planar" if its maps are right in planar worlds only.
    """

    name: str
    run: Callable[[Robot], Survey]
    assumes: Literal["planar"] | None = None

    def __call__(self, robot: Robot) -> Survey:
        """Explore the robot's world. Deterministic: the same world gives the same run."""
        return self.run(robot)

    def __repr__(self) -> str:
        """The name; it is no code, for whoever wants one runs it by its name."""
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
"""Every algorithm under its name, from the weakest rule to the strongest."""

STEERED: dict[str, Steered] = {
    mapper.name: mapper
    for mapper in (
        Steered("homing", homing),
        Steered("planner", planner),
        Steered("homing+planar", planar_homing, assumes="planar"),
        Steered("planner+planar", planar_planner, assumes="planar"),
    )
}
"""The mappers that are no algorithms of the paper's loop. `all` leaves them out."""

NAMED: dict[str, Algorithm | Steered] = {**CATALOGUE, **STEERED}
"""Whatever a TARGET may name: the algorithms, then the steered mappers."""


def algorithm(name: str) -> Algorithm:
    """The algorithm of this name.

    Raises:
        ValueError: no such algorithm; the sentence lists them.
    """
    if name not in CATALOGUE:
        raise ValueError(f"no algorithm {name!r}: there are {', '.join(CATALOGUE)}")
    return CATALOGUE[name]
