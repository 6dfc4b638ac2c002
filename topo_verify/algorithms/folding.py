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
    NodeDart     a dart of a node, as a number; different numbers may be the same dart

**What a test costs.** A test folds in a layer above what was seen; with the contradiction the layer
is dropped. If there is none the layer is kept: behind the same e the hypothesis is tested again
after each mismatch, and then only the places seen since are folded in. (Folding anew each time is
quadratic in the places behind open edges.) One test takes time nearly linear in its identifications
(union-find, by size), and a long run makes tens of millions of them; so `_fold` has its look-ups
written out. The code is written apart from `checkers/folding.py`; tests compare them.

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

NodeDart = int
"""A dart of a node. They are numbered from 1, so that 0 is none."""

OWN_END = "a dart would be its own other end"
UNLIKE = "two degrees, or the marker and its absence, at one place"


class SeenPlaces:
    """What was seen, and what follows from that alone. Node by node, its darts clockwise.

    Attributes, per dart: `node` (the first dart of its node), `around` (the darts of its node,
    clockwise from it, once `clockwise` was asked; rows for each dart of a vertex with many loops
    would be too many), `looks` (the signature of its node); `leader` (0, or a dart that it is),
    `behind` (if it has no leader: 0, or the other end, or a dart that this leads). `weight`, per
    node: how many it stands for, itself not counted. `known`: the nodes that are vertices of S.
    """

    def __init__(self) -> None:
        """Nothing is seen yet."""
        self.node: list[NodeDart] = [0]
        self.around: list[tuple[NodeDart, ...]] = [()]
        self.looks: list[tuple[int, bool]] = [(0, False)]
        self.leader, self.behind, self.weight = [0], [0], [0]
        self.known: set[NodeDart] = set()
        self.joined: list[tuple[NodeDart, NodeDart]] = []  # every edge, in the order of `join`
        self.merges = 0  # how many times places were identified

    def add(self, percept: Percept) -> NodeDart:
        """Add a node with this percept at its first dart, which is returned."""
        first, degree = len(self.node), percept.degree
        self.node += [first] * degree
        self.around += [()] * degree
        self.looks += [percept.signature] * degree
        for numbers in (self.leader, self.behind, self.weight):
            numbers.extend([0] * degree)
        return first

    def clockwise(self, dart: NodeDart) -> tuple[NodeDart, ...]:
        """The darts of a dart's node, clockwise from it."""
        if not self.around[dart]:
            first = self.node[dart]
            beyond = first + self.looks[dart][0]
            self.around[dart] = (*range(dart, beyond), *range(first, dart))
        return self.around[dart]


