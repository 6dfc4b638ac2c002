"""Every world with m edges, every reachable map S of it, and walks on both, as clauses.

**World.** The darts are 0 … 2m-1. A vertex is an interval of them, clockwise from the dart by which
it was first entered (docs/semantics.md, section 3); v0 begins with the marked dart, 0.

    first[d]        dart d is the first of its vertex
    joined[a, b]    a and b are the two darts of one edge, a < b
    vertex[f, n]    the darts f … f+n-1 are a vertex (defined)
    known[d]        d is a dart of S: a prefix of the numbers, in whole vertices
    explored[d]     S knows the edge of d, and so its other end

**Map.** S and the world share numbers in the order of discovery. The first dart of every vertex but
v0 is joined with a smaller one (`entry`), by an explored edge if S knows the vertex. So the world
is connected and S *reachable*: cross the entry edges in order, then the other edges. Conversely,
every S of an exploration is of this form. The other vertices are numbered breadth-first, so each
pair of a world and a map is one model.

**Positions** and doors are one-hot rows, also where others determine them: redundant, but it makes
words of four doors feasible.

**Walks.** Behind the unexplored dart `e` the robot stands at `vu`, its reference dart `alpha(e)`.
Hypothesis `h`: this is dart h of S. A word of doors is followed `there`, in the world from
alpha(e), and `here`, on S from h. The rules compare percepts of both:

    confirm   here ends at v0 and the last percepts are equal            ⇒  h = alpha(e)
    trace     h = alpha(e), every door crosses an explored dart          ⇒  all percepts are equal
    prefix    h = alpha(e), another word was executed there              ⇒  equal on what they share
    history   h = alpha(e), any word, traced until a dart is unexplored  ⇒  equal until then
    records   as history, then against the record of an earlier word behind the unexplored dart

Cost: O(m³) clauses for a world, a step, or a percept.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import Literal

from topo_verify.proofs.bounded.cnf import REFUTED, CnfLiteral, CnfRow, Formula

MarkerDetail = Literal["directed", "undirected", "none"]
"""What is compared of the marker: its direction, its presence, or nothing."""


@dataclass(frozen=True, slots=True)
class EncodedMap:
    known: CnfRow
    explored: CnfRow


@dataclass(frozen=True, slots=True)
class EncodedPercept:
    """A percept; `degree` (less one) and the marker's door are one-hot."""

    degree: CnfRow
    here: CnfLiteral
    marker: CnfRow


