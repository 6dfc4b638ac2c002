"""Folding, the complete rule: it keeps a hypothesis exactly if some world that fits makes it true.

The rule keeps every percept: the vertices of S, and **ghosts**, visited places not known to be
vertices of S. To test a hypothesis it joins e with h and folds; the hypothesis is false if folding
meets a contradiction. Otherwise hang a leaf on every open dart of the folded map: in that world the
hypothesis is true and every percept is the same. So no rule that is right in all worlds can reject
more. Once vu folds into a vertex of S, a single remaining hypothesis is concluded without motion.

A test folds in a layer, which the next test of the same hypothesis continues: folding anew is
quadratic in the places. Written apart from `checkers/folding.py`; tests compare them.

Source: docs/semantics.md, sections 8 and 11.
"""

from __future__ import annotations

from collections.abc import Sequence

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.exploration import Refutation
from topo_verify.algorithms.motion import Executed, Hypothesis
from topo_verify.algorithms.rules import NoRule
from topo_verify.robot.events import Evidence, MapDart
from topo_verify.robot.percept import Door, Percept

NodeDart = int
"""Numbered from 1; 0 is none. Different numbers may be the same dart."""

OWN_END = "a dart would be its own other end"
UNLIKE = "two degrees, or the marker and its absence, at one place"


class SeenPlaces:
    """The nodes of a history without any hypothesis.

    Attributes:
        node: of each dart, the first dart of its node.
        around: of each dart, the darts of its node clockwise from it, made on demand.
        looks: of each dart, the signature of its node.
        leader: of each dart, 0 or a dart that it is.
        behind: of each leading dart, its other end or 0.
        weight: of each node, the number of others that it stands for.
        known: the nodes that are vertices of S.
        joined: the leading darts of every edge, in order.
        changed: the darts of each node that was identified or became known, in order.
    """

    def __init__(self) -> None:
        self.node: list[NodeDart] = [0]
        self.around: list[tuple[NodeDart, ...]] = [()]
        self.looks: list[tuple[int, bool]] = [(0, False)]
        self.leader, self.behind, self.weight = [0], [0], [0]
        self.known: set[NodeDart] = set()
        self.joined: list[tuple[NodeDart, NodeDart]] = []
        self.changed: list[NodeDart] = []

    def add(self, percept: Percept) -> NodeDart:
        """Add a node with this percept at its first dart. Returns that dart."""
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
    """Nodes, their identifications, and the ends of their darts.

    A fold may be a **layer** above another one, which it reads but never changes. Methods that
    identify return "" or the contradiction, after which the fold is useless.

    Invariant: a layer differs from the fold below only at the darts in its `leader` and `behind`.
    So a change below at other darts holds in the layer too, and needs no work there.
    """

    def __init__(self, below: PartialFold | None = None) -> None:
        self.below = below
        self.seen: SeenPlaces = SeenPlaces() if below is None else below.seen
        self.leader: dict[NodeDart, NodeDart] = {}
        self.behind: dict[NodeDart, NodeDart] = {}
        self.weight: dict[NodeDart, int] = {}
        self._joined, self._made = len(self.seen.joined), len(self.seen.changed)
        self._changed = self._made

    def layer(self) -> PartialFold:
        """An empty layer above this fold."""
        return type(self)(self)

    def add(self, percept: Percept, *, known: bool = False) -> NodeDart:
        """Add a node with this percept at its first dart. Returns that dart."""
        first = self.seen.add(percept)
        if known:
            self.seen.known.add(first)
        return first

    def turn(self, dart: NodeDart, door: Door) -> NodeDart:
        """The dart `door` doors clockwise from this one."""
        first = self.seen.node[dart]
        return first + (dart - first + door) % self.seen.looks[dart][0]

    def resolve(self, dart: NodeDart) -> NodeDart:
        """The dart that leads all darts that are the same."""
        leader, leader_seen = self.leader, self.seen.leader
        while up := leader_seen[dart] or leader.get(dart):
            dart = up
        return dart

    def is_known(self, dart: NodeDart) -> bool:
        """Whether the dart is at a vertex of S."""
        return self.seen.node[self.resolve(dart)] in self.seen.known

    def across(self, dart: NodeDart) -> NodeDart:
        """The other end of a dart's edge; 0 if the dart was never crossed."""
        dart = self.resolve(dart)
        return self.behind.get(dart) or self.seen.behind[dart]

    def know(self, dart: NodeDart) -> None:
        """Make the dart's node a vertex of S."""
        dart = self.resolve(dart)
        self.seen.known.add(self.seen.node[dart])
        self.seen.changed += self.seen.clockwise(dart)

    def join(self, d: NodeDart, e: NodeDart) -> str:
        """Join two darts to one edge, and fold."""
        d, e = self.resolve(d), self.resolve(e)
        if self.below is None:
            self.seen.joined.append((d, e))
        if d == e:
            return OWN_END
        behind, seen = self.behind, self.seen.behind
        d_end, e_end = behind.get(d) or seen[d], behind.get(e) or seen[e]
        pairs: list[tuple[NodeDart, NodeDart]] = []  # the last pair is folded first
        if d_end:
            pairs.append((d_end, e))
        else:
            behind[d] = e
        if e_end:
            pairs.append((e_end, d))
        else:
            behind[e] = d
        return self._drawn(pairs)

    def identify(self, d: NodeDart, e: NodeDart) -> str:
        """Make two darts one, and fold."""
        return self._drawn([(d, e)], one_partner=False)

    def _drawn(self, pairs: list[tuple[NodeDart, NodeDart]], *, one_partner: bool = True) -> str:
        """Fold; in the lowest fold keep the result, or drop all of it after a contradiction.

        A partial result would lead later folds in circles.
        """
        contradiction = self._fold(pairs, one_partner=one_partner)
        if self.below is None:
            self._keep(right=not contradiction)
        return contradiction

    def _fold(  # noqa: C901, PLR0912  one kernel, since it runs by the million
        self, waiting: list[tuple[NodeDart, NodeDart]], *, one_partner: bool = True
    ) -> str:
        """Make the darts of each pair one. With `one_partner` they share a partner."""
        seen, leader, behind, weight = self.seen, self.leader, self.behind, self.weight
        node, around, looks, known = seen.node, seen.around, seen.looks, seen.known
        leader_seen, behind_seen, weight_seen = seen.leader, seen.behind, seen.weight
        for d, e in waiting:
            if looks[d] != looks[e]:
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
            if s in known:  # a vertex of S leads its class
                if n in known:
                    return "two vertices of S would be one"
                small, large = large, small
            elif n not in known:
                light, heavy = weight.get(s) or weight_seen[s], weight.get(n) or weight_seen[n]
                if light > heavy:
                    small, large, n = large, small, s
                weight[n] = light + 1 + heavy
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
        seen = self.seen
        if right and self.leader:
            seen.changed += [*self.leader, *self.leader.values()]
        for additions, kept in (
            (self.leader, seen.leader),
            (self.behind, seen.behind),
            (self.weight, seen.weight),
        ):
            for place, number in additions.items() if right else ():
                kept[place] = number
            additions.clear()

    def follow(self) -> str | None:
        """Fold in what was joined below since this layer was made or last followed.

        Returns: "" or the contradiction; None if the layer must be made anew: a place that it
        changes has changed below, or there is a contradiction and any place has.
        """
        leader, behind = self.leader.keys(), self.behind.keys()
        changed = self.seen.changed[self._changed :]
        self._changed += len(changed)
        if not (leader.isdisjoint(changed) and behind.isdisjoint(changed)):
            return None
        while not self.stands():
            contradiction = self.join(*self.seen.joined[self._joined])
            if contradiction:
                return contradiction if self._changed == self._made else None
            self._joined += 1
        return ""

    def stands(self) -> bool:
        """Whether no edge was joined, since `follow`, at a dart that this layer changes."""
        for edge in self.seen.joined[self._joined :]:
            if not (self.leader.keys().isdisjoint(edge) and self.behind.keys().isdisjoint(edge)):
                return False
            self._joined += 1
        return True


