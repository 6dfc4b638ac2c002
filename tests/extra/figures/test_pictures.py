"""The pictures: the same bytes each time, every line named, the paper's numbers as marks."""

from __future__ import annotations

import re
from itertools import pairwise

import pytest

from tests.extra.figures.rows import made_up, rows_of
from topo_verify.extra.figures.figures import FIGURES, PAIRS, FigureExtent
from topo_verify.extra.figures.pictures import LINES, picture, spread
from topo_verify.extra.figures.points import FigurePoint, figure_points
from topo_verify.extra.figures.words import SHORT

FIGURE = FIGURES["6d"]


def points(extent: FigureExtent | None = None) -> list[FigurePoint]:
    """Made-up points: each line costs a little more than the one before it."""
    extent = extent or FigureExtent(graphs=2, quick=True)
    runs = rows_of(FIGURE, extent, lambda run, k: made_up(run, 100 + k, 10 + k % 9))
    return figure_points(FIGURE, extent, runs)


def words(svg: bytes) -> set[str]:
    """Every text of the picture: glyphs are paths, and a comment before them has the words."""
    return set(re.findall(r"<!-- (.*?) -->", svg.decode()))


@pytest.mark.long
def test_every_line_and_axis_is_named_and_the_stated_costs_are_marked() -> None:
    found = words(picture(FIGURE, points(), "svg"))
    assert {SHORT[name] for name in (*FIGURE.lines, "edges", "least-cost")} <= found
    assert {"paper, basic: 14,000", "paper, III all: about 4,500"} <= found
    assert {"cost (edge traversals)", "side of the lattice (nodes before holes)"} <= found


def test_without_the_point_there_is_no_mark() -> None:
    small = [point for point in points() if point.size < 10]
    assert not [text for text in words(picture(FIGURE, small, "svg")) if "paper" in text]


@pytest.mark.long
def test_the_same_points_give_the_same_bytes_with_no_date() -> None:
    first, second = (picture(FIGURE, points(), "svg") for _ in range(2))
    assert first == second
    assert b"dc:date" not in first
    assert b'[style*="fill: #fdfcf9"]{fill:#14181c!important}' in first  # the card of a dark page
    assert picture(FIGURE, points(), "png").startswith(b"\x89PNG")


def test_the_spread_over_policies_is_drawn_and_said() -> None:
    extent = FigureExtent(graphs=2, quick=True, policies=PAIRS)
    found = words(picture(FIGURE, points(extent), "svg"))
    assert "thick bars: lowest to highest mean over 10 pairs of policies" in found


def test_every_line_has_a_style_and_no_two_in_one_figure_look_alike() -> None:
    for figure in FIGURES.values():
        styles = [LINES[name] for name in (*figure.lines, "edges", "least-cost")]
        assert len({*styles}) == len(styles)


@pytest.mark.parametrize(
    "places", [[0.0], [1.0, 1.0, 1.0], [0.0, 0.1, 5.0], [3.0, 2.9, 2.8, 1.0], [0.0, 1.1, 0.2, 1.0]]
)
def test_labels_keep_apart_and_keep_their_order(places: list[float]) -> None:
    moved = spread(places, 1.0)
    order = sorted(range(len(places)), key=lambda k: (places[k], k))
    assert all(moved[b] - moved[a] >= 1.0 - 1e-9 for a, b in pairwise(order))
    assert sum(moved) == pytest.approx(sum(places))


def test_labels_that_are_far_apart_stay() -> None:
    assert spread([5.0, 0.0, 2.0], 1.0) == [5.0, 0.0, 2.0]
