"""`World`: what it is made of, which world it is, and what it refuses to be."""

from __future__ import annotations

from base64 import b64encode
from pathlib import Path
from random import Random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.vendor.pretty import pretty

from tests.helpers import EMPTY
from tests.helpers import worlds as every_world
from topo_verify.errors import InputError
from topo_verify.world import World, families, io
from topo_verify.world.enumeration import rank_order

LOOP = World((1, 0), (1, 0), 0)
PARALLEL = World.from_rotations([[0, 2, 4], [5, 3, 1]], [[0, 1], [2, 3], [4, 5]], 0)
PATH = World.from_rotations([[0], [1, 2], [3]], [[0, 1], [2, 3]], 0)
"""Three vertices in a row, the marker at an end."""

ranks = st.integers(0, 12).flatmap(
    lambda edges: st.tuples(st.just(edges), st.integers(0, rank_order.count(edges) - 1))
)
worlds = ranks.map(lambda pair: World.from_code(rank_order.unrank(*pair)))


def shuffled(world: World, seed: int) -> World:
    """The same world with its darts called otherwise."""
    numbers = list(range(len(world.alpha)))
    Random(seed).shuffle(numbers)
    return world.renumbered(numbers)


# ---------------------------------------------------------------- what it is made of


def test_a_path_reads_as_it_was_written() -> None:
    assert PATH.vertices == ((0,), (1, 2), (3,))
    assert PATH.edges == ((0, 1), (2, 3))
    assert PATH.marker == 0
    assert PATH.marker_vertex == 0
    assert PATH.degrees == (1, 2, 1)
    assert PATH.vertex_of == (0, 1, 1, 2)
    assert PATH.place_of == (0, 0, 1, 0)
    assert PATH.faces == ((0, 2, 3, 1),)
    assert (PATH.cost_bound, LOOP.cost_bound) == (2 * (3 + 3 * 2 * 2), 1)


def test_the_world_without_a_dart_is_a_world() -> None:
    assert EMPTY.vertices == ((),)
    assert EMPTY.edges == ()
    assert EMPTY.faces == ((),)
    assert (EMPTY.root, EMPTY.marker_vertex, EMPTY.genus) == (None, 0, 0)
    assert EMPTY.code == ((0,), ())
    assert EMPTY.id == "m0/0"
    assert EMPTY.is_simple
    assert EMPTY.is_planar
    assert EMPTY.mirror() == EMPTY == EMPTY.renumbered([]) == World.from_id("m0/0")
    assert World.from_rotations([[]], [], None) == EMPTY
    assert EMPTY.vertex_of == EMPTY.place_of == ()


def test_loops_and_parallel_edges_are_allowed_and_seen() -> None:
    assert not LOOP.is_loopless
    assert not LOOP.is_simple
    assert PARALLEL.is_loopless
    assert not PARALLEL.is_simple
    assert PATH.is_simple
    assert LOOP.vertices == ((0, 1),)
    assert len(LOOP.faces) == 2


def test_vertices_keep_the_order_and_the_first_dart_that_they_were_given() -> None:
    world = World.from_rotations([[3], [2, 1], [0]], [[0, 1], [2, 3]], 3)
    assert world.vertices == ((3,), (2, 1), (0,))
    assert world.mirror().vertices == ((3,), (2, 1), (0,))
    assert world == PATH.with_marker(3)


def test_darts_may_be_any_integers_and_are_numbered_in_ascending_order() -> None:
    world = World.from_rotations([[70], [-5, 8], [9]], [[70, 8], [9, -5]], 70)
    assert world.vertices == ((3,), (0, 1), (2,))
    assert world.root == 3


def test_a_square_seen_from_above_has_its_exits_clockwise() -> None:
    """The convention itself: `lattice` numbers exits from the north, clockwise, y upwards."""
    square = families.lattice(2, 2, marker=0)
    assert square.positions == ((0.0, 1.0), (1.0, 1.0), (0.0, 0.0), (1.0, 0.0))
    (east, south), (south_again, west) = square.vertices[0], square.vertices[1]
    assert square.alpha[east] == west  # top left: first east, then, clockwise, south
    assert square.vertex_of[square.alpha[south]] == 2
    assert square.vertex_of[square.alpha[south_again]] == 3


