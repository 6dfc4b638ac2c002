"""Scenes: exact worlds with a map S and a place behind an edge, in which a faulty rule fails.

Formulas make a tiny structure a world with a reachable map: doors are the numbers modulo 12, which
all degrees up to 4 divide; turns come round after `degree` doors and no sooner; the world is
connected; S consists of v0 and of vertices entered by their first dart, `mfirst`, over an explored
edge; malpha maps an unexplored dart to itself.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

from tests.proofs.first_order.conformance import RecordTrie, structure
from topo_verify.algorithms.chart import Chart
from topo_verify.algorithms.motion import Hypothesis, Pilot
from topo_verify.errors import InternalError
from topo_verify.proofs.first_order import finite_models, terms
from topo_verify.proofs.first_order import theory as t
from topo_verify.proofs.first_order.finite_models import element
from topo_verify.proofs.theorem import Budget, SolverAnswer
from topo_verify.robot.events import MapDart, Move
from topo_verify.robot.percept import Door, Percept
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.world.rooted_map import World

# The least common multiple of 1, 2, 3, 4.
DOORS, MOST_DEGREE = 12, 4

mfirst = terms.Symbol("mfirst", ("M",), "M")
mtofirst = terms.Symbol("mtofirst", ("M",), "K")

AXIOMS = tuple(name for name in t.CORRESPONDENCE if name not in t.LEMMAS)
"""The axioms without the lemmas on doors, which would slow Z3 down."""


def door(number: int) -> terms.App:
    return element("K", number % DOORS)


def exact(darts: int, known: int) -> dict[str, terms.Term]:
    """The formulas that make a structure of this size exact."""
    doors = [terms.eq(t.succ(door(n)), door(n + 1)) for n in range(DOORS)]
    return {
        **{name: t.AXIOMS[name] for name in AXIOMS},
        "door-0": terms.eq(t.k0, door(0)),
        "doors": terms.conj(*doors),
        **_degrees(),
        **_connected(darts),
        **_discovered(known),
    }


def _degrees() -> dict[str, terms.Term]:
    def is_degree(n: int) -> terms.Term:
        sooner = [terms.differ(t.rot(t.a, door(k)), t.a) for k in range(1, n)]
        return terms.conj(terms.eq(t.rot(t.a, door(n)), t.a), *sooner)

    rows = [
        terms.forall(t.a, terms.eq(terms.eq(t.deg(t.a), element("G", n - 1)), is_degree(n)))
        for n in range(1, MOST_DEGREE + 1)
    ]
    return {"degrees": terms.conj(*rows)}


def _connected(darts: int) -> dict[str, terms.Term]:
    reached = [terms.Symbol(f"reached{n}", ("W",), terms.BOOL) for n in range(darts)]
    a = t.a
    rows = [terms.forall(a, terms.eq(reached[0](a), terms.eq(a, t.root)))]
    for before, after in pairwise(reached):
        ways = terms.disj(before(a), before(t.alpha(a)), before(t.sigma(a)))
        rows.append(terms.forall(a, terms.eq(after(a), ways)))
    return {"connected": terms.conj(*rows, terms.forall(a, reached[-1](a)))}


def _discovered(known: int) -> dict[str, terms.Term]:
    reached = [terms.Symbol(f"found{n}", ("M",), terms.BOOL) for n in range(known)]
    x = t.x
    entered = [terms.forall(x, terms.eq(reached[0](x), t.minv0(x)))]
    for before, after in pairwise(reached):
        ways = terms.disj(before(x), terms.conj(t.explored(mfirst(x)), before(t.malpha(mfirst(x)))))
        entered.append(terms.forall(x, terms.eq(after(x), ways)))
    return {
        "unexplored-ends-itself": terms.forall(
            x, terms.neg(t.explored(x)), terms.eq(t.malpha(x), x)
        ),
        "first-of-vertex": terms.forall(x, terms.eq(mfirst(t.msigma(x)), mfirst(x))),
        "first-is-there": terms.forall(x, terms.eq(t.mrot(x, mtofirst(x)), mfirst(x))),
        "first-of-v0": terms.eq(mfirst(t.mroot), t.mroot),
        "discovered": terms.conj(*entered, terms.forall(x, reached[-1](x))),
    }


@dataclass(frozen=True, slots=True)
class Scene:
    """A decoded model; `place` is phi, darts of S to darts of the world.

    Attributes:
        first: for each dart of S, the first dart of its vertex.
        constants: the mutant's: darts of S, darts of the world, or doors.
    """

    world: World
    place: tuple[int, ...]
    first: tuple[int, ...]
    explored: frozenset[int]
    constants: Mapping[str, int]


def find(
    given: Mapping[str, terms.Term], budget: Budget, *, edges: int, known: int
) -> tuple[Scene | None, SolverAnswer, str]:
    """Search a scene of this size; return it or None, the answer, and the reason for `unknown`.

    Raises:
        InternalError: the model is not a world.
    """
    sizes = {"W": 2 * edges, "M": known, "K": DOORS, "G": MOST_DEGREE}
    formulas = [*exact(2 * edges, known).values(), *given.values()]
    model = finite_models.model(formulas, sizes, budget)
    if model.structure is None:
        return None, model.answer, model.why
    return _decoded(model.structure, 2 * edges, known, given), "sat", ""


def question(given: Mapping[str, terms.Term], *, edges: int, known: int) -> str:
    sizes = {"W": 2 * edges, "M": known, "K": DOORS, "G": MOST_DEGREE}
    return finite_models.grounded([*exact(2 * edges, known).values(), *given.values()], sizes)


def _decoded(
    structure: terms.Structure, darts: int, known: int, given: Mapping[str, terms.Term]
) -> Scene:
    of = structure.functions
    names = {
        symbol.name
        for term in given.values()
        for symbol in terms.symbols(term)
        if not symbol.arguments and "!" not in symbol.name
    }
    world = World(
        tuple(int(of["alpha"](d)) for d in range(darts)),
        tuple(int(of["sigma"](d)) for d in range(darts)),
        int(of["root"]()),
    )
    for d in range(darts):
        if of["deg"](d) != world.degrees[world.vertex_of[d]] - 1:
            raise InternalError(f"the model's degree at dart {d} is not that of its world")
    return Scene(
        world,
        tuple(int(of["phi"](x)) for x in range(known)),
        tuple(int(of["mfirst"](x)) for x in range(known)),
        frozenset(x for x in range(known) if of["explored"](x)),
        {name: int(of[name]()) for name in sorted(names)},
    )


MOVES = 10_000


class SceneReplay:
    """A robot in a scene's world, for one replay; the edges of `without` are left to the mutant."""

    def __init__(self, scene: Scene, *, without: Collection[str] = ()) -> None:
        self.scene = scene
        self.robot = SimulatedRobot(scene.world, MOVES)
        self.chart = Chart(self.robot.percept)
        self.pilot = Pilot(self.robot)
        self.at: MapDart = 0
        self.trie = RecordTrie()
        left_out = {scene.constants[name] for name in without}
        left_out |= {self._other(x) for x in left_out}
        self.number: dict[int, MapDart] = {}
        self._enter(self._at_place(scene.world.root), 0)
        self._draw(left_out)

    def _at_place(self, dart: int | None) -> int:
        return self.scene.place.index(dart if dart is not None else -1)

    def _other(self, x: int) -> int:
        return self._at_place(self.scene.world.alpha[self.scene.place[x]])

    def _enter(self, x: int, first: MapDart) -> None:
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
        e = self.number[x]
        self.at = self.pilot.walk(self.chart, self.at, self.chart.vertex[e])
        if self.robot.percept != self.chart.percepts[self.at]:
            raise InternalError(f"S of {self.scene.world.id} differs from what the robot senses")
        return self.pilot.cross(self.chart, self.at, e)

    def _join(self, x: int, other: MapDart) -> None:
        self.chart.join(self.number[x], other)
        self.at = other

    def dart(self, name: str) -> MapDart:
        return self.number[self.scene.constants[name]]

    def first(self, dart: MapDart) -> MapDart:
        return self.chart.first[self.chart.vertex[dart]]

    def door(self, name: str, degree: int) -> Door:
        return self.scene.constants[name] % degree

    def behind(self, name: str) -> Percept:
        """Cross a dart of S; return the percept."""
        return self._cross(self.scene.constants[name])

    def forward(self, name: str) -> Percept:
        """Take a door as a mapper that knows how it is turned."""
        return self.pilot.forward(self.door(name, self.robot.percept.degree))

    def take(self, name: str) -> Percept:
        """Take a door regardless of how the robot is turned."""
        return self.robot.move(self.door(name, self.robot.percept.degree))

    def close(self, e: str, h: str) -> None:
        """Go back behind e and join it with h, its true end."""
        self.pilot.back(0)
        entry = self.dart(h)
        self._join(self.scene.constants[e], entry)
        self.at = self.chart.turn(entry, self.pilot.turned)

    def hypothesis(self, name: str) -> Hypothesis:
        return Hypothesis(self.dart(name), self.chart, self.chart.tree(0))

    def says(self, rule: terms.Term, *seen: Percept, **values: int) -> bool:
        """Is a term true of S and percepts, for which b = 0, 1, ... stand?"""
        return structure(self.chart, seen, self.trie).holds(rule, **values)

    def truth(self, e: str, h: str) -> bool:
        """Does e end in h?"""
        place, constants = self.scene.place, self.scene.constants
        return self.scene.world.alpha[place[constants[e]]] == place[constants[h]]

    @cached_property
    def root(self) -> int:
        assert self.scene.world.root is not None
        return self.scene.world.root

    @property
    def history(self) -> tuple[Door, ...]:
        return tuple(event.door for event in self.robot.events if isinstance(event, Move))
