"""Where each seeded fault is found: the table of docs/data, and what the tests compare with it.

.venv/bin/python -m tests.faults.table > docs/data/tables/faults.csv        # four minutes

With names of faults: their rows alone.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Callable, Sequence
from functools import cache
from itertools import islice
from pathlib import Path
from statistics import median
from typing import NamedTuple

import topo_verify as tv
from tests.faults.every import EVERY
from topo_verify.faults import Fault
from topo_verify.strategies.sample import resolve_strategy, sample
from topo_verify.world.enumeration import rank_order

FILE = Path(__file__).parents[2] / "docs" / "data" / "tables" / "faults.csv"

COUNTED, LARGEST = 5, 7
"""Most edges of worlds in which all failing ones are counted; in which the first is looked for."""

LARGEST_HARMLESS = 4

SEEDS = range(5)
EXAMPLES = 100
STRATEGIES = (
    "worlds(max_edges=30)",
    "worlds(min_edges=16,max_edges=24,max_degree=4,simple=True)",
)
"""Any worlds, mostly small; and street networks whose ways home lead through known places."""


class Row(NamedTuple):
    """A row of the table.

    Attributes:
        claim: the claim that must catch the fault.
        world: the first world of the smallest size in which it does.
        failing: the number of worlds of this size in which any claim fails.
        tests: the number of examples after which a property test fails; see `by_examples`.
        theorem: the theorem with the same mistake, which tests/proofs refutes.
    """

    fault: str
    part: str
    claim: str
    world: str
    failing: str
    tests: str
    theorem: str


# ---------------------------------------------------------------- exhaustive search


class Failing(NamedTuple):
    """The worlds of one size in which a claim fails.

    Attributes:
        number: how many there are.
        first: the first in which the claim fails that must catch the fault; None: it never does.
    """

    number: int
    first: str | None


Engine = Callable[[Fault, int], Failing]


def by_reference(fault: Fault, edges: int) -> Failing:
    """The worlds with this number of edges, judged by the checkers; the first if over `COUNTED`."""
    reports = (tv.examine(fault, world) for world in tv.worlds(edges=edges))
    wrong = (report for report in reports if not report.ok or report.undecided)
    failing = list(islice(wrong, None if edges <= COUNTED else 1))
    caught = (r.world for r in failing if r.claims.get(fault.claim or "") == "failed")
    return Failing(len(failing), next(caught, None))


def by_search(engine: Engine, fault: Fault, largest: int = LARGEST) -> tuple[str, str]:
    """The cells `world` and `failing`: of the smallest size in which a claim fails."""
    for edges in range(1, largest + 1):
        number, first = engine(fault, edges)
        if number and edges > COUNTED:
            return first or "-", "not counted"
        if number:
            return first or "-", f"{number} of {rank_order.count(edges)}"
    return "-", "none"


# ---------------------------------------------------------------- property tests


def by_examples(fault: Fault, seeds: Sequence[int] = SEEDS, most: int = EXAMPLES) -> str:
    """The median number of examples, over the seeds, after which a property test fails.

    The first strategy that finds the fault with every seed counts; an asterisk marks the second.
    """
    for strategy, mark in zip(STRATEGIES, ("", "*"), strict=True):
        numbers = [_first_failing(fault, _drawn(strategy, seed)[:most]) for seed in seeds]
        if all(numbers):
            return f"{round(median(numbers))}{mark}"
    return "none"


@cache
def _drawn(strategy: str, seed: int) -> list[tv.World]:
    return sample(resolve_strategy(strategy), EXAMPLES, start=seed)


def _first_failing(fault: Fault, worlds: Sequence[tv.World]) -> int:
    """The number of the first world in which a property test fails, from 1; 0: in none."""
    for number, world in enumerate(worlds, 1):
        try:
            tv.assert_maps(fault, world)
        except tv.ClaimFailed:
            return number
    return 0


# ---------------------------------------------------------------- the table


def row_of(fault: Fault) -> Row:
    """The row of a fault."""
    world, failing = by_search(by_reference, fault, LARGEST if fault.claim else LARGEST_HARMLESS)
    claim, theorem = fault.claim or "-", fault.theorem or "-"
    return Row(fault.name, fault.part, claim, world, failing, by_examples(fault), theorem)


def stored() -> dict[str, Row]:
    """The rows of docs/data, by fault."""
    with FILE.open(newline="", encoding="utf-8") as file:
        _, *lines = csv.reader(file)
    return {line[0]: Row(*line) for line in lines}


def main() -> None:
    ask = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    ask.add_argument("names", nargs="*", metavar="NAME", help="a fault; by default all of them")
    names: list[str] = ask.parse_args().names
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(Row._fields)
    for name in names or EVERY:
        table.writerow(row_of(EVERY[name]))
        sys.stdout.flush()


if __name__ == "__main__":
    main()
