"""Scenes: exact worlds with a map S and a place behind an edge, in which a faulty rule fails.

In a tiny structure, "is at v0", "degree" and "door" must mean what they mean in a world; otherwise
a rule could fail there that fails in no world. So formulas beside the axioms require: doors are the
numbers modulo 12, which all degrees up to 4 divide; the degree is the least number of doors after
which a turn comes round; the world is connected; S consists of v0 and of vertices that were entered
by their first dart over an explored edge; malpha maps an unexplored dart of S to itself. A model is
then a world with a map that an exploration can have drawn, and is decoded as such.

    mfirst(x)   the first dart of x's vertex in S: the one by which it was entered

Source: docs/semantics.md, sections 1 to 3.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

from topo_verify.errors import InternalError
from topo_verify.proofs.first_order import axioms as t
from topo_verify.proofs.first_order import finite_models
from topo_verify.proofs.first_order.finite_models import element
from topo_verify.proofs.first_order.structures import Structure
from topo_verify.proofs.first_order.terms import (
    BOOL,
    App,
    Symbol,
    Term,
    conj,
    differ,
    disj,
    eq,
    forall,
    neg,
    symbols,
)
from topo_verify.proofs.theorem import Budget, SolverAnswer
from topo_verify.world.rooted_map import World

# 12 is the least common multiple of 1, 2, 3, 4: every turn comes round after so many doors.
DOORS, MOST_DEGREE = 12, 4

mfirst = Symbol("mfirst", ("M",), "M")
mtofirst = Symbol("mtofirst", ("M",), "K")

AXIOMS = tuple(name for name in t.CORRESPONDENCE if name not in t.LEMMAS)
"""The axioms without the lemmas on doors, which follow and would only slow Z3 down."""


def door(number: int) -> App:
    """The constant for a door."""
    return element("K", number % DOORS)


def exact(darts: int, known: int) -> dict[str, Term]:
    """The formulas that make a structure with these numbers of darts, in world and S, exact."""
    return {
        **{name: t.AXIOMS[name] for name in AXIOMS},
        **_doors(),
        **_degrees(),
        **_connected(darts),
        **_discovered(known),
    }


def _doors() -> dict[str, Term]:
    rows = [eq(t.succ(door(n)), door(n + 1)) for n in range(DOORS)]
    return {"door-0": eq(t.k0, door(0)), "doors": conj(*rows)}


def _degrees() -> dict[str, Term]:
    def is_degree(n: int) -> Term:
        sooner = [differ(t.rot(t.a, door(k)), t.a) for k in range(1, n)]
        return conj(eq(t.rot(t.a, door(n)), t.a), *sooner)

    rows = [
        forall(t.a, eq(eq(t.deg(t.a), element("G", n - 1)), is_degree(n)))
        for n in range(1, MOST_DEGREE + 1)
    ]
    return {"degrees": conj(*rows)}


def _connected(darts: int) -> dict[str, Term]:
    """Every dart is reached from the root in fewer turns and crossings than there are darts."""
    reached = [Symbol(f"reached{n}", ("W",), BOOL) for n in range(darts)]
    a = t.a
    rows = [forall(a, eq(reached[0](a), eq(a, t.root)))]
    for before, after in pairwise(reached):
        ways = disj(before(a), before(t.alpha(a)), before(t.sigma(a)))
        rows.append(forall(a, eq(after(a), ways)))
    return {"connected": conj(*rows, forall(a, reached[-1](a)))}


def _discovered(known: int) -> dict[str, Term]:
    """S consists of v0 and of vertices entered by their first dart from one found before."""
    found = [Symbol(f"found{n}", ("M",), BOOL) for n in range(known)]
    x = t.x
    entered = [forall(x, eq(found[0](x), t.minv0(x)))]
    for before, after in pairwise(found):
        ways = disj(before(x), conj(t.explored(mfirst(x)), before(t.malpha(mfirst(x)))))
        entered.append(forall(x, eq(after(x), ways)))
    return {
        "unexplored-ends-itself": forall(x, neg(t.explored(x)), eq(t.malpha(x), x)),
        "first-of-vertex": forall(x, eq(mfirst(t.msigma(x)), mfirst(x))),
        "first-is-there": forall(x, eq(t.mrot(x, mtofirst(x)), mfirst(x))),
        "first-of-v0": eq(mfirst(t.mroot), t.mroot),
        "discovered": conj(*entered, forall(x, found[-1](x))),
    }


# ---------------------------------------------------------------- looking for one


@dataclass(frozen=True, slots=True)
class Scene:
    """A decoded model: the world, S as darts of the world, and the constants of the mutant.

    Attributes:
        world: has the darts of the model.
        place: for each dart of S, the dart of the world that it is (phi).
        first: for each dart of S, the first dart of its vertex.
        explored: the explored darts of S.
        constants: by name, darts of S, darts of the world, or doors.
    """

    world: World
    place: tuple[int, ...]
    first: tuple[int, ...]
    explored: frozenset[int]
    constants: Mapping[str, int]


def find(
    given: Mapping[str, Term], budget: Budget, *, edges: int, known: int
) -> tuple[Scene | None, SolverAnswer, str]:
    """A scene of this size in which these formulas hold.

    Returns:
        The scene if the answer is `sat`, the answer, and Z3's reason if it is `unknown`.
    Raises:
        InternalError: the model is not a world.
    """
    sizes = {"W": 2 * edges, "M": known, "K": DOORS, "G": MOST_DEGREE}
    formulas = [*exact(2 * edges, known).values(), *given.values()]
    found = finite_models.model(formulas, sizes, budget)
    if found.structure is None:
        return None, found.answer, found.why
    return _decoded(found.structure, 2 * edges, known, given), "sat", ""


def question(given: Mapping[str, Term], *, edges: int, known: int) -> str:
    """The SMT-LIB script that asks for such a scene."""
    sizes = {"W": 2 * edges, "M": known, "K": DOORS, "G": MOST_DEGREE}
    return finite_models.grounded([*exact(2 * edges, known).values(), *given.values()], sizes)


def _decoded(structure: Structure, darts: int, known: int, given: Mapping[str, Term]) -> Scene:
    of = structure.functions
    names = {s.name for term in given.values() for s in _constants(term)}
    world = World(
        tuple(int(of["alpha"](d)) for d in range(darts)),
        tuple(int(of["sigma"](d)) for d in range(darts)),
        int(of["root"]()),
    )
    # Degrees are elements 0, 1, ... of the sort G, so element n - 1 stands for degree n.
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


def _constants(term: Term) -> Iterator[Symbol]:
    return (symbol for symbol in symbols(term) if not symbol.arguments and "!" not in symbol.name)
