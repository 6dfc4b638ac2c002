"""The figures as data: what `--figure` names, which runs a figure needs."""

from __future__ import annotations

import pytest

from tests.extra.figures.rows import planned_runs
from topo_verify import CATALOGUE, InputError
from topo_verify.extra.figures import figures


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("all", [*figures.FIGURES]),
        ("6", ["6a", "6b", "6c", "6d", "6e", "6f"]),
        ("6d, 3", ["3", "6d"]),
        ("6A,6a", ["6a"]),
    ],
)
def test_figures_are_named_as_in_the_paper(text: str, names: list[str]) -> None:
    assert [figure.name for figure in figures.chosen_figures(text)] == names


@pytest.mark.parametrize("text", ["4", "6g", "", "3,", "al"])
def test_another_figure_is_refused(text: str) -> None:
    with pytest.raises(InputError, match="expected all, 6 or one of 3, 6a"):
        figures.chosen_figures(text)


def test_together_the_figures_have_every_algorithm_that_is_right_everywhere() -> None:
    general = {name for name, algorithm in CATALOGUE.items() if algorithm.assumes is None}
    lattices = [figure for figure in figures.FIGURES.values() if figure.setting.name == "lattice"]
    dense = [figure for figure in figures.FIGURES.values() if figure.setting.name == "dense"]
    assert {name for figure in lattices for name in figure.lines} == general
    assert {name for figure in dense for name in figure.lines} == general


def test_a_run_that_two_figures_share_is_made_once() -> None:
    extent = figures.FigureExtent(graphs=2, quick=True)
    runs = planned_runs(figures.chosen_figures("3,6a"), extent)
    assert len(runs) == len({*runs}) == 4 * 3 * 2  # sizes, lines, graphs


def test_two_seeds_share_no_graph() -> None:
    figure = figures.FIGURES["3"]
    first, second = (
        set(figures.FigureExtent(seed=seed).worlds(figure.setting, 4)) for seed in (0, 1)
    )
    assert len(first) == len(second) == 30
    assert not first & second


def test_the_pairs_of_policies_differ_and_have_the_reference() -> None:
    assert len({*figures.PAIRS}) == len(figures.PAIRS) == 10
    assert figures.REFERENCE in figures.PAIRS
