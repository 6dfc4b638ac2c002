"""The claims recomputed without the checkers: slow, naive, and by other means.

The checkers keep S as three rows with times and reduce doors to words; here the trace is played
event by event, S is what it is at that moment, and an excursion is a stack of darts of the world:
leaving by the dart by which the robot came takes the last one off. Two worlds are compared by
walking through both at once. What the two opinions share is the reading of docs/semantics.md.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

from topo_verify import World
from topo_verify.robot import events as ev
from topo_verify.robot.percept import Percept

Doors = tuple[int, ...]


def failing_claims(world: World, trace: Sequence[ev.Event]) -> set[str]:
    """The names of the claims 1-8 that do not hold (of those that the mapper let be judged)."""
    play = Play(world)
    for event in trace:
        if not play.lost and (isinstance(event, ev.Move) or not play.spoiled):
            play.take(event)
    wrong = set(play.wrong)
    cost = sum(isinstance(event, ev.Move) for event in trace)
    n, m = len(world.vertices), len(world.edges)
    finish = trace[-1]
    if isinstance(finish, ev.Finish):
        explored = 0 if play.spoiled or play.lost else len(play.joined)
        if not isomorphic(finish.map, world) or (explored and explored != len(play.phi)):
            wrong.add("map-isomorphic")
        if finish.cost is not None and finish.cost != cost:
            wrong.add("cost-honest")
        if cost < m:
            wrong.add("cost-within-bound")
    else:
        wrong.add("map-isomorphic")
    if cost > (m if n == 1 else m * (n + (2 * m - 1) * 2 * (n - 1))):
        wrong.add("cost-within-bound")
    posed, kinds = any(isinstance(e, ev.Pose) for e in trace), {type(e) for e in trace}
    if not posed and m:
        wrong.discard("true-hypothesis-posed")
        if ev.Reject not in kinds:
            wrong -= {"true-hypothesis-kept", "rejection-justified"}
        if ev.Confirm not in kinds:
            wrong.discard("no-false-confirm")
    return wrong


@dataclass
class Play:
    """A trace while it is played."""

    world: World
    at: int = 0
    lost: bool = False  # beyond a door that is not there
    spoiled: bool = False  # S is no map of this world any more
    phi: list[int] = field(default_factory=list[int])  # dart of S -> dart of the world
    joined: dict[int, int] = field(default_factory=dict[int, int])  # alpha of S where explored
    pose: ev.Pose | None = None
    crossed: set[int] = field(default_factory=set[int])  # darts of the world, both of each edge
    late: bool = False  # was the last pose made elsewhere than behind its edge?
    stack: list[int] = field(default_factory=list[int])  # the reference darts of the excursion
    sequences: list[list[int]] = field(default_factory=list[list[int]])
    records: dict[tuple[int, Doors], Percept] = field(
        default_factory=dict[tuple[int, Doors], Percept]
    )
    waiting: dict[int, list[int]] = field(default_factory=dict[int, list[int]])
    wrong: set[str] = field(default_factory=set[str])

    def take(self, event: ev.Event) -> None:
        """Play one event, and note which claims it breaks."""
        match event:
            case ev.Start():
                if self.world.root is not None:
                    self.at = self.world.root
                    self.phi += self.rotation(self.at)
                self.say("percepts-true", event.percept == self.seen(self.at))
            case ev.Move():
                self.move(event)
            case ev.Pose():
                self.say("true-hypothesis-posed", self.fair(event))
                self.pose, self.stack, self.sequences = event, [self.at], []
                self.late = not self.unexplored(event.edge) or self.at != self.beyond(event.edge)
                if self.unexplored(event.edge):
                    self.waiting.setdefault(event.edge, []).extend(event.hypotheses)
            case ev.Reject():
                self.say("true-hypothesis-kept", self.truth(event.edge) != event.hypothesis)
                if event.rule != "folding":  # what rests on folding is not its to say
                    self.say("rejection-justified", self.justified(event))
                self.account(event)
                if event.rule == "motion" and len(self.stack) > 1:
                    self.sequences.append(list(self.stack))
            case ev.Confirm():
                self.say("no-false-confirm", self.truth(event.edge) == event.hypothesis)
                self.account(event)
            case ev.Augment():
                self.grow(event)
            case ev.Finish():
                pass

    def say(self, claim: str, holds: bool) -> None:
        """Note whether a claim holds."""
        if not holds:
            self.wrong.add(claim)

    # ------------------------------------------------------------ the world

    def rotation(self, dart: int) -> list[int]:
        """The darts of a vertex from this one on."""
        row = [dart]
        while (after := self.world.sigma[row[-1]]) != dart:
            row.append(after)
        return row

    def seen(self, dart: int) -> Percept:
        """What a robot with this reference dart senses."""
        if self.world.root is None:
            return Percept(0, None)
        row = self.rotation(dart)
        return Percept(len(row), row.index(self.world.root) if self.world.root in row else None)

    def door(self, dart: int, exit_dart: int) -> int:
        """Which door of a reference dart is an exit."""
        return self.rotation(dart).index(exit_dart)

    def move(self, event: ev.Move) -> None:
        """Play a move."""
        if self.world.root is None or not 0 <= event.door < self.seen(self.at).degree:
            self.wrong.add("percepts-true")
            self.lost = True
            return
        exit_dart = self.rotation(self.at)[event.door]
        self.at = self.world.alpha[exit_dart]
        self.crossed |= {exit_dart, self.at}
        self.say("percepts-true", event.percept == self.seen(self.at))
        if self.late:
            return
        if len(self.stack) > 1 and exit_dart == self.stack[-1]:
            self.stack.pop()
        else:
            self.stack.append(self.at)

    # ------------------------------------------------------------ S

    def unexplored(self, dart: int) -> bool:
        """Is this an unexplored dart of S?"""
        return 0 <= dart < len(self.phi) and dart not in self.joined

    def beyond(self, e: int) -> int:
        """The other end, in the world, of a dart of S."""
        return self.world.alpha[self.phi[e]]

    def truth(self, e: int) -> int | None:
        """The dart of S that an unexplored dart of S leads to."""
        end = self.world.alpha[self.phi[e]] if self.unexplored(e) else None
        return self.phi.index(end) if end in self.phi else None

    def fair(self, pose: ev.Pose) -> bool:
        """Was e crossed, and are these unexplored darts of S, the true one among them?"""
        if not all(map(self.unexplored, (pose.edge, *pose.hypotheses))):
            return False
        truth = self.truth(pose.edge)
        return self.phi[pose.edge] in self.crossed and (truth is None or truth in pose.hypotheses)

    def grow(self, event: ev.Augment) -> None:
        """Let S grow, if that is true."""
        e, posed = event.edge, self.pose is not None and self.pose.edge == event.edge
        self.say("true-hypothesis-posed", posed)
        truth = self.truth(e)
        self.say("true-hypothesis-kept", event.kind == "loop" or truth is None)
        end = self.world.alpha[self.phi[e]] if self.unexplored(e) else 0
        dart = len(self.phi) if event.kind == "new" else truth
        if (
            not self.unexplored(e)
            or (event.kind == "new") != (truth is None)
            or event.dart != dart
            or event.degree != self.seen(end).degree
        ):
            self.wrong.add("map-isomorphic")
            self.spoiled = True
            return
        if posed and truth is None:
            left = [h for h in self.waiting[e] if self.unexplored(h)]
            self.say("true-hypothesis-kept", not left)
        if truth is None:
            self.phi += self.rotation(end)
        self.joined[e], self.joined[event.dart] = event.dart, e
        for sequence in self.sequences if posed else []:
            self.record(event.dart, sequence)
        self.pose, self.sequences = None, []

    def account(self, event: ev.Reject | ev.Confirm) -> None:
        """Take a hypothesis off the list of those that wait for a decision."""
        waiting = self.waiting.get(event.edge, [])
        waiting[:] = [h for h in waiting if h != event.hypothesis]

    # ------------------------------------------------------------ evidence

    def steps(self, sequence: list[int]) -> Iterator[tuple[int, Percept]]:
        """The doors of a stack of darts, and what was seen behind each."""
        for before, after in pairwise(sequence):
            yield self.door(before, self.world.alpha[after]), self.seen(after)

    def trace(self, dart: int, doors: Doors) -> tuple[int, Doors | None]:
        """Where doors lead on S: a dart, and None; or the unexplored dart, and the doors left."""
        for place, door in enumerate(doors):
            row = self.rotation(self.phi[dart])
            exit_dart = self.phi.index(row[door % len(row)])
            if exit_dart not in self.joined:
                return exit_dart, doors[place + 1 :]
            dart = self.joined[exit_dart]
        return dart, None

    def record(self, entry: int, sequence: list[int]) -> None:
        """Keep what a sequence showed behind the first unexplored dart."""
        steps = list(self.steps(sequence))
        for length in range(1, len(steps) + 1):
            dart, left = self.trace(entry, tuple(door for door, _ in steps[:length]))
            if left is not None:
                self.records[dart, left] = steps[length - 1][1]

    def justified(self, event: ev.Reject) -> bool:
        """Does the evidence disagree?"""
        evidence, pose = event.evidence, self.pose
        if pose is None or event.edge != pose.edge or event.hypothesis not in pose.hypotheses:
            return False
        if not (self.unexplored(event.edge) and self.unexplored(event.hypothesis)):
            return False
        if event.rule == "planar":
            return event.hypothesis not in self.face(event.edge)
        if evidence.sequence is None and event.rule == "motion":
            stack = self.stack
        elif evidence.sequence in range(len(self.sequences)):
            stack = self.sequences[evidence.sequence or 0]
        else:
            return False
        if evidence.step not in range(len(stack)):
            return False
        steps = list(self.steps(stack))[: evidence.step]
        end = self.world.alpha[self.phi[event.edge]]
        observed = steps[-1][1] if steps else self.seen(end)
        expected = self.expected(event.hypothesis, tuple(door for door, _ in steps), evidence)
        return (
            expected == evidence.expected and observed == evidence.observed and expected != observed
        )

    def face(self, dart: int) -> Iterator[int]:
        """The darts of S around a face: across if there is an edge, then the next to the left."""
        at = dart
        while True:
            row = self.rotation(self.phi[self.joined.get(at, at)])
            at = self.phi.index(row[1 % len(row)])
            yield at
            if at == dart:
                return

    def expected(self, hypothesis: int, doors: Doors, evidence: ev.Evidence) -> Percept | None:
        """What is seen behind doors if the hypothesis is true, and the evidence says whence."""
        dart, left = self.trace(hypothesis, doors)
        if evidence.at not in (None, dart):
            return None
        if left is None:
            return self.seen(self.phi[dart]) if evidence.record is None else None
        return self.records.get((dart, left)) if evidence.record == ev.Record(dart, left) else None


def isomorphic(drawn: ev.MapData, world: World) -> bool:
    """Is this the world? Both are walked through at once, from the marker on."""
    sigma = {d: r[i - len(r) + 1] for r in drawn.vertices for i, d in enumerate(r)}
    if any(len(edge) != 2 for edge in drawn.edges):
        return False
    alpha = {d: e[1 - i] for e in drawn.edges for i, d in enumerate(e)}
    darts = [d for r in drawn.vertices for d in r]
    ends = [d for e in drawn.edges for d in e]
    if sorted(darts) != sorted(ends) or len(set(darts)) != len(darts) or len(alpha) != len(ends):
        return False
    if world.root is None:
        return drawn == ev.MapData(((),), (), None)
    if drawn.marker not in sigma or () in drawn.vertices or len(darts) != len(world.alpha):
        return False
    twin = {drawn.marker: world.root}
    queue = deque(twin)
    while queue:
        dart = queue.popleft()
        there = twin[dart]
        for mine, theirs in ((sigma[dart], world.sigma[there]), (alpha[dart], world.alpha[there])):
            if mine not in twin:
                twin[mine] = theirs
                queue.append(mine)
            elif twin[mine] != theirs:
                return False
    return len(twin) == len(set(twin.values())) == len(darts)
