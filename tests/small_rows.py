"""What every algorithm does in every world to four edges: rows that many statements are about.

They are made once for all workers of pytest, by the first one that asks; ten seconds of work.
"""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from tests.helpers import made_once
from topo_verify.algorithms import NAMED
from topo_verify.campaign.backend import here
from topo_verify.campaign.campaign import Campaign, Ranks, results
from topo_verify.campaign.row import Row

SmallRows = dict[str, list[Row]]
"""The rows of each algorithm, in the order of the worlds."""


def _make(folder: Path) -> None:
    campaign = Campaign(worlds=Ranks(4), mappers=tuple(NAMED))
    rows = [row for _, result in results(campaign, here()) for row in result.rows]
    (folder / "rows.json").write_bytes(msgspec.json.encode(rows))


@pytest.fixture(scope="session")
def small_rows(tmp_path_factory: pytest.TempPathFactory) -> SmallRows:
    """What every algorithm does in every world to four edges."""
    folder = made_once(tmp_path_factory, "small_rows", _make)
    rows: SmallRows = {name: [] for name in NAMED}
    for row in msgspec.json.decode((folder / "rows.json").read_bytes(), type=list[Row]):
        rows[row.mapper].append(row)
    return rows


def costs(rows: list[Row], edges: int) -> list[int]:
    """What the worlds of one size cost, in the order of their ranks."""
    return [row.cost for row in rows if row.edges == edges]
