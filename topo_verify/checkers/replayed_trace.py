"""A trace replayed in its world: where the robot stood, what its map S was, what it had walked.

Trusted. Positions follow from the doors alone; S is drawn from the declared augmentations as far as
they are true. Decisions after `illegal` or `spoiled` are not judged.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import msgspec

from topo_verify.checkers import entailment as ent
from topo_verify.checkers.darts import KnownDart, WorldDart
from topo_verify.checkers.excursions import Excursion, Records, Word
from topo_verify.checkers.map_in_world import MapInWorld
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept
from topo_verify.world.rooted_map import Code, World


class Round(msgspec.Struct, frozen=True):
    """A decision at event `when`, and what was executed behind the edge since the last pose.

    After a **late pose**, of an edge crossed before, no move is behind the edge.

    Attributes:
        pose: the last one so far, if it was of this edge and S did not grow since.
        end: the other end of its edge in the world; None if the edge is not an unexplored dart of
            S.
        truth: that end as a dart of S, if its vertex is known.
        crossing: that edge of the world, as in `ReplayedTrace.crossing`.
    """

    when: int
    event: ev.Decision
    pose: ev.Pose | None
    word: Word
    sequences: tuple[Word, ...]
    end: WorldDart | None
    truth: KnownDart | None
    crossing: WorldDart | None


class ReplayedTrace:
    """A world and a trace, replayed once; what the claims are asked about.

    Args:
        trace: begins with its only `start`, and may end with `finish`.
        stopped: why the mapper ended without a map, if it did.
    Attributes:
        fold: as far as it was read; claim 9 reads on where claim 10 ends.
        kinds: the types of the events.
        cost: the number of moves.
        map: S, drawn on the world.
        positions: the reference dart in the world after each event, up to an illegal move.
        illegal: the first move through a door that is not there.
        spoiled: the first augmentation that is false in this world.
        crossings: the crossed edges of the world, and at which event first.
        rounds: every decision that can be judged: up to the first illegal move or false map.
        fates: for each posed edge of the world its last pose, or the augmentation along it; in
            the order of the poses.
        left: for each such edge the hypotheses without a fate since they were posed; none after a
            loop.
        false_percepts: an event, its percept, and the percept that the world shows.
    Raises:
        InputError: the events are in no such order.
    """

    def __init__(self, world: World, trace: Sequence[ev.Event], stopped: str | None = None) -> None:
        trace = ev.require_order(trace)
        self.world, self.trace, self.stopped = world, trace, stopped
        self.fold = ent.FoldedTrace(trace)
        kinds = [*map(type, trace)]
        self.kinds, self.cost = frozenset(kinds), kinds.count(ev.Move)
        self.map = MapInWorld(world)
        self.records = Records(self.map)
        self.illegal: int | None = None
        self.spoiled: int | None = None
        self.positions: list[WorldDart] = []
        self.crossings: dict[WorldDart, int] = {}
        self.false_percepts: list[tuple[int, Percept, Percept]] = []
        self.rounds: list[Round] = []
        self.fates: dict[WorldDart, Round] = {}
        self.left: dict[WorldDart, set[int]] = {}
        self._posed: Round | None = None  # the last pose, if S did not grow since
        self._behind = Excursion()
        self._replay()

    def _replay(self) -> None:
        at = WorldDart(self.world.root or 0)
        seen = self.map.seen_at(at)
        for when, event in enumerate(self.trace):
            if type(event) is ev.Move:
                if not 0 <= event.door < seen.degree:
                    self.illegal = when
                    return
                at = self.map.beyond(at, event.door)
                left, seen = seen, self.map.seen_at(at)
                self._behind.move(event.door, left.degree, seen)
                self.crossings.setdefault(self.crossing(at), when)
            elif self.spoiled is None and ev.is_decision(event):
                self._decide(when, event, at)
            if (told := getattr(event, "percept", seen)) != seen:
                self.false_percepts.append((when, told, seen))
            self.positions.append(at)

    def _decide(self, when: int, event: ev.Decision, at: WorldDart) -> None:
        decision = self._round(when, event, at)
        self.rounds.append(decision)
        behind = self._behind
        if type(event) is ev.Pose:
            self._posed = decision
        elif type(event) is ev.Augment:
            if not self.map.grow(when, event):
                self.spoiled = when
            elif decision.pose:  # it is true, so S has its dart
                self.records.add(when, KnownDart(event.dart), behind.sequences)
            self._posed, behind.sequences = None, ()
        elif type(event) is ev.Reject and event.rule == "motion" and decision.word:
            behind.sequences = (*behind.sequences, decision.word)
        if decision.crossing is not None:
            self._settle(decision.crossing, decision)

    def _round(self, when: int, event: ev.Decision, at: WorldDart) -> Round:
        posed = None if type(event) is ev.Pose else self._posed
        pose = end = truth = crossing = None
        if posed and posed.event.edge == event.edge:  # S is the same
            pose, end, truth, crossing = posed.pose, posed.end, posed.truth, posed.crossing
        elif self.map.is_open(event.edge, when):
            end = self.map.end(event.edge)
            truth, crossing = self.map.number.get(end), self.crossing(end)
        if type(event) is ev.Pose:
            pose, self._behind = event, Excursion(is_late=end != at)
        behind = self._behind
        return Round(when, event, pose, tuple(behind.word), behind.sequences, end, truth, crossing)

    def _settle(self, crossing: WorldDart, decision: Round) -> None:
        event, when = decision.event, decision.when
        left = self.left.setdefault(crossing, set())
        if type(event) is ev.Pose:
            self.fates[crossing] = decision
            left.update(event.hypotheses)
        elif type(event) is not ev.Augment:
            left.discard(event.hypothesis)
        elif decision.pose and when != self.spoiled:
            self.fates[crossing] = decision
            left -= {h for h in left if event.kind == "loop" or not self.map.is_open(h, when)}

    @property
    def is_history(self) -> bool:
        """Whether the world has all doors and shows all percepts of the trace."""
        return self.illegal is None and not self.false_percepts

    def crossing(self, dart: WorldDart) -> WorldDart:
        """The edge of the world that has this dart, by the lesser of its two."""
        return min(dart, self.map.across[dart])

    @cached_property
    def code(self) -> Code | str | None:
        """The code of the delivered map, or why it is not a map; None without one."""
        finish = self.trace[-1]
        if type(finish) is not ev.Finish:
            return None
        return self.world.code if self.map.is_world(finish.map) else ent.delivered_code(finish.map)

    @cached_property
    def conclusions(self) -> dict[int, ent.Conclusion]:
        """By event, whether each declared reject, confirm and augmentation follows; in order.

        A history that the world does not show proves nothing.
        """
        folded = ent.FoldedTrace(self.trace) if self.fold.read else self.fold
        conclusions = ent.decision_conclusions(folded) if self.is_history else ()
        return {conclusion.when: conclusion for conclusion in conclusions}