class Worlds(Formula):
    """The clauses of all worlds with this many edges.

    Attributes:
        entry: entry[e, f]: the vertex beginning with dart f was found through dart e < f.
        in_v0: per dart, is it a dart of v0?
    """

    def __init__(self, edges: int) -> None:
        super().__init__()
        self.edges = edges
        self.darts = range(2 * edges)
        self.first = self.booleans("first", 2 * edges)
        self.joined = {
            (a, b): self.boolean(f"joined.{a}.{b}") for a, b in combinations(self.darts, 2)
        }
        self.vertex: dict[tuple[int, int], CnfLiteral] = {}
        self.entry: dict[tuple[int, int], CnfLiteral] = {}
        self._rotation()
        self._edges()
        self.in_v0 = self._first_vertex()

    def edge(self, one: int, other: int) -> CnfLiteral:
        return self.joined[min(one, other), max(one, other)]

    def _rotation(self) -> None:
        end = len(self.darts)
        self.add("rotation", self.first[0])
        for f in self.darts:
            for after in range(f + 1, end + 1):
                inside = [-self.first[d] for d in range(f + 1, after)]
                closed = [] if after == end else [self.first[after]]
                self.vertex[f, after - f] = self.define_and(
                    "rotation", f"vertex.{f}.{after - f}", [self.first[f], *inside, *closed]
                )

    def _edges(self) -> None:
        for d in self.darts:
            self.exactly_one("edges", [self.edge(d, x) for x in self.darts if x != d])
        for (e, f), joined in self.joined.items():
            self.entry[e, f] = self.define_and("edges", f"entry.{e}.{f}", [self.first[f], joined])
        # By induction every vertex is joined with v0.
        for f in self.darts[1:]:
            self.imply("connected", [self.first[f]], *(self.entry[e, f] for e in range(f)))

    def _first_vertex(self) -> CnfRow:
        degrees = [self.vertex[0, after] for after in range(1, len(self.darts) + 1)]
        # Dart d is at v0 if v0 has more than d darts.
        return tuple(self.define_or("rotation", f"in_v0.{d}", degrees[d:]) for d in self.darts)

    def map(self, name: str) -> EncodedMap:
        known = self.booleans(f"{name}.known", len(self.darts))
        explored = self.booleans(f"{name}.explored", len(self.darts))
        group = f"{name}.reachable"
        self.add(group, known[0])
        for d in self.darts[1:]:
            self.imply(group, [known[d]], known[d - 1])
            self.imply(group, [known[d - 1], -self.first[d]], known[d])
            self.imply(group, [known[d], self.first[d]], explored[d])
        for d in self.darts:
            self.imply(group, [explored[d]], known[d])
        for (a, b), joined in self.joined.items():
            self.imply(group, [joined, explored[a]], explored[b])
            self.imply(group, [joined, explored[b]], explored[a])
        return EncodedMap(known, explored)

    def number_the_rest(self, known: CnfRow | None = None) -> None:
        """Require that unknown vertices (None: all but v0) are numbered breadth-first."""
        known = self.in_v0 if known is None else known
        group = "numbering"
        for (e1, f1), earlier in self.entry.items():
            for (e2, f2), later in self.entry.items():
                # The unknown vertex with the earlier entry comes first.
                if f1 < f2 and e1 > e2:
                    self.imply(group, [earlier, later], known[f1], known[f2])
        for (f, degree), vertex in self.vertex.items():
            for g in range(f + 1, f + degree) if f else ():
                for e in range(f):  # its first dart is the one with the earliest partner
                    before = [self.entry[x, f] for x in range(e)]
                    self.imply(group, [vertex, self.edge(e, g)], *before, known[f])

    def include(self, group: str, smaller: EncodedMap, larger: EncodedMap) -> None:
        for d in self.darts:
            self.imply(group, [smaller.known[d]], larger.known[d])
            self.imply(group, [smaller.explored[d]], larger.explored[d])

    def restrict(self, world_class: str) -> None:
        """Require a class: `any`, `loopless` or `simple`."""
        if world_class == "any":
            return
        group = "class"
        same: dict[tuple[int, int], CnfLiteral] = {}
        for a, b in combinations(self.darts, 2):
            literal = self.define_and(
                group, f"same.{a}.{b}", [-self.first[d] for d in range(a + 1, b + 1)]
            )
            same[a, b] = same[b, a] = literal  # no vertex begins between a and b
        for (a, b), joined in self.joined.items():
            self.imply(group, [joined], -same[a, b])
            # No second edge c-d beside a-b.
            for c in self.darts if world_class == "simple" else ():
                for d in self.darts:
                    if a < min(c, d) and b not in {c, d} and c != d:
                        self.add(group, -joined, -self.edge(c, d), -same[a, c], -same[b, d])

    def position(self, group: str, name: str) -> CnfRow:
        return self.row(group, name, len(self.darts))

    def turn(
        self,
        group: str,
        at: CnfRow,
        door: CnfRow,
        leave: CnfRow,
        *guard: CnfLiteral,
        absolute: bool = False,
    ) -> None:
        """Require, under the guard, that `leave` is this door; `absolute` is a seeded fault."""
        for (f, degree), vertex in self.vertex.items():
            for x in range(f, f + degree):
                for k in self.darts:
                    here = (*guard, at[x], vertex)
                    if k < degree:
                        place = k if absolute else (x - f + k) % degree
                        self.imply(group, (*here, door[k]), leave[f + place])
                    else:
                        self.imply(group, here, -door[k])

    def cross(self, group: str, leave: CnfRow, arrive: CnfRow, *guard: CnfLiteral) -> None:
        """Require, under the guard, that `arrive` is the partner of `leave`."""
        for (a, b), joined in self.joined.items():
            self.imply(group, [*guard, leave[a], joined], arrive[b])
            self.imply(group, [*guard, leave[b], joined], arrive[a])

    def at_one_of(self, group: str, at: CnfRow, darts: CnfRow, name: str) -> CnfLiteral:
        among = self.boolean(name)
        for place, member in zip(at, darts, strict=True):
            self.imply(group, [place, member], among)
            self.imply(group, [place, -member], -among)
        return among

    def sense(self, group: str, at: CnfRow, name: str) -> EncodedPercept:
        degree = self.row(group, f"{name}.degree", len(self.darts))
        marker = self.booleans(f"{name}.marker", len(self.darts))
        here = self.at_one_of(group, at, self.in_v0, f"{name}.here")
        for (f, doors), vertex in self.vertex.items():
            for x in range(f, f + doors):
                self.imply(group, [at[x], vertex], degree[doors - 1])
                # From dart x of v0 the marked dart is door -x.
                if f == 0:
                    self.imply(group, [at[x], vertex], marker[-x % doors])
        for one, other in combinations(marker, 2):
            self.add(group, -one, -other)
        for door in marker:
            self.imply(group, [door], here)
        return EncodedPercept(degree, here, marker)

    def alike(
        self,
        group: str,
        one: EncodedPercept,
        other: EncodedPercept,
        name: str,
        marker: MarkerDetail = "directed",
    ) -> CnfLiteral:
        parts = [self.define_equal(group, f"{name}.degree", one.degree, other.degree)]
        if marker != "none":
            parts.append(
                self.define_equal(
                    group, f"{name}.here", (one.here, -one.here), (other.here, -other.here)
                )
            )
        if marker == "directed":
            # "Not here" makes the marker's row one-hot.
            away = (-one.here, *one.marker), (-other.here, *other.marker)
            parts.append(self.define_equal(group, f"{name}.marker", *away))
        return self.define_and(group, f"{name}.alike", parts)


