"""Means and intervals, against a library and by hand."""

from __future__ import annotations

from math import sqrt
from statistics import stdev
from typing import Any

import pytest

from topo_verify.extra.arena.league import FamilySample, mean_interval, student

VALUES = [1.0, 2.0, 4.0, 7.0]


@pytest.mark.parametrize("degrees", [*range(1, 41), 100, 1000])
def test_the_quantiles_are_those_of_scipy(degrees: int) -> None:
    stats: Any = pytest.importorskip("scipy.stats")
    assert student(degrees) == pytest.approx(stats.t.ppf(0.975, degrees), abs=1e-9)


def test_a_fraction_of_a_degree_makes_no_interval_narrower() -> None:
    assert student(2.9) == student(2)
    assert student(31.5) == student(31)


def test_one_family_has_the_interval_of_student() -> None:
    found = mean_interval([FamilySample(VALUES, exact=False)])
    reach = student(3) * stdev(VALUES) / sqrt(4)
    assert found.mean == 3.5
    assert (found.low, found.high) == pytest.approx((3.5 - reach, 3.5 + reach), abs=1e-5)


def test_families_weigh_the_same_and_an_exact_one_adds_no_error() -> None:
    alone = mean_interval([FamilySample(VALUES, exact=False)])
    both = mean_interval([FamilySample(VALUES, exact=False), FamilySample([1.5] * 90, exact=True)])
    assert both.mean == 2.5
    assert both.low is not None
    assert alone.low is not None
    assert both.mean - both.low == pytest.approx((alone.mean - alone.low) / 2, abs=1e-5)


def test_every_world_of_a_class_has_no_error_and_one_drawn_world_no_interval() -> None:
    exact = mean_interval([FamilySample(VALUES, exact=True)])
    assert (exact.low, exact.high) == (3.5, 3.5)
    one = mean_interval([FamilySample([2.0], exact=False)])
    assert (one.mean, one.low, one.high) == (2.0, None, None)
