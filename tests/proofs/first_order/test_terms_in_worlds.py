"""Axioms and obligations put to real worlds and maps: evaluated without a solver, they hold."""

from __future__ import annotations

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.helpers import any_world, path, worlds
from tests.proofs.first_order.conformance import binary, nullary, of_world, unary
from topo_verify import World
from topo_verify.proofs.first_order import theory as t
from topo_verify.proofs.first_order.obligations import Obligation
from topo_verify.proofs.first_order.terms import Function, Structure, implies, neg, symbols
from topo_verify.proofs.first_order.theorems import OBLIGATIONS
from topo_verify.proofs.first_order.theory import TRUE_RECORDS

THEMES = {
    "world": (*t.WORLD, *t.DOORS, "doors-wrap", "rot-injective", "rot-degree", "rot-marker"),
    "map": (*t.MAP, *t.MAP_DOORS, "map-sigma-onto", "map-doors-wrap"),
    "together": (*t.INVARIANT, "phi-rot"),
}


def model(world: World, known: frozenset[int], explored: frozenset[int]) -> Structure:
    """A world, and the map S that knows these vertices and these darts' edges, in their numbers."""
    assert world.root is not None
    darts = [d for d in range(len(world.alpha)) if world.vertex_of[d] in known]
    number = {dart: x for x, dart in enumerate(darts)}
    doors = max(world.degrees) + 1

    there = of_world(world)
    rot, degree, at_v0 = there["rot"], there["deg"], there["inv0"]

    def to_root(a: int) -> int:
        root = world.root or 0
        return (world.place_of[root] - world.place_of[a]) % degree(a) if at_v0(a) else 0

    functions: dict[str, Function] = {
        **there,
        "toroot": to_root,
        "plus": binary(lambda i, j: i + j),
        "msigma": unary(lambda x: number[world.sigma[darts[x]]]),
        "mback": unary(lambda x: number[int(rot(darts[x], -1))]),
        "malpha": unary(lambda x: number[world.alpha[darts[x]]] if darts[x] in explored else x),
        "mdeg": unary(lambda x: degree(darts[x])),
        "minv0": unary(lambda x: at_v0(darts[x])),
        "mrot": binary(lambda x, k: number[int(rot(darts[x], k))]),
        "mroot": nullary(number[world.root or 0]),
        "mtoroot": unary(lambda x: to_root(darts[x])),
        "explored": unary(lambda x: darts[x] in explored),
        "phi": unary(lambda x: darts[x]),
    }
    return Structure({"W": len(world.alpha), "M": len(darts), "K": doors}, functions)


def maps(world: World) -> st.SearchStrategy[Structure]:
    """A world with a map of it: v0 and some vertices, some of the edges between them."""
    vertices = st.sets(st.integers(0, len(world.vertices) - 1)).map(
        lambda some: frozenset({world.marker_vertex, *some})
    )

    def of(known: frozenset[int]) -> st.SearchStrategy[Structure]:
        inner = [
            edge for edge in world.edges if all(world.vertex_of[dart] in known for dart in edge)
        ]
        chosen = st.sets(st.sampled_from(inner)) if inner else st.just(set[tuple[int, int]]())
        return chosen.map(
            lambda edges: model(world, known, frozenset(d for edge in edges for d in edge))
        )

    return vertices.flatmap(of)


some_maps = any_world(max_edges=5).flatmap(maps)


@pytest.mark.parametrize("name", [name for names in THEMES.values() for name in names])
def test_every_axiom_holds_in_every_small_world_and_its_whole_map(name: str) -> None:
    for world in worlds(range(1, 4)):
        whole = model(world, frozenset(range(len(world.vertices))), frozenset(range(9)))
        assert whole.holds(t.AXIOMS[name]), world.id


@pytest.mark.long
@given(structure=some_maps)
def test_every_axiom_holds_on_every_map_of_a_world(structure: Structure) -> None:
    for names in THEMES.values():
        for name in names:
            assert structure.holds(t.AXIOMS[name]), name


ABOUT_MAPS = [
    obligation
    for obligation in OBLIGATIONS
    if obligation.name
    in {
        *("percept", "trace-init", "trace-step", "motion-keeps", "prefix-keeps", "history-keeps"),
        *("confirm-final", "confirm-back", "confirm-conclude", "posed", "new-is-new"),
        *("fold-conclude", "closed-turns", "closed-crosses", "retrace-back", "retrace-turned"),
    }
]


