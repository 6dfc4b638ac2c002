"""Twins: two worlds that look the same without the marker's direction, and why there is none."""

from __future__ import annotations

from collections import defaultdict
from itertools import combinations

import pytest

import topo_verify as tv
from tests.helpers import some
from topo_verify.errors import InputError, InternalError
from topo_verify.world import twins
from topo_verify.world.rooted_map import World
from topo_verify.world.twins import find_twin, look_alike, no_twin


def worlds(most: int) -> list[World]:
    return [world for m in range(1, most + 1) for world in tv.worlds(edges=m)]


def test_whether_a_world_has_a_twin_is_what_all_pairs_of_one_size_say() -> None:
    """Brute force: every two worlds with up to 3 edges are walked side by side."""
    for m in (1, 2, 3):
        with_twin = {
            world
            for pair in combinations(tv.worlds(edges=m), 2)
            if look_alike(*pair, "undirected")
            for world in pair
        }
        for world in tv.worlds(edges=m):
            assert (world.twin() is not None) == (world in with_twin), world
            assert (no_twin(world, "undirected") == "") == (world in with_twin), world


def test_in_all_worlds_of_up_to_4_edges_a_twin_looks_the_same_and_is_another_world() -> None:
    determined = defaultdict[int, int](int)
    for world in worlds(4):
        other, why = find_twin(world, "undirected")
        assert (other is None) == bool(why)
        assert why != "no exchange of two edges makes one"
        determined[len(world.edges)] += other is None
        if other is not None:
            assert len(other.edges) == len(world.edges)
            assert not other.is_isomorphic(world)
            assert look_alike(world, other, "undirected")
    assert [determined[m] for m in (1, 2, 3, 4)] == [2, 7, 57, 576]


def test_worlds_with_other_degrees_or_another_place_of_the_marker_look_different() -> None:
    here, path, degree = map(World.from_id, ("m2/7", "m2/0", "m2/5"))
    assert not look_alike(here, degree, "undirected")
    assert not look_alike(path, path.with_marker(1), "undirected")


def test_without_a_marker_trees_alone_are_determined() -> None:
    for world in worlds(3):
        other = world.twin("none")
        is_tree = len(world.edges) < len(world.vertices)
        assert (other is None) == is_tree
        if other is not None:
            assert len(other.edges) == 2 * len(world.edges)
            assert look_alike(world, other, "none")


@pytest.mark.parametrize(
    ("world", "twin"), [("m2/7", "m2/8"), ("m3/30", "m3/31"), ("m6/18704", "m6/18705")]
)
def test_the_smallest_pairs_of_all_loopless_and_simple_worlds(world: str, twin: str) -> None:
    other = some(World.from_id(world).twin())
    assert other.id == twin


@pytest.mark.parametrize(
    ("world", "why"),
    [
        ("m2/5", "no two darts look alike"),
        ("m3/28", "no two darts look alike"),
        ("m4/183", "no two darts look alike"),
        ("m1/0", "a tree"),
        ("m2/3", "it has only one cycle"),
    ],
)
def test_why_there_is_none(world: str, why: str) -> None:
    other, reason = find_twin(World.from_id(world), "undirected")
    assert other is None
    assert why in reason


def test_a_platonic_solid_has_a_twin_on_the_torus() -> None:
    other = some(tv.families.cube().twin())
    assert other.genus == 1


def test_a_twin_that_looks_different_is_not_handed_out(monkeypatch: pytest.MonkeyPatch) -> None:
    def exchanged(_: World) -> list[World]:
        return [World.from_id("m2/0")]

    monkeypatch.setattr(twins, "_exchanged", exchanged)
    with pytest.raises(InternalError, match="do not look the same"):
        World.from_id("m2/7").twin()


@pytest.mark.parametrize("model", twins.MODELS)
def test_a_world_that_falls_apart_is_no_twin(
    model: twins.MarkerModel, monkeypatch: pytest.MonkeyPatch
) -> None:
    def joined(*_: object) -> None:
        return None

    monkeypatch.setattr(twins, "_joined", joined)
    assert find_twin(World.from_id("m2/7"), model) == (None, "no exchange of two edges makes one")


def test_an_unknown_model_is_refused() -> None:
    with pytest.raises(InputError, match="expected one of undirected, none"):
        World.from_id("m2/7").twin("seen")  # type: ignore[arg-type]  # pyright: ignore[reportArgumentType]  that is refused
