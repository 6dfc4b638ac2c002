"""The fold of a whole history, S as its settled part, and the robot in it.

Nothing is assumed, so the fold is true whatever doors the robot takes; once no dart of it is open,
it is the world. A policy that steers by a History affects only the cost.

    S, U         the chart: the settled part of the fold, and its unexplored darts
    e, vu        a crossed dart of U, and the place behind it
    h            a hypothesis for e: another dart of U, at a vertex that looks like vu
    ghost        a node of the fold that is not known to be a vertex of S

**An edge is settled** wherever the robot stands: as a loop once folding makes vu a vertex of S, as
a new vertex once folding refutes every h. One settled edge may settle others, because two vertices
of S are never one. For each other h, the places if e ended in h are kept and follow the history.

The first h that is not refuted is the witness that vu may be known. It is checked again only once
an edge was settled, places changed, or an edge was joined where its places differ from the fold.

Source: docs/homing.md; docs/semantics.md, section 11.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from typing import Any, ClassVar

from topo_verify.algorithms.beyond.folding import NodeDart
from topo_verify.algorithms.beyond.places import PlaceNode, Places
from topo_verify.algorithms.chart import Chart, Tree
from topo_verify.algorithms.exploration import Refutation
from topo_verify.robot.events import Augment, Confirm, Evidence, MapDart, Pose, Reject, Robot
from topo_verify.robot.percept import Percept, Purpose


@dataclass(slots=True)
class Crossed:
    """A crossed dart of U.

    Attributes:
        entry: the dart of entry behind it.
        refuted: the hypotheses that no world allows.
        supposed: of the others, the places if they are true.
        possible: the first hypothesis allowed at the last check.
        checked: `settled` of the history and `changes` of its places at that check.
    """

    entry: NodeDart
    refuted: dict[MapDart, Refutation] = field(default_factory=dict[MapDart, Refutation])
    supposed: dict[MapDart, Places] = field(default_factory=dict[MapDart, Places])
    possible: MapDart | None = None
    checked: tuple[int, int] = (0, 0)


class ImpossibleError(Exception):
    """No world that the mapper allows for has this history."""


class History:
    """All percepts of a run, folded. `move` adds one and settles what it proves.

    Attributes:
        chart: S.
        places: the fold, with S in it.
        crossed: the crossed darts of U.
        at: the robot's reference dart.
        settled: the number of settled edges.
        notes: what a policy keeps about crossed darts; dropped when there is a new percept.
    """

    allowed: ClassVar = "world"

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.chart = Chart(robot.percept)  # H.1
        self.places = Places(robot.percept)
        self.at = self.places.entries[0]
        self.crossed: dict[MapDart, Crossed] = {}
        self.cost, self.settled = 0, 0
        self.notes: dict[MapDart, Any] = {}
        self._home: Tree | None = None
        self._neighbours: dict[PlaceNode, list[tuple[PlaceNode, NodeDart]]] = {}

    # ---------------------------------------------------------------- S in the fold

    def node_dart(self, dart: MapDart) -> NodeDart:
        """The dart of the fold for a dart of S."""
        v = self.chart.vertex[dart]
        return self.places.turn(self.places.entries[v], dart - self.chart.first[v])

    def map_dart(self, dart: NodeDart, places: Places | None = None) -> MapDart | None:
        """The dart of S for a dart of the fold (or of `places`); None at a ghost."""
        places = places or self.places
        v = places.vertex(dart)
        if v is None:
            return None
        return self.chart.turn(self.chart.first[v], places.door(places.entries[v], dart))

    def behind(self, e: MapDart) -> NodeDart:
        """The dart of entry behind a crossed dart of S."""
        return self.places.resolve(self.crossed[e].entry)

    def home(self) -> Tree:
        """The breadth-first tree of S rooted at v0."""
        if self._home is None:
            self._home = self.chart.tree(0)
        return self._home

    # ---------------------------------------------------------------- places and ways

    def in_s(self) -> bool:
        """Whether the robot is known to stand at a vertex of S."""
        return self.places.vertex(self.at) is not None

    def beside(self, e: MapDart) -> bool:
        """Whether the robot stands at one of the ghosts behind e."""
        return e in self.crossed and self.places.place(self.at) in self.ghosts(e)

    def away(self) -> int:
        """Distance from the robot to the nearest vertex of S."""
        search = self.outward(self.at)
        return next(far for place, far, _ in search if self.places.vertex(place) is not None)

    def open_darts(self, place: PlaceNode) -> Iterator[NodeDart]:
        """The darts of a place that were never crossed."""
        return (dart for dart in self.places.darts(place) if self.places.across(dart) is None)

    def leads(self, place: PlaceNode) -> Iterator[MapDart]:
        """The darts of U to settle from a place: uncrossed, or leading to a ghost."""
        ghost = self.places.vertex(place) is None
        for dart in self.places.darts(place):
            end = self.places.across(dart)
            if ghost == (end is not None):
                e = self.map_dart(end or dart)
                if e is not None:
                    yield e

    def outward(
        self, start: NodeDart, *, ghosts_only: bool = False
    ) -> Iterator[tuple[PlaceNode, int, NodeDart | None]]:
        """Breadth-first search over the places visited: place, distance, dart that leads back.

        Args:
            ghosts_only: skip the vertices of S, except the first place.
        """
        first = self.places.place(start)
        reached = {first}
        queue: list[tuple[PlaceNode, int, NodeDart | None]] = [(first, 0, None)]
        for step in queue:
            yield step
            place, distance, _ = step
            for neighbour, end in self._neighbours.get(place) or self.neighbours(place):
                if neighbour not in reached:
                    reached.add(neighbour)
                    if not (ghosts_only and self.places.vertex(neighbour) is not None):
                        queue.append((neighbour, distance + 1, end))

    def neighbours(self, place: PlaceNode) -> list[tuple[PlaceNode, NodeDart]]:
        """The places next to a place, each with the dart of arrival; cached."""
        places = self.places
        if place not in self._neighbours:
            ends = (places.across(dart) for dart in places.darts(place))
            self._neighbours[place] = [(places.place(end), end) for end in ends if end is not None]
        return self._neighbours[place]

    def ghosts(self, e: MapDart) -> dict[PlaceNode, int]:
        """The ghosts connected with vu through ghosts, and their distances from it."""
        search = self.outward(self.behind(e), ghosts_only=True)
        return {place: distance for place, distance, _ in search}

    def distances(self, goals: Collection[PlaceNode]) -> Iterator[tuple[PlaceNode, int]]:
        """The goals with their distances from the robot, nearest first."""
        reached, missing, distance = set[PlaceNode](), len(goals), 0
        border = {self.places.place(self.at)}
        while missing:
            reached |= border
            for place in goals:
                if place in border:
                    missing -= 1
                    yield place, distance
            nearby = (self._neighbours.get(place) or self.neighbours(place) for place in border)
            border = {place for row in nearby for place, _ in row} - reached
            distance += 1

    def way(self, goal: NodeDart) -> list[NodeDart]:
        """The exits on a shortest way from the robot to the place of a dart."""
        target = self.places.place(goal)
        back, search = dict[PlaceNode, NodeDart | None](), self.outward(self.at)
        while target not in back:
            place, _, leads_back = next(search)
            back[place] = leads_back
        exits: list[NodeDart] = []
        while (leads_back := back[target]) is not None:
            leaves = self.places.across(leads_back)
            assert leaves is not None, "the search came by this edge"
            exits.append(leaves)
            target = self.places.place(leaves)
        return exits[::-1]

    # ---------------------------------------------------------------- moving

    def move(self, exit_dart: NodeDart, purpose: Purpose = "walk") -> None:
        """Leave by a dart of the robot's place; fold, and settle what follows.

        Raises:
            ImpossibleError: no world that the mapper allows for has this history.
        """
        places = self.places
        percept = self.robot.move(places.door(self.at, exit_dart), purpose)
        self.cost += 1
        beyond = places.across(exit_dart)
        if beyond is None:
            changes = places.changes
            e = self.map_dart(exit_dart)
            beyond, contradiction = places.add(exit_dart, percept)  # H.14
            if contradiction:
                raise self.impossible(contradiction)
            # crossed doors of a ghost may now be doors of S
            merged = places.changes != changes
            if merged:
                self._neighbours.clear()
            else:
                self._neighbours.pop(places.place(exit_dart), None)
            self._note(self.chart.unexplored if merged else () if e is None else (e,))
            self._settle()
        self.at = places.resolve(beyond)

    def impossible(self, contradiction: str) -> ImpossibleError:
        """The exception for a contradictory history."""
        return ImpossibleError(f"no {self.allowed} shows this history: {contradiction}")

    def _note(self, darts: Collection[MapDart]) -> None:
        for e in darts:
            entry = None if e in self.crossed else self.places.across(self.node_dart(e))
            if entry is not None:
                self.crossed[e] = Crossed(entry)

    # ---------------------------------------------------------------- settling

    def alike(self, e: MapDart) -> list[MapDart]:
        """H: the darts of U, other than e, at vertices that look like the place behind e."""
        looks, percepts = self.places.looks(self.behind(e)), self.chart.percepts
        return [h for h in self.chart.unexplored if h != e and percepts[h].signature == looks]

    def hypotheses(self, e: MapDart) -> Iterator[tuple[MapDart, Places]]:
        """Each h for a crossed e that some world allows, with the places if it is true."""
        for h in self.alike(e):
            places = self.suppose(e, h)
            if places is not None:
                yield h, places

    def suppose(self, e: MapDart, h: MapDart) -> Places | None:
        """The places if a crossed e ends in h, or None if no world allows that."""
        crossed = self.crossed[e]
        if h in crossed.refuted:
            return None
        supposed = crossed.supposed.get(h)
        if supposed is None or not supposed.follow():
            fold = self.places.suppose(self.node_dart(e), self.node_dart(h))  # H.10
            if isinstance(fold, str):
                crossed.refuted[h] = Refutation("folding", Evidence(0, contradiction=fold))
                return None
            supposed = crossed.supposed[h] = fold
        return supposed

    def _settle(self) -> None:
        self.notes.clear()
        grown = True
        while grown:
            grown = False
            for e in list(self.crossed):  # H.15
                # Not settled meanwhile as the other end, and not checked already.
                if e not in self.crossed or self._stands(e):
                    continue
                h = self.map_dart(self.behind(e))
                if h is not None:  # H.16
                    self._settle_loop(e, h)
                elif not self._may_be_known(e):  # H.17
                    self._settle_new(e)
                else:
                    continue
                grown = True

    def _stands(self, e: MapDart) -> bool:
        """Whether nothing changed, since e was checked, that its possible end depends on."""
        crossed = self.crossed[e]
        return (
            crossed.possible is not None
            and crossed.checked == (self.settled, self.places.changes)
            and crossed.supposed[crossed.possible].fold.stands()
        )

    def _may_be_known(self, e: MapDart) -> bool:
        crossed = self.crossed[e]
        crossed.checked = self.settled, self.places.changes
        h = crossed.possible  # still the first, as refutations last
        if h is None or h not in self.chart.unexplored or self.suppose(e, h) is None:
            crossed.possible = next((h for h, _ in self.hypotheses(e)), None)
        return crossed.possible is not None

    def _settle_loop(self, e: MapDart, h: MapDart) -> None:
        self.robot.declare(Pose(e, tuple(self.alike(e))))
        self.robot.declare(Confirm(e, h, "folding"))
        self._join(e, h)
        self.robot.declare(Augment(e, "loop", h, self.chart.percepts[h].degree))

    def _settle_new(self, e: MapDart) -> None:
        entry, alike = self.behind(e), self.alike(e)
        degree, _ = self.places.looks(entry)
        self.robot.declare(Pose(e, tuple(alike)))
        for h in alike:
            self.robot.declare(Reject(e, h, *self.crossed[e].refuted[h]))
        self.places.know(entry)
        first = self.chart.add_vertex(Percept(degree, None))  # with the marker it would be v0
        self._join(e, first)
        self.robot.declare(Augment(e, "new", first, degree))
        self._note([d for d in self.chart.darts(self.chart.vertex[first]) if d != first])

    def _join(self, e: MapDart, other: MapDart) -> None:
        self.chart.join(e, other)
        self.crossed.pop(e)
        self.crossed.pop(other, None)
        self.settled += 1
        self._home = None
