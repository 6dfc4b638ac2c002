"""Classes of worlds: how they are written, which worlds are in them, how many, one of them."""

from __future__ import annotations

from collections import Counter
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.helpers import EMPTY
from topo_verify.errors import InputError
from topo_verify.world import World, families
from topo_verify.world.enumeration import classes, rank_order
from topo_verify.world.enumeration.classes import WorldClass

# ---------------------------------------------------------------- how they are written


@pytest.mark.parametrize(
    ("text", "plain"),
    [
        ("any", "any"),
        ("planar", "planar"),
        ("genus:0", "planar"),
        ("genus<=0", "planar"),
        ("planar,genus<=3", "planar"),
        ("genus:2", "genus:2"),
        ("genus:2,genus<=2", "genus:2"),
        ("genus<=4,genus<=2", "genus<=2"),
        ("simple,loopless", "simple"),
        ("any,loopless,any", "loopless"),
        (" max-degree:5 , max-degree:3,simple", "simple,max-degree:3"),
        ("max-degree:3,genus:1,loopless", "genus:1,loopless,max-degree:3"),
        ("min-degree:2,max-degree:4,min-degree:3", "min-degree:3,max-degree:4"),
        ("max-degree:3,planar,min-degree:3", "planar,regular:3"),
        ("regular:3,min-degree:0", "regular:3"),
    ],
)
def test_equal_classes_are_equal_and_print_alike(text: str, plain: str) -> None:
    assert str(WorldClass.parse(text)) == plain
    assert WorldClass.parse(plain) == WorldClass.parse(text)


@pytest.mark.parametrize(
    ("text", "term"),
    [
        ("", "''"),
        ("planer", "'planer'"),
        ("planar,", "''"),
        ("genus:", "'genus:'"),
        ("genus:-1", "'genus:-1'"),
        ("genus>=1", "'genus>=1'"),
        ("genus<1", "'genus<1'"),
        ("max-degree:1e3", "'max-degree:1e3'"),
        ("max-degree:" + "9" * 5000, "'max-degree:999"),
        ("Planar", "'Planar'"),
        ("planar;simple", "'planar;simple'"),
    ],
)
def test_what_is_no_class_is_refused_with_a_list_of_those_there_are(text: str, term: str) -> None:
    with pytest.raises(InputError, match="expected any, planar, genus:G") as refusal:
        WorldClass.parse(text)
    assert term in str(refusal.value)


