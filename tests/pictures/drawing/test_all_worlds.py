"""Every world to 3 edges is drawn true; every one to 5, each family and 1,000 drawn ones nightly.

True means what `pictures.drawn` asserts: the order at every vertex, no foreign vertex touched, no
overlap, no crossing but the bridges.
"""

from __future__ import annotations

from random import Random

import pytest

from tests.helpers import worlds
from tests.marks import with_marks
from tests.pictures.drawing.pictures import drawn
from topo_verify.world import families
from topo_verify.world.resolve import resolve_world

pytestmark = pytest.mark.no_cover  # drawing is not trusted: it is left out of the measure

FAMILIES = (
    *("lattice(4,5)", "lattice(5,5,holes=0.3,seed=2)", "king(3,4)", "torus(3,4)", "torus(5,7)"),
    "king_torus(3,4)",
    *("triangular_torus(3,3)", "triangular_torus(4,5)", "hexagonal_torus(3,4)"),
    *("regular(10,3,seed=1)", "regular(12,4,seed=2)", "dense(9,0.5,seed=1)", "complete(5,seed=3)"),
    *("complete_bipartite(3,4,seed=1)", "random_tree(20,seed=1)", "random_planar(20,seed=5)"),
    *("random_genus(20,2,seed=1)", "path(1)", "path(2)", "path(30)", "cycle(1)", "cycle(2)"),
    *("cycle(12)", "star(1)", "star(30)", "wheel(3)", "wheel(12)", "prism(3)", "prism(9)"),
    *("tetrahedron()", "cube()", "octahedron()", "dodecahedron()", "icosahedron()"),
)

LARGE = (
    *("lattice(20,20)", "king(8,8)", "torus(15,20)", "triangular_torus(10,12)", "prism(150)"),
    *("hexagonal_torus(9,9)", "regular(50,3,seed=1)", "complete(9,seed=1)", "random_tree(300)"),
    *("random_planar(200,seed=1)", "random_genus(150,3,seed=1)", "path(300)", "cycle(300)"),
    *("star(100)", "wheel(299)", "complete_bipartite(6,8)", "dense(20,0.3)"),
)


@pytest.mark.parametrize(
    "edges", [0, 1, 2, *(pytest.param(edges, marks=pytest.mark.nightly) for edges in (4, 5))]
)
def test_every_world_of_a_size_is_drawn_true(edges: int) -> None:
    for world in worlds([edges]):
        drawn(world)


@pytest.mark.parametrize("part", range(5))
def test_every_world_of_three_edges_is_drawn_true(part: int) -> None:
    for world in list(worlds([3]))[part::5]:
        drawn(world)


def test_the_families_here_are_all_that_there_are() -> None:
    assert {name.split("(")[0] for name in FAMILIES} == families.FAMILIES.keys()


@pytest.mark.parametrize("name", with_marks(FAMILIES, long=["king_torus(3,4)"]))
def test_every_family_is_drawn_true(name: str) -> None:
    drawn(resolve_world(f"family:{name}"))


@pytest.mark.parametrize("genus", [0, 1, 2, 3])
def test_a_sample_of_each_genus_is_drawn_true(genus: int) -> None:
    for edges in (6, 8, 10):
        drawn(families.random_genus(edges, genus, seed=edges))


# ---------------------------------------------------------------- all of it, nightly


@pytest.mark.nightly
@pytest.mark.parametrize("name", LARGE)
def test_large_members_of_the_families_are_drawn_true(name: str) -> None:
    drawn(resolve_world(f"family:{name}"))


@pytest.mark.nightly
@pytest.mark.parametrize("genus", [0, 1, 2, 3])
def test_250_worlds_of_each_genus_are_drawn_true(genus: int) -> None:
    random = Random(100 + genus)
    for _ in range(250):
        drawn(families.random_genus(random.randint(6, 25), genus, seed=random.randrange(10**6)))
