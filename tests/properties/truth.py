"""Where a run really was: its trace beside its world, with every dart of S as a dart of the world.

Written apart from the checkers and their replay of traces, for statements about runs that can be
read without them. It trusts the augmentations as long as they are right; that is asked for.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

from topo_verify import Exploration
from topo_verify.robot.events import Augment, Confirm, Event, Move, Pose, Reject
from topo_verify.robot.percept import Percept
from topo_verify.world.rooted_map import Dart


@dataclass
class Truth:
    """The world beside S while a trace is read. Lives for one trace.

    Attributes:
        at: the robot's reference dart.
        image: the dart of the world that each dart of S is.
        joined: the other dart of S of each explored edge.
    """

    run: Exploration
    at: Dart = 0
    image: list[Dart] = field(default_factory=list[Dart])
    joined: dict[Dart, Dart] = field(default_factory=dict[Dart, Dart])

    def events(self) -> Iterator[tuple[Event, Dart | None]]:
        """Each event; with a decision, the dart of S in which its edge truly ends, if there is one.

        What an augmentation does to S is done when the next event is asked for.
        """
        world = self.run.world
        self.at = world.root or 0
        self._new_vertex(self.at if world.alpha else None)
        for event in self.run.trace:
            if isinstance(event, Move):
                self.at = world.alpha[self.turned(self.at, event.door)]
            if isinstance(event, Pose | Reject | Confirm | Augment):
                yield event, self._true_end(event.edge)
            else:
                yield event, None
            if isinstance(event, Augment):
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

    def _grow(self, event: Augment) -> None:
        if event.kind == "new":
            self._new_vertex(self.run.world.alpha[self.image[event.edge]])
        self.joined[event.edge] = event.dart
        self.joined[event.dart] = event.edge

    def _new_vertex(self, entry: Dart | None) -> None:
        dart = entry
        while dart is not None and dart not in self.image:
            self.image.append(dart)
            dart = self.run.world.sigma[dart]