@pytest.mark.parametrize(
    "text", ["planar,genus:1", "genus:1,genus:2", "genus:2,genus<=1", "genus<=0,genus:3"]
)
def test_two_genera_contradict_each_other(text: str) -> None:
    with pytest.raises(InputError, match="contradicts itself: a world has one genus"):
        WorldClass.parse(text)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("max-degree:0", "at most 0 exits a vertex there is no world with an edge"),
        ("regular:3,max-degree:2", "no vertex has at least 3 and at most 2 exits"),
        ("max-degree:2,genus:1", "at most 2 exits a vertex there is no world of genus 1"),
    ],
)
def test_a_class_that_must_be_empty_is_refused(text: str, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        WorldClass.parse(text)


# ---------------------------------------------------------------- which worlds


@pytest.mark.parametrize(
    ("text", "world", "inside"),
    [
        ("any", families.king(4, 4), True),
        ("planar", families.lattice(3, 3), True),
        ("planar", families.torus(2, 2), False),
        ("genus:1", families.torus(2, 2), True),
        ("genus<=1", families.lattice(3, 3), True),
        ("genus<=1", families.king(4, 4), False),
        ("loopless", families.torus(2, 2), True),
        ("loopless", families.torus(1, 2), False),
        ("simple", families.torus(2, 2), False),
        ("simple", families.torus(3, 3), True),
        ("max-degree:4", families.torus(3, 3), True),
        ("max-degree:3", families.torus(3, 3), False),
        ("min-degree:4", families.torus(3, 3), True),
        ("min-degree:4", families.lattice(3, 3), False),
        ("regular:4", families.torus(3, 3), True),
        ("min-degree:1", EMPTY, False),
        ("simple,planar,max-degree:1", EMPTY, True),
        ("genus:1", EMPTY, False),
    ],
)
def test_a_world_is_in_the_class_whose_properties_it_has(
    text: str, world: World, inside: bool
) -> None:
    assert WorldClass.parse(text).admits(world.code) is inside


@given(seed=st.integers(0, 999), edges=st.integers(0, 9))
def test_tables_are_judged_as_their_worlds_are(seed: int, edges: int) -> None:
    table = rank_order.sample(edges, Random(seed))
    world = World.from_code(table)
    verdicts = {
        "planar": world.is_planar,
        "genus:1": world.genus == 1,
        "genus<=1": world.genus <= 1,
        "loopless": world.is_loopless,
        "simple": world.is_simple,
        "max-degree:3": max(world.degrees) <= 3,
    }
    for text, verdict in verdicts.items():
        assert WorldClass.parse(text).admits(table) is verdict
    both = WorldClass.parse("loopless,genus<=1")
    assert both.admits(table) is (world.is_loopless and world.genus <= 1)


# ---------------------------------------------------------------- how many


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("genus<=1", [2, 10, 74, 685, 7196]),
        ("simple,planar", [1, 2, 6, 23, 103]),
    ],
)
def test_the_classes_have_their_known_numbers_of_worlds(text: str, numbers: list[int]) -> None:
    chosen = WorldClass.parse(text)
    assert [chosen.count(edges) for edges in range(1, len(numbers) + 1)] == numbers


FORMULAS = (
    "any",
    "planar",
    "planar,loopless",
    "planar,simple",
    "genus:1",
    "genus:2",
    "genus<=1",
    "genus<=9",
)
BY_DEGREES = ("simple", "loopless", "max-degree:1", "max-degree:2", "max-degree:3", "max-degree:4",
              "simple,max-degree:3", "loopless,max-degree:4", "min-degree:1", "min-degree:3",
              "regular:2", "regular:4", "simple,min-degree:2,max-degree:3")  # fmt: skip


@pytest.mark.no_cover
@pytest.mark.parametrize("text", FORMULAS + BY_DEGREES)
def test_formulas_count_what_a_list_counts(text: str) -> None:
    chosen = WorldClass.parse(text)
    for edges in range(7 if text in BY_DEGREES else 6):
        assert chosen.count(edges) == sum(map(chosen.admits, rank_order.tables(edges)))


@pytest.mark.parametrize("text", [*FORMULAS, *BY_DEGREES, "genus:1,loopless"])
@pytest.mark.parametrize("edges", [*range(5), pytest.param(5, marks=pytest.mark.no_cover)])
def test_worlds_are_counted_by_their_vertices_as_a_list_counts_them(text: str, edges: int) -> None:
    chosen = WorldClass.parse(text)
    listed = Counter(len(t[0]) for t in rank_order.tables(edges) if chosen.admits(t))
    assert chosen.count_by_vertices(edges) == listed
    assert [*chosen.count_by_vertices(edges)] == sorted(listed)


def test_the_dual_maps_have_as_many_vertices_as_these_have_faces() -> None:
    numbers = WorldClass.parse("genus:2").count_by_vertices(40)
    assert [*numbers] == [*range(1, 38)]  # V + F = 40 - 2
    assert [*numbers.values()] == [*numbers.values()][::-1]
    assert sum(numbers.values()) == WorldClass.parse("genus:2").count(40)
    with pytest.raises(InputError, match="expected at most 100 edges to count by vertices, got 10"):
        WorldClass.parse("genus:2").count_by_vertices(101)


def test_formulas_count_where_nobody_can_list() -> None:
    assert WorldClass.parse("any").count(30) == rank_order.count(30)
    assert WorldClass.parse("planar").count(30) == rank_order.count_planar(30)
    parts = [WorldClass.parse(f"genus:{genus}").count(30) for genus in range(4)]
    assert WorldClass.parse("genus<=3").count(30) == sum(parts)