RuleFault = Literal[
    "", "through-unexplored", "absolute-doors", "shifted", "turned", "one-more", "first-dart"
]
"""One mistake in a rule, which fails in a small world; "" is none:

    through-unexplored  an unexplored dart is traced as if it led back to itself
    absolute-doors      doors on S are counted from the vertex's first dart
    shifted             a percept is compared with the next one
    turned              the robot forgets that an excursion turned it
    one-more            the door behind the common prefix is compared too
    first-dart          records are traced again from the vertex's first dart
"""


@dataclass(frozen=True, slots=True)
class Walk:
    """A walk of n doors: n + 1 positions and percepts, the doors, the darts left by."""

    at: tuple[CnfRow, ...]
    doors: tuple[CnfRow, ...]
    leave: tuple[CnfRow, ...]
    senses: tuple[EncodedPercept, ...]


@dataclass(frozen=True, slots=True)
class EdgeCrossing:
    """A world, a map, and the robot behind dart e, with reference dart vu."""

    world: Worlds
    chart: EncodedMap
    e: CnfRow
    vu: CnfRow


def behind_an_edge(edges: int, *, world_class: str = "any") -> EdgeCrossing:
    world = Worlds(edges)
    world.restrict(world_class)
    chart = world.map("S")
    world.number_the_rest(chart.known)
    e, vu = crossed(world, chart, "e")
    return EdgeCrossing(world, chart, e, vu)


def crossed(world: Worlds, chart: EncodedMap, name: str) -> tuple[CnfRow, CnfRow]:
    e = open_dart(world, chart, name)
    vu = world.position(name, f"{name}.behind")
    world.cross(name, e, vu)
    return e, vu


def open_dart(world: Worlds, chart: EncodedMap, name: str) -> CnfRow:
    dart = world.position(name, name)
    for d in world.darts:
        world.add(name, -dart[d], chart.known[d])
        world.add(name, -dart[d], -chart.explored[d])
    return dart


def hypothesis(scene: EdgeCrossing) -> CnfRow:
    """Any hypothesis for e: another unexplored dart."""
    h = open_dart(scene.world, scene.chart, "h")
    for one, other in zip(scene.e, h, strict=True):
        scene.world.add("h", -one, -other)
    return h


def true_hypothesis(scene: EdgeCrossing) -> CnfRow:
    """The other end of e, in worlds where S knows it."""
    h = hypothesis(scene)
    scene.world.equate("h", (), h, scene.vu)
    return h


def doors(world: Worlds, name: str, steps: int) -> tuple[CnfRow, ...]:
    return tuple(world.row(name, f"{name}.{i}", len(world.darts)) for i in range(steps))


