"""Which edge comes next: the one with the least rank of all darts of U, at every choice."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from random import Random

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from tests.helpers import any_world
from topo_verify import World, explore, families
from topo_verify.algorithms.beyond.folding import NodeDart
from topo_verify.algorithms.beyond.history import History
from topo_verify.algorithms.beyond.homing import most_telling_door
from topo_verify.algorithms.beyond.next_edge import (
    OUTWARD,
    Rank,
    edge_along_face,
    look_alike,
    nearest_edge,
    outward_edge,
)
from topo_verify.algorithms.beyond.steering import NextEdge
from topo_verify.algorithms.beyond.steering import explore as steer
from topo_verify.robot.events import Augment, MapDart

RankOf = Callable[[History, MapDart, int], Rank]
"""The rank of a dart of U that is so many moves away."""


def moves_from(history: History, start: NodeDart, e: MapDart) -> int:
    """How many moves a robot needs from a place to the one behind a dart of U."""
    crossed = e in history.crossed
    goal = history.behind(e) if crossed else history.node_dart(e)
    far = {place: distance for place, distance, _ in history.outward(start)}
    return far[history.places.place(goal)] + (not crossed)


def nearest(history: History, e: MapDart, moves: int) -> Rank:
    return moves, e in history.crossed, e


def outward(history: History, e: MapDart, moves: int) -> Rank:
    return moves - OUTWARD * history.home().depth[history.chart.vertex[e]], e in history.crossed, e


def along_face(history: History, e: MapDart, moves: int) -> Rank:
    chart = history.chart
    return moves, (e - chart.first[chart.vertex[e]]) % chart.degree[chart.vertex[e]], e


def least_of_all(history: History, policy: NextEdge, rank: RankOf) -> MapDart:
    """What a policy is to choose, found by trying every dart of U."""
    start = history.at
    if policy is edge_along_face or len(set(history.chart.degree)) == 1:
        start, rank = history.node_dart(history.chart.first[-1]), along_face
    ranks = (rank(history, e, moves_from(history, start, e)) for e in history.chart.unexplored)
    return min(ranks)[2]


@pytest.mark.parametrize(
    ("policy", "rank"),
    [(nearest_edge, nearest), (outward_edge, outward), (edge_along_face, along_face)],
)
@settings(max_examples=30)
@given(world=any_world(max_edges=8), random=st.randoms(use_true_random=False))
@example(world=families.lattice(4, 4, seed=1), random=Random(1))
@example(world=families.torus(3, 3), random=Random(1))
def test_a_policy_chooses_the_least_of_all(
    policy: NextEdge, rank: RankOf, world: World, random: Random
) -> None:
    chosen: list[tuple[MapDart, MapDart]] = []

    def edge(history: History) -> MapDart:
        chosen.append((policy(history), least_of_all(history, policy, rank)))
        return random.choice(list(history.chart.unexplored))

    run = explore(world, partial(steer, edge=edge, door=most_telling_door))
    # What a mapper raises ends its run, and is no failure of the test: so they are compared here.
    assert run.map is not None, run.stopped
    assert [found for found, _ in chosen] == [least for _, least in chosen]


@pytest.mark.parametrize("policy", [nearest_edge, outward_edge])
@pytest.mark.parametrize(
    ("world", "expected"),
    [(families.torus(3, 4), {True}), (families.lattice(4, 4, seed=1), {True, False})],
)
def test_places_look_alike_until_two_degrees_were_seen(
    world: World, expected: set[bool], policy: NextEdge
) -> None:
    seen: set[bool] = set()

    def edge(history: History) -> MapDart:
        seen.add(look_alike(history))
        return policy(history)

    explore(world, partial(steer, edge=edge, door=most_telling_door))
    assert seen == expected


@pytest.mark.no_cover
@pytest.mark.parametrize("name", ["homing", "planner"])
def test_where_places_look_alike_the_first_closed_trip_goes_round_a_face(name: str) -> None:
    run = explore(families.torus(5, 5), name)
    edges = [{one.edge, one.dart} for one in run.trace if isinstance(one, Augment)]
    # v0 has the darts 0 to 3, and each new vertex four more: the first of them is the way back.
    assert edges[:4] == [{0, 4}, {5, 8}, {9, 12}, {13, 3}]