def test_a_class_without_a_formula_is_not_counted_where_listing_takes_too_long() -> None:
    with pytest.raises(
        InputError, match=r"class genus:1,simple: expected at most 7 edges, got 8: no formula"
    ):
        WorldClass.parse("genus:1,simple").count(8)
    with pytest.raises(InputError, match="expected at most 16 edges, got"):
        WorldClass.parse("simple").count(17)


# ---------------------------------------------------------------- one of them


@pytest.mark.parametrize("text", ["any", "planar", "genus:1", "simple", "loopless,max-degree:4"])
def test_a_drawn_world_is_in_the_class(text: str) -> None:
    chosen = WorldClass.parse(text)
    random = Random(5)
    for _ in range(20):
        world = chosen.sample(6, random)
        assert chosen.admits(world.code)
        assert len(world.edges) == 6


def test_drawing_from_a_class_is_drawing_from_all_and_waiting() -> None:
    """Rejection is exactly uniform: the draw is the first of the plain draws that is inside."""
    chosen = WorldClass.parse("simple")
    plain, drawn = Random(3), Random(3)
    for _ in range(30):
        first = next(t for t in iter(lambda: rank_order.sample(4, plain), None) if chosen.admits(t))
        assert chosen.sample(4, drawn).code == first


def test_drawing_from_nothing_is_refused() -> None:
    with pytest.raises(InputError, match="class genus:3: there is no world with 5 edges in it"):
        WorldClass.parse("genus:3").sample(5, Random(0))


def test_drawing_is_refused_at_once_where_it_would_take_ages() -> None:
    with pytest.raises(
        InputError, match=r"class genus:3: too few .* with 150 edges .* of all draws.* random_genus"
    ):
        WorldClass.parse("genus:3").sample(150, Random(0))


def test_drawing_a_genus_in_large_worlds_is_refused_before_it_is_counted() -> None:
    with pytest.raises(InputError, match=r"class genus<=2: .* \(none is tried above 200 edges\)"):
        WorldClass.parse("genus<=2").sample(1000, Random(0))
    assert len(WorldClass().sample(201, Random(0)).edges) == 201


def test_planar_worlds_are_drawn_among_planar_ones() -> None:
    """As `random_planar` draws them, exactly uniform: no planar world is too rare."""
    random = Random(1)
    assert WorldClass.parse("planar").sample(1000, random).is_planar
    world = WorldClass.parse("planar,max-degree:4").sample(12, random)
    assert world.is_planar
    assert max(world.degrees) <= 4


@pytest.mark.parametrize(
    ("edges", "genus"),
    [
        (30, 1),
        (12, 5),
        *(pytest.param(*pair, marks=pytest.mark.no_cover) for pair in ((300, 1), (40, 2), (30, 3))),
    ],
)
def test_worlds_of_a_genus_are_drawn_where_they_are_rare_and_where_they_are_not(
    edges: int, genus: int
) -> None:
    world = WorldClass.parse(f"genus:{genus}").sample(edges, Random(1))
    assert (len(world.edges), world.genus) == (edges, genus)


def test_a_world_of_a_genus_and_a_property_of_the_graph_is_drawn() -> None:
    assert WorldClass.parse("genus:1,loopless").sample(12, Random(1)).is_loopless


def test_drawing_gives_up_with_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(classes, "MAX_DRAWN_EDGES", 50 * 25)
    with pytest.raises(
        InputError,
        match=r"class simple: too few .* \(none of 50 that were .* a wider class,"
        r" or if it has few, choose from tv\.worlds\(\d+, cls='simple'\)$",
    ):
        WorldClass.parse("simple").sample(25, Random(0))


def test_a_class_is_shown_as_it_is_written() -> None:
    assert repr(WorldClass.parse("simple,planar")) == "tv.WorldClass.parse('planar,simple')"
