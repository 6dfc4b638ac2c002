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

**What a test costs.** A test folds in a layer above what was seen; with the contradiction the layer
is dropped. If there is none the layer is kept: behind the same e the hypothesis is tested again
after each mismatch, and then only the places seen since are folded in. (Folding anew each time is
quadratic in the places behind open edges.) One test takes time nearly linear in its identifications
(union-find with offsets, by size). The code is written apart from `checkers/folding.py`; tests
compare them.

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
    """Nodes, their identifications so far, and what lies behind their doors.

    A fold may be a **layer** above another one: it reads through to the fold below and leaves it as
    it is. So to undo is to drop the layer. A layer copies the doors of a node when it first puts an
    end there; of what is joined below afterwards it learns by `follow`.

    Every method that identifies returns "" or the contradiction it met. After a contradiction the
    fold is of no more use.
    """

    def __init__(self, below: PartialFold | None = None) -> None:
        # As seen at each node with door 0 as the reference dart; a layer adds no nodes.
        self.signatures: list[tuple[int, bool]] = [] if below is None else below.signatures
        # Of an identified node: the leader, and by how many doors it is turned against it.
        self.leader: dict[int, tuple[int, Door]] = {}
        self.weight: dict[int, int] = {}  # how many nodes a leader stands for, if more than one
        self.behind: dict[int, dict[Door, NodeDart]] = {}
        self.known: set[int] = set()  # is it (has it been folded into) a vertex of S?
        self.joined: list[tuple[NodeDart, NodeDart]] = []  # every edge, in the order of `join`
        self.below = below
        self._leader, self._weight, self._behind, self._known = (
            ({}, {}, {}, set[int]())
            if below is None
            else (below.leader, below.weight, below.behind, below.known)
        )
        self._merges, self._followed = len(self._leader), 0 if below is None else len(below.joined)

    def layer(self) -> PartialFold:
        """An empty layer above this fold."""
        return type(self)(self)

    def add(self, percept: Percept, *, known: bool = False) -> int:
        """Add a node with this percept at its door 0. Returns the node."""
        node = len(self.signatures)
        self.signatures.append(percept.signature)
        if known:
            self.known.add(node)
        self.behind[node] = {}
        return node

    def resolve(self, place: NodeDart) -> NodeDart:
        """The pair that stands for all pairs that are the same dart."""
        node, door = place
        leader, below = self.leader, self._leader
        while (up := leader.get(node) or below.get(node)) is not None:
            node, turned = up
            door += turned
        return node, door % self.signatures[node][0]

    def is_known(self, node: int) -> bool:
        """Whether a leader is a vertex of S."""
        return node in self.known or node in self._known

    def across(self, place: NodeDart) -> NodeDart | None:
        """The other end of a dart's edge; None if nothing was seen behind it."""
        node, door = self.resolve(place)
        return self._doors(node).get(door)

    def join(self, one: NodeDart, other: NodeDart) -> str:
        """Join two darts to one edge, and fold."""
        self.joined.append((one, other))
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
        resolve, leader, below = self.resolve, self.leader, self._leader
        waiting = [(one, other)]
        while waiting:
            one, other = waiting.pop()
            (small, k), (large, n) = resolve(one), resolve(other)
            if small == large:
                if k != n:
                    return "a vertex would be itself, turned"
                continue
            if self._size(small) > self._size(large):  # keeps every chain of leaders short
                small, k, large, n = large, n, small, k
            if wrong := self._clash(small, large):
                return wrong
            self._merge(small, large, n - k)
            turned, degree = leader[small][1], self.signatures[small][0]
            doors = self._doors(large)
            for door, end in self._doors(small).items():
                moved = large, (door + turned) % degree
                # Ends were resolved when they were put, so most of them stand for themselves.
                place = resolve(end) if end[0] in leader or end[0] in below else end
                if place == moved:
                    return "a dart would be its own other end"
                beyond = doors.get(moved[1])
                if beyond is None:
                    doors = self._put(moved, place)
                elif beyond != place:
                    waiting.append((beyond, place))
        return ""

    def _clash(self, small: int, large: int) -> str:
        """Why two nodes cannot be one vertex, judged by what was seen at them; "" if they can."""
        if self.signatures[small] != self.signatures[large]:
            return "two degrees, or the marker and its absence, at one place"
        both = self.is_known(small) and self.is_known(large)
        return "two vertices of S would be one" if both else ""

    def _merge(self, small: int, large: int, turned: Door) -> None:
        """Make `large` the leader of `small`, whose door k is door k + turned of `large`."""
        self.weight[large] = self._size(small) + self._size(large)
        self.leader[small] = large, turned
        if self.is_known(small):
            self.known.add(large)

    def _size(self, node: int) -> int:
        """How many nodes a leader stands for."""
        return self.weight.get(node) or self._weight.get(node, 1)

    def _doors(self, node: int) -> dict[Door, NodeDart]:
        """The doors of a leader with something behind them, and the other ends, as they came."""
        doors = self.behind.get(node)
        return self._behind[node] if doors is None else doors

    def _put(self, place: NodeDart, beyond: NodeDart) -> dict[Door, NodeDart]:
        """Note one end of an edge behind the other. Returns the doors there."""
        node, door = place
        if node not in self.behind:  # of the fold below, which stays as it is
            self.behind[node] = self._behind[node].copy()
        self.behind[node][door] = beyond
        return self.behind[node]

    def follow(self) -> bool:
        """Fold in what was joined below since this layer was made or last followed.

        Returns:
            Whether the layer still stands. It does not if it meets a contradiction now, or if
            places were identified below, which a layer made before cannot be told.
        """
        assert self.below is not None
        new = self.below.joined[self._followed :]
        self._followed += len(new)
        return len(self._leader) == self._merges and not any(self.join(*edge) for edge in new)


class FoldingRule(NoRule):
    """Rejects every hypothesis that no world allows. It remembers everything seen in the run."""

    def __init__(self) -> None:
        self.fold = PartialFold()
        self.entries: list[NodeDart] = []  # of each vertex of S: its first dart
        self.e: NodeDart = (0, 0)
        self.vu: NodeDart = (0, 0)
        self.assumed: dict[MapDart, PartialFold] = {}  # of each hypothesis kept: its layer

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
        self.assumed.clear()

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
        layer = self.assumed.pop(hypothesis.dart, None)
        if layer is None or not layer.follow():
            layer = self.fold.layer()
            # Folded anew, so that the contradiction does not depend on what had been kept.
            wrong = layer.join(self.e, self.node_dart(chart, hypothesis.dart))
        else:
            wrong = ""
        if not wrong:
            self.assumed[hypothesis.dart] = layer
            return None
        return Refutation("folding", Evidence(0, contradiction=wrong))

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        """The last hypothesis, once vu is known to be a vertex of S."""
        node, _ = self.fold.resolve(self.vu)
        return remaining[0] if len(remaining) == 1 and self.fold.is_known(node) else None

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        """Note which vertex of S vu is: a new one, or that of `entry`."""
        if len(self.entries) < len(chart.first):
            self.entries.append(self.vu)
            self.fold.known.add(self.fold.resolve(self.vu)[0])
        else:
            self.fold.join(self.e, self.node_dart(chart, entry))