# ---------------------------------------------------------------- surfaces


def test_eulers_formula_holds_in_every_world_up_to_four_edges() -> None:
    for world in every_world(range(5)):
        characteristic = len(world.vertices) - len(world.edges) + len(world.faces)
        assert characteristic == 2 - 2 * world.genus
        assert world.genus >= 0
        assert world.is_planar == (world.genus == 0)
        assert sorted(dart for face in world.faces for dart in face) == list(
            range(len(world.alpha))
        )


def test_the_smallest_nonplanar_world_is_two_loops_that_cross() -> None:
    assert [world.id for world in every_world(range(3)) if world.genus] == ["m2/8"]
    assert World.from_id("m2/8").code == ((4,), (2, 3, 0, 1))


# ---------------------------------------------------------------- which world it is


@given(world=worlds, seed=st.integers(0, 999))
def test_calling_the_darts_otherwise_changes_neither_code_nor_id(world: World, seed: int) -> None:
    other = shuffled(world, seed)
    assert other.code == world.code
    assert other.is_isomorphic(world)
    assert other.id == world.id
    assert (other.genus, sorted(other.degrees)) == (world.genus, sorted(world.degrees))


@given(world=worlds, seed=st.integers(0, 999))
def test_renumbering_keeps_the_order_of_the_vertices(world: World, seed: int) -> None:
    assert shuffled(world, seed).degrees == world.degrees


@given(world=worlds)
def test_the_mirror_image_of_the_mirror_image_is_the_world(world: World) -> None:
    assert world.mirror().mirror() == world
    assert world.mirror().genus == world.genus


def test_a_mirror_image_may_be_another_world() -> None:
    images = {world.id: world.mirror().id for world in every_world(range(3))}
    others = {name: image for name, image in images.items() if name != image}
    assert others == {"m2/4": "m2/5", "m2/5": "m2/4", "m2/7": "m2/9", "m2/9": "m2/7"}


def medial(world: World) -> World:
    """A vertex in the middle of each edge, an edge along each corner: the same for the dual."""
    rotations = [(2 * a + 1, 2 * b, 2 * b + 1, 2 * a) for a, b in world.edges]
    corners = [(2 * dart, 2 * after + 1) for dart, after in enumerate(world.sigma)]
    return World.from_rotations(rotations, corners, 0)


def without_marker(world: World) -> object:
    """A code of the map, whichever dart is marked."""
    return min(world.with_marker(dart).code for dart in range(len(world.alpha)))


@pytest.mark.no_cover
def test_a_map_and_its_dual_have_the_same_medial_map() -> None:
    images = [(world, world.mirror(), world.dual()) for world in every_world((1, 2, 4))]
    codes = [[without_marker(medial(world)) for world in row] for row in images]
    assert all(code == dual for code, _, dual in codes)
    assert any(code != mirrored for code, mirrored, _ in codes), "a mirrored dual is noticed"


def test_a_world_made_of_lists_is_the_world_made_of_tuples() -> None:
    swap: Any = [1, 0]
    world = World(swap, swap, 0)
    assert world == LOOP
    assert hash(world) == hash(LOOP)


def test_the_dual_leaves_the_face_on_the_left_of_each_dart() -> None:
    # a loop with a leaf outside: inside is one corner, outside three
    world = World.from_rotations([[0, 1, 2], [3]], [[0, 1], [2, 3]], 0)
    assert world.faces == ((0, 2, 3), (1,))
    assert world.dual().vertices == ((0, 3, 2), (1,))
    assert World.from_id("m4/4").dual().id == "m4/505"


@given(worlds)
def test_the_dual_of_the_dual_has_the_marker_at_the_other_end_of_its_edge(world: World) -> None:
    turned = world if world.root is None else world.with_marker(world.alpha[world.root])
    assert world.dual().dual().is_isomorphic(turned)
    assert (len(world.dual().vertices), world.dual().genus) == (len(world.faces), world.genus)