class PartialFold:
    """Nodes, their identifications so far, and what lies behind their doors.

    A fold may be a **layer** above another one: it reads through to what that has seen, and leaves
    it as it is. So to undo is to drop the layer. Of what is joined below afterwards it learns by
    `follow`.

    Every method that identifies returns "" or the contradiction it met. After a contradiction the
    fold is of no more use.
    """

    def __init__(self, below: PartialFold | None = None) -> None:
        self.below = below
        self.seen: SeenPlaces = SeenPlaces() if below is None else below.seen
        # What is found beyond `seen`, by dart or node as there.
        self.leader: dict[NodeDart, NodeDart] = {}
        self.behind: dict[NodeDart, NodeDart] = {}
        self.weight: dict[NodeDart, int] = {}
        self._merges, self._followed = self.seen.merges, len(self.seen.joined)

    def layer(self) -> PartialFold:
        """An empty layer above this fold."""
        return type(self)(self)

    def add(self, percept: Percept, *, known: bool = False) -> NodeDart:
        """Add a node with this percept at its door 0. Returns the dart of that door."""
        first = self.seen.add(percept)
        if known:
            self.seen.known.add(first)
        return first

    def turn(self, dart: NodeDart, door: Door) -> NodeDart:
        """The dart that is so many doors clockwise from this one."""
        first = self.seen.node[dart]
        return first + (dart - first + door) % self.seen.looks[dart][0]

    def resolve(self, dart: NodeDart) -> NodeDart:
        """The dart that stands for all that are the same dart."""
        leader, leader_seen = self.leader, self.seen.leader
        while up := leader_seen[dart] or leader.get(dart):
            dart = up
        return dart

    def is_known(self, dart: NodeDart) -> bool:
        """Whether the dart is one of a vertex of S."""
        return self.seen.node[self.resolve(dart)] in self.seen.known

    def across(self, dart: NodeDart) -> NodeDart:
        """The other end of a dart's edge; 0 if nothing was seen behind it."""
        dart = self.resolve(dart)
        return self.behind.get(dart) or self.seen.behind[dart]

    def know(self, dart: NodeDart) -> None:
        """Take note that the dart is one of a vertex of S."""
        self.seen.known.add(self.seen.node[self.resolve(dart)])

    def join(self, one: NodeDart, other: NodeDart) -> str:
        """Join two darts to one edge, and fold."""
        if self.below is None:
            self.seen.joined.append((one, other))
        one, other = self.resolve(one), self.resolve(other)
        if one == other:
            return OWN_END
        behind, seen = self.behind, self.seen.behind
        had, has = behind.get(one) or seen[one], behind.get(other) or seen[other]
        # The last pair is folded first: what is behind h, if anything, with the vertex of e in S.
        pairs: list[tuple[NodeDart, NodeDart]] = []
        if had:
            pairs.append((had, other))
        else:
            behind[one] = other
        if has:
            pairs.append((has, one))
        else:
            behind[other] = one
        return self._drawn(pairs)

    def identify(self, one: NodeDart, other: NodeDart) -> str:
        """Make two darts one, and fold."""
        return self._drawn([(one, other)], one_partner=False)

    def _drawn(self, pairs: list[tuple[NodeDart, NodeDart]], *, one_partner: bool = True) -> str:
        """Fold; where nothing was assumed, take what was found for seen, or drop it if it clashes.

        (It never clashes in a world. What was found halfway would lead later folds in circles.)
        """
        wrong = self._fold(pairs, one_partner=one_partner)
        if self.below is None:
            self._keep(right=not wrong)
        return wrong

    def _fold(  # noqa: C901, PLR0912  one kernel, since it runs by the million
        self, waiting: list[tuple[NodeDart, NodeDart]], *, one_partner: bool = True
    ) -> str:
        """Make the two darts of each pair one, and draw what follows.

        Args:
            one_partner: the two darts of each pair have one partner, so nothing more is to be
                drawn from what lies behind them.
        """
        seen, leader, behind, weight = self.seen, self.leader, self.behind, self.weight
        node, around, looks, known = seen.node, seen.around, seen.looks, seen.known
        leader_seen, behind_seen, weight_seen = seen.leader, seen.behind, seen.weight
        for one, other in waiting:
            if looks[one] != looks[other]:
                return UNLIKE
        while waiting:
            small, large = waiting.pop()
            while up := leader_seen[small] or leader.get(small):
                small = up
            while up := leader_seen[large] or leader.get(large):
                large = up
            if small == large:
                continue
            s, n = node[small], node[large]
            if s == n:
                return "a vertex would be itself, turned"
            if s in known:  # it leads whatever is identified with it
                if n in known:
                    return "two vertices of S would be one"
                small, large = large, small
            elif n not in known:
                light, heavy = weight.get(s) or weight_seen[s], weight.get(n) or weight_seen[n]
                if light > heavy:  # keeps every chain of leaders short
                    small, large, n = large, small, s
                weight[n] = light + 1 + heavy
            # Alike, so of one degree.
            darts = around[small] or seen.clockwise(small)
            for dart, same in zip(darts, around[large] or seen.clockwise(large)):  # noqa: B905  made by the million
                leader[dart] = same
                end = behind.get(dart) or behind_seen[dart]
                if not end or (one_partner and dart == small):
                    continue
                while up := leader_seen[end] or leader.get(end):
                    end = up
                if end == same:
                    return OWN_END
                beyond = behind.get(same) or behind_seen[same]
                if not beyond:
                    behind[same] = end
                elif beyond != end:
                    if looks[beyond] != looks[end]:
                        return UNLIKE
                    waiting.append((beyond, end))
        return ""

    def _keep(self, *, right: bool) -> None:
        """Take for seen what was found, if it is right; and begin anew."""
        seen = self.seen
        seen.merges += len(self.leader) if right else 0
        for found, kept in (
            (self.leader, seen.leader),
            (self.behind, seen.behind),
            (self.weight, seen.weight),
        ):
            for place, number in found.items() if right else ():
                kept[place] = number
            found.clear()

    def follow(self) -> str | None:
        """Fold in what was joined below since this layer was made or last followed.

        Returns:
            As the methods that identify; or None if places were identified below, of which a layer
            that was made before cannot be told.
        """
        new = self.seen.joined[self._followed :]
        self._followed += len(new)
        if self.seen.merges != self._merges:
            return None
        return next((wrong for edge in new if (wrong := self.join(*edge))), "")


