r"""The totals of large searches in one small table, kept in docs/data/totals.csv.

    topo-verify search basic --edges 9 --engine compiled --keep-going --worst \
        --ledger basic9.ledger --format json > basic9.json
    python -m research.totals basic9.json > docs/data/totals.csv

A row is one algorithm in all worlds of one size: worlds, failing, undecided, the highest cost, the
number of worlds with it, the first of them, the sum of costs. Of equal rows the first file counts.
"""

from __future__ import annotations

import argparse
import csv
import json
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import Any

HEAD = (
    *("algorithm", "edges", "worlds", "failing", "undecided"),
    *("max_cost", "attained", "first", "total_cost"),
)


def rows(results: Iterable[dict[str, Any]]) -> Iterable[tuple[Any, ...]]:
    for result in results:
        if result["class"] != "any":
            raise SystemExit(f"expected a search of class any, got {result['class']}")
        for size in result["by_edges"]:
            if size["checked"] != size["total"]:
                raise SystemExit(f"{result['target']}: not all worlds were examined")
            fields = (size[name] for name in ("edges", "checked", "failing", "undecided"))
            highest = (size["max_cost"], size["attained"], size["worst"][0], size["total_cost"])
            yield result["target"], *fields, *highest


def main() -> None:
    row_of: dict[tuple[str, int], tuple[Any, ...]] = {}
    ask = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    ask.add_argument("files", type=Path, nargs="+", help="JSON of `topo-verify search`")
    for path in ask.parse_args().files:
        for row in rows(json.loads(path.read_text())["results"]):
            row_of.setdefault((row[0], row[1]), row)
    table = csv.writer(sys.stdout, lineterminator="\n")
    table.writerow(HEAD)
    table.writerows(row_of.values())


if __name__ == "__main__":
    main()
