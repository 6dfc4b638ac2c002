"""Maps, walks and percepts as clauses, compared with worlds and the simulator."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from random import Random

import pytest

from tests.helpers import some, worlds
from topo_verify import World
from topo_verify.proofs.bounded.cnf import models, solve
from topo_verify.proofs.bounded.encoding import MarkerDetail, Worlds, doors, walk
from topo_verify.proofs.bounded.replay import decode_world
from topo_verify.proofs.theorem import Budget
from topo_verify.robot.percept import Percept
from topo_verify.robot.simulator import exit_dart, percepts
from topo_verify.world.rooted_map import Dart

BUDGET = Budget()

Drawn = tuple[tuple[int, ...], tuple[Dart, ...], int, frozenset[Dart]]
"""Degrees and alpha in the numbering of a discovery, darts known, darts explored."""


def reachable_maps(world: World) -> Iterator[Drawn]:
    """All maps of a world that an exploration can draw, found by drawing them, with no solver."""
    todo, seen = (
        [(_rotation(world, some(world.root)), frozenset[Dart]())],
        set[tuple[tuple[Dart, ...], frozenset[Dart]]](),
    )
    while todo:
        known, explored = todo.pop()
        if (known, explored) in seen:
            continue
        seen.add((known, explored))
        yield _numbered(world, known, explored)
        for e in known:
            if e not in explored:
                end = world.alpha[e]
                more = () if end in known else _rotation(world, end)
                todo.append(((*known, *more), explored | {e, end}))


def _rotation(world: World, entry: Dart) -> tuple[Dart, ...]:
    degree = world.degrees[world.vertex_of[entry]]
    return tuple(exit_dart(world, entry, k) for k in range(degree))


def _numbered(world: World, known: tuple[Dart, ...], explored: frozenset[Dart]) -> Drawn:
    """The darts in the order of discovery, then breadth-first."""
    order = list(known)
    for dart in order:  # grows as it goes
        if world.alpha[dart] not in order:
            order += _rotation(world, world.alpha[dart])
    number = {dart: place for place, dart in enumerate(order)}
    degrees: list[int] = []
    while sum(degrees) < len(order):
        degrees.append(world.degrees[world.vertex_of[order[sum(degrees)]]])
    alpha = tuple(number[world.alpha[dart]] for dart in order)
    return tuple(degrees), alpha, len(known), frozenset(number[dart] for dart in explored)


@pytest.mark.nightly
@pytest.mark.parametrize("edges", [1, 2, 3])
def test_the_maps_are_exactly_those_that_an_exploration_can_draw(edges: int) -> None:
    world = Worlds(edges)
    chart = world.map("S")
    world.number_the_rest(chart.known)
    over = (*world.first, *world.joined.values(), *chart.known, *chart.explored)
    found: list[Drawn] = []
    for model in models(world, over, BUDGET):
        decoded = decode_world(world, model)
        known = sum(map(model.holds, chart.known))
        explored = frozenset(d for d in world.darts if model.holds(chart.explored[d]))
        found.append((decoded.degrees, decoded.alpha, known, explored))
    drawn = [drawn for one in worlds([edges]) for drawn in reachable_maps(one)]
    assert len(found) == len(set(found))
    assert set(found) == set(drawn)


def pinned(world: World) -> Worlds:
    """The encoding of one world alone."""
    encoded = Worlds(len(world.edges))
    degrees, alpha = world.code
    starts = {sum(degrees[:i]) for i in range(len(degrees))}
    for d in encoded.darts:
        encoded.add("pinned", encoded.first[d] if d in starts else -encoded.first[d])
        encoded.add("pinned", encoded.edge(d, alpha[d]))
    return encoded


@pytest.mark.parametrize("world", list(worlds([1, 2])) + list(worlds([3]))[::5], ids=repr)
def test_a_walk_in_clauses_is_the_walk_of_the_simulator(world: World) -> None:
    random = Random(world.id)
    world = World.from_code(world.code)
    at = random.randrange(len(world.alpha))
    word = [random.randrange(len(world.alpha)) for _ in range(3)]
    encoded = pinned(world)
    start = encoded.position("start", "start")
    encoded.add("start", start[at])
    row = doors(encoded, "door", 3)
    walked = walk(encoded, "walk", start, row)
    for literals, door in zip(row, word, strict=True):
        encoded.add("word", literals[door])
    model = solve(encoded, BUDGET).model
    for place, sense in zip(walked.at, walked.senses, strict=True):
        if model is not None:
            assert model.index(place) == at
            seen = percepts(world)[at]
            assert model.index(sense.degree) + 1 == seen.degree
            assert model.holds(sense.here) == (seen.marker is not None)
            pointed = [door for door, literal in enumerate(sense.marker) if model.holds(literal)]
            assert pointed == ([] if seen.marker is None else [seen.marker])
        if not word:
            break
        door = word.pop(0)
        if door >= percepts(world)[at].degree:
            assert model is None, "there is no such door, and so no such walk"
            return
        at = world.alpha[exit_dart(world, at, door)]
    assert model is not None


LOOKED: dict[MarkerDetail, Callable[[Percept], object]] = {
    "directed": lambda percept: percept,
    "undirected": lambda percept: percept.signature,
    "none": lambda percept: percept.degree,
}


@pytest.mark.nightly
@pytest.mark.parametrize("marker", LOOKED)
def test_percepts_are_alike_as_far_as_the_marker_is_looked_at(marker: MarkerDetail) -> None:
    for world in worlds([2]):
        world = World.from_code(world.code)  # noqa: PLW2901  numbered by its code
        seen = percepts(world)
        looked = LOOKED[marker]
        for one in range(4):
            for other in range(4):
                encoded = pinned(world)
                places = [encoded.position("at", f"at.{i}") for i in range(2)]
                encoded.add("at", places[0][one])
                encoded.add("at", places[1][other])
                senses = [encoded.sense("at", at, f"sense.{i}") for i, at in enumerate(places)]
                alike = encoded.alike("at", senses[0], senses[1], "same", marker)
                model = some(solve(encoded, BUDGET).model)
                assert model.holds(alike) == (looked(seen[one]) == looked(seen[other]))