def going(world: Worlds, name: str, steps: int) -> tuple[CnfLiteral, ...]:
    """Per step, is it made? This allows shorter words."""
    go = world.booleans(f"{name}.go", steps)
    for before, after in pairwise(go):
        world.add(name, -after, before)
    return go


def walk(
    world: Worlds,
    name: str,
    start: CnfRow,
    word: tuple[CnfRow, ...],
    go: tuple[CnfLiteral, ...] | None = None,
) -> Walk:
    """The walk along a word in the world, at rest once `go` has ended."""
    at, leave, senses = [start], list[CnfRow](), [world.sense(name, start, f"{name}.0")]
    for i, door in enumerate(word):
        # Without a step, `leave` is any dart.
        guard = () if go is None else (go[i],)
        leave.append(world.position(name, f"{name}.leave.{i}"))
        at.append(world.position(name, f"{name}.at.{i + 1}"))
        world.turn(name, at[i], door, leave[i], *guard)
        world.cross(name, leave[i], at[i + 1], *guard)
        if go is not None:
            world.equate(name, (-go[i],), at[i], at[i + 1])
        senses.append(world.sense(name, at[i + 1], f"{name}.{i + 1}"))
    return Walk(tuple(at), word, tuple(leave), tuple(senses))


@dataclass(frozen=True, slots=True)
class TracedWalk:
    """A walk on a map, alive until a step ends it at an unexplored dart."""

    walk: Walk
    alive: tuple[CnfLiteral, ...]
    ends: tuple[CnfLiteral, ...]


def trace(
    world: Worlds,
    name: str,
    chart: EncodedMap,
    start: CnfRow,
    word: tuple[CnfRow, ...],
    *,
    fault: RuleFault = "",
) -> TracedWalk:
    at, leave, senses = [start], list[CnfRow](), [world.sense(name, start, f"{name}.0")]
    # `first[0]` is the constant true.
    alive, ends = [world.first[0]], list[CnfLiteral]()
    for i, door in enumerate(word):
        leave.append(world.position(name, f"{name}.leave.{i}"))
        at.append(world.position(name, f"{name}.at.{i + 1}"))
        world.turn(name, at[i], door, leave[i], alive[i], absolute=fault == "absolute-doors")
        known = world.at_one_of(name, leave[i], chart.explored, f"{name}.known.{i}")
        on = world.define_and(name, f"{name}.on.{i + 1}", [alive[i], known])
        ends.append(world.define_and(name, f"{name}.ends.{i}", [alive[i], -known]))
        world.cross(name, leave[i], at[i + 1], on)
        world.equate(name, (-alive[i],), at[i], at[i + 1])
        through = fault == "through-unexplored"
        world.equate(name, (ends[i],), leave[i] if through else at[i], at[i + 1])
        alive.append(world.first[0] if through else on)
        senses.append(world.sense(name, at[i + 1], f"{name}.{i + 1}"))
    return TracedWalk(Walk(tuple(at), word, tuple(leave), tuple(senses)), tuple(alive), tuple(ends))


def stay_explored(
    world: Worlds, chart: EncodedMap, walked: Walk, go: tuple[CnfLiteral, ...]
) -> None:
    """Require that every step made crosses an explored dart."""
    for leave, on in zip(walked.leave, go, strict=True):
        for d in world.darts:
            world.add("explored-way", -on, -leave[d], chart.explored[d])


def differ_somewhere(
    world: Worlds, pairs: Sequence[tuple[EncodedPercept, EncodedPercept, tuple[CnfLiteral, ...]]]
) -> None:
    """Negate the conclusion: somewhere all guards hold and the percepts differ.

    The premises alone must reach a guarded place.
    """
    reached: list[CnfLiteral] = []
    differing: list[CnfLiteral] = []
    for i, (one, other, guards) in enumerate(pairs):
        same = world.alike("percepts", one, other, f"compare.{i}")
        if guards:
            reached.append(world.define_and("percepts", f"reached.{i}", guards))
        differing.append(world.define_and("percepts", f"differ.{i}", [-same, *guards]))
    world.add(REFUTED, *differing)
    world.met.append(tuple(reached))