def test_a_mirror_image_is_drawn_as_in_a_mirror() -> None:
    world = families.lattice(1, 2, marker=0)
    assert world.mirror().positions == ((-0.0, 0.0), (-1.0, 0.0))
    assert world.mirror().mirror().positions == world.positions


def test_the_marker_makes_the_world() -> None:
    assert [PATH.with_marker(dart).id for dart in range(4)] == ["m2/0", "m2/2", "m2/2", "m2/0"]
    assert PATH.with_marker(0).is_isomorphic(PATH.with_marker(3))
    assert not PATH.with_marker(0).is_isomorphic(PATH.with_marker(1))


def test_worlds_are_equal_only_with_equal_darts_whatever_else_they_carry() -> None:
    same = World(PATH.alpha, PATH.sigma, PATH.root, name="path", starts=(3, 1, 0))
    assert same == PATH
    assert hash(same) == hash(PATH)
    assert {same, PATH} == {PATH}
    turned = shuffled(PATH, 1)
    assert turned != PATH
    assert turned.is_isomorphic(PATH)
    assert PATH != "m2/0"


# ---------------------------------------------------------------- ids


@given(pair=ranks)
def test_an_id_and_its_world_name_each_other(pair: tuple[int, int]) -> None:
    text = f"m{pair[0]}/{pair[1]}"
    assert World.from_id(text).id == World.from_id(text).name == text


@pytest.mark.parametrize(
    "text",
    ["", "5/17", "m5", "m5/", "m/17", "m5/-1", "m-5/1", "m5/1.0", "m5/1/2", "m\u0665/1", "m 5/1"],
)
def test_what_is_no_id_is_refused_with_an_example(text: str) -> None:
    with pytest.raises(InputError, match=r"expected a world id m<edges>/<rank>, such as m5/17"):
        World.from_id(text)


@pytest.mark.parametrize("text", ["m5/" + "9" * 5000, "m" + "9" * 5000 + "/5"])
def test_an_id_with_thousands_of_digits_is_no_id(text: str) -> None:
    with pytest.raises(InputError, match="expected a world id") as refusal:
        World.from_id(text)
    assert len(str(refusal.value)) < 200


def test_an_id_beyond_the_last_rank_is_refused() -> None:
    with pytest.raises(InputError, match="ranks of worlds with 5 edges run from 0 to 8161"):
        World.from_id("m5/8162")


def test_ids_work_up_to_200_edges_and_are_refused_beyond() -> None:
    last = rank_order.count(200) - 1
    assert World.from_id(f"m200/{last}").known_id == f"m200/{last}"
    with pytest.raises(InputError, match="201 edges has no id"):
        World.from_id("m201/0")
    with pytest.raises(InputError, match="save it as a file"):
        _ = families.lattice(1, 202).id
    assert families.lattice(1, 202).known_id is None


def test_a_world_shows_itself_as_what_makes_it_or_by_its_size() -> None:
    assert repr(shuffled(PATH, 3)) == "tv.World.from_id('m2/0')"
    assert (
        repr(families.torus(15, 15)) == "<World 'torus(15,15)': 225 vertices, 450 edges, genus 1>"
    )


# ---------------------------------------------------------------- what it refuses to be


