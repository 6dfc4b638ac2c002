"""What may be asked for: every bound is kept, and what cannot be is refused with a sentence."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import find, given, settings
from hypothesis import strategies as st
from hypothesis.strategies import SearchStrategy

import topo_verify
from topo_verify import InputError, World, strategies
from topo_verify.strategies import (
    dense_worlds,
    door_words,
    lattices,
    mappers,
    nonplanar_worlds,
    planar_worlds,
    symmetric_worlds,
    tree_worlds,
    uniform_worlds,
    worlds,
)

Make = Callable[..., SearchStrategy[Any]]


@pytest.mark.parametrize(
    ("make", "arguments", "sentence"),
    [
        (worlds, {"min_edges": 3, "max_edges": 2}, "min_edges=3 is above max_edges=2"),
        (worlds, {"min_genus": 2, "max_genus": 1}, "min_genus=2 is above max_genus=1"),
        (worlds, {"min_edges": -1}, "min_edges=-1, expected an integer of 0 or more"),
        (worlds, {"max_edges": 2.5}, "max_edges=2.5, expected an integer"),
        (worlds, {"max_edges": True}, "max_edges=True, expected an integer"),
        (worlds, {"max_edges": 2001}, "max_edges=2001 is more than 2000"),
        (worlds, {"marker": "middle"}, "marker='middle', expected one of 'any', 'leaf', 'hub'"),
        (worlds, {"min_genus": 2, "max_edges": 3}, "genus 2 or more has 1 to 3 edges: it takes 4"),
        (worlds, {"min_genus": 1, "loopless": True, "max_edges": 2}, "no loops has 1 to 2 edges"),
        (worlds, {"min_genus": 1, "simple": True, "max_edges": 4}, "it takes 5 or more"),
        (worlds, {"min_genus": 2, "simple": True, "max_edges": 7}, "it takes 8 or more"),
        (worlds, {"min_genus": 1, "max_degree": 3, "max_edges": 2}, "it takes 3 or more"),
        (worlds, {"min_genus": 1, "max_degree": 2}, "and none has more or fewer: ask for less"),
        (worlds, {"max_degree": 1, "min_edges": 2}, "it has fewer; lower min_edges"),
        (worlds, {"marker": "leaf", "min_edges": 0, "max_edges": 0}, "at a dead end has 0 edges"),
        (tree_worlds, {"max_edges": 0}, "is above max_edges=0: min_edges=0 draws m0/0, too"),
        (worlds, {"marker": "leaf", "min_genus": 1, "max_edges": 2}, "it takes 3 or more"),
        (planar_worlds, {"max_degree": 0, "min_edges": 1}, "planar_worlds: no world of genus 0"),
        (nonplanar_worlds, {"genus": 0}, "expected genus 1 or more, got 0: planar_worlds"),
        (nonplanar_worlds, {"genus": 3, "max_edges": 5}, "genus 3 has 1 to 5 edges: it takes 6"),
        (tree_worlds, {"max_degree": 1, "min_edges": 2}, "tree_worlds: no world of max_degree 1"),
        (dense_worlds, {"min_genus": 5, "max_edges": 9}, "it takes 10 or more"),
        (lattices, {"min_edges": 9, "max_edges": 8}, "lattices: min_edges=9 is above"),
        (lattices, {"marker": "leaf"}, "lattices: marker='leaf', expected one of 'any', 'hub'"),
        (symmetric_worlds, {"simple": True, "min_edges": 2, "max_edges": 2}, "has 2 to 2 edges"),
        (symmetric_worlds, {"loopless": True, "max_degree": 0, "min_edges": 1}, "widen the bounds"),
        (uniform_worlds, {"edges": -3}, "uniform_worlds: edges=-3, expected an integer"),
        (uniform_worlds, {"edges": 201}, "expected at most 200 edges, got 201"),
        (mappers, {"algorithms": ["basic", "best"]}, "no algorithm 'best': there are basic, "),
        (mappers, {"algorithms": []}, "algorithms is empty: there are basic, "),
        (door_words, {"world": World((), (), None), "min_length": 1}, "world without doors, got 1"),
        (door_words, {"world": World.from_id("m1/0"), "max_length": -1}, "max_length=-1, expected"),
        (door_words, {"world": World.from_id("m1/0"), "min_length": 101}, "min_length=101"),
        (door_words, {"world": World.from_id("m1/0"), "max_length": 2001}, "<= 2000"),
    ],
)
def test_what_cannot_be_is_refused_when_the_strategy_is_made(
    make: Make, arguments: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(InputError, match=r"^[a-z_]+: ") as refusal:
        make(**arguments)
    assert sentence in str(refusal.value)


BOUNDS = {
    "min_edges": st.integers(0, 12),
    "max_edges": st.integers(6, 40),
    "min_genus": st.integers(0, 2),
    "max_genus": st.none() | st.integers(1, 4),
    "simple": st.booleans(),
    "loopless": st.booleans(),
    "max_degree": st.none() | st.integers(1, 6),
    "marker": st.sampled_from(["any", "leaf", "hub"]),
}
NO_GENUS = {name: bound for name, bound in BOUNDS.items() if "genus" not in name}
TAKES: list[tuple[Make, dict[str, SearchStrategy[Any]]]] = [
    (worlds, BOUNDS),
    (dense_worlds, BOUNDS),
    (planar_worlds, NO_GENUS),
    (nonplanar_worlds, {**NO_GENUS, "genus": st.none() | st.integers(1, 4)}),
    (symmetric_worlds, NO_GENUS),
    (tree_worlds, {name: BOUNDS[name] for name in ("min_edges", "max_edges", "max_degree")}),
    (lattices, {name: BOUNDS[name] for name in ("min_edges", "max_edges")}),
]


def keeps(world: World, asked: dict[str, Any]) -> bool:
    """Does the world keep all that was asked for?"""
    degree = world.degrees[world.marker_vertex]
    genus = asked.get("genus")
    return (
        asked.get("min_edges", 1) <= len(world.edges) <= asked.get("max_edges", 200)
        and asked.get("min_genus", 0) <= world.genus
        and (asked.get("max_genus") is None or world.genus <= asked["max_genus"])
        and (genus is None or world.genus == genus)
        and (not asked.get("simple") or world.is_simple)
        and (not asked.get("loopless") or world.is_loopless)
        and (asked.get("max_degree") is None or max(world.degrees) <= asked["max_degree"])
        and (asked.get("marker") != "leaf" or degree == 1)
        and (asked.get("marker") != "hub" or degree == max(world.degrees))
    )


@pytest.mark.parametrize(
    ("make", "takes"),
    [
        pytest.param(make, takes, marks=pytest.mark.long if make is dense_worlds else ())
        for make, takes in TAKES
    ],
    ids=lambda value: getattr(value, "__name__", ""),
)
@settings(max_examples=150)
@given(data=st.data())
def test_every_bound_is_kept(
    make: Make, takes: dict[str, SearchStrategy[Any]], data: st.DataObject
) -> None:
    asked = data.draw(st.fixed_dictionaries(takes))
    try:
        strategy = make(**asked)
    except InputError:
        return  # whether the refusals are right is asked elsewhere
    assert keeps(data.draw(strategy), asked)


@pytest.mark.long
@pytest.mark.parametrize("make", [make for make, _ in TAKES])
def test_the_default_bounds_are_the_widest(make: Make) -> None:
    """Up to 200 edges, which is the most that has an id to print."""
    world = find(make(), lambda world: len(world.edges) > 60, settings=settings(max_examples=5000))
    assert len(world.edges) <= 200


@pytest.mark.long
@pytest.mark.parametrize("make", [make for make, _ in TAKES if make is not nonplanar_worlds])
def test_the_world_without_an_edge_is_drawn_on_request_only(make: Make) -> None:
    """verify, search and the marks of pytest never try m0/0: a property test agrees with them."""
    assert len(find(make(), lambda _: True).edges) == 1
    assert find(make(min_edges=0), lambda _: True).id == "m0/0"


@pytest.mark.nightly
def test_strategies_compose_as_strategies_do() -> None:
    mirrors = worlds(min_edges=2, max_edges=9).map(World.mirror).filter(lambda w: w.genus == 1)
    assert find(mirrors, lambda _: True).genus == 1
    pairs = st.tuples(worlds(), mappers())
    assert find(pairs, lambda _: True)[1].name == "basic"
    assert find(st.builds(World.mirror, worlds(min_edges=3)), lambda _: True).id == "m3/24"


@pytest.mark.parametrize(
    "call",
    [
        "worlds()",
        "worlds(max_edges=6)",
        "nonplanar_worlds(genus=2, simple=True, marker='hub')",
        "tree_worlds(min_edges=0)",
        "lattices(max_edges=9)",
        "symmetric_worlds(max_degree=3)",
        "uniform_worlds(edges=5)",
        "mappers(algorithms=['basic'])",
        "mappers(policies=policies(random=False))",
        "door_words(tv.World.from_id('m1/0'), max_length=2)",
    ],
)
def test_a_strategy_prints_as_the_call_that_made_it(call: str) -> None:
    names = {**vars(strategies), "tv": topo_verify}
    strategy: SearchStrategy[Any] = eval(call, names)  # noqa: S307  as typed at a prompt
    assert repr(strategy) == call


def test_what_is_exported_is_pinned() -> None:
    assert sorted(strategies.__all__) == [
        *("dense_worlds", "door_words", "lattices", "mappers", "nonplanar_worlds", "observe"),
        *("planar_worlds", "policies", "symmetric_worlds", "tree_worlds", "uniform_worlds"),
        "worlds",
    ]
