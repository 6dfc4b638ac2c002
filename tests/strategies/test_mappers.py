"""Mappers with their policies, and walks from door to door."""

from __future__ import annotations

import pytest
from hypothesis import find, given
from hypothesis import strategies as st

from tests.versions import older
from topo_verify import CATALOGUE, Algorithm, World
from topo_verify.robot.events import Policies
from topo_verify.robot.simulator import SimulatedRobot
from topo_verify.strategies import door_words, mappers, policies, worlds


def drawn_names(strategy: st.SearchStrategy[Algorithm]) -> set[str]:
    names: set[str] = set()

    @given(strategy)
    def draw(mapper: Algorithm) -> None:
        names.add(mapper.name)

    draw()
    return names


@pytest.mark.skipif(
    older("hypothesis", 6, 140, 1),
    reason="Hypothesis before 6.140.1: with one seed in 40, a hundred draws leave an algorithm out",
)
def test_all_of_the_catalogue_is_drawn_and_what_assumes_a_plane_only_if_asked_for() -> None:
    sure = {name for name, algorithm in CATALOGUE.items() if algorithm.assumes is None}
    assert drawn_names(mappers()) == sure
    assert drawn_names(mappers(planar=True)) == set(CATALOGUE)
    assert drawn_names(mappers(algorithms=["folding+planar"])) == {"folding+planar"}


@pytest.mark.long
def test_they_shrink_to_basic_and_to_the_reference_policies() -> None:
    assert find(policies(), lambda _: True) == Policies("nearest", "shortest")
    assert find(mappers(), lambda _: True) == CATALOGUE["basic"]
    assert find(mappers(), lambda m: m.name > "f").name == "folding"
    fixed = mappers(policies=st.just(Policies("last", "newest")))
    assert find(fixed, lambda _: True).policies == Policies("last", "newest")


@pytest.mark.parametrize("text", ["nearest", "last", "first", "random(0)"])
def test_every_pick_policy_is_found(text: str) -> None:
    assert find(policies(), lambda p: p.pick == text or text in p.pick).order == "shortest"


@given(policies(random=False))
def test_random_policies_can_be_left_out(chosen: Policies) -> None:
    assert "random" not in chosen.pick + chosen.order


@given(data=st.data(), world=worlds(min_edges=1, max_edges=20))
def test_a_robot_can_take_the_doors_of_a_word(data: st.DataObject, world: World) -> None:
    doors = data.draw(door_words(world, min_length=1, max_length=9))
    robot = SimulatedRobot(world, budget=9)
    for door in doors:
        robot.move(door)
    assert 1 <= robot.cost == len(doors) <= 9


@pytest.mark.long
def test_door_words_reach_every_vertex_and_shrink_to_few_low_doors() -> None:
    lattice = World.from_id("m4/0")  # a path of five vertices, from its end
    for length in range(5):
        word = find(door_words(lattice), lambda doors: len(doors) >= length)  # noqa: B023
        assert word == (0,) * length
    assert find(door_words(lattice), lambda doors: sum(doors) >= 3) == (0, 1, 1, 1)


def test_where_there_is_no_door_the_only_word_is_empty() -> None:
    assert find(door_words(World((), (), None)), lambda _: True) == ()


def test_a_text_names_the_world_of_door_words() -> None:
    assert find(door_words("m2/0", min_length=2), lambda _: True) == (0, 0)
