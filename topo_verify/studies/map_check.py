"""Judges a map by a log: is it refuted, proved, or what is left to walk?

    check = check_map(world, read_trace(log))
    check.verdict        # REFUTED, PROVED or UNKNOWN
    check.onward         # UNKNOWN: the moves that prove it from where the log ends

An edge of the map's breadth-first tree is **proved** if the fold has crossed it at the end of
the tree path from v0; a chord, if its loop is closed in the fold.

**What is minimised.** A plan goes home, perhaps over an unproved edge; then it walks the loops
not yet proved, shortest first, and hanging trees on its way. If every loop is proved, it walks
the shortest-path tree from where the robot stands. The cheapest plan counts. It is optimal from
the start and in a tree, elsewhere an upper bound (a travelling salesman problem).

Source: docs/semantics.md, section 11.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

from topo_verify.checkers.entailment import FoldedTrace
from topo_verify.checkers.folding import Place
from topo_verify.checkers.replayed_trace import ReplayedTrace
from topo_verify.errors import InternalError
from topo_verify.robot.events import Event, Move, Start, Trace
from topo_verify.robot.percept import Door
from topo_verify.robot.simulator import exit_dart, first_percept, percepts, shared_move
from topo_verify.world.least_cost import BreadthFirstTree, covering_walk
from topo_verify.world.rooted_map import Dart, World

MOST_DETOURS = 8
"""Most unproved edges, nearest first, that are tried as a way home."""


@dataclass(frozen=True, slots=True)
class MapCheck:
    """The verdict on a map, and how to go on.

    Attributes:
        verdict: REFUTED: the map does not show this log. PROVED: it alone does.
        event: the event that refutes the map.
        unproved: the unproved edges, each by its two darts in the map.
        onward: the moves that prove an UNKNOWN map from where the log ends.
    """

    verdict: Literal["PROVED", "UNKNOWN", "REFUTED"]
    event: int | None = None
    message: str = ""
    unproved: tuple[tuple[Dart, Dart], ...] = ()
    onward: tuple[Move, ...] = ()

    @property
    def doors(self) -> tuple[Door, ...]:
        """The doors of `onward`."""
        return tuple(event.door for event in self.onward)


def check_map(world: World, log: Sequence[Event]) -> MapCheck:
    """Judge the map `world` by this log.

    Raises:
        InputError: the log does not begin with its only `start`, or goes on after `finish`.
    Complexity: at most `MOST_DETOURS` + 2 plans, each folds the log once and takes O(cost) besides.
    """
    replayed = ReplayedTrace(world, log)
    if not replayed.is_history:
        return _refutation(replayed)
    history = [event for event in log if isinstance(event, Start | Move)]
    folded = FoldedTrace(history)
    fold = folded.fold
    if broken := folded.read_to(len(history)):
        raise InternalError(f"a world shows a log whose fold contradicts: {broken[1]}")
    if not fold.open_darts():
        return MapCheck("PROVED")
    at = replayed.positions[-1]
    onward = tuple(moves(world, at, _way_on(world, history, at)))
    for event in onward:
        fold.move(event.door, event.percept)
    if open_darts := fold.open_darts():
        raise InternalError(f"a way on leaves {open_darts} darts of the fold open")
    unproved = tuple(_unproved(_Planner(world, history)))
    return MapCheck("UNKNOWN", unproved=unproved, onward=onward)


def moves(world: World, at: Dart, doors: Sequence[Door]) -> Iterator[Move]:
    """The moves of a robot with reference dart `at` that takes these doors."""
    shown = percepts(world)
    for door in doors:
        at = world.alpha[exit_dart(world, at, door)]
        yield shared_move(door, shown[at], None)


def tour_log(world: World) -> Trace:
    """The log of a robot that walks `World.proof_tour`, the cheapest proof."""
    start = Start(percept=first_percept(world), world=world.known_id)
    return start, *moves(world, world.root or 0, world.proof_tour())


def _refutation(replayed: ReplayedTrace) -> MapCheck:
    if replayed.false_percepts:
        event, observed, shown = replayed.false_percepts[0]
        message = f"the map shows {shown} there, and the log says {observed}"
    else:
        assert replayed.illegal is not None, "a log that is no history shows why"
        event = replayed.illegal
        degree = replayed.map.seen_at(replayed.positions[-1]).degree
        refused = replayed.trace[event]
        assert isinstance(refused, Move), "only a move can be illegal"
        message = (
            f"the map has doors 0 to {degree - 1} there, and the log takes door {refused.door}"
        )
    return MapCheck("REFUTED", event, message)


class _Planner:
    """A map in its canonical numbering, a folded log, and the robot at its end."""

    def __init__(self, world: World, history: Sequence[Event], at: Dart | None = None) -> None:
        self.tree = BreadthFirstTree(world.code)
        self.canonical = World.from_code(world.code)
        self.darts = _numbering(world, self.tree)
        folded = FoldedTrace(history)
        folded.read_to(len(history))
        self.fold = folded.fold
        self.at = 0 if at is None else self.darts.index(at)

    def go(self, darts: Sequence[Dart]) -> None:
        for event in moves(self.canonical, self.at, self.tree.doors(darts, self.at)):
            self.fold.move(event.door, event.percept)
        if darts:
            self.at = self.tree.table[1][darts[-1]]

    def trace(self, darts: Sequence[Dart]) -> Place | None:
        """Where a walk from v0 by these darts arrives in the fold, or None."""
        node, reference = self.fold.find((0, 0))
        for door in self.tree.doors(darts):
            end = self.fold.partner((node, reference + door))
            if end is None:
                return None
            node, reference = end
        return node, reference

    def is_closed(self, chord: Dart) -> bool:
        loop = self.tree.loop(chord)
        return self.trace(loop) == self.fold.find((0, self.tree.table[1][loop[-1]]))

    def open_loops(self) -> list[Dart]:
        """Open chords, shortest loop first."""
        chords = [chord for chord in self.tree.chords if not self.is_closed(chord)]
        return sorted(chords, key=lambda chord: (self.tree.weight(chord), chord))

    def unreached(self) -> list[int]:
        """Vertices whose tree path is not wholly crossed."""
        return [v for v in range(len(self.tree.first)) if self.trace(self.tree.down(v)) is None]

    def plan(self, home: Sequence[Dart]) -> list[Dart]:
        """The darts to leave by, first on this way to v0, until every edge is proved."""
        trips = [list(home)]
        self.go(home)
        for chord in self.open_loops():
            if not self.is_closed(chord):
                trips.append(self.tree.loop(chord))
                self.go(trips[-1])
        return covering_walk(self.tree, trips, self.unreached())


def _numbering(world: World, tree: BreadthFirstTree) -> list[Dart]:
    """The world's dart for each dart of its canonical code."""
    darts: list[Dart] = []
    for v, first in enumerate(tree.first):
        dart = world.alpha[darts[tree.table[1][first]]] if v else world.root
        for _ in range(tree.table[0][v]):
            assert dart is not None, "only a world without darts has no root"
            darts.append(dart)
            dart = world.sigma[dart]
    return darts


