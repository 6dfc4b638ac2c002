"""A trace replayed in its world: where the robot stood, what its map S was, what it had walked.

Trusted, and all that the claims build on. Nothing that a mapper said is believed: positions follow
from the doors, and S is drawn from the declared augmentations only as far as they are true. From
the first move through a door that is not there (`illegal`) the position is unknown; from the first
false augmentation on (`spoiled`) S is no map of this world. Later decisions are not judged.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import NamedTuple

from topo_verify.checkers.darts import KnownDart, WorldDart
from topo_verify.checkers.entailment import Conclusion, decision_conclusions
from topo_verify.checkers.excursions import Excursion, Records, Word
from topo_verify.checkers.map_in_world import MapInWorld
from topo_verify.errors import InputError
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept
from topo_verify.world.rooted_map import World


class Round(NamedTuple):
    """A decision at event `when`, and what was executed behind the edge since the last pose.

    After a **late pose**, of an edge crossed before, no move is behind the edge.

    Attributes:
        pose: the last one so far, if it was of this edge and S did not grow since.
    """

    when: int
    event: ev.Decision
    pose: ev.Pose | None
    word: Word
    sequences: tuple[Word, ...]


class Fate(NamedTuple):
    """What became of an edge that was posed.

    Attributes:
        when, event: its last pose; or the augmentation, once S grew along it.
        left: hypotheses neither rejected nor confirmed since they were posed; none after a loop.
    """

    when: int
    event: ev.Pose | ev.Augment
    left: set[int]


def require_order(trace: Sequence[ev.Event]) -> None:
    """Raise InputError unless the trace begins with its only `start` and ends with any `finish`."""
    for when, event in enumerate(trace or (None,)):
        ends = isinstance(event, ev.Finish) and when + 1 < len(trace)
        if isinstance(event, ev.Start) != (when == 0) or ends:
            rule = "a trace begins with its only 'start' and does not go on after 'finish'"
            raise InputError(f"event {when} of the trace is out of order: {rule}")


class ReplayedTrace:
    """A world and a trace, replayed once; what the claims are asked about.

    Args:
        world: where the run took place.
        trace: what happened; begins with its only `start`, and may end with `finish`.
        stopped: why the mapper ended without a map, if it did.
    Attributes:
        cost: the number of moves.
        kinds: the types of its events.
        map: S, drawn on the world.
        positions: the reference dart in the world after each event, up to an illegal move.
        followed: the events up to an illegal move.
        illegal: the first move through a door that is not there, or None.
        spoiled: the first augmentation that is false in this world, or None.
        crossings: the edges of the world that the robot crossed, and at which event first.
        false_percepts: each event whose percept is not what the world shows: its own, and what is.
    Raises:
        InputError: the events are in no such order.
    """

    def __init__(self, world: World, trace: Sequence[ev.Event], stopped: str | None = None) -> None:
        require_order(trace)
        self.world, self.trace, self.stopped = world, trace, stopped
        self.cost = sum(isinstance(event, ev.Move) for event in trace)
        self.kinds = {*map(type, trace)}
        self.map = MapInWorld(world)
        self.records = Records(self.map)
        self.illegal: int | None = None
        self.spoiled: int | None = None
        self.positions: list[WorldDart] = []
        self.crossings: dict[int, int] = {}
        self.false_percepts: list[tuple[int, Percept, Percept]] = []
        self._walk()
        self.followed = trace[: len(self.positions)]

    def _walk(self) -> None:
        """Follow the doors up to the first that is not there, and draw S on the way."""
        at = WorldDart(self.world.root or 0)
        for when, event in enumerate(self.trace):
            if isinstance(event, ev.Move):
                if not 0 <= event.door < self.map.seen_at(at).degree:
                    self.illegal = when
                    return
                at = self.map.beyond(at, event.door)
                self.crossings.setdefault(self.crossing(at), when)
            elif isinstance(event, ev.Augment) and self.spoiled is None:
                self.spoiled = None if self.map.grow(when, event) else when
            if isinstance(event, (ev.Start, ev.Move)) and event.percept != self.map.seen_at(at):
                self.false_percepts.append((when, event.percept, self.map.seen_at(at)))
            self.positions.append(at)

    @property
    def is_history(self) -> bool:
        """Whether the world shows all percepts of the trace and has all its doors."""
        return self.illegal is None and not self.false_percepts

    @cached_property
    def rounds(self) -> tuple[Round, ...]:
        """Every decision that can be judged: up to the first illegal move or false map."""
        return tuple(self._rounds())

    def _rounds(self) -> Iterator[Round]:
        pose: ev.Pose | None = None
        behind = Excursion()
        for when, event in enumerate(self.followed):
            if isinstance(event, ev.Move):
                left, entered = map(self.map.seen_at, self.positions[when - 1 : when + 1])
                behind.move(event.door, left.degree, entered)
            elif isinstance(event, ev.Pose):
                pose, behind = event, Excursion(is_late=not self._is_behind(when, event.edge))
                yield Round(when, event, pose, (), ())
            elif isinstance(event, (ev.Reject, ev.Confirm, ev.Augment)):
                of_edge = pose if pose and pose.edge == event.edge else None
                yield Round(when, event, of_edge, tuple(behind.word), behind.sequences)
                if isinstance(event, ev.Augment):
                    if when == self.spoiled:
                        return
                    if of_edge:  # it is true, so S has its dart
                        self.records.add(when, KnownDart(event.dart), behind.sequences)
                    pose, behind.sequences = None, ()
                elif isinstance(event, ev.Reject) and event.rule == "motion" and behind.word:
                    behind.sequences = (*behind.sequences, tuple(behind.word))

    def _is_behind(self, when: int, e: int) -> bool:
        """Whether the robot stands behind the unexplored dart e of S, come in by its other end."""
        return self.map.is_open(e, when) and self.positions[when] == self.map.end(e)

    def crossing(self, dart: WorldDart) -> int:
        """The edge of the world that has this dart, by the lesser of its two."""
        return min(dart, self.world.alpha[dart])

    @cached_property
    def fates(self) -> dict[int, Fate]:
        """What became of each edge of the world that was posed, in the order of the poses."""
        fates: dict[int, Fate] = {}
        for when, event, pose, _, _ in self.rounds:
            if not self.map.is_open(event.edge, when):
                continue
            edge = self.crossing(self.map.end(event.edge))
            left: set[int] = fates[edge].left if edge in fates else set()
            if isinstance(event, ev.Pose):
                fates[edge] = Fate(when, event, left.union(event.hypotheses))
            elif not isinstance(event, ev.Augment):
                left.discard(event.hypothesis)
            elif pose and when != self.spoiled:
                left = {h for h in left if event.kind == "new" and self.map.is_open(h, when)}
                fates[edge] = Fate(when, event, left)
        return fates

    @cached_property
    def conclusions(self) -> dict[int, Conclusion]:
        """By event, whether each declared reject, confirm and augmentation follows; in order.

        Of a history that the world does not show, none: it proves nothing.
        """
        found = decision_conclusions(self.trace) if self.is_history else ()
        return {conclusion.when: conclusion for conclusion in found}
