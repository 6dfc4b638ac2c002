"""Means with confidence intervals, over families of worlds that weigh the same.

With F families, of which family f has n worlds, mean x and variance s² (of the sample), the mean is
that of the family means, and its standard error the root of Σ s²/n over F. An **exact** family,
every world of a finite class, has no error of sampling. The interval is Student's, at 95 %; its
degrees of freedom are those of B. L. Welch (Biometrika 34, 1947): (Σ a)² / Σ (a² / (n-1)) with
a = s²/n. With one family they are n - 1.

Of two mappers the differences in the same worlds are taken first (**paired**): what makes a world
dear for both drops out.

What this does not show: where a family's ratios are far from normal and its worlds are few, 95 % is
an approximation. A family of one drawn world has no interval.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from statistics import fmean, variance
from typing import NamedTuple

import msgspec

LEVEL = 0.95
"""The share of intervals that hold the true mean."""


class MeanInterval(msgspec.Struct, frozen=True):
    """A mean and its confidence interval; `low` and `high` are null where there is none.

    Attributes:
        mean, low, high: the mean, and the ends of its interval.
    """

    mean: float
    low: float | None
    high: float | None


class FamilySample(NamedTuple):
    """The values of one family; `exact`: of every world of a finite class."""

    values: Sequence[float]
    exact: bool


def mean_interval(families: Sequence[FamilySample]) -> MeanInterval:
    """The mean over families, and its interval. Each family has one value at least."""
    mean = fmean(fmean(family.values) for family in families)
    sampled = [family.values for family in families if not family.exact]
    if any(len(values) < 2 for values in sampled):
        return MeanInterval(_rounded(mean), None, None)
    errors = [variance(values) / len(values) for values in sampled]
    total = sum(errors)
    if total == 0:
        return MeanInterval(_rounded(mean), _rounded(mean), _rounded(mean))
    shares = (e**2 / (len(v) - 1) for e, v in zip(errors, sampled, strict=True))
    reach = student(total**2 / sum(shares)) * sqrt(total) / len(families)
    return MeanInterval(_rounded(mean), _rounded(mean - reach), _rounded(mean + reach))


def _rounded(value: float) -> float:
    # So that a sum taken in another order, on another machine, prints the same digits.
    return round(value, 6) + 0.0


def student(freedom: float) -> float:
    """The 97.5 % quantile of Student's t distribution; `freedom` is 1 or more.

    A fraction of a degree is left out, which makes the interval a little wider.
    """
    import scipy.special  # type: ignore[import-untyped]  # pyright: ignore[reportMissingTypeStubs]

    return float(scipy.special.stdtrit(int(freedom), (1 + LEVEL) / 2))