class FoldingRule(NoRule):
    """Rejects every hypothesis that no world allows. It remembers the whole run."""

    def __init__(self) -> None:
        self.fold = PartialFold()
        self.entries: list[NodeDart] = []
        self.e: NodeDart = 0
        self.vu: NodeDart = 0
        self.assumed: dict[MapDart, PartialFold] = {}

    def node_dart(self, chart: Chart, dart: MapDart) -> NodeDart:
        """The dart of the fold for a dart of S."""
        v = chart.vertex[dart]
        return self.fold.turn(self.entries[v], dart - chart.first[v])

    def arrive(self, chart: Chart, e: MapDart, percept: Percept) -> None:
        """Find vu: a place visited before, or a new ghost."""
        if not self.entries:
            self.entries.append(self.fold.add(chart.percepts[0], known=True))
        self.e = self.node_dart(chart, e)
        self.vu = self._cross(self.e, percept)
        self.assumed.clear()

    def _cross(self, exit_place: NodeDart, percept: Percept) -> NodeDart:
        """The dart of entry behind an exit; adds a ghost on the first visit."""
        beyond = self.fold.across(exit_place)
        if not beyond:
            beyond = self.fold.add(percept)
            self.fold.join(exit_place, beyond)
            if percept.marker is not None:
                self.fold.identify(self.fold.turn(beyond, percept.marker), self.entries[0])
        return beyond

    def observe(self, sequence: Executed) -> None:
        """Keep every percept of the sequence."""
        at = self.vu
        for step, door in enumerate(sequence.doors, 1):
            at = self._cross(self.fold.turn(at, door), sequence.percepts[step])

    def refute(
        self, chart: Chart, hypothesis: Hypothesis, sequences: Sequence[Executed]
    ) -> Refutation | None:
        """Why no world allows the hypothesis; None if one does."""
        layer = self.assumed.pop(hypothesis.dart, None)
        contradiction = None if layer is None else layer.follow()
        if layer is None or contradiction is None:
            layer = self.fold.layer()
            contradiction = layer.join(self.e, self.node_dart(chart, hypothesis.dart))
        if not contradiction:
            self.assumed[hypothesis.dart] = layer
            return None
        return Refutation("folding", Evidence(0, contradiction=contradiction))

    def conclude(self, remaining: Sequence[Hypothesis]) -> Hypothesis | None:
        """The last hypothesis, once vu is known to be a vertex of S."""
        return remaining[0] if len(remaining) == 1 and self.fold.is_known(self.vu) else None

    def learn(
        self, chart: Chart, e: MapDart, entry: MapDart, sequences: Sequence[Executed]
    ) -> None:
        """Record which vertex of S vu is: a new one, or that of `entry`."""
        if len(self.entries) < len(chart.first):
            self.entries.append(self.vu)
            self.fold.know(self.vu)
        else:
            self.fold.join(self.e, self.node_dart(chart, entry))
