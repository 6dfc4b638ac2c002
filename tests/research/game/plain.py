"""The value of a game by plain recursion over histories: no folds, no memory, no bounds.

A game is given by the worlds that are drawn and by all those that the robot has to exclude, a
finite list. It ends when one of the latter shows the history.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Sequence

from topo_verify.world.rooted_map import World

Place = tuple[World, int]
"""A world and the robot's reference dart in it."""


def sight(place: Place) -> tuple[int, int | None]:
    """The percept there: the degree, and the door of the marker."""
    world, dart = place
    rotation = world.vertices[world.vertex_of[dart]]
    turned = [*rotation[rotation.index(dart) :], *rotation[: rotation.index(dart)]]
    return len(turned), turned.index(0) if 0 in turned else None


def behind(place: Place, door: int) -> Place:
    """Where the robot stands behind a door."""
    world, dart = place
    for _ in range(door):
        dart = world.sigma[dart]
    return world, world.alpha[dart]


def plain_value(
    drawn: Sequence[World], excluded: Sequence[World], depth: int, *, mean: bool
) -> float:
    """The least sum, or the least worst case, of robots that make at most so many moves."""
    assert all(world.root == 0 for world in excluded)
    names = {world.id for world in drawn}
    return _answers([(world, 0) for world in excluded], names, depth, mean=mean)


def _answers(places: Sequence[Place], drawn: set[str], depth: int, *, mean: bool) -> float:
    seen = defaultdict[tuple[int, int | None], list[Place]](list)
    for place in places:
        seen[sight(place)].append(place)
    values = [
        _play(group, drawn, depth, mean=mean)
        for group in seen.values()
        if any(world.id in drawn for world, _ in group)
    ]
    return sum(values) if mean else max(values)


def _play(places: Sequence[Place], drawn: set[str], depth: int, *, mean: bool) -> float:
    if len(places) == 1:
        return 0
    if depth == 0:
        return math.inf
    weight = sum(world.id in drawn for world, _ in places) if mean else 1
    degree, _ = sight(places[0])
    return weight + min(
        _answers([behind(place, door) for place in places], drawn, depth - 1, mean=mean)
        for door in range(degree)
    )
