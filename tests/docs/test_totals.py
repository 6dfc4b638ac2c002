"""docs/data/totals.csv and the table made of it: what can be computed here again is the same."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

from tests.small_rows import SmallRows, costs
from topo_verify import World, explore
from topo_verify.world.enumeration import rank_order

DOCS = Path(__file__).parent.parent.parent / "docs"

with (DOCS / "data" / "totals.csv").open(newline="") as file:
    ROWS = list(csv.DictReader(file))

NAMES = list(dict.fromkeys(row["algorithm"] for row in ROWS))


@pytest.mark.parametrize("name", NAMES)
def test_the_totals_of_small_sizes_are_those_of_the_reference(
    name: str, small_rows: SmallRows
) -> None:
    for row in (row for row in ROWS if row["algorithm"] == name and int(row["edges"]) <= 4):
        paid = costs(small_rows[name], int(row["edges"]))
        assert (int(row["max_cost"]), int(row["attained"])) == (max(paid), paid.count(max(paid)))
        assert row["first"] == f"m{row['edges']}/{paid.index(max(paid))}"
        assert int(row["total_cost"]) == sum(paid)


def test_each_row_speaks_of_all_worlds_and_no_claim_fails() -> None:
    for row in ROWS:
        assert int(row["worlds"]) == rank_order.count(int(row["edges"]))
        assert row["failing"] == row["undecided"] == "0"


def test_the_dearest_world_costs_what_is_said() -> None:
    for row in ROWS:
        assert explore(World.from_id(row["first"]), row["algorithm"]).cost == int(row["max_cost"])


SHOWN = ("basic", "enhancement-i", "enhancement-iii-all+i")


def test_the_table_of_the_findings_is_made_of_the_totals() -> None:
    text = (DOCS / "findings.md").read_text(encoding="utf-8")
    for edges in range(6, 10):
        rows = {row["algorithm"]: row for row in ROWS if row["edges"] == str(edges)}
        shown = [rows.get(name) for name in SHOWN]
        highest = [row["max_cost"] if row else "-" for row in shown]
        means = [f"{mean(row):.2f}" if row else "-" for row in shown]
        cells = [str(edges), str(rank_order.count(edges)), *highest, *means]
        assert f"| {' | '.join(cells)} |" in text


def mean(row: dict[str, str]) -> float:
    """The mean cost of a row."""
    return int(row["total_cost"]) / int(row["worlds"])
