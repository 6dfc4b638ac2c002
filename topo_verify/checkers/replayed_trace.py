"""A trace replayed in its world: where the robot stood, what its map S was, what it had walked.

Trusted. Positions follow from the doors alone; S is drawn from the declared augmentations as far as
they are true. Decisions after `illegal` or `spoiled` are not judged.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from functools import cached_property

import msgspec

from topo_verify.checkers.darts import KnownDart, WorldDart
from topo_verify.checkers.entailment import Conclusion, FoldedTrace, decision_conclusions
from topo_verify.checkers.excursions import Excursion, Records, Word
from topo_verify.checkers.map_in_world import MapInWorld
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept
from topo_verify.world.rooted_map import World


class Round(msgspec.Struct, frozen=True):
    """A decision at event `when`, and what was executed behind the edge since the last pose.

    After a **late pose**, of an edge crossed before, no move is behind the edge.

    Attributes:
        pose: the last one so far, if it was of this edge and S did not grow since.
        end: the other end of its edge in the world; None if the edge is not an unexplored dart of
            S.
        truth: that end as a dart of S, if its vertex is known.
    """

    when: int
    event: ev.Decision
    pose: ev.Pose | None
    word: Word
    sequences: tuple[Word, ...]
    end: WorldDart | None
    truth: KnownDart | None


class Fate(msgspec.Struct, frozen=True):
    """What became of an edge that was posed.

    Attributes:
        when, event: its last pose; or the augmentation, once S grew along it.
        left: hypotheses without a fate since they were posed; none after a loop.
    """

    when: int
    event: ev.Pose | ev.Augment
    left: set[int]


class ReplayedTrace:
    """A world and a trace, replayed once; what the claims are asked about.

    Args:
        trace: begins with its only `start`, and may end with `finish`.
        stopped: why the mapper ended without a map, if it did.
    Attributes:
        fold: as far as it was read; claim 9 reads on where claim 10 ends.
        kinds: the number of events of each type.
        map: S, drawn on the world.
        positions: the reference dart in the world after each event, up to an illegal move.
        followed: the events up to an illegal move.
        illegal: the first move through a door that is not there.
        spoiled: the first augmentation that is false in this world.
        crossings: the crossed edges of the world, and at which event first.
        false_percepts: an event, its percept, and the percept that the world shows.
    Raises:
        InputError: the events are in no such order.
    """

    def __init__(self, world: World, trace: Sequence[ev.Event], stopped: str | None = None) -> None:
        ev.require_order(trace)
        self.world, self.trace, self.stopped = world, trace, stopped
        self.fold = FoldedTrace(trace)
        self.kinds = Counter(map(type, trace))
        self.cost = self.kinds[ev.Move]
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
        at = WorldDart(self.world.root or 0)
        seen = self.map.seen_at(at)
        for when, event in enumerate(self.trace):
            if isinstance(event, ev.Move):
                if not 0 <= event.door < seen.degree:
                    self.illegal = when
                    return
                at = self.map.beyond(at, event.door)
                seen = self.map.seen_at(at)
                self.crossings.setdefault(min(at, self.world.alpha[at]), when)
            elif isinstance(event, ev.Augment) and self.spoiled is None:
                self.spoiled = None if self.map.grow(when, event) else when
            if (told := getattr(event, "percept", seen)) != seen:
                self.false_percepts.append((when, told, seen))
            self.positions.append(at)

    @property
    def is_history(self) -> bool:
        """Whether the world has all doors and shows all percepts of the trace."""
        return self.illegal is None and not self.false_percepts

    @cached_property
    def rounds(self) -> tuple[Round, ...]:
        """Every decision that can be judged: up to the first illegal move or false map."""
        return tuple(self._rounds())

    def _rounds(self) -> Iterator[Round]:
        poses: dict[int, ev.Pose] = {}  # by its edge: the last pose, if S did not grow since
        behind = Excursion()
        for when, event in enumerate(self.followed):
            if isinstance(event, ev.Move):
                before, at = self.positions[when - 1 : when + 1]
                behind.move(event.door, self.map.seen_at(before).degree, self.map.seen_at(at))
            elif isinstance(event, ev.DECISIONS):
                edge = event.edge
                end = self.map.end(edge) if self.map.is_open(edge, when) else None
                if isinstance(event, ev.Pose):
                    poses, behind = {edge: event}, Excursion(is_late=end != self.positions[when])
                truth = None if end is None else self.map.known(end, when)
                pose, word = poses.get(edge), tuple(behind.word)
                yield Round(when, event, pose, word, behind.sequences, end, truth)
                if isinstance(event, ev.Augment):
                    if when == self.spoiled:
                        return
                    if pose:  # it is true, so S has its dart
                        self.records.add(when, KnownDart(event.dart), behind.sequences)
                    poses, behind.sequences = {}, ()
                elif isinstance(event, ev.Reject) and event.rule == "motion" and word:
                    behind.sequences = (*behind.sequences, word)

    def crossing(self, dart: WorldDart) -> int:
        """The edge of the world that has this dart, by the lesser of its two."""
        return min(dart, self.world.alpha[dart])

    @cached_property
    def fates(self) -> dict[int, Fate]:
        """What became of each posed edge of the world, in the order of the poses."""
        fates: dict[int, Fate] = {}
        for decision in self.rounds:
            if decision.end is None:
                continue
            edge, event, when = self.crossing(decision.end), decision.event, decision.when
            left: set[int] = fates[edge].left if edge in fates else set()
            if isinstance(event, ev.Pose):
                fates[edge] = Fate(when, event, left.union(event.hypotheses))
            elif not isinstance(event, ev.Augment):
                left.discard(event.hypothesis)
            elif decision.pose and when != self.spoiled:
                left = {h for h in left if event.kind == "new" and self.map.is_open(h, when)}
                fates[edge] = Fate(when, event, left)
        return fates

    @cached_property
    def conclusions(self) -> dict[int, Conclusion]:
        """By event, whether each declared reject, confirm and augmentation follows; in order.

        A history that the world does not show proves nothing.
        """
        folded = FoldedTrace(self.trace) if self.fold.read else self.fold
        conclusions = decision_conclusions(folded) if self.is_history else ()
        return {conclusion.when: conclusion for conclusion in conclusions}
