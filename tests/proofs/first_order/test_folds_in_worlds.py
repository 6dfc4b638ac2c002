"""The axioms on folding put to real walks and to the checkers' own fold of them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.helpers import any_world, trace_of, worlds
from tests.proofs.first_order.conformance import binary, of_world, unary
from topo_verify import World
from topo_verify.checkers import Fold
from topo_verify.proofs.first_order.obligations.growth import CLOSED, FITS, PI_ROT, pi, same
from topo_verify.proofs.first_order.terms import Function, Structure, Var, eq, forall, implies
from topo_verify.proofs.first_order.theory import AXIOMS
from topo_verify.robot.events import Move
from topo_verify.robot.simulator import SimulatedRobot, exit_dart, first_percept

Place = tuple[int, int]


def folded(world: World, doors: list[int]) -> tuple[Structure, Fold]:
    """A walk in a world, as a structure: its places, what they are, and what the fold says."""
    robot, percepts = SimulatedRobot(world, len(doors)), [first_percept(world)]
    fold, arrivals = Fold(percepts[0]), [world.root or 0]
    at = [fold.at]  # of each visit: the fold adds no node for a place that it knows
    joined: set[tuple[Place, Place]] = set()
    for visit, door in enumerate(doors):
        taken = door % percepts[-1].degree
        arrivals.append(world.alpha[exit_dart(world, arrivals[-1], taken)])
        percepts.append(robot.move(taken))
        fold.move(taken, percepts[-1])
        at.append(fold.at)
        joined |= {((visit, taken), (visit + 1, 0)), ((visit + 1, 0), (visit, taken))}
    places = [(v, d) for v, percept in enumerate(percepts) for d in range(percept.degree)]
    number = {place: p for p, place in enumerate(places)}
    found = [fold.find((at[v][0], at[v][1] + d)) for v, d in places]
    edges = {(number[one], number[other]) for one, other in joined}

    def degree(p: int) -> int:
        return percepts[places[p][0]].degree

    def turned(p: int, door: int) -> int:
        visit, dart = places[p]
        return number[visit, (dart + door) % degree(p)]

    def to_root(p: int) -> int:
        visit, dart = places[p]
        marker = percepts[visit].marker
        return 0 if marker is None else (marker - dart) % degree(p)

    def dart(p: int) -> int:
        visit, door = places[p]
        return exit_dart(world, arrivals[visit], door)

    def beyond(p: int) -> int:
        ends = [q for r, q in edges if found[r] == found[p]]
        return ends[0] if ends else p

    def are_joined(p: int, q: int) -> bool:
        """What folding knows: the two are ends of an edge, as they are or as what they are same."""
        return any(found[r] == found[p] and found[s] == found[q] for r, s in edges)

    functions: dict[str, Function] = {
        **of_world(world),
        "pturn": unary(lambda p: turned(p, 1)),
        "prot": binary(turned),
        "pdeg": unary(degree),
        "pinv0": unary(lambda p: percepts[places[p][0]].marker is not None),
        "ppoints": unary(lambda p: percepts[places[p][0]].marker == places[p][1]),
        "ptoroot": unary(to_root),
        "pacross": unary(beyond),
        "joined": binary(are_joined),
        "same": binary(lambda p, q: found[p] == found[q]),
        "pi": unary(dart),
    }
    doors_there = max(world.degrees) + 1
    sizes = {"W": len(world.alpha), "P": len(places), "K": doors_there}
    return Structure(sizes, functions), fold


p, q = Var("p", "P"), Var("q", "P")


@pytest.mark.long
@given(world=any_world(max_edges=4), doors=st.lists(st.integers(0, 7), max_size=4))
def test_a_world_fits_its_own_walk_and_folds_identify_only_what_is_one_dart(
    world: World, doors: list[int]
) -> None:
    structure, _ = folded(world, doors)
    for name, axiom in {**FITS, **PI_ROT, "doors-wrap": AXIOMS["doors-wrap"]}.items():
        assert structure.holds(axiom), name
    assert structure.holds(forall((p, q), implies(same(p, q), eq(pi(p), pi(q)))))


def test_a_closed_fold_is_what_the_theory_calls_closed_and_is_the_world() -> None:
    closed = 0
    for world in worlds([2]):
        trace = trace_of(world, "basic")
        structure, fold = folded(world, [move.door for move in trace if isinstance(move, Move)])
        assert fold.open_darts() == 0
        for name, axiom in CLOSED.items():
            if name != "edges-folded":  # P to the fourth: too long to be written out
                assert structure.holds(axiom), (world.id, name)
        assert structure.holds(forall((p, q), eq(same(p, q), eq(pi(p), pi(q)))))
        met = {structure.functions["pi"](place) for place in range(structure.sizes["P"])}
        assert met == set(range(len(world.alpha)))
        closed += 1
    assert closed == 10


def test_an_open_fold_is_not_closed() -> None:
    structure, fold = folded(World.from_id("m2/0"), [0])
    assert fold.open_darts()
    assert not structure.holds(CLOSED["no-place-open"])
