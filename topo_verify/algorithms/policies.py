"""The two policies that the paper leaves open: which edge next, and which hypothesis first.

Every claim holds for every choice; costs differ. `random(seed)` is Python's `random.Random(seed)`,
not promised to implementations in other languages.

Source: docs/semantics.md, section 5.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from random import Random
from typing import TYPE_CHECKING

from topo_verify.algorithms.chart import Chart, Tree
from topo_verify.robot.events import MapDart

if TYPE_CHECKING:
    from topo_verify.robot.events import Policies

Pick = Callable[[Chart, MapDart], MapDart]
"""(S, the robot's reference dart on S) -> the dart of U to explore next."""

Order = Callable[[Iterable[MapDart], Chart, Tree], list[MapDart]]
"""(H, S, the breadth-first tree rooted at v0) -> H in the order in which to try it."""


def nearest(chart: Chart, at: MapDart) -> MapDart:
    """The dart of U whose vertex is nearest on S to the robot; ties: the lowest dart."""
    best: MapDart | None = None
    reach = 0
    for v, distance, _ in chart.outward(chart.vertex[at]):
        if best is not None and distance > reach:
            break
        for dart in chart.darts(v):
            if dart in chart.unexplored:
                if best is None or dart < best:
                    best, reach = dart, distance
                break
    assert best is not None, "U is not empty and S is connected"
    return best


def last(chart: Chart, at: MapDart) -> MapDart:
    """The highest dart of U: depth-first."""
    return next(reversed(chart.unexplored))


def first(chart: Chart, at: MapDart) -> MapDart:
    """The lowest dart of U: breadth-first."""
    return next(iter(chart.unexplored))


def shortest(darts: Iterable[MapDart], chart: Chart, tree: Tree) -> list[MapDart]:
    """H by length of the validation path, then by dart."""
    return sorted(darts, key=lambda h: (tree.depth[chart.vertex[h]], h))


def oldest(darts: Iterable[MapDart], chart: Chart, tree: Tree) -> list[MapDart]:
    """H by dart, ascending."""
    return sorted(darts)


def newest(darts: Iterable[MapDart], chart: Chart, tree: Tree) -> list[MapDart]:
    """H by dart, descending."""
    return sorted(darts, reverse=True)


PICKS = {"nearest": nearest, "last": last, "first": first}
ORDERS = {"shortest": shortest, "oldest": oldest, "newest": newest}


def pick_policy(text: str) -> Pick:
    """The pick policy of this name, for one run.

    Raises:
        ValueError: no such policy.
    """
    if text in PICKS:
        return PICKS[text]
    if (random := _random(text)) is None:
        raise ValueError(f"no pick policy {text!r}: there are {', '.join(PICKS)}, random(SEED)")
    return lambda chart, at: random.choice(list(chart.unexplored))


def order_policy(text: str) -> Order:
    """The order policy of this name, for one run.

    Raises:
        ValueError: no such policy.
    """
    if text in ORDERS:
        return ORDERS[text]
    if (random := _random(text)) is None:
        raise ValueError(f"no order policy {text!r}: there are {', '.join(ORDERS)}, random(SEED)")
    return lambda darts, chart, tree: _shuffled(random, darts)


def check(policies: Policies) -> Policies:
    """The same policies, or a ValueError that lists those that exist."""
    pick_policy(policies.pick)
    order_policy(policies.order)
    return policies


def _random(text: str) -> Random | None:
    match = re.fullmatch(r"random\((\d{1,18})\)", text, re.ASCII)
    return Random(int(match[1])) if match else None


def _shuffled(random: Random, darts: Iterable[MapDart]) -> list[MapDart]:
    row = sorted(darts)
    random.shuffle(row)
    return row
