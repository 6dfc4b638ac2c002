"""A trace replayed in its world: where the robot stood, what its map S was, what the truth is.

Trusted, and all that the claims build on. Nothing that a mapper said is believed: positions follow
from the doors, and S is drawn from the declared augmentations only as far as they are true.

    phi      S -> world: which dart of the world a dart of S is
    born     the event at which a dart of S appeared     (S at event i: the darts born before i)
    joined   the event at which it was explored          (explored at event i: joined before i)

S only grows, so these rows are S at every moment. From the first false augmentation on (`spoiled`)
it is no map of this world, and later decisions cannot be judged.

**Excursions.** Behind an edge the robot walks out and back. Its moves are reduced to the word of
doors from vu to where it stands: a move through the dart by which it came cancels the last door,
every other move adds one. A *sequence* is the word at a mismatch in motion. Once it is known where
the edge leads, its sequences show what lies behind unexplored darts: `records`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import NamedTuple

from topo_verify.errors import InputError
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Door, Percept
from topo_verify.robot.simulator import exit_dart, first_percept, percepts
from topo_verify.world.rooted_map import Dart, World


class Step(NamedTuple):
    """One door of a word, and what the world shows behind it to a robot that comes in there."""

    door: Door
    percept: Percept


Word = tuple[Step, ...]


class Round(NamedTuple):
    """A decision at event `when`: what had been posed, and executed behind the edge, until then."""

    when: int
    event: ev.Event
    pose: ev.Pose | None
    word: Word
    sequences: tuple[Word, ...]


def require_order(trace: Sequence[ev.Event]) -> None:
    """Does the trace begin with its only `start`, and not go on after `finish`? (InputError)."""
    for when, event in enumerate(trace or (None,)):
        ends = isinstance(event, ev.Finish) and when + 1 < len(trace)
        if isinstance(event, ev.Start) != (when == 0) or ends:
            told = "a trace begins with its only 'start' and does not go on after 'finish'"
            raise InputError(f"event {when} of the trace is out of order: {told}")


class Case:
    """A world and a trace, replayed once; what the claims are asked about.

    Args:
        world: where the run took place.
        trace: what happened; begins with its only `start`, and may end with `finish`.
        stopped: why the mapper ended without a map, if it did.
    Raises:
        InputError: the events are in no such order.
    """

    def __init__(self, world: World, trace: Sequence[ev.Event], stopped: str | None = None) -> None:
        require_order(trace)
        self.world, self.trace, self.stopped = world, trace, stopped
        self.cost = sum(isinstance(event, ev.Move) for event in trace)
        self.percepts = percepts(world)
        self.illegal: int | None = None  # the first move through a door that is not there
        self.positions = list(self._walk())  # the reference dart in the world after each event
        self.phi: list[Dart] = []
        self.born: list[int] = []
        self.joined: list[int] = []
        self.alpha: dict[Dart, Dart] = {}  # of S
        self.number: dict[Dart, Dart] = {}  # the inverse of phi
        self.records: dict[Dart, list[tuple[int, Word]]] = {}
        self.spoiled: int | None = None  # the first augmentation that is false in this world
        self._draw()

    def _walk(self) -> Iterator[Dart]:
        at = self.world.root or 0
        for when, event in enumerate(self.trace):
            if isinstance(event, ev.Move):
                if not 0 <= event.door < self.seen_at(at).degree:
                    self.illegal = when
                    return
                at = self.beyond(at, event.door)
            yield at

    def seen_at(self, dart: Dart) -> Percept:
        """What the world shows to a robot with this reference dart."""
        return self.percepts[dart] if self.percepts else first_percept(self.world)

    def beyond(self, dart: Dart, door: Door) -> Dart:
        """The reference dart in the world after leaving by a door."""
        return self.world.alpha[exit_dart(self.world, dart, door)]

    # ------------------------------------------------------------ its map S

    def _draw(self) -> None:
        if self.world.root is not None:
            self._add_vertex(self.world.root, 0)
        for when, event in enumerate(self.trace[: len(self.positions)]):
            if isinstance(event, ev.Augment) and not self._grow(when, event):
                self.spoiled = when
                return

    def _grow(self, when: int, event: ev.Augment) -> bool:
        """Let S grow as declared, if that is true of the world."""
        if not self.is_open(event.edge, when):
            return False
        end, new = self.end(event.edge), event.kind == "new"
        here = len(self.phi) if new and end not in self.number else self.number.get(end)
        if event.dart != here or new == (end in self.number):
            return False
        if event.degree != self.seen_at(end).degree:
            return False
        if new:
            self._add_vertex(end, when)
        for dart, other in ((event.edge, event.dart), (event.dart, event.edge)):
            self.alpha[dart], self.joined[dart] = other, when
        return True

    def _add_vertex(self, entry: Dart, when: int) -> None:
        for door in range(self.seen_at(entry).degree):
            self.number[exit_dart(self.world, entry, door)] = len(self.phi)
            self.phi.append(exit_dart(self.world, entry, door))
            self.born.append(when)
            self.joined.append(len(self.trace))

    def is_open(self, dart: Dart, when: int) -> bool:
        """Is this a dart of S, and unexplored, when event `when` happens?"""
        known = 0 <= dart < len(self.phi) and self.born[dart] <= when
        return known and self.joined[dart] >= when

    def turn(self, dart: Dart, door: Door) -> Dart:
        """The dart of S that a door means to a robot whose reference dart on S is `dart`."""
        return self.number[exit_dart(self.world, self.phi[dart], door)]

    def end(self, e: Dart) -> Dart:
        """The dart of the world at the other end of a dart of S."""
        return self.world.alpha[self.phi[e]]

    def truth(self, e: Dart, when: int) -> Dart | None:
        """The other end of the unexplored dart e of S, if its vertex is known at event `when`."""
        end = self.number.get(self.end(e)) if self.is_open(e, when) else None
        return end if end is not None and self.born[end] < when else None

    # ------------------------------------------------------------ excursions

    @cached_property
    def rounds(self) -> tuple[Round, ...]:
        """Every decision that can be judged: up to the first illegal move or false map."""
        return tuple(self._rounds())

    def _rounds(self) -> Iterator[Round]:
        pose: ev.Pose | None = None
        word: list[Step] = []
        sequences: tuple[Word, ...] = ()
        turned: Door = 0
        for when, event in enumerate(self.trace[: len(self.positions)]):
            match event:
                case ev.Move(door):
                    door = (door + turned) % self.seen_at(self.positions[when - 1]).degree
                    if door == 0 and word:
                        turned = word.pop().door
                    else:
                        word.append(Step(door, self.seen_at(self.positions[when])))
                        turned = 0
                case ev.Start() | ev.Finish():
                    pass
                case ev.Pose():
                    pose, word, sequences, turned = event, [], (), 0
                    yield Round(when, event, pose, (), ())
                case _:
                    yield Round(when, event, pose, tuple(word), sequences)
                    if isinstance(event, ev.Reject) and event.rule == "motion" and word:
                        sequences = (*sequences, tuple(word))
                    if isinstance(event, ev.Augment):
                        if pose is not None and pose.edge == event.edge and when != self.spoiled:
                            for sequence in sequences:
                                self._record(when, event.dart, sequence)
                        pose, sequences = None, ()
            if when == self.spoiled:
                return

    def _record(self, when: int, at: Dart, sequence: Word) -> None:
        """Keep what a sequence from a dart of S showed behind the first unexplored dart."""
        for place, step in enumerate(sequence):
            exit_at = self.turn(at, step.door)
            if self.is_open(exit_at, when + 1):
                self.records.setdefault(exit_at, []).append((when, sequence[place:]))
                return
            at = self.alpha[exit_at]

    def recorded(self, dart: Dart, doors: tuple[Door, ...], when: int) -> Percept | None:
        """What was known at event `when` of the place behind an unexplored dart and doors."""
        for since, word in self.records.get(dart, ()):
            if since < when and tuple(step.door for step in word[1 : len(doors) + 1]) == doors:
                return word[len(doors)].percept
        return None