class FoldingRule(NoRule):
    """Rejects every hypothesis that no world allows. It remembers everything seen in the run."""

    def __init__(self) -> None:
        self.fold = PartialFold()
        self.entries: list[NodeDart] = []  # of each vertex of S: its first dart
        self.e: NodeDart = 0
        self.vu: NodeDart = 0
        self.assumed: dict[MapDart, PartialFold] = {}  # of each hypothesis kept: its layer

    def node_dart(self, chart: Chart, dart: MapDart) -> NodeDart:
        """The dart of a node that a dart of S is."""
        v = chart.vertex[dart]
        return self.fold.turn(self.entries[v], dart - chart.first[v])

    def arrive(self, chart: Chart, e: MapDart, percept: Percept) -> None:
        """Take note of vu, which is a place seen before, or a new ghost."""
        if not self.entries:
            self.entries.append(self.fold.add(chart.percepts[0], known=True))
        self.e = self.node_dart(chart, e)
        self.vu = self._cross(self.e, percept)
        self.assumed.clear()

    def _cross(self, exit_place: NodeDart, percept: Percept) -> NodeDart:
        """The dart by which the robot comes in behind an exit; adds a ghost if it is new there."""
        beyond = self.fold.across(exit_place)
        if not beyond:
            beyond = self.fold.add(percept)
            self.fold.join(exit_place, beyond)
            if percept.marker is not None:
                self.fold.identify(self.fold.turn(beyond, percept.marker), self.entries[0])
        return beyond

    def observe(self, sequence: Executed) -> None:
        """Keep every percept of an executed sequence."""
        at = self.vu
        for step, door in enumerate(sequence.doors, 1):
            at = self._cross(self.fold.turn(at, door), sequence.percepts[step])

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        """Why no world allows the hypothesis, if none does."""
        layer = self.assumed.pop(hypothesis.dart, None)
        wrong = None if layer is None else layer.follow()
        if layer is None or wrong is None:
            layer = self.fold.layer()
            wrong = layer.join(self.e, self.node_dart(chart, hypothesis.dart))
        if not wrong:
            self.assumed[hypothesis.dart] = layer
            return None
        return Refutation("folding", Evidence(0, contradiction=wrong))

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        """The last hypothesis, once vu is known to be a vertex of S."""
        return remaining[0] if len(remaining) == 1 and self.fold.is_known(self.vu) else None

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        """Note which vertex of S vu is: a new one, or that of `entry`."""
        if len(self.entries) < len(chart.first):
            self.entries.append(self.vu)
            self.fold.know(self.vu)
        else:
            self.fold.join(self.e, self.node_dart(chart, entry))
