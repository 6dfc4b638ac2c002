"""A trace replayed in its world: where the robot stood, what its map S was, what the truth is.

Trusted, and all that the claims build on. Nothing that a mapper said is believed: positions follow
from the doors alone, and S is drawn from the declared augmentations only as far as they are true.

    phi      S -> world: which dart of the world a dart of S is
    born     the event at which a dart of S appeared     (S at event i: the darts born before i)
    joined   the event at which it was explored          (explored at event i: joined before i)

Since S only grows, these three rows are S at every moment. From the first false augmentation on
(`spoiled`) S is no map of this world and later decisions cannot be judged.

**Excursions.** Behind an edge e the robot walks out and back. Its moves are reduced to the word of
doors that leads from vu to where it stands: a move through the dart by which it came cancels the
last door, every other move adds one. A *sequence* is the word at a mismatch in motion. Once it is
known where e leads, its sequences show what lies behind unexplored darts: `records`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import NamedTuple

from topo_verify.errors import InputError
from topo_verify.robot.events import Augment, Event, Finish, Move, Pose, Reject, Start
from topo_verify.robot.percept import Door, Percept
from topo_verify.robot.simulator import exit_dart, first_percept, percepts
from topo_verify.world.rooted_map import Dart, World


class Step(NamedTuple):
    """One door of a word, and what the world shows behind it to a robot that comes in there."""

    door: Door
    percept: Percept


Word = tuple[Step, ...]


class Round(NamedTuple):
    """A decision about edge e: what was posed, and what had been executed when it was made."""

    when: int
    event: Event
    pose: Pose | None
    word: Word
    sequences: tuple[Word, ...]


class Case:
    """A world and a trace, replayed once; what the claims are asked about.

    Args:
        world: where the run took place.
        trace: what happened; begins with its only `start`; ends with `finish` if the mapper did.
        stopped: why the mapper ended without a map, if it did.
    Raises:
        InputError: the events are in no such order.
    """

    def __init__(self, world: World, trace: Sequence[Event], stopped: str | None = None) -> None:
        self.world, self.trace, self.stopped = world, trace, stopped
        if not trace or not isinstance(trace[0], Start):
            raise InputError("a trace begins with a 'start' event")
        for index, event in enumerate(trace[1:], 1):
            if isinstance(event, Start) or (isinstance(event, Finish) and index + 1 != len(trace)):
                raise InputError(
                    f"event {index} of the trace is a second 'start', or a 'finish' before the end"
                )
        self.percepts = percepts(world)
        self.illegal: int | None = None
        """The first move through a door that is not there; nothing is known after it."""
        self.positions = self._walk()
        self.phi: list[Dart] = []
        self.born: list[int] = []
        self.joined: list[int | None] = []
        self.alpha: list[Dart | None] = []
        self.number: dict[Dart, Dart] = {}
        self.records: dict[Dart, list[tuple[int, Word]]] = {}
        self.spoiled: int | None = None
        """The first augmentation that is false in this world."""
        self._draw()

    # ------------------------------------------------------------ where the robot was

    def _walk(self) -> list[Dart]:
        """The robot's reference dart in the world after each event."""
        at = self.world.root or 0
        row: list[Dart] = []
        for index, event in enumerate(self.trace):
            if isinstance(event, Move):
                if not 0 <= event.door < self.seen_at(at).degree:
                    self.illegal = index
                    break
                at = self.beyond(at, event.door)
            row.append(at)
        return row

    def seen_at(self, dart: Dart) -> Percept:
        """What the world shows to a robot with this reference dart."""
        return self.percepts[dart] if self.percepts else first_percept(self.world)

    def beyond(self, dart: Dart, door: Door) -> Dart:
        """The reference dart in the world after leaving by a door."""
        return self.world.alpha[exit_dart(self.world, dart, door)]

    @property
    def cost(self) -> int:
        """Edge traversals: the number of moves."""
        return sum(isinstance(event, Move) for event in self.trace)

    @property
    def judged(self) -> Sequence[Event]:
        """The events whose decisions can be judged: up to the first illegal move or false map."""
        end = len(self.positions)
        return self.trace[: end if self.spoiled is None else min(end, self.spoiled + 1)]

    # ------------------------------------------------------------ its map S

    def _draw(self) -> None:
        if self.world.root is not None:
            self._add_vertex(self.world.root, 0)
        for index, event in enumerate(self.trace[: len(self.positions)]):
            if isinstance(event, Augment) and not self._grow(index, event):
                self.spoiled = index
                return

    def _grow(self, index: int, event: Augment) -> bool:
        """Let S grow as declared, if that is true of the world."""
        e = event.edge
        if not self.is_open(e, index):
            return False
        end = self.world.alpha[self.phi[e]]
        if event.degree != self.percepts[end].degree:
            return False
        if event.kind == "new":
            if end in self.number or event.dart != len(self.phi):
                return False
            self._add_vertex(end, index)
        elif self.number.get(end) != event.dart:
            return False
        for dart, other in ((e, event.dart), (event.dart, e)):
            self.alpha[dart], self.joined[dart] = other, index
        return True

    def _add_vertex(self, entry: Dart, index: int) -> None:
        for door in range(self.percepts[entry].degree):
            dart = exit_dart(self.world, entry, door)
            self.number[dart] = len(self.phi)
            self.phi.append(dart)
            self.born.append(index)
            self.joined.append(None)
            self.alpha.append(None)

    def is_open(self, dart: Dart, index: int) -> bool:
        """Is this a dart of S, and unexplored, when event `index` happens?"""
        if not 0 <= dart < len(self.phi) or self.born[dart] > index:
            return False
        joined = self.joined[dart]
        return joined is None or joined >= index

    def crossed(self, dart: Dart, index: int) -> Dart | None:
        """The other end of a dart of S, if it is explored when event `index` happens."""
        return None if self.is_open(dart, index) else self.alpha[dart]

    def turn(self, dart: Dart, door: Door) -> Dart:
        """The dart of S that a door means to a robot whose reference dart on S is `dart`."""
        return self.number[exit_dart(self.world, self.phi[dart], door)]

    def truth(self, e: Dart, index: int) -> Dart | None:
        """The other end of the unexplored dart e of S, if its vertex is known at event `index`."""
        if not self.is_open(e, index):
            return None
        end = self.number.get(self.world.alpha[self.phi[e]])
        return end if end is not None and self.born[end] < index else None

    # ------------------------------------------------------------ excursions

    @cached_property
    def rounds(self) -> tuple[Round, ...]:
        """Every judged decision, with what had been executed behind its edge until then."""
        return tuple(self._rounds())

    def _rounds(self) -> Iterator[Round]:
        pose: Pose | None = None
        word: list[Step] = []
        sequences: tuple[Word, ...] = ()
        turned: Door = 0
        for index, event in enumerate(self.judged):
            match event:
                case Move():
                    before = self.seen_at(self.positions[index - 1])
                    door = (event.door + turned) % before.degree
                    if door == 0 and word:
                        turned = word.pop().door
                    else:
                        word.append(Step(door, self.seen_at(self.positions[index])))
                        turned = 0
                case Start() | Finish():
                    pass
                case Pose():
                    pose, word, sequences, turned = event, [], (), 0
                    yield Round(index, event, pose, (), ())
                case _:
                    yield Round(index, event, pose, tuple(word), sequences)
                    if isinstance(event, Reject) and event.rule == "motion" and word:
                        sequences = (*sequences, tuple(word))
                    if isinstance(event, Augment):
                        if pose is not None and pose.edge == event.edge and index != self.spoiled:
                            for sequence in sequences:
                                self._record(index, event.dart, sequence)
                        pose, sequences = None, ()

    def _record(self, index: int, at: Dart, sequence: Word) -> None:
        """Keep what a sequence from a dart of S showed behind the first unexplored dart."""
        for place, step in enumerate(sequence):
            exit_dart = self.turn(at, step.door)
            arrival = self.crossed(exit_dart, index + 1)
            if arrival is None:
                self.records.setdefault(exit_dart, []).append((index, sequence[place:]))
                return
            at = arrival

    def recorded(self, dart: Dart, doors: tuple[Door, ...], index: int) -> Percept | None:
        """What was known at event `index` of the place behind an unexplored dart and doors."""
        for since, word in self.records.get(dart, ()):
            if since < index and tuple(step.door for step in word[1:])[: len(doors)] == doors:
                return word[len(doors)].percept
        return None
