"""Folding, the complete rule: it keeps a hypothesis exactly if some world that fits makes it true.

The rule keeps everything ever seen: the vertices of S, and **ghosts**, places that were seen but
are not known to be any vertex of S. A test of a hypothesis joins e with h and folds: a dart has one
partner, so where it would get two, the two are one dart, and their vertices one vertex, turned
against each other. The hypothesis is false if folding meets a contradiction: two degrees at one
place; the marker seen at one and not at the other (a place seen without the marker is never v0);
two vertices of S, or one with itself turned; a dart that is its own partner. If there is none, hang
a leaf on every open dart of the folded map: in that world the hypothesis is true and every percept
so far is the same. So no rule that is right in all worlds can reject more.

That vu is new is one more alternative. It is ruled out when vu folds into a vertex of S; if one
hypothesis is left then, it is concluded without motion.

    letter       what it is
    e, h, vu     as in exploration.py
    NodeDart     (node, door): a dart of a node; different pairs may be the same dart

One test costs time nearly linear in the number of identifications (union-find with offsets, by
size, undone by rollback). The code is written apart from `checkers/folding.py`; tests compare them.

Source: docs/semantics.md, section 11; J. R. Stallings, "Topology of finite graphs", Invent. Math.
71 (1983).
"""

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.algorithms.basic import NoRule
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis
from topo_verify.robot.events import Evidence, MapDart
from topo_verify.robot.percept import Door, Percept

NodeDart = tuple[int, Door]


class PartialFold:
    """Nodes, their identifications so far, and what lies behind their doors; it can roll back.

    Every method that identifies returns "" or the contradiction it met. After a contradiction only
    `roll_back` may be called.
    """

    def __init__(self) -> None:
        self.percepts: list[Percept] = []  # as seen with door 0 as the reference dart
        self.known: list[bool] = []  # is it (has it been folded into) a vertex of S?
        self.leader: list[int] = []
        self.turned: list[Door] = []  # door k of a node is door k + turned of its leader
        self.weight: list[int] = []
        self.behind: list[dict[Door, NodeDart]] = []
        self.done: list[tuple[int, Door | None, bool]] = []  # what `roll_back` takes back

    def add(self, percept: Percept, *, known: bool = False) -> int:
        """Add a node with this percept at its door 0. Returns the node."""
        self.percepts.append(percept)
        self.known.append(known)
        self.leader.append(len(self.leader))
        self.turned.append(0)
        self.weight.append(1)
        self.behind.append({})
        return len(self.leader) - 1

    def resolve(self, place: NodeDart) -> NodeDart:
        """The pair that stands for all pairs that are the same dart."""
        node, door = place
        while (leader := self.leader[node]) != node:  # no path compression: it could not roll back
            door += self.turned[node]
            node = leader
        return node, door % self.percepts[node].degree

    def across(self, place: NodeDart) -> NodeDart | None:
        """The other end of a dart's edge; None if nothing was seen behind it."""
        node, door = self.resolve(place)
        return self.behind[node].get(door)

    def join(self, one: NodeDart, other: NodeDart) -> str:
        """Join two darts to one edge, and fold."""
        one, other = self.resolve(one), self.resolve(other)
        if one == other:
            return "a dart would be its own other end"
        had, has = self.across(one), self.across(other)
        if had is None:
            self._put(one, other)
        if has is None:
            self._put(other, one)
        return (had and self.identify(had, other)) or (has and self.identify(has, one)) or ""

    def identify(self, one: NodeDart, other: NodeDart) -> str:
        """Make two darts one, and fold."""
        waiting = [(one, other)]
        while waiting:
            (small, k), (large, n) = (self.resolve(place) for place in waiting.pop())
            if small == large:
                if k != n:
                    return "a vertex would be itself, turned"
                continue
            if self.weight[small] > self.weight[large]:  # keeps every chain of leaders short
                (small, k), (large, n) = (large, n), (small, k)
            if wrong := self._clash(small, large):
                return wrong
            self._merge(small, large, n - k)
            for door, place in self.behind[small].items():
                moved = self.resolve((small, door))
                beyond = self.across(moved)
                if self.resolve(place) == moved:
                    return "a dart would be its own other end"
                if beyond is None:
                    self._put(moved, place)
                else:
                    waiting.append((beyond, place))
        return ""

    def _clash(self, small: int, large: int) -> str:
        """Why two nodes cannot be one vertex, judged by what was seen at them; "" if they can."""
        if self.percepts[small].signature != self.percepts[large].signature:
            return "two degrees, or the marker and its absence, at one place"
        return "two vertices of S would be one" if self.known[small] and self.known[large] else ""

    def _merge(self, small: int, large: int, turned: Door) -> None:
        """Make `large` the leader of `small`, whose door k is door k + turned of `large`."""
        self.done.append((small, None, self.known[large]))
        self.leader[small], self.turned[small] = large, turned
        self.weight[large] += self.weight[small]
        self.known[large] |= self.known[small]

    def _put(self, place: NodeDart, beyond: NodeDart) -> None:
        """Note one end of an edge behind the other, such that it can be taken back."""
        self.behind[place[0]][place[1]] = beyond
        self.done.append((*place, False))

    def roll_back(self, mark: int) -> None:
        """Undo all identifications and edges made since `done` had this length."""
        while len(self.done) > mark:
            node, door, was_known = self.done.pop()
            if door is not None:
                del self.behind[node][door]
                continue
            large = self.leader[node]
            self.leader[node], self.turned[node] = node, 0
            self.weight[large] -= self.weight[node]
            self.known[large] = was_known


