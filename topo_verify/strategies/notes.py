"""What a property test says of its runs: notes for the failing one, features for all of them.

    @given(world=worlds(max_edges=30), mapper=mappers())
    def test_cost_is_honest(world, mapper):
        run = tv.explore(world, mapper)
        observe(run)
        assert run.map.cost == run.cost

Of the failing example Hypothesis then prints the line

    enhancement-ii (pick nearest, order shortest) in m4/17: 12 edge traversals

With Hypothesis's own observability switch on (`HYPOTHESIS_EXPERIMENTAL_OBSERVABILITY=1`), every run
carries the features `edges`, `genus`, `cost` and `loop closings` into what it writes under
`.hypothesis/observed`. With it off they are not even computed.
"""

from __future__ import annotations

from typing import Protocol

from hypothesis import currently_in_test_context, event, note
from hypothesis.internal.observability import observability_enabled

from topo_verify.robot.events import Augment, Policies, Trace
from topo_verify.world.enumeration.rank_order import MAX_ID_EDGES
from topo_verify.world.rooted_map import World


class ObservedRun(Protocol):
    """A run of a mapper, as `topo_verify.explore` returns it."""

    @property
    def world(self) -> World:
        """Where."""
        ...

    @property
    def algorithm(self) -> str:
        """The mapper's name."""
        ...

    @property
    def policies(self) -> Policies | None:
        """Its policies, where they are known."""
        ...

    @property
    def cost(self) -> int:
        """Edge traversals."""
        ...

    @property
    def trace(self) -> Trace:
        """Everything that happened."""
        ...


def observe(run: ObservedRun) -> None:
    """Tell Hypothesis what this run was. Outside of a test of Hypothesis: nothing."""
    if not currently_in_test_context():
        return
    note(describe(run))
    if observability_enabled():
        for feature, value in features(run).items():
            event(feature, value)


def describe(run: ObservedRun) -> str:
    """Algorithm, policies, world and cost in one line.

    A world that has an id is called by it; a larger one by its JSON, which `World.from_json` reads.
    """
    world = run.world.id if len(run.world.edges) <= MAX_ID_EDGES else run.world.to_json()
    chosen = run.policies
    how = "" if chosen is None else f" (pick {chosen.pick}, order {chosen.order})"
    return f"{run.algorithm}{how} in {world}: {run.cost} edge traversals"


def features(run: ObservedRun) -> dict[str, int]:
    """What the viewers of Hypothesis's observations can sort runs by."""
    loops = sum(isinstance(event, Augment) and event.kind == "loop" for event in run.trace)
    return {
        "edges": len(run.world.edges),
        "genus": run.world.genus,
        "cost": run.cost,
        "loop closings": loops,
    }
