"""The replay of a scene in the simulator, without a solver, to put a faulty rule to the test.

The robot of the trusted core starts at the marker of the scene's world. It crosses the edges that S
of the scene has explored, in an order in which each vertex is entered by its first dart. Then it
makes the moves of the mutant. The percepts on the way must be those that S shows; the rule is
evaluated on S and on the percepts sensed behind e.
"""

from __future__ import annotations

from collections.abc import Collection
from functools import cached_property

from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.motion import Hypothesis, Pilot
from topo_verify.errors import InternalError
from topo_verify.proofs.first_order.run_structure import RecordTrie, structure
from topo_verify.proofs.first_order.scenes import Scene
from topo_verify.proofs.first_order.terms import Term
from topo_verify.robot.events import MapDart, Move
from topo_verify.robot.percept import Door, Percept
from topo_verify.robot.simulator import SimulatedRobot

MOVES = 10_000


class SceneReplay:
    """A robot in the world of a scene. It lives for one replay; its map grows as it moves.

    Attributes:
        chart: S as it was drawn; its darts are numbered in the order of discovery.
        without: constants of the scene: the edges of these darts are left for the mutant to cross.
    """

    def __init__(self, scene: Scene, *, without: Collection[str] = ()) -> None:
        self.scene = scene
        self.robot = SimulatedRobot(scene.world, MOVES)
        self.chart = Chart(self.robot.percept)
        self.pilot = Pilot(self.robot)
        self.at: MapDart = 0
        self.trie = RecordTrie()
        left_out = {scene.constants[name] for name in without}
        # Both darts of an edge are left out, whichever of them is named.
        left_out |= {self._other(x) for x in left_out}
        self.number: dict[int, MapDart] = {}
        """For each dart of the scene's S, its number on the chart."""
        self._enter(self._at_place(scene.world.root), 0)
        self._draw(left_out)

    # ------------------------------------------------------------ drawing S

    def _at_place(self, dart: int | None) -> int:
        """The dart of the scene's S at this dart of the world."""
        return self.scene.place.index(dart if dart is not None else -1)

    def _other(self, x: int) -> int:
        return self._at_place(self.scene.world.alpha[self.scene.place[x]])

    def _enter(self, x: int, first: MapDart) -> None:
        """Number the vertex of x, a dart of the scene's S, from dart `first` of the chart on."""
        world, degree = self.scene.world, self.chart.degree[self.chart.vertex[first]]
        dart = self.scene.place[x]
        for door in range(degree):
            self.number[self._at_place(dart)] = first + door
            dart = world.sigma[dart]

    def _draw(self, left_out: Collection[int]) -> None:
        edges = [x for x in sorted(self.scene.explored) if x not in left_out]
        while len(self.number) < len(self.scene.place):
            # An edge into a vertex that is not drawn yet, by its first dart. It exists, since the
            # scene requires that S was discovered in this way.
            x = next(
                x
                for x in edges
                if x in self.number
                and (y := self._other(x)) not in self.number
                and self.scene.first[y] == y
            )
            percept = self._cross(x)
            entry = self.chart.add_vertex(percept)
            self._join(x, entry)
            self._enter(self._other(x), entry)
        for x in edges:
            if self.chart.alpha[self.number[x]] is None:
                self._cross(x)
                self._join(x, self.number[self._other(x)])

    def _cross(self, x: int) -> Percept:
        """Walk to a dart of the scene's S, cross it, and return the percept behind it."""
        e = self.number[x]
        self.at = self.pilot.walk(self.chart, self.at, self.chart.vertex[e])
        if self.robot.percept != self.chart.percepts[self.at]:
            raise InternalError(f"S of {self.scene.world.id} differs from what the robot senses")
        return self.pilot.cross(self.chart, self.at, e)

    def _join(self, x: int, other: MapDart) -> None:
        self.chart.join(self.number[x], other)
        # The robot came in by `other`, so that is its reference dart.
        self.at = other

    # ------------------------------------------------------------ the moves of the mutant

    def dart(self, name: str) -> MapDart:
        """The number on the chart of a constant that is a dart of S."""
        return self.number[self.scene.constants[name]]

    def first(self, dart: MapDart) -> MapDart:
        """The first dart of a vertex."""
        return self.chart.first[self.chart.vertex[dart]]

    def door(self, name: str, degree: int) -> Door:
        """The door that a constant means at a vertex of this degree."""
        return self.scene.constants[name] % degree

    def behind(self, name: str) -> Percept:
        """Cross a dart of S, and return the percept behind it."""
        return self._cross(self.scene.constants[name])

    def forward(self, name: str) -> Percept:
        """Take a door of the excursion as a mapper does that knows how it is turned."""
        return self.pilot.forward(self.door(name, self.robot.percept.degree))

    def take(self, name: str) -> Percept:
        """Take a door without regard to how the robot is turned."""
        return self.robot.move(self.door(name, self.robot.percept.degree))

    def close(self, e: str, h: str) -> None:
        """Go back behind e and join it with h, its true end."""
        self.pilot.back(0)
        entry = self.dart(h)
        self._join(self.scene.constants[e], entry)
        self.at = self.chart.turn(entry, self.pilot.turned)

    def hypothesis(self, name: str) -> Hypothesis:
        """The dart as a hypothesis, with its way home."""
        return Hypothesis(self.dart(name), self.chart, self.chart.tree(0))

    # ------------------------------------------------------------ judging

    def says(self, rule: Term, *seen: Percept, **values: int) -> bool:
        """Whether a term is true of S and of these percepts, which b = 0, 1, ... stand for."""
        return structure(self.chart, seen, self.trie).holds(rule, **values)

    def truth(self, e: str, h: str) -> bool:
        """Whether e ends in h in the world."""
        place, constants = self.scene.place, self.scene.constants
        return self.scene.world.alpha[place[constants[e]]] == place[constants[h]]

    @cached_property
    def root(self) -> int:
        """The marked dart of the world."""
        assert self.scene.world.root is not None
        return self.scene.world.root

    @property
    def history(self) -> tuple[Door, ...]:
        """The doors of all moves so far."""
        return tuple(event.door for event in self.robot.events if isinstance(event, Move))