class FoldingRule(NoRule):
    """Rejects every hypothesis that no world allows. It remembers everything seen in the run."""

    def __init__(self) -> None:
        self.fold = PartialFold()
        self.entries: list[NodeDart] = []  # of each vertex of S: its first dart
        self.e: NodeDart = (0, 0)
        self.vu: NodeDart = (0, 0)

    def node_dart(self, chart: Chart, dart: MapDart) -> NodeDart:
        """The node and door of a dart of S."""
        v = chart.vertex[dart]
        node, door = self.entries[v]
        return node, door + dart - chart.first[v]

    def arrive(self, chart: Chart, e: MapDart, percept: Percept) -> None:
        """Take note of vu, which is a place seen before, or a new ghost."""
        if not self.entries:
            self.entries.append((self.fold.add(chart.percepts[0], known=True), 0))
        self.e = self.node_dart(chart, e)
        self.vu = self._cross(self.e, percept)

    def _cross(self, exit_place: NodeDart, percept: Percept) -> NodeDart:
        """The dart by which the robot comes in behind an exit; adds a ghost if it is new there."""
        beyond = self.fold.across(exit_place)
        if beyond is None:
            beyond = (self.fold.add(percept), 0)
            self.fold.join(exit_place, beyond)
            if percept.marker is not None:
                self.fold.identify((beyond[0], percept.marker), (0, 0))
        return beyond

    def observe(self, sequence: Executed) -> None:
        """Keep every percept of an executed sequence."""
        node, door = self.vu
        for step, turn in enumerate(sequence.doors, 1):
            node, door = self._cross((node, door + turn), sequence.percepts[step])

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        """Why no world allows the hypothesis, if none does."""
        mark = len(self.fold.done)
        wrong = self.fold.join(self.e, self.node_dart(chart, hypothesis.dart))
        self.fold.roll_back(mark)
        if not wrong:
            return None
        return Refutation("folding", Evidence(0, contradiction=wrong))

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        """The last hypothesis, once vu is known to be a vertex of S."""
        node, _ = self.fold.resolve(self.vu)
        return remaining[0] if len(remaining) == 1 and self.fold.known[node] else None

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        """Note which vertex of S vu is: a new one, or that of `entry`."""
        if len(self.entries) < len(chart.first):
            self.entries.append(self.vu)
            self.fold.known[self.fold.resolve(self.vu)[0]] = True
        else:
            self.fold.join(self.e, self.node_dart(chart, entry))
