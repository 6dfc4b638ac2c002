"""The paragraph under a figure says what the points say, and changes with them."""

from __future__ import annotations

import msgspec

from tests.extra.figures.rows import made_up, rows_of
from topo_verify.campaign.row import Row
from topo_verify.extra.figures.figures import FIGURES, PAIRS, FigureExtent, PolicyPair
from topo_verify.extra.figures.points import FigurePoint, PlannedRun, figure_points
from topo_verify.extra.figures.words import judged_sentence, page, paragraph


def points(
    name: str, costs: dict[str, int], policies: tuple[PolicyPair, ...] = (PAIRS[0],)
) -> list[FigurePoint]:
    """Points whose mean is the cost of their algorithm, times their size."""
    figure, extent = FIGURES[name], FigureExtent(graphs=2, quick=True, policies=policies)

    def made(run: PlannedRun, _number: int) -> Row:
        size = int(run.world.partition("(")[2].partition(",")[0])
        cost = size * costs.get(run.algorithm, 50) + (run.pick == "last")
        return made_up(run, cost, size * size, size)

    return figure_points(figure, extent, rows_of(figure, extent, made))


def said(name: str, costs: dict[str, int]) -> str:
    return paragraph(FIGURES[name], points(name, costs))


def test_what_is_stated_stands_beside_what_was_measured() -> None:
    text = said("6d", {"basic": 210, "enhancement-iii-all": 90})
    assert (
        "at 10×10 the paper states 14,000 edge traversals for basic, measured are 2,100 ± 0,"
        in text
    )
    assert "about 4,500 edge traversals for III all, measured are 900 ± 0, 20 % of that" in text
    assert "No size here has a basic mean of 14,000 or more." in text


def test_the_first_size_that_costs_what_the_paper_states_is_named() -> None:
    text = said("6a", {"basic": 1800, "enhancement-i": 90})
    assert "The first size here whose basic mean reaches 14,000 is 8×8." in text


def test_an_enhancement_that_costs_less_agrees_and_one_that_costs_more_does_not() -> None:
    assert "Agrees: I costs less than basic" in said("6a", {"basic": 200, "enhancement-i": 90})
    text = said("6a", {"basic": 90, "enhancement-i": 200})
    assert "Does not agree: the paper says that I costs less than basic" in text
    assert "at 0 of 4 sizes, and costs more at size 4, 6, 8, 10." in text
    text = said("6a", {"basic": 90, "enhancement-i": 90})
    assert "at 0 of 4 sizes, and costs the same at size 4, 6, 8, 10." in text
    assert "Agrees" not in text


def test_where_an_enhancement_costs_the_same_at_some_sizes_it_is_said_at_how_many_it_agrees() -> (
    None
):
    figure = FIGURES["6a"]
    equal = [point for point in points("6a", {"basic": 90, "enhancement-i": 90}) if point.size < 8]
    less = [point for point in points("6a", {"basic": 90, "enhancement-i": 9}) if point.size >= 8]
    text = paragraph(figure, [*equal, *less])
    assert "Agrees:" not in text
    assert "at 2 of 4 sizes, and costs the same at size 4, 6." in text


def test_one_figure_is_compared_with_another() -> None:
    weaker = points("6b", {"basic": 200, "enhancement-ii": 80})
    stronger = points("6c", {"basic": 200, "enhancement-iii-one": 90})
    assert "III one costs less than II" not in paragraph(FIGURES["6c"], stronger)
    text = paragraph(FIGURES["6c"], stronger, [*weaker, *stronger])
    assert "Does not agree: the paper says that III one costs less than II" in text


def test_exponents_and_yardsticks_are_said() -> None:
    text = said("3", {"basic": 40, "folding": 20})
    assert "basic 0.50 ± 0.00, folding 0.50 ± 0.00" in text  # cost ~ size, m ~ size²
    assert "basic pays 40.0 times that least cost, folding 20.0 times" in text


def test_the_spread_over_policies_names_its_ends() -> None:
    pairs = (PAIRS[0], PolicyPair("last", "newest"))
    text = paragraph(FIGURES["3"], points("3", {"basic": 40}, pairs))
    assert "basic costs 400 (nearest/shortest) to 401 (last/newest) at size 10." in text


def test_what_was_judged_is_said_and_a_run_of_two_figures_counts_once() -> None:
    both = [*points("3", {}), *points("6a", {})]
    assert judged_sentence(both) == "24 runs were judged: 10 of 10 claims held in each."


def test_runs_of_which_fewer_claims_were_asked_are_counted_apart() -> None:
    few = msgspec.structs.replace(points("6a", {})[0], size=100, held=2, of=2)
    text = judged_sentence([*points("3", {}), few])
    assert (
        text
        == "18 runs were judged: of those asked held 10 of 10 claims in 16, 2 of 2 claims in 2."
    )


def test_the_page_has_every_paragraph_and_the_command() -> None:
    found = [(FIGURES[name], points(name, {"basic": 200})) for name in ("3", "6a")]
    text = page(found, command="topo-verify reproduce", judged="judged.")
    assert "    topo-verify reproduce\n" in text
    assert text.count("\n## Figure ") == 2
    assert "(figure-6a.svg)" in text