def _unproved(planner: _Planner) -> list[tuple[Dart, Dart]]:
    """The unproved edges by their two darts, ascending."""
    tree, darts = planner.tree, planner.darts
    darts_left = [*(tree.first[v] for v in planner.unreached()), *planner.open_loops()]
    pairs = ((darts[dart], darts[tree.table[1][dart]]) for dart in darts_left)
    return sorted((min(pair), max(pair)) for pair in pairs)


def _way_on(world: World, history: Sequence[Event], at: Dart) -> tuple[Door, ...]:
    planner = _Planner(world, history, at)
    tree, start = planner.tree, planner.at
    home = tree.home(tree.vertex[start])
    if loops := planner.open_loops():
        detours = _detours(tree, start, loops)[: MOST_DETOURS if home else 0]
        plans = [_Planner(world, history, at).plan(way) for way in (home, *detours)]
        return min((tree.doors(plan, start) for plan in plans), key=len)
    around = _around(world, at, _unproved(planner))
    return min(around, tree.doors(planner.plan(home), start), key=len)


def _detours(tree: BreadthFirstTree, at: Dart, chords: Sequence[Dart]) -> list[list[Dart]]:
    """The ways home over one of these edges, shortest first."""
    alpha, start = tree.table[1], tree.vertex[at]
    entry: dict[int, Dart] = {start: at}  # by which the search left
    queue = [start]
    for v in queue:  # grows as it goes
        for dart in range(tree.first[v], tree.first[v] + tree.table[0][v]):
            if (end := tree.vertex[alpha[dart]]) not in entry:
                entry[end] = dart
                queue.append(end)
    ways: list[list[Dart]] = []
    for dart in (end for chord in chords for end in (chord, alpha[chord])):
        way = tree.home(tree.vertex[alpha[dart]])
        there, v = [dart], tree.vertex[dart]
        while v != start:
            there.append(entry[v])
            v = tree.vertex[entry[v]]
        ways.append([*reversed(there), *way])
    return sorted(ways, key=len)


def _around(world: World, at: Dart, unproved: Sequence[tuple[Dart, Dart]]) -> tuple[Door, ...]:
    """A shortest walk over these tree edges, which every spanning tree has."""
    there = world.with_marker(at)
    tree = BreadthFirstTree(there.code)
    number = {dart: place for place, dart in enumerate(_numbering(there, tree))}
    ends = [max(tree.vertex[number[dart]] for dart in edge) for edge in unproved]
    return tree.doors(covering_walk(tree, [], ends))
