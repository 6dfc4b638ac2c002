"""Reports runs to Hypothesis: a note for the failing example, features for every example.

    run = tv.explore(world, mapper)
    observe(run)

With `HYPOTHESIS_EXPERIMENTAL_OBSERVABILITY=1` features are written under `.hypothesis/observed`.
"""

from __future__ import annotations

from typing import Protocol

from hypothesis import currently_in_test_context, event, note
from hypothesis.internal.observability import observability_enabled

from topo_verify.errors import plural, shown
from topo_verify.robot.events import Augment, Policies, Trace
from topo_verify.world.rooted_map import World


class ObservedRun(Protocol):
    """A run of a mapper, as `topo_verify.explore` returns it."""

    @property
    def world(self) -> World:
        """The world that was explored."""
        ...

    @property
    def algorithm(self) -> str:
        """The name of the mapper."""
        ...

    @property
    def policies(self) -> Policies | None:
        """The mapper's policies, if any."""
        ...

    @property
    def cost(self) -> int:
        """The cost in edge traversals."""
        ...

    @property
    def trace(self) -> Trace:
        """All events of the run."""
        ...


def observe(run: ObservedRun) -> None:
    """Note the run in Hypothesis; outside of its tests, do nothing."""
    if not currently_in_test_context():
        return
    note(describe(run))
    if observability_enabled():
        for feature, value in features(run).items():
            event(feature, value)


def describe(run: ObservedRun) -> str:
    """Algorithm, policies, world (its id, or its JSON) and cost in one line."""
    chosen = run.policies
    how = "" if chosen is None else f" (pick {chosen.pick}, order {chosen.order})"
    return f"{shown(run.algorithm)}{how} in {run.world.text}: {plural(run.cost, 'edge traversal')}"


def features(run: ObservedRun) -> dict[str, int]:
    """Numbers for viewers of Hypothesis's observations."""
    loops = sum(isinstance(event, Augment) and event.kind == "loop" for event in run.trace)
    return {
        "edges": len(run.world.edges),
        "genus": run.world.genus,
        "cost": run.cost,
        "loop closings": loops,
    }
