"""The two claims about all worlds that look alike, as statements without the checkers.

Each takes a run and asserts. They are judged by brute force, in every world with up to one edge
more than the run's: so for runs in small worlds. What this does not show: that no larger world
looks alike. The folding of `checkers/` says that, and is asked in test_claims.py. The other eight
claims have their second opinion in tests/checkers/second_opinion.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from itertools import islice

from tests.helpers import worlds
from topo_verify import Exploration
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world.rooted_map import Dart, World


@dataclass
class Truth:
    """The world beside S while a trace is read, each dart of S as a dart of it. For one trace.

    It trusts the augmentations as long as they are right; that is asked for.

    Attributes:
        at: the robot's reference dart.
        image: the dart of the world that each dart of S is.
    """

    run: Exploration
    at: Dart = 0
    image: list[Dart] = field(default_factory=list[Dart])

    def events(self) -> Iterator[tuple[ev.Event, Dart | None]]:
        """Each event; with a decision, the dart of S in which its edge truly ends, if there is one.

        What an augmentation does to S is done when the next event is asked for.
        """
        world = self.run.world
        self.at = world.root or 0
        self._new_vertex(self.at if world.alpha else None)
        for event in self.run.trace:
            if isinstance(event, ev.Move):
                self.at = world.alpha[self.turned(self.at, event.door)]
            if isinstance(event, ev.Pose | ev.Reject | ev.Confirm | ev.Augment):
                yield event, self._true_end(event.edge)
            else:
                yield event, None
            if isinstance(event, ev.Augment):
                self._grow(event)

    def turned(self, dart: Dart, door: int) -> Dart:
        """sigma^door(dart), by the definition."""
        for _ in range(door):
            dart = self.run.world.sigma[dart]
        return dart

    def sensed(self, dart: Dart) -> Percept:
        """What a robot senses with this reference dart, by the definition."""
        world = self.run.world
        row = [dart]
        while world.sigma[row[-1]] != dart:
            row.append(world.sigma[row[-1]])
        return Percept(len(row), row.index(world.root) if world.root in row else None)

    def _true_end(self, edge: Dart) -> Dart | None:
        arrival = self.run.world.alpha[self.image[edge]]
        return self.image.index(arrival) if arrival in self.image else None

    def _grow(self, event: ev.Augment) -> None:
        if event.kind == "new":
            self._new_vertex(self.run.world.alpha[self.image[event.edge]])

    def _new_vertex(self, entry: Dart | None) -> None:
        dart = entry
        while dart is not None and dart not in self.image:
            self.image.append(dart)
            dart = self.run.world.sigma[dart]


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
    "map-entailed": map_entailed,
    "decisions-entailed": decisions_entailed,
}