@pytest.mark.parametrize(
    ("alpha", "sigma", "root", "sentence"),
    [
        ((1, 0), (0,), 0, "alpha has 2 entries and sigma 1"),
        ((0,), (0,), 0, "alpha has 1 entries and sigma 1: give both one a dart, two darts an edge"),
        ((1, 0), (0, 1), None, "marker None with 2 darts"),
        ((), (), 0, "marker 0 with 0 darts"),
        ((1, 0), (0, 1), 2, "the marker points at dart 2, which is out of range"),
        ((1, 0), (0, 1), -1, "the marker points at dart -1"),
        ((2, 0), (0, 1), 0, r"alpha\[0\] = 2 is out of range: name one of the darts 0 … 1"),
        ((1, 0), (0, -1), 0, r"sigma\[1\] = -1 is out of range"),
        ((1, 0, 2, 3), (1, 2, 3, 0), 0, "alpha has the fixed point 2"),
        ((1, 2, 3, 0), (1, 2, 3, 0), 0, r"no involution|alpha\[0\] = 1, but alpha\[1\] = 2"),
        ((1, 0, 3, 2), (1, 0, 3, 3), 0, "sigma is not a permutation: darts 2 and 3 both turn to"),
        ((1, 0, 3, 2), (1, 0, 3, 2), 0, r"not connected: no way leads from the marker .* dart 2;"),
        ((1, 0, 3, 2), (1, 0, 3, 2), 3, r"not connected: .*\(dart 3\) to dart 0"),
    ],
)
def test_what_is_no_world_is_refused_and_the_dart_named(
    alpha: tuple[int, ...], sigma: tuple[int, ...], root: int | None, sentence: str
) -> None:
    with pytest.raises(InputError, match=sentence):
        World(alpha, sigma, root)


def test_a_marker_can_only_be_moved_to_a_dart() -> None:
    with pytest.raises(InputError, match="dart 4, which is out of range"):
        PATH.with_marker(4)


def test_what_is_carried_along_has_to_fit_the_vertices() -> None:
    with pytest.raises(InputError, match="vertex_names has 2 entries for 3 vertices"):
        World(PATH.alpha, PATH.sigma, 0, vertex_names=("a", "b"))
    with pytest.raises(InputError, match="positions has 4 entries for 3 vertices"):
        World(PATH.alpha, PATH.sigma, 0, positions=((0, 0), (1, 1), (2, 2), (3, 3)))


@pytest.mark.parametrize("odd", [(0.0, float("nan")), (float("inf"), 0.0)])
def test_a_position_is_finite(odd: tuple[float, float]) -> None:
    with pytest.raises(InputError, match=r"positions\[1\] is .* two finite numbers"):
        World(PATH.alpha, PATH.sigma, 0, positions=((0, 0), odd, (2, 2)))


def test_its_text_brings_it_back_whatever_its_size() -> None:
    small = World.from_id("m5/17")
    assert small.text == "m5/17"
    assert io.from_text(small.text) == small
    large = families.path(300)
    assert large.text.startswith("{")
    assert io.from_text(large.text) == large


def test_pretty_printers_as_hypothesis_has_one_say_what_makes_it_up_to_200_edges() -> None:
    assert pretty(PATH) == repr(PATH)
    street = families.lattice(8, 8)
    assert repr(street) == "<World 'lattice(8,8)': 64 vertices, 112 edges, genus 0>"
    assert pretty(street) == f"tv.World.from_id({street.id!r})"
    assert pretty(families.path(300)) == repr(families.path(300))


def test_a_world_shows_itself_and_writes_its_picture(tmp_path: Path) -> None:
    world = World.from_id("m1/0")
    picture = world.draw(tmp_path / "world.svg")
    assert (tmp_path / "world.svg").read_text() == picture
    html = str(vars(World)["_repr_html_"](world))
    assert b64encode(picture.encode()).decode() in html
    numbered = world.draw(tmp_path / "doors.svg", doors=True, darts=True)
    assert (tmp_path / "doors.svg").read_text() == numbered != picture
    assert not hasattr(world, "_repr_svg_"), "a notebook would draw the picture twice"
    with pytest.raises(InputError, match=r"world\.gif"):
        world.draw(tmp_path / "world.gif")


def test_a_notebook_shows_a_large_world_as_a_sentence() -> None:
    street = families.path(1002)
    shown = str(vars(World)["_repr_html_"](street))
    assert "1001 edges, genus 0" in shown
    assert "<img" not in shown


@given(ranks)
def test_a_listed_world_is_given_the_code_and_the_id_that_it_has(pair: tuple[int, int]) -> None:
    code, (_, rank) = rank_order.unrank(*pair), pair
    listed, computed = World.from_code(code, rank=rank), World.from_code(code)
    assert (listed, listed.code, listed.id) == (computed, computed.code, computed.id)