@pytest.mark.long
@given(structure=some_maps, draw=st.data())
def test_the_obligations_hold_of_any_places_and_doors(
    structure: Structure, draw: st.DataObject
) -> None:
    of = {
        name: draw.draw(st.integers(0, structure.sizes[sort] - 1), label=name)
        for name, sort in CONSTANTS.items()
    }
    functions = {**structure.functions, **{name: nullary(value) for name, value in of.items()}}
    here = Structure(structure.sizes, functions)
    for obligation in ABOUT_MAPS:
        given_ = tuple(obligation.given.values())
        statement = implies(*given_, obligation.goal) if given_ else obligation.goal
        assert here.holds(statement), obligation.name


CONSTANTS = {
    name: sort
    for sort, names in {"W": "a1 b1", "M": "x1 y1 e h", "K": "d1 j1 k1 own1"}.items()
    for name in names.split()
}


@pytest.mark.parametrize("obligation", ABOUT_MAPS, ids=lambda one: one.name)
def test_what_they_assume_does_happen(obligation: Obligation) -> None:
    """Else the property above would hold of nothing."""
    found = path(3, marker=0)
    for known, explored in (
        ((0,), ()),
        ((0, 1), (0, 1)),
        ((0, 1, 2), (0, 1)),
        ((0, 1, 2), range(4)),
    ):
        structure = model(found, frozenset(known), frozenset(explored))
        if _some_places(structure, obligation):
            return
    pytest.fail("never assumed")


def _some_places(structure: Structure, obligation: Obligation) -> bool:
    ranges = [range(structure.sizes[sort]) for sort in CONSTANTS.values()]
    given_ = obligation.given.values()
    used = {symbol.name for term in given_ for symbol in symbols(term)}
    rows = [
        span if name in used else range(1) for name, span in zip(CONSTANTS, ranges, strict=True)
    ]
    for row in product(*rows):
        values = {n: nullary(v) for n, v in zip(CONSTANTS, row, strict=True)}
        here = Structure(structure.sizes, {**structure.functions, **values})
        if all(here.holds(g) for g in obligation.given.values()):
            return True
    return False


def test_a_broken_world_breaks_an_axiom() -> None:
    world = World.from_id("m3/30")
    structure = model(world, frozenset(range(len(world.vertices))), frozenset())
    bent = {**structure.functions, "alpha": unary(lambda a: a)}
    assert not Structure(structure.sizes, bent).holds(t.AXIOMS["alpha-no-fixed-point"])
    assert structure.holds(t.AXIOMS["alpha-no-fixed-point"])
    assert not structure.holds(neg(t.AXIOMS["phi-injective"]))


def test_records_have_their_own_axioms() -> None:
    assert not TRUE_RECORDS.keys() & t.AXIOMS.keys()


@pytest.mark.long
@given(structure=some_maps, word=st.lists(st.integers(0, 5), max_size=4), draw=st.data())
def test_what_inductions_over_words_say_holds_of_any_word(
    structure: Structure, word: list[int], draw: st.DataObject
) -> None:
    here = with_words(structure, [word, word[1:]])
    by_name = {obligation.name: obligation for obligation in OBLIGATIONS}
    for name in ("word-trace-step", "word-confirm-step"):
        assert here.holds(by_name[name].given["for-the-rest"]), name
    assert here.holds(by_name["word-trace-base"].goal)
    x = draw.draw(st.integers(0, structure.sizes["M"] - 1))
    ends = here.functions["stays"](x, 0), here.functions["walk"](here.functions["phi"](x), 0)
    assert not ends[0] or here.functions["phi"](here.functions["mwalk"](x, 0)) == ends[1]


def with_words(structure: Structure, words: list[list[int]]) -> Structure:
    """The structure with words: number n stands for words[n], the last number for no doors."""
    of = structure.functions
    rows = [*words, []]

    def walk(a: int, n: int) -> int:
        for door in rows[n]:
            a = int(of["alpha"](of["rot"](a, door)))
        return a

    def mwalk(x: int, n: int) -> int:
        for door in rows[n]:
            x = int(of["malpha"](of["mrot"](x, door)))
        return x

    def stays(x: int, n: int) -> bool:
        for door in rows[n]:
            exit_dart = of["mrot"](x, door)
            if not of["explored"](exit_dart):
                return False
            x = int(of["malpha"](exit_dart))
        return True

    more: dict[str, Function] = {
        "walk": binary(walk),
        "mwalk": binary(mwalk),
        "stays": binary(stays),
        "nil": nullary(len(words)),
        "w1": nullary(0),
    }
    return Structure({**structure.sizes, "L": len(rows)}, {**of, **more})
