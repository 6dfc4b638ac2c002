"""Rotations, edges and maps that are none: each is refused, the dart or the place named."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from topo_verify.errors import InputError
from topo_verify.world import World
from topo_verify.world.validation import optional_part

EDGE = World.from_id("m1/0")
LOOP = World.from_id("m1/1")


# ---------------------------------------------------------------- rotations and edges


Rows = list[list[int]]

NO_WORLDS: list[tuple[Rows, Rows, int | None, str]] = [
    ([], [], None, "'vertices' is empty: give one list a vertex; the smallest world is"),
    ([[0, 1], []], [[0, 1]], 0, r"vertices\[1\] has no dart: the world is not connected"),
    ([[], []], [], None, r"vertices\[0\] has no dart"),
    ([[0, 1], [1]], [[0, 1]], 0, r"dart 1 stands at two places .* vertices\[0\] and vertices\[1"),
    ([[0, 0]], [[0, 1]], 0, r"dart 0 stands at two places .* vertices\[0\] and vertices\[0\]"),
    ([[0, 1]], [[0]], 0, r"edges\[0\] has 1 dart: an edge is two darts"),
    ([[0, 1]], [[0, 1, 2]], 0, r"edges\[0\] has 3 darts"),
    ([[0, 1]], [[0, 2]], 0, r"edges\[0\] names dart 2, which no vertex has"),
    ([[0, 1]], [[0, 0]], 0, r"dart 0 stands in edges\[0\] and edges\[0\]"),
    ([[0, 1, 2]], [[0, 1], [2, 0]], 0, r"dart 0 stands in edges\[0\] and edges\[1\]"),
    ([[0, 1], [7]], [[0, 1]], 0, r"dart 7 of vertices\[1\] belongs to no edge"),
    ([[0, 1]], [[0, 1]], 2, "the marker points at dart 2, which no vertex has"),
    ([[0, 1]], [[0, 1]], None, "marker None with 2 darts"),
    ([[]], [], 0, "the marker points at dart 0, which no vertex has"),
    ([[0, 1], [2, 3]], [[0, 1], [2, 3]], 0, "not connected"),
    ([[30, 40], [10, 20]], [[10, 20], [30, 40]], 10, r"marker \(dart 10\) to dart 30;"),
]


@pytest.mark.parametrize(("vertices", "edges", "marker", "sentence"), NO_WORLDS)
def test_rotations_and_edges_that_are_no_world_are_refused_with_what_to_do(
    vertices: list[list[int]], edges: list[list[int]], marker: int | None, sentence: str
) -> None:
    with pytest.raises(InputError, match=sentence) as refusal:
        World.from_rotations(vertices, edges, marker)
    mend = r"[:;,] (or )?(give|name|put|take|leave|correct|join) .*"
    assert re.search(mend, str(refusal.value)), str(refusal.value)
    with pytest.raises(InputError, match=sentence):
        World.from_map({"vertices": vertices, "edges": edges, "marker": marker})


# ---------------------------------------------------------------- what is a map


@dataclass
class Map:
    """A map as a user might write one."""

    vertices: Any = field(default_factory=lambda: [[0], [1]])
    edges: Any = field(default_factory=lambda: [[0, 1]])
    marker: Any = 0


@pytest.mark.parametrize(
    "map_like",
    [
        Map(),
        SimpleNamespace(vertices=((0,), (1,)), edges=((0, 1),), marker=1),
        {"vertices": [[8], [-3]], "edges": [[8, -3]], "marker": 8, "cost": 12},
        Map(edges={frozenset({0, 1})}),  # an edge has no order
        Map(vertices={"a": [0], "b": [1]}.values()),
        Map(np.array([[0], [1]]), np.array([[0, 1]]), np.int8(1)),
        Map([[np.int64(0)], [np.uint8(1)]]),
        EDGE,
    ],
    ids=["object", "namespace", "mapping", "sets", "view", "arrays", "numpy integers", "world"],
)
def test_anything_with_vertices_edges_and_marker_is_a_map(map_like: object) -> None:
    assert World.from_map(map_like).is_isomorphic(EDGE)


def test_the_map_without_a_dart_is_a_map() -> None:
    assert World.from_map(Map([[]], [], None)).id == "m0/0"


def test_an_integer_too_long_to_be_shown_is_refused_without_being_shown() -> None:
    with pytest.raises(InputError, match=r"expected a list of darts .* vertices\[0\]"):
        World.from_map(Map([[10**5000]]))


@pytest.mark.parametrize("nonsense", [None, 5, "map", [], {}, {"vertices": [[0, 1]]}, object()])
def test_what_lacks_a_part_is_no_map(nonsense: object) -> None:
    with pytest.raises(InputError, match=r"has no '(vertices|edges)'; expected a map with"):
        World.from_map(nonsense)


@pytest.mark.parametrize(
    "vertices",
    [None, 5, "01", b"01", {0: [0, 1]}, iter([[0, 1]]), np.array(5)],
    ids=["None", "int", "str", "bytes", "mapping", "iterator", "array without a dimension"],
)
def test_vertices_and_edges_are_lists(vertices: object) -> None:
    with pytest.raises(InputError, match="list of lists of darts as the map's 'vertices'"):
        World.from_map(Map(vertices))
    with pytest.raises(InputError, match="list of lists of darts as the map's 'edges'"):
        World.from_map(Map(edges=vertices))


@pytest.mark.parametrize(
    "row",
    [
        None,
        0,
        "01",
        [True, 0],
        [0.0, 1.0],
        ["0", "1"],
        [None, 0],
        [[0], [1]],
        [2**63, 0],
        np.array([0.0, 1.0]),
        [np.array([1.5]), 0],
    ],
    ids=lambda row: type(row).__name__,
)
def test_a_vertex_or_an_edge_is_a_list_of_integers(row: object) -> None:
    with pytest.raises(InputError, match=r"expected a list of darts .* vertices\[1\]"):
        World.from_map(Map([[0], row]))
    with pytest.raises(InputError, match=r"expected a list of darts .* edges\[0\]"):
        World.from_map(Map(edges=[row]))


def test_a_set_is_no_rotation_because_it_has_no_order() -> None:
    with pytest.raises(InputError, match=r"expected a list of darts .* vertices\[0\]"):
        World.from_map(Map([{0, 1}]))


@pytest.mark.parametrize("marker", ["0", 0.0, True, [0], 2**63])
def test_a_marker_is_a_dart_or_none(marker: object) -> None:
    with pytest.raises(InputError, match=r"expected a dart .* as the map's 'marker'"):
        World.from_map(Map(marker=marker))


def test_a_part_that_may_be_missing_has_a_default() -> None:
    assert optional_part({"cost": 3}, "cost") == 3
    assert optional_part(SimpleNamespace(cost=3), "cost") == 3
    assert optional_part(Map(), "cost") is None
    assert optional_part({}, "cost", 7) == 7
