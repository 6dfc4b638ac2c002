"""Means, standard errors, growth and CSV, by hand; and the files in docs/figures."""

from __future__ import annotations

import csv
from collections import defaultdict
from math import sqrt
from pathlib import Path

import pytest
from msgspec.structs import replace

from tests.extra.figures.rows import made_up, measured, planned_runs, rows_of
from tests.helpers import some
from tests.marks import with_marks
from topo_verify.campaign.row import Row
from topo_verify.extra.figures import points as pts
from topo_verify.extra.figures.figures import FIGURES, PAIRS, FigureExtent
from topo_verify.extra.figures.words import LADDER

DOCS = Path(__file__).resolve().parents[3] / "docs" / "figures"

KEPT = {"lattice": (DOCS / "lattices", 30), "dense": (DOCS / "dense", 30)}
"""Where the files of each family of graphs are, and with how many graphs a point they were made."""

FIGURE = FIGURES["3"]
EXTENT = FigureExtent(graphs=3, quick=True)


def rows(extent: FigureExtent = EXTENT) -> dict[pts.PlannedRun, Row]:
    """Made-up runs: graph k of a point costs 100 + k times 10."""
    return rows_of(FIGURE, extent, lambda run, k: made_up(run, 100 + 10 * (k % extent.graphs)))


def test_a_point_is_the_mean_and_its_standard_error() -> None:
    first = pts.figure_points(FIGURE, EXTENT, rows())[0]
    assert (first.algorithm, first.size, first.graphs) == ("basic", 4, 3)
    assert (first.mean, first.stderr) == (110, round(10 / sqrt(3), 2))
    assert (first.edges, first.held, first.of) == (10, 10, 10)


def test_yardsticks_come_last_and_are_of_the_same_graphs() -> None:
    *_, edges, least = [p for p in pts.figure_points(FIGURE, EXTENT, rows()) if p.size == 10]
    assert (edges.algorithm, edges.mean, edges.stderr, edges.pick) == ("edges", 10, 0, None)
    assert (least.algorithm, least.mean) == ("least-cost", 20)


def test_what_the_paper_states_stands_at_its_point_alone() -> None:
    extent = FigureExtent(graphs=3, quick=True, policies=PAIRS)
    stated = [p for p in pts.figure_points(FIGURE, extent, rows(extent)) if p.paper is not None]
    assert [(p.algorithm, p.size, p.paper, p.stated, p.pick) for p in stated] == [
        ("basic", 10, 10000, "more than 10,000", "nearest")
    ]


def test_a_point_that_lacks_a_run_is_left_out() -> None:
    runs = rows()
    del runs[next(run for run in runs if run.algorithm == "folding")]
    points = pts.figure_points(FIGURE, EXTENT, runs)
    assert [p.size for p in points if p.algorithm == "folding"] == [6, 8, 10]


def test_an_undecided_run_counts_as_undecided_and_not_as_a_cost() -> None:
    runs = rows()
    run = next(iter(runs))
    runs[run] = replace(made_up(run, 0), undecided="out of time")
    first = pts.figure_points(FIGURE, EXTENT, runs)[0]
    assert (first.graphs, first.undecided, first.mean) == (2, 1, 115)


def test_the_exponent_of_a_power_is_found_exactly() -> None:
    fit = some(pts.growth([(m, 7 * m**1.5) for m in (10, 20, 40, 80)]))
    assert (fit.exponent, fit.stderr, fit.points) == (1.5, 0, 4)


def test_the_standard_error_is_that_of_the_slope() -> None:
    # log cost = log m ± 0.1 at log m = 0, 1, 2, 3: residuals by hand, Σ(x - x̄)² = 5.
    from math import exp

    fit = pts.growth([(exp(x), exp(x + y)) for x, y in ((0, 0.1), (1, -0.1), (2, -0.1), (3, 0.1))])
    assert fit is not None
    assert fit.exponent == 1
    assert fit.stderr == round(sqrt(0.04 / 2 / 5), 4)


def test_two_sizes_have_no_standard_error_and_one_has_no_exponent() -> None:
    assert str(pts.growth([(10, 10), (20, 40)])) == "2.00"
    assert pts.growth([(10, 10), (10, 12)]) is None


