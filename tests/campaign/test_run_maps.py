"""What a mapper may deliver: anything with vertices, edges and a marker, and nothing else."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from tests.campaign.test_run import SHORT, WORLD, Unspeakable, delivers, why
from topo_verify import CATALOGUE, Robot, examine, explore
from topo_verify.campaign.judge import judge

VERTICES, EDGES = [[0, 1, 2], [3]], [[0, 2], [1, 3]]


class Slotted:
    """A map of one's own."""

    def __init__(self) -> None:
        self.vertices, self.edges, self.marker = VERTICES, EDGES, 0


@pytest.mark.parametrize(
    "result",
    [
        {"vertices": VERTICES, "edges": EDGES, "marker": 0},
        {"vertices": VERTICES, "edges": EDGES, "marker": 0, "cost": 2, "colour": "red"},
        {"vertices": VERTICES, "edges": EDGES, "marker": 0, "cost": None},
        {"vertices": VERTICES, "edges": EDGES, "marker": np.int64(0), "cost": np.int32(2)},
        {"vertices": [[50, -7, 9], [8]], "edges": [[9, 50], [-7, 8]], "marker": 50},
        {"vertices": [[3], [1, 2, 0]], "edges": [[3, 1], [2, 0]], "marker": 0},
        Slotted(),
        WORLD,
    ],
)
def test_anything_with_vertices_edges_and_a_marker_is_a_map(result: object) -> None:
    report = examine(delivers(result), WORLD)
    assert report.ok, str(report)


def lazy(error: Exception) -> object:
    """A map that cannot be read."""

    class Lazy:
        edges, marker = EDGES, 0

        @property
        def vertices(self) -> object:
            raise error

    return Lazy()


class Endless(list[Any]):
    """A row that never ends."""

    def __iter__(self) -> Iterator[Any]:
        while True:
            yield 0


@pytest.mark.parametrize(
    ("result", "reason"),
    [
        (None, "None (is a `return` missing?) has no 'vertices'"),
        ((door for door in (0, 1)), "returned a generator: it has a `yield`"),
        ("a map", "str has no 'vertices'"),
        ({"vertices": VERTICES, "edges": EDGES}, "dict has no 'marker'"),
        (Slotted, "type has no 'vertices'"),
        ({"vertices": "01", "edges": EDGES, "marker": 0}, "lists of darts as the map's 'vertices'"),
        ({"vertices": [[0.0, 1, 2], [3]], "edges": EDGES, "marker": 0}, "vertices[0]"),
        ({"vertices": VERTICES, "edges": EDGES, "marker": "0"}, "'marker'"),
        ({"vertices": VERTICES, "edges": EDGES, "marker": 0, "cost": "2"}, "the cost '2'"),
        ({"vertices": VERTICES, "edges": EDGES, "marker": 0, "cost": 2.0}, "the cost 2.0"),
        ({"vertices": VERTICES, "edges": EDGES, "marker": 0, "cost": True}, "the cost True"),
        ({"vertices": VERTICES, "edges": EDGES, "marker": 0, "cost": 10**30}, "not from -2^63"),
        ({"vertices": VERTICES, "edges": EDGES, "marker": 10**30}, "'marker'"),
        (lazy(ValueError("nobody looks")), "what was delivered cannot be read: ValueError: nob"),
        (lazy(Unspeakable()), "what was delivered cannot be read: Unspeakable"),
    ],
)
def test_nonsense_is_no_map(result: object, reason: str) -> None:
    assert reason in why(delivers(result))


@pytest.mark.filterwarnings("error")
def test_an_async_mapper_is_told_the_word_to_remove() -> None:
    async def mapper(_robot: Robot) -> None: ...

    assert why(mapper).startswith("the mapper is `async`: remove the word")


def test_a_map_that_never_ends_is_out_of_time() -> None:
    endless = {"vertices": Endless(), "edges": EDGES, "marker": 0}
    assert why(delivers(endless), SHORT).startswith(
        "the mapper did not move for 0.15 s; it was at "
    )


@pytest.mark.parametrize(
    "result",
    [
        {"vertices": VERTICES, "edges": [[0, 2, 1], [3]], "marker": 0},
        {"vertices": VERTICES, "edges": [[0, 2]], "marker": 0},
        {"vertices": VERTICES, "edges": EDGES, "marker": None},
    ],
)
def test_a_map_that_is_no_world_is_delivered_and_refuted(result: object) -> None:
    run = explore(WORLD, delivers(result))
    assert run.map is not None
    (finding,) = judge(run).findings[:1]
    assert finding.claim == "map-isomorphic"
    assert finding.message.startswith("the delivered value is not a map: ")


def test_moves_that_a_map_makes_when_it_is_read_are_counted() -> None:
    def mapper(robot: Robot) -> object:
        survey = CATALOGUE["basic"](robot)

        class Late:
            edges, marker, cost = survey.edges, survey.marker, survey.cost

            @property
            def vertices(self) -> object:
                robot.move(0)
                return survey.vertices

        return Late()

    report = examine(mapper, WORLD)
    assert (report.cost, report.claims["cost-honest"]) == (3, "failed")
