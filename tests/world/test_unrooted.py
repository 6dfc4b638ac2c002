"""Worlds without their marker: counted by a formula, by hand, and as published."""

from __future__ import annotations

from itertools import product

import pytest

import topo_verify as tv
from topo_verify import families
from topo_verify.errors import InputError
from topo_verify.world.enumeration.classes import WorldClass
from topo_verify.world.unrooted import (
    automorphisms,
    ranks,
    same_unrooted,
    unrooted_count,
    unrooted_id,
)


def test_the_formula_gives_the_published_numbers() -> None:
    """Unrooted maps on orientable surfaces of any genus, by edges: OEIS A170946."""
    counts = [unrooted_count(m, WorldClass()) for m in range(8)]
    assert counts == [1, 2, 5, 20, 107, 870, 9436, 122840]


@pytest.mark.parametrize("edges", [1, 2, 3, 4])
def test_the_formula_counts_the_worlds_that_differ_wherever_the_marker_lies(edges: int) -> None:
    groups = {
        frozenset(world.with_marker(dart).code for dart in range(2 * edges))
        for world in tv.worlds(edges)
    }
    assert unrooted_count(edges, WorldClass()) == len(groups)
    by_genus = [unrooted_count(edges, WorldClass.parse(f"genus:{g}")) for g in range(3)]
    assert sum(number or 0 for number in by_genus) == len(groups)


@pytest.mark.no_cover
def test_planar_worlds_are_counted_by_a_formula() -> None:
    """Unrooted planar maps: OEIS A006384; with 5 edges those of other genus are listed."""
    counts = [unrooted_count(m, WorldClass.parse("planar")) for m in range(11)]
    assert counts == [1, 2, 4, 14, 57, 312, 2071, 15030, 117735, 967850, 8268816]
    by_genus = [unrooted_count(5, WorldClass.parse(f"genus:{g}")) for g in range(3)]
    assert by_genus == [312, 452, 106]
    assert sum(filter(None, by_genus)) == unrooted_count(5, WorldClass())


@pytest.mark.no_cover
def test_worlds_of_other_classes_are_counted_from_their_list() -> None:
    """Unrooted maps on the torus: OEIS A006386."""
    counts = [unrooted_count(m, WorldClass.parse("genus:1")) for m in range(2, 7)]
    assert counts == [1, 6, 46, 452, 4852]


def test_the_automorphisms_of_the_platonic_solids_are_their_rotations() -> None:
    solids = [families.tetrahedron(), families.cube(), families.dodecahedron()]
    assert [automorphisms(world) for world in solids] == [12, 24, 60]
    assert automorphisms(tv.World((), (), None)) == 1
    for edges in (1, 2, 3, 4):  # the roots of a map are its darts up to automorphism
        sizes = [2 * edges // automorphisms(world) for world in tv.worlds(edges)]
        assert sum(1 / size for size in sizes) == pytest.approx(unrooted_count(edges, WorldClass()))


@pytest.mark.no_cover
def test_worlds_have_one_unrooted_id_iff_they_differ_in_the_marker_alone() -> None:
    ids = [f"m4/{rank}" for rank in ranks(4, WorldClass())]
    worlds = [*tv.worlds(4)]
    assert sorted({unrooted_id(world) for world in worlds}) == sorted(ids)
    for world in worlds[::50]:
        assert {unrooted_id(world.with_marker(dart)) for dart in range(8)} == {unrooted_id(world)}
    assert unrooted_id(tv.World((), (), None)) == "m0/0"


def test_worlds_are_the_same_unrooted_map_iff_their_unrooted_ids_are_equal() -> None:
    worlds = [*tv.worlds(3), *tv.worlds(1), tv.World((), (), None)]
    ids = [(world, unrooted_id(world)) for world in worlds]
    for (world, text), (other, other_text) in product(ids, repeat=2):
        assert same_unrooted(world, other) == (text == other_text)


@pytest.mark.no_cover
def test_large_worlds_without_their_marker_are_compared_but_have_no_id() -> None:
    world = families.random_planar(5000, seed=1)
    assert automorphisms(world) == 1
    assert same_unrooted(world, world.with_marker(4321).renumbered(range(9999, -1, -1)))
    assert not same_unrooted(world, world.mirror())
    with pytest.raises(InputError, match="a world with 5000 edges has no id"):
        unrooted_id(world)


@pytest.mark.parametrize(
    ("edges", "kind"), [(7, "genus:1"), (201, "any"), (60, "genus:1"), (17, "simple")]
)
def test_what_would_take_too_long_is_not_counted(edges: int, kind: str) -> None:
    assert unrooted_count(edges, WorldClass.parse(kind)) is None
