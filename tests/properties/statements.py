"""The ten claims as statements about a run that can be read on their own, without the checkers.

Each takes a run and asserts. `STATEMENTS` has them under the names of the claims.

The last two speak of all worlds that look alike. They are judged by brute force, in every world
with up to one edge more than the run's: so for runs in small worlds. What this does not show: that
no larger world looks alike. The folding of `checkers/` says that, and is asked in test_claims.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import islice

from tests.helpers import of_type, worlds
from tests.properties.truth import Truth
from topo_verify import Exploration
from topo_verify.robot import events as ev
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world.rooted_map import Dart, World


def percepts_true(run: Exploration) -> None:
    """What is sensed is what the world shows."""
    truth = Truth(run)
    for event, _ in truth.events():
        if isinstance(event, ev.Move):
            assert event.percept == truth.sensed(truth.at)


def true_hypothesis_posed(run: Exploration) -> None:
    """If the edge leads to a known vertex, its dart is among the hypotheses."""
    for event, true_end in Truth(run).events():
        if isinstance(event, ev.Pose) and true_end is not None:
            assert true_end in event.hypotheses


def true_hypothesis_kept(run: Exploration) -> None:
    """No rule and no motion rejects the true hypothesis."""
    for event, true_end in Truth(run).events():
        if isinstance(event, ev.Reject):
            assert event.hypothesis != true_end


def no_false_confirm(run: Exploration) -> None:
    """What is confirmed is true."""
    for event, true_end in Truth(run).events():
        if isinstance(event, ev.Confirm):
            assert event.hypothesis == true_end


def map_isomorphic(run: Exploration) -> None:
    """Every map on the way is a part of the world, the last one all of it."""
    truth = Truth(run)
    for event, true_end in truth.events():
        if isinstance(event, ev.Augment):
            assert_true_of_world(truth, event, true_end)
    assert run.map is not None
    assert World.from_map(run.map).is_isomorphic(run.world)
    assert sorted(truth.image) == list(range(len(run.world.alpha)))
    assert all(
        run.world.alpha[truth.image[dart]] == truth.image[other]
        for dart, other in truth.joined.items()
    )


def cost_honest(run: Exploration) -> None:
    """The reported cost is the number of moves."""
    (finish,) = of_type(ev.Finish, run.trace)
    assert finish.cost == len(of_type(ev.Move, run.trace)) == run.cost


def cost_within_bound(run: Exploration) -> None:
    """Every edge is walked, and none of them more often than O(mn) times."""
    m, n = len(run.world.edges), len(run.world.vertices)
    assert m <= run.cost <= (m if n == 1 else m * (n + (2 * m - 1) * 2 * (n - 1)))
    assert run.world.least_cost() <= run.cost


def rejection_justified(run: Exploration) -> None:
    """What was observed is what the world shows, and not what S shows."""
    truth = Truth(run)
    for event, _ in truth.events():
        if not isinstance(event, ev.Reject) or event.rule == "folding":
            continue
        evidence = event.evidence
        assert evidence.expected != evidence.observed
        if evidence.record is None and evidence.at is not None:
            assert evidence.expected == truth.sensed(truth.image[evidence.at])
        if event.rule == "motion":
            assert evidence.observed == truth.sensed(truth.at)


# ---------------------------------------------------------------- in all worlds of about that size


def others(run: Exploration) -> Iterator[tuple[World, int]]:
    """Every world with up to one edge more than the run's; and how many events it shows alike."""
    for world in worlds(range(len(run.world.edges) + 2)):
        yield world, shown(world, run.trace)


def shown(world: World, trace: ev.Trace) -> int:
    """How many events of a trace are as this world shows them, up to the first that is not."""
    robot = SimulatedRobot(world, len(trace))
    for when, event in enumerate(trace):
        if isinstance(event, ev.Move):
            if event.door >= robot.percept.degree:
                return when
            robot.move(event.door)
        if isinstance(event, ev.Start | ev.Move) and event.percept != robot.percept:
            return when
    return len(trace)


def map_entailed(run: Exploration) -> None:
    """No other world with up to one edge more shows the whole history."""
    assert run.map is not None
    alike = [world for world, length in others(run) if length == len(run.trace)]
    assert alike == [World.from_code(World.from_map(run.map).code)]


def decisions_entailed(run: Exploration) -> None:
    """Each decision is true in every world with up to one edge more that looked alike before it."""
    for world, length in others(run):
        truth = Truth(replace(run, world=world))
        for event, true_end in islice(truth.events(), length):
            assert_true_of_world(truth, event, true_end)


def assert_true_of_world(truth: Truth, event: ev.Event, true_end: Dart | None) -> None:
    """A decision is true of the world in which S is followed."""
    if isinstance(event, ev.Reject):
        assert event.hypothesis != true_end
    if isinstance(event, ev.Confirm):
        assert event.hypothesis == true_end
    if isinstance(event, ev.Augment):
        assert (event.kind == "new") == (true_end is None)
        assert event.dart == (len(truth.image) if true_end is None else true_end)
        behind = truth.run.world.alpha[truth.image[event.edge]]
        assert event.degree == truth.sensed(behind).degree


STATEMENTS: dict[str, Callable[[Exploration], None]] = {
    statement.__name__.replace("_", "-"): statement
    for statement in (
        percepts_true,
        true_hypothesis_posed,
        true_hypothesis_kept,
        no_false_confirm,
        map_isomorphic,
        cost_honest,
        cost_within_bound,
        rejection_justified,
        map_entailed,
        decisions_entailed,
    )
}

OF_ALL_WORLDS = ("map-entailed", "decisions-entailed")
"""Those that are judged in all worlds of about the run's size."""
