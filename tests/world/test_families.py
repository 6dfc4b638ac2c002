"""Families of worlds: their shape, their holes, their names, what they refuse."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import accumulate, combinations, product
from math import atan2, pi
from random import Random
from typing import Any, cast

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from tests.python import python
from topo_verify.errors import InputError
from topo_verify.world import World, families
from topo_verify.world.enumeration import rank_order
from topo_verify.world.families import MAX_DARTS, random_maps
from topo_verify.world.resolve import resolve_world

EXAMPLES = [
    *("lattice(1,1)", "lattice(2,3,marker=0)", "lattice(10,10,holes=0.2,seed=7)"),
    *("king(5,4,holes=0.3,seed=1)", "king_torus(3,4)", "king_torus(4,4,holes=0.2,seed=3,marker=1)"),
    *("torus(3,4)", "torus(1,2,marker=5)", "regular(20,3,holes=0.1,seed=2)", "regular(8,6)"),
    *("dense(12,0.4,seed=3)", "dense(6,1.0)", "complete(5,seed=4,marker=0)"),
    *("complete_bipartite(3,4,seed=4)", "triangular_torus(3,4)", "hexagonal_torus(2,3,marker=7)"),
    *("random_tree(9,seed=1)", "random_planar(12,seed=2,marker=5)", "random_genus(12,3,seed=2)"),
    *("path(5)", "cycle(1,marker=1)", "star(4)", "wheel(5)", "prism(3)", "tetrahedron()"),
    *("cube(marker=3)", "octahedron()", "dodecahedron()", "icosahedron()"),
]


def joined(world: World) -> set[frozenset[int]]:
    """Which vertices are joined with which."""
    return {frozenset((world.vertex_of[a], world.vertex_of[b])) for a, b in world.edges}


# ---------------------------------------------------------------- names


@pytest.mark.parametrize("name", EXAMPLES)
def test_a_world_is_called_exactly_what_makes_it_again(name: str) -> None:
    world = resolve_world(f"family:{name}")
    assert world.name == name
    assert resolve_world(f"family:{world.name}").to_json() == world.to_json()


def test_there_is_an_example_of_every_family() -> None:
    assert {name.partition("(")[0] for name in EXAMPLES} == families.FAMILIES.keys()


def test_defaults_stay_out_of_the_name_and_numpys_numbers_are_plain_in_it() -> None:
    assert families.lattice(3, 3, holes=0, seed=0, marker=None).name == "lattice(3,3)"
    three, half, zero = cast("Any", (np.int64(3), np.float64(0.5), np.int8(0)))
    world = families.lattice(three, 3, holes=half, marker=zero)
    assert world.name == "lattice(3,3,holes=0.5,marker=0)"
    assert families.dense(3, 1).name == "dense(3,1.0)"


def test_names_are_promises_so_random_worlds_stay_what_they_are() -> None:
    """Pinned: a change of the drawing order would make old names mean other worlds."""
    assert families.lattice(3, 3, holes=0.2, seed=7).id == "m8/3904113"
    assert families.regular(6, 3, seed=7).id == "m9/67076271"
    assert families.dense(5, 0.6, seed=7).id == "m9/69188484"
    assert families.random_tree(8, seed=7).id == "m8/1945708"
    assert families.random_planar(8, seed=7).id == "m8/2052384"
    assert families.random_genus(8, 2, seed=7).id == "m8/15914165"


def test_hashing_does_not_change_what_is_drawn() -> None:
    code = (
        "from topo_verify.world import families as f;"
        "print(f.regular(30, 5, holes=0.2, seed=1).to_json(), f.dense(20, 0.3).to_json())"
    )
    runs = [python("-c", code, environment={"PYTHONHASHSEED": seed}) for seed in ("0", "1")]
    assert runs[0].stdout == runs[1].stdout != ""


# ---------------------------------------------------------------- lattices


@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (1, 5), (5, 1), (2, 2), (4, 7)])
def test_a_lattice_is_the_planar_grid(rows: int, columns: int) -> None:
    world = families.lattice(rows, columns)
    nodes = [(row, column) for row in range(rows) for column in range(columns)]
    assert joined(world) == {
        frozenset((a, b))
        for a, (row, column) in enumerate(nodes)
        for b, (other_row, other_column) in enumerate(nodes)
        if abs(row - other_row) + abs(column - other_column) == 1
    }
    assert world.is_simple
    assert world.is_planar
    assert len(world.faces) == (rows - 1) * (columns - 1) + 1


def test_a_king_moves_to_eight_neighbours_and_the_map_is_not_planar() -> None:
    world = families.king(4, 4)
    assert (len(world.vertices), len(world.edges)) == (16, 42)
    assert sorted(set(world.degrees)) == [3, 5, 8]
    assert world.is_simple
    assert world.genus == 9


@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (1, 3), (2, 2), (3, 3), (3, 5)])
def test_a_king_on_a_torus_has_eight_exits_everywhere(rows: int, columns: int) -> None:
    world = families.king_torus(rows, columns)
    assert set(world.degrees) == {8}
    assert (len(world.vertices), len(world.edges)) == (rows * columns, 4 * rows * columns)
    assert world.is_simple == (rows > 2 and columns > 2)
    assert not world.positions
    assert joined(world) == {
        frozenset(
            (row * columns + column, (row + down) % rows * columns + (column + right) % columns)
        )
        for row in range(rows)
        for column in range(columns)
        for down, right in ((-1, 0), (-1, 1), (0, 1), (1, 1))  # the others are their opposites
    }


def test_the_seed_of_a_king_torus_draws_its_holes_and_its_marker() -> None:
    worlds = [families.king_torus(5, 5, holes=0.2, seed=seed) for seed in range(4)]
    assert {len(world.vertices) for world in worlds} == {20}
    assert len({world.code for world in worlds}) == 4
    assert len({families.king_torus(5, 5, seed=seed).marker for seed in range(9)}) > 1


@pytest.mark.parametrize("make", [families.lattice, families.king])
@given(holes=st.floats(0, 0.6), seed=st.integers(0, 99))
def test_exits_are_clockwise_in_the_drawing(
    make: Callable[..., World], holes: float, seed: int
) -> None:
    world = make(4, 5, holes=holes, seed=seed)
    for vertex, rotation in enumerate(world.vertices):
        x, y = world.positions[vertex]
        others = [world.positions[world.vertex_of[world.alpha[dart]]] for dart in rotation]
        bearings = [(pi / 2 - atan2(v - y, u - x)) % (2 * pi) for u, v in others]
        assert bearings == sorted(bearings)  # from the north, clockwise


@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (1, 2), (2, 1), (2, 2), (1, 4), (3, 5)])
def test_a_torus_has_genus_1_and_four_exits_everywhere(rows: int, columns: int) -> None:
    world = families.torus(rows, columns)
    assert world.genus == 1
    assert set(world.degrees) == {4}
    assert len(world.vertices) == len(world.faces) == rows * columns
    assert world.is_loopless == (rows > 1 and columns > 1)
    assert world.is_simple == (rows > 2 and columns > 2)
    assert all(len(face) == 4 for face in world.faces)
    assert world.root == 0


# ---------------------------------------------------------------- random graphs


@pytest.mark.parametrize(("nodes", "degree"), [(2, 1), (5, 2), (6, 3), (6, 5), (9, 6), (50, 3)])
@pytest.mark.parametrize("seed", range(5))
def test_a_regular_world_has_the_same_degree_everywhere(nodes: int, degree: int, seed: int) -> None:
    world = families.regular(nodes, degree, seed=seed)
    assert set(world.degrees) == {degree}
    assert world.is_simple
    assert len(world.vertices) <= nodes  # a regular graph may come out in parts


def test_regular_graphs_that_get_stuck_begin_again() -> None:
    """With 2 exits at each of 5 nodes, the pairing often ends with both free ends at one node."""
    assert all(families.regular(5, 2, seed=seed).degrees == (2,) * 5 for seed in range(50))


def test_every_two_vertices_of_a_complete_world_are_joined() -> None:
    assert joined(families.complete(6)) == {frozenset(p) for p in combinations(range(6), 2)}
    assert families.complete(6).is_simple
    assert families.complete(1).id == "m0/0"


def test_a_dense_world_lies_between_one_vertex_and_a_complete_world() -> None:
    assert families.dense(9, 0).id == "m0/0"
    assert len(families.dense(9, 1).edges) == 36
    assert 0 < len(families.dense(9, 0.5).edges) < 36
    assert families.dense(9, 0.5).is_simple


def test_rotations_are_drawn() -> None:
    assert len({families.complete(4, seed=seed, marker=0).genus for seed in range(60)}) == 2
    assert families.complete(5, seed=1) != families.complete(5, seed=2)


# ---------------------------------------------------------------- holes


@given(
    rows=st.integers(1, 8),
    columns=st.integers(1, 8),
    holes=st.floats(0, 0.95),
    seed=st.integers(0, 99),
)
def test_what_is_left_among_holes_is_one_connected_piece_of_the_grid(
    rows: int, columns: int, holes: float, seed: int
) -> None:
    left = rows * columns - round(holes * rows * columns)
    assume(left)
    world = families.lattice(rows, columns, holes=holes, seed=seed)
    assert 1 <= len(world.vertices) <= left
    assert world.is_planar
    assert len(set(world.positions)) == len(world.positions) == len(world.vertices)


def test_as_many_nodes_are_taken_out_as_asked_for() -> None:
    assert len(families.complete(10).vertices) == 10
    assert len(families.regular(10, 9, holes=0.25).vertices) == 8  # round(2.5) is 2


def test_the_largest_piece_is_kept_and_of_equal_ones_the_first() -> None:
    """A row of five without one node: with the middle one gone, two pieces of two are left."""
    pieces = {
        tuple(x for x, _ in families.lattice(1, 5, holes=0.2, seed=seed).positions)
        for seed in range(40)
    }
    assert pieces == {(1, 2, 3, 4), (2, 3, 4), (0, 1), (0, 1, 2), (0, 1, 2, 3)}


# ---------------------------------------------------------------- the marker


@pytest.mark.parametrize(
    "name",
    [
        *("lattice(4,4,holes=0.1", "regular(8,3", "dense(8,0.5", "complete(4"),
        *("random_tree(9", "random_planar(9", "random_genus(9,2"),
    ],
)
def test_a_marker_that_is_named_changes_nothing_else(name: str) -> None:
    drawn = resolve_world(f"family:{name},seed=3)")
    named = resolve_world(f"family:{name},seed=3,marker=2)")
    assert named == drawn.with_marker(2)


def test_the_marker_is_drawn_over_all_places() -> None:
    assert {families.lattice(2, 2, seed=seed).root for seed in range(60)} == set(range(8))


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


@pytest.mark.parametrize("size", [(1, 1), (1, 2), (2, 2), (2, 3), (3, 3)])
def test_the_honeycomb_is_the_dual_of_the_triangles(size: tuple[int, int]) -> None:
    honeycomb = families.hexagonal_torus(*size)
    dual = World.from_rotations(honeycomb.faces, honeycomb.edges, 0)
    codes = {dual.with_marker(dart).code for dart in range(2 * len(dual.edges))}
    triangles = families.triangular_torus(*size)
    assert triangles.code in codes
    assert triangles.is_simple == (min(size) > 2)
    assert honeycomb.is_simple == (min(size) > 1)


# ---------------------------------------------------------------- random maps


def words(edges: int) -> Iterator[list[int]]:
    """Every plane tree as its ups and downs."""
    for word in product((1, -1), repeat=2 * edges):
        heights = list(accumulate(word))
        if heights[-1] == 0 and min(heights) >= 0:
            yield list(word)


def one_face_walks(edges: int, genus: int) -> Counter[tuple[int, ...]]:
    """The maps with one face that vertices of others are glued to, and in how many ways."""
    if genus == 0:
        around = random_maps._walk  # pyright: ignore[reportPrivateUsage]
        return Counter(tuple(around(word)) for word in words(edges))
    glued: Counter[tuple[int, ...]] = Counter()
    for p in range(1, genus + 1):
        for walk in one_face_walks(edges, genus - p):
            corner = {dart: place for place, dart in reversed([*enumerate(walk)])}
            vertices = map_of_one_face(walk).vertices
            first = sorted(min(corner[dart] for dart in vertex) for vertex in vertices)
            for chosen in combinations(first, 2 * p + 1):
                glued[numbered(random_maps.glued(list(walk), list(chosen)))] += 1
    return glued


def numbered(walk: list[int]) -> tuple[int, ...]:
    """The walk with its edges in the order in which it meets them."""
    number: dict[int, int] = {}
    for dart in walk:
        if dart not in number:
            number |= {dart: len(number), dart ^ 1: len(number) + 1}
    return tuple(number[dart] for dart in walk)


def map_of_one_face(walk: tuple[int, ...]) -> World:
    sigma = [0] * len(walk)
    for place, dart in enumerate(walk):
        sigma[walk[place - 1] ^ 1] = dart
    return World(tuple(dart ^ 1 for dart in range(len(walk))), tuple(sigma), walk[0])


@pytest.mark.parametrize(
    ("edges", "genus"),
    [(2, 1), (4, 1), (4, 2), (5, 2), pytest.param(6, 3, marks=pytest.mark.no_cover)],
)
def test_every_map_with_one_face_is_glued_in_as_many_ways_as_twice_its_genus(
    edges: int, genus: int
) -> None:
    """So a uniform choice of the vertices to glue makes a uniform map with one face."""
    ways = one_face_walks(edges, genus)
    assert len(ways) == random_maps.one_face_maps(edges, genus)
    assert set(ways.values()) == {2 * genus}
    assert {(w.genus, len(w.faces)) for w in map(map_of_one_face, ways)} == {(genus, 1)}


@pytest.mark.parametrize(
    ("edges", "genus"), [(1, 0), (2, 0), (3, 0), (2, 1), (3, 1), (4, 1), (4, 2)]
)
def test_every_map_of_a_genus_comes_from_equally_many_maps_with_one_face_and_steps(
    edges: int, genus: int
) -> None:
    """So a uniform map with one face, uniform steps that close and a coin make a uniform map."""
    alpha = tuple(dart ^ 1 for dart in range(2 * edges))
    labelled = [
        random_maps.labelled_map(walk, steps, coin=coin)
        for walk in one_face_walks(edges, genus)
        for steps in product((-1, 0, 1), repeat=edges)
        for coin in (0, 1)
    ]
    made = Counter(World(alpha, tuple(made[0]), made[1]).code for made in labelled if made)
    worlds = {w.code for w in map(World.from_code, rank_order.tables(edges)) if w.genus == genus}
    assert made.keys() == worlds
    assert set(made.values()) == {edges + 2 - 2 * genus}
    assert Fraction(len(labelled), edges + 2 - 2 * genus) == random_maps.draws(edges, genus)


def test_trees_are_drawn_with_equal_chances() -> None:
    """14 rooted plane trees with 4 edges, 200 draws expected of each."""
    drawn = Counter(families.random_tree(4, seed=seed).code for seed in range(2800))
    assert len(drawn) == 14
    assert all(150 < number < 250 for number in drawn.values())


@pytest.mark.no_cover
def test_worlds_of_genus_1_are_drawn_with_equal_chances() -> None:
    """20 of them with 3 edges, 200 draws expected of each; about one draw in nine closes."""
    random = Random(1)
    worlds = [random_maps.drawn(3, 1, random) for _ in range(36_000)]
    drawn = Counter(world.code for world in worlds if world is not None)
    assert len(drawn) == 20
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


# ---------------------------------------------------------------- what they refuse


REFUSED: list[tuple[str, dict[str, object], str]] = [
    ("king", {"rows": True, "columns": 2}, "king: rows is True"),
    ("torus", {"rows": "3", "columns": 3}, "torus: rows is '3'"),
    ("lattice", {"rows": 3, "columns": 3, "holes": float("nan")}, "holes is nan"),
    ("lattice", {"rows": 3, "columns": 3, "holes": "0.1"}, "holes is '0.1'"),
    ("lattice", {"rows": 3, "columns": 3, "seed": None}, "seed is None"),
    ("dense", {"nodes": 5, "probability": 10**400}, "dense: probability is 1000"),
]
"""What no text says."""


@pytest.mark.parametrize(("family", "arguments", "sentence"), REFUSED)
def test_arguments_of_other_types_are_refused_and_named(
    family: str, arguments: dict[str, object], sentence: str
) -> None:
    with pytest.raises(InputError, match=sentence):
        families.FAMILIES[family](**arguments)


def test_thousands_of_vertices_need_no_recursion() -> None:
    assert families.lattice(1, 5000).degrees.count(2) == 4998
    assert families.random_planar(5000, seed=1).is_planar


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
