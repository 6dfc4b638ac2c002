"""Path data and crossings of polylines."""

from __future__ import annotations

import numpy as np
import pytest

from topo_verify.pictures.drawing import curves
from topo_verify.pictures.drawing.arrays import Floats
from topo_verify.pictures.drawing.curves import crossings

pytestmark = pytest.mark.no_cover  # drawing is not trusted: it is left out of the measure


@pytest.mark.parametrize(
    ("value", "text"), [(1.0, "1"), (0.125, "0.12"), (-0.001, "0"), (100.0, "100"), (-2.5, "-2.5")]
)
def test_a_coordinate_has_two_decimals_at_most(value: float, text: str) -> None:
    assert curves.number(value) == text


def test_path_data_is_read_as_it_was_written() -> None:
    points = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)]
    assert curves.flatten(curves.straight(points)).tolist() == [list(p) for p in points]
    round_one = curves.flatten(curves.smooth(points))
    assert round_one[0].tolist() == [0, 0]
    assert round_one[-1].tolist() == [10, 10]
    # The corner is cut on the inner side, not left out.
    assert 0 < float(np.hypot(*(round_one - (10, 0)).T).min()) < 5


def test_a_piece_of_a_line_has_the_length_that_was_asked_for() -> None:
    line = np.array([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)])
    found = curves.flatten(curves.piece(line, 10, 3))
    assert found.tolist() == [[7, 0], [10, 0], [10, 3]]
    assert curves.length(found) == 6


def test_crossings_are_found_and_corners_are_none() -> None:
    bent = np.array([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)])
    across = np.array([(5.0, -5.0), (5.0, 5.0)])
    (found,) = crossings([bent, across])
    assert (found.first, found.second, found.at) == (0, 1, (5, 0))
    assert (found.along_first, found.along_second) == (5, 5)
    assert crossings([bent]) == []
    assert crossings([]) == []


def test_a_curve_that_crosses_itself_is_seen() -> None:
    knot = np.array([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (5.0, 10.0), (5.0, -5.0)])
    (found,) = crossings([knot])
    assert (found.first, found.second) == (0, 0)
    assert found.at == (5, 0)


def test_crossings_far_apart_in_size_are_found() -> None:
    random = np.random.default_rng(1)
    lines = [random.uniform(0, 100, (2, 2)) for _ in range(60)]

    def side(line: Floats, p: Floats) -> bool:
        a, b = line
        return bool((b[0] - a[0]) * (p[1] - a[1]) > (b[1] - a[1]) * (p[0] - a[0]))

    expected = sum(
        side(p, q[0]) != side(p, q[1]) and side(q, p[0]) != side(q, p[1])
        for k, p in enumerate(lines)
        for q in lines[:k]
    )
    assert len(crossings(lines)) == expected > 100
