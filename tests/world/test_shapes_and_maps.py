"""Shapes, solids, the other tori and random maps: genus, faces, degrees, how likely each map is."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from itertools import accumulate, product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from topo_verify.errors import InputError
from topo_verify.world import World, families
from topo_verify.world.enumeration import rank_order
from topo_verify.world.families import MAX_DARTS, random_maps
from topo_verify.world.resolve import resolve_world

# ---------------------------------------------------------------- what each one is


@pytest.mark.parametrize(
    ("name", "vertices", "edges", "genus", "degrees", "faces"),
    [
        ("path(1)", 1, 0, 0, {0}, {0}),
        ("path(2)", 2, 1, 0, {1}, {2}),
        ("path(6)", 6, 5, 0, {1, 2}, {10}),
        ("cycle(1)", 1, 1, 0, {2}, {1}),
        ("cycle(2)", 2, 2, 0, {2}, {2}),
        ("cycle(7)", 7, 7, 0, {2}, {7}),
        ("star(1)", 2, 1, 0, {1}, {2}),
        ("star(5)", 6, 5, 0, {1, 5}, {10}),
        ("wheel(3)", 4, 6, 0, {3}, {3}),
        ("wheel(6)", 7, 12, 0, {3, 6}, {3, 6}),
        ("prism(3)", 6, 9, 0, {3}, {3, 4}),
        ("prism(5)", 10, 15, 0, {3}, {4, 5}),
        ("tetrahedron()", 4, 6, 0, {3}, {3}),
        ("cube()", 8, 12, 0, {3}, {4}),
        ("octahedron()", 6, 12, 0, {4}, {3}),
        ("dodecahedron()", 20, 30, 0, {3}, {5}),
        ("icosahedron()", 12, 30, 0, {5}, {3}),
        ("triangular_torus(1,1)", 1, 3, 1, {6}, {3}),
        ("triangular_torus(2,3)", 6, 18, 1, {6}, {3}),
        ("triangular_torus(3,4)", 12, 36, 1, {6}, {3}),
        ("hexagonal_torus(1,1)", 2, 3, 1, {3}, {6}),
        ("hexagonal_torus(2,2)", 8, 12, 1, {3}, {6}),
        ("hexagonal_torus(3,4)", 24, 36, 1, {3}, {6}),
        ("complete_bipartite(2,3,seed=2)", 5, 6, 0, {2, 3}, {4}),
        ("complete_bipartite(3,3)", 6, 9, 2, {3}, {18}),
    ],
)
def test_a_family_has_its_size_its_genus_its_degrees_and_its_faces(
    name: str, vertices: int, edges: int, genus: int, degrees: set[int], faces: set[int]
) -> None:
    world = resolve_world(f"family:{name}")
    assert (len(world.vertices), len(world.edges), world.genus) == (vertices, edges, genus)
    assert set(world.degrees) == degrees
    assert set(map(len, world.faces)) == faces
    assert world.root == (0 if edges else None) or name.startswith("complete")


@pytest.mark.parametrize(
    ("name", "id"), [("path(3)", "m2/0"), ("cycle(1)", "m1/1"), ("star(1)", "m1/0")]
)
def test_a_small_one_is_pinned(name: str, id: str) -> None:  # noqa: A002  the id of the world
    assert resolve_world(f"family:{name}").id == id


@pytest.mark.parametrize("name", ["tetrahedron", "cube", "octahedron", "dodecahedron"])
def test_in_a_solid_all_darts_look_alike_and_so_does_the_mirror_image(name: str) -> None:
    world = families.FAMILIES[name]()
    darts = range(2 * len(world.edges))
    assert {families.FAMILIES[name](marker=dart).code for dart in darts} == {world.code}
    assert world.mirror().code == world.code


@pytest.mark.parametrize("size", [(1, 1), (2, 3), (3, 3)])
def test_the_honeycomb_is_the_dual_of_the_triangles(size: tuple[int, int]) -> None:
    honeycomb = families.hexagonal_torus(*size)
    dual = World.from_rotations(honeycomb.faces, honeycomb.edges, 0)
    codes = {dual.with_marker(dart).code for dart in range(2 * len(dual.edges))}
    assert families.triangular_torus(*size).code in codes


def test_the_tori_are_simple_from_some_size_on() -> None:
    assert families.triangular_torus(3, 3).is_simple
    assert not families.triangular_torus(2, 3).is_simple
    assert families.hexagonal_torus(2, 2).is_simple
    assert not families.hexagonal_torus(1, 2).is_simple


# ---------------------------------------------------------------- random maps


def words(edges: int) -> Iterator[list[int]]:
    """Every plane tree as its ups and downs."""
    for word in product((1, -1), repeat=2 * edges):
        heights = list(accumulate(word))
        if heights[-1] == 0 and min(heights) >= 0:
            yield list(word)


@pytest.mark.parametrize("edges", [1, 2, 3])
def test_every_planar_map_comes_from_equally_many_trees_with_steps(edges: int) -> None:
    """So a uniform tree, uniform steps and a coin make a uniform planar map."""
    alpha = tuple(dart ^ 1 for dart in range(2 * edges))
    made = Counter(
        World(alpha, tuple(sigma), root).code
        for word in words(edges)
        for steps in product((-1, 0, 1), repeat=edges)
        for coin in (0, 1)
        for sigma, root in [random_maps.planar_map(word, steps, coin=coin)]
    )
    planar = {w.code for w in map(World.from_code, rank_order.tables(edges)) if w.is_planar}
    assert made.keys() == planar
    assert set(made.values()) == {edges + 2}


def test_trees_are_drawn_with_equal_chances() -> None:
    """14 rooted plane trees with 4 edges, 200 draws expected of each."""
    drawn = Counter(families.random_tree(4, seed=seed).code for seed in range(2800))
    assert len(drawn) == 14
    assert all(150 < number < 250 for number in drawn.values())


@given(edges=st.integers(0, 40), seed=st.integers(0, 99))
def test_a_random_tree_is_a_tree_and_a_random_planar_map_is_planar(edges: int, seed: int) -> None:
    tree = families.random_tree(edges, seed=seed)
    assert len(tree.vertices) == edges + 1
    assert len(tree.edges) == edges
    planar = families.random_planar(edges, seed=seed)
    assert (len(planar.edges), planar.genus) == (edges, 0)


@given(data=st.data(), genus=st.integers(0, 6), seed=st.integers(0, 99))
def test_a_random_map_has_the_genus_that_was_asked_for(
    data: st.DataObject, genus: int, seed: int
) -> None:
    edges = data.draw(st.integers(2 * genus, 2 * genus + 20))
    world = families.random_genus(edges, genus, seed=seed)
    assert (len(world.edges), world.genus) == (edges, genus)


@pytest.mark.parametrize(("edges", "genus", "total"), [(2, 0, 9), (2, 1, 1), (3, 1, 20)])
def test_every_map_of_a_genus_can_come_out(edges: int, genus: int, total: int) -> None:
    drawn = {families.random_genus(edges, genus, seed=seed).code for seed in range(900)}
    assert len(drawn) == total


def test_names_of_random_maps_are_promises_too() -> None:
    assert families.random_tree(8, seed=7).id == "m8/1945708"
    assert families.random_planar(8, seed=7).id == "m8/2052384"
    assert families.random_genus(8, 2, seed=7).id == "m8/15914165"


@pytest.mark.parametrize("name", ["random_tree(9", "random_planar(9", "random_genus(9,2"])
def test_a_marker_that_is_named_changes_nothing_else_in_a_random_map(name: str) -> None:
    drawn = resolve_world(f"family:{name},seed=3)")
    assert resolve_world(f"family:{name},seed=3,marker=2)") == drawn.with_marker(2)


def test_a_large_planar_map_needs_no_recursion() -> None:
    assert families.random_planar(5000, seed=1).is_planar


# ---------------------------------------------------------------- what they refuse


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("lattice(0,3)", "lattice: rows is 0, expected an integer of 1 or more"),
        ("lattice(3,-1)", "lattice: columns is -1"),
        ("lattice(1e9,3)", "lattice: rows is 1000000000.0, expected an integer"),
        ("lattice(1e999,3)", "lattice: rows is inf"),
        ("lattice(3,3,holes=1)", "lattice: holes is 1, expected a number from 0 to below"),
        ("lattice(3,3,holes=-0.1)", "holes is -0.1"),
        ("lattice(3,3,seed=-1)", "seed is -1, expected an integer of 0 or more"),
        ("lattice(3,3,marker=-1)", "marker is -1"),
        ("lattice(3,3,marker=1.0)", "marker is 1.0"),
        ("lattice(3,3,marker=24)", r"lattice\(3,3,marker=24\): the marker points at dart 24"),
        ("lattice(1,1,marker=0)", r"lattice\(1,1,marker=0\): the marker points at dart 0"),
        ("lattice(1,1,holes=0.9)", r"lattice\(1,1,holes=0.9\): no node is left"),
        ("lattice(99999999999999999999,3)", "lattice: so large a world .* more than 1000000 darts"),
        ("king(2.0,2)", "king: rows is 2.0"),
        ("torus(3,0)", "torus: columns is 0"),
        ("torus(1000,251)", "torus: so large a world"),
        ("regular(4,0)", "regular: degree is 0"),
        ("regular(4,4)", "regular: nodes is 4, expected an integer of 5 or more"),
        ("regular(5,3)", "5 nodes of degree 3 have an odd number of darts"),
        ("regular(1000000000,2)", "regular: so large a world"),
        ("dense(0,0.5)", "dense: nodes is 0"),
        ("dense(5,1.5)", "dense: probability is 1.5, expected a number from 0 to 1"),
        ("dense(1002,0.1)", "dense: so large a world"),
        ("complete(0)", "complete: nodes is 0"),
        ("complete(1000000)", "complete: so large a world"),
        ("path(0)", "path: nodes is 0, expected an integer of 1 or more"),
        ("path(600000)", f"path: so large a world might have more than {MAX_DARTS} darts"),
        ("path(2.0)", "path: nodes is 2.0"),
        ("path(1,marker=0)", r"path\(1,marker=0\): the marker points at dart 0"),
        ("cycle(0)", "cycle: nodes is 0"),
        ("star(0)", "star: leaves is 0"),
        ("wheel(2)", "wheel: rim is 2, expected an integer of 3 or more"),
        ("prism(2)", "prism: sides is 2"),
        ("cube(marker=24)", r"cube\(marker=24\): the marker points at dart 24"),
        ("cube(3)", "too many positional arguments; the family is cube"),
        ("dodecahedron(marker=-1)", "dodecahedron: marker is -1"),
        ("triangular_torus(0,1)", "triangular_torus: rows is 0"),
        ("hexagonal_torus(1,0)", "hexagonal_torus: columns is 0"),
        ("hexagonal_torus(1000,1000)", "hexagonal_torus: so large a world"),
        ("complete_bipartite(0,2)", "complete_bipartite: left is 0"),
        ("complete_bipartite(2,0)", "complete_bipartite: right is 0"),
        ("complete_bipartite(1000,1000)", "complete_bipartite: so large a world"),
        ("random_tree(-1)", "random_tree: edges is -1"),
        ("random_tree(3,seed=-1)", "random_tree: seed is -1"),
        ("random_tree(3,marker=6)", r"random_tree\(3,marker=6\): the marker points at dart 6"),
        ("random_planar(1000000)", "random_planar: so large a world"),
        ("random_genus(3,2)", "random_genus: edges is 3, expected an integer of 4 or more"),
        ("random_genus(3,-1)", "random_genus: genus is -1"),
        ("random_genus(10001,1)", "random_genus: edges is 10001, expected 10000 at most"),
    ],
)
def test_arguments_out_of_range_are_refused_and_named(text: str, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        resolve_world(f"family:{text}")