def test_csv_has_a_row_a_point() -> None:
    points = pts.figure_points(FIGURE, EXTENT, rows())
    lines = pts.points_csv(points).splitlines()
    assert lines[0] == "figure,algorithm,pick,order,size,graphs,edges,mean,stderr,paper"
    assert lines[1] == "3,basic,nearest,shortest,4,3,10.00,110.00,5.77,"
    assert lines[4] == "3,basic,nearest,shortest,10,3,10.00,110.00,5.77,10000"
    assert lines[-1] == "3,least-cost,,,10,3,10.00,20.00,0.00,"
    assert len(lines) == 1 + len(points)


# ---------------------------------------------------------------- docs/figures


@pytest.mark.parametrize(
    "name", with_marks(FIGURES, long=["6a", "6b", "6c", "6d"], nightly=["6e", "6f"])
)
def test_the_points_in_docs_are_those_that_this_code_makes(name: str) -> None:
    """The smallest size of each line, recomputed and compared to the byte."""
    figure = FIGURES[name]
    folder, graphs = KEPT[figure.setting.name]
    extent = FigureExtent(graphs)
    worlds = {*extent.worlds(figure.setting, min(figure.setting.sizes))}
    planned = [run for run in planned_runs([figure], extent) if run.world in worlds]
    made = pts.points_csv(
        pts.figure_points(figure, extent, {run: measured(run) for run in planned})
    )
    lines = made.splitlines()[1:]
    assert len(lines) == len(figure.lines) + 2
    assert {*lines} <= {*(folder / f"figure-{name}.csv").read_text().splitlines()}


def means(setting: str) -> dict[int, dict[str, float]]:
    """The mean costs in docs/figures, by size and algorithm."""
    found = defaultdict[int, dict[str, float]](dict)
    for path in KEPT[setting][0].glob("figure-*.csv"):
        for point in csv.DictReader(path.read_text().splitlines()):
            found[int(point["size"])][point["algorithm"]] = float(point["mean"])
    return found


@pytest.mark.parametrize(
    ("setting", "size", "percent"),
    [("lattice", 10, 49), ("lattice", 20, 69), ("dense", 20, 53), ("dense", 100, 82)],
)
def test_all_level_enhancement_iii_saves_as_much_as_the_pages_say(
    setting: str, size: int, percent: int
) -> None:
    costs = means(setting)[size]
    assert round(100 * (1 - costs["enhancement-iii-all"] / costs["basic"])) == percent


@pytest.mark.parametrize("setting", KEPT)
def test_in_the_mean_no_enhancement_costs_more_than_the_one_before_it(setting: str) -> None:
    for costs in means(setting).values():
        ladder = [costs[name] for name in LADDER]
        assert ladder == sorted(ladder, reverse=True)


@pytest.mark.parametrize("setting", KEPT)
def test_the_growth_in_docs_is_that_of_the_points_in_docs(setting: str) -> None:
    folder, _ = KEPT[setting]
    kept = list(csv.DictReader((folder / "growth.csv").read_text().splitlines()))
    assert len(kept) == 11  # nine algorithms and two yardsticks
    points = [
        point
        for path in folder.glob("figure-*.csv")
        for point in csv.DictReader(path.read_text().splitlines())
    ]
    for fit in kept:
        line = {p["size"]: p for p in points if p["algorithm"] == fit["algorithm"]}.values()
        found = some(pts.growth([(float(p["edges"]), float(p["mean"])) for p in line]))
        assert (f"{found.exponent:.4f}", f"{found.stderr:.4f}") == (fit["exponent"], fit["stderr"])


def test_growth_csv_has_each_line_once() -> None:
    points = pts.figure_points(
        FIGURE, EXTENT, {r: made_up(r, 100, 10 + len(r.world)) for r in rows()}
    )
    text = pts.growth_csv([*points, *points], {"3": "lattice"})
    assert text.splitlines()[0] == "graphs_of,algorithm,pick,order,exponent,stderr,points"
    assert [line.split(",")[1] for line in text.splitlines()[1:]] == [
        "basic", "folding", "edges", "least-cost",
    ]  # fmt: skip
