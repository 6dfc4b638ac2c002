"""What every algorithm does in every world to four edges: rows that many statements are about.

They are made once for all workers of pytest, by the first one that asks; ten seconds of work.
"""

from __future__ import annotations

import fcntl
import os
from pathlib import Path

import msgspec
import pytest

from topo_verify.algorithms import NAMED
from topo_verify.campaign.backend import here
from topo_verify.campaign.campaign import Campaign, Ranks, results
from topo_verify.campaign.row import Row

SmallRows = dict[str, list[Row]]
"""The rows of each algorithm, in the order of the worlds."""


def _made(file: Path) -> bytes:
    """The rows of the file, as JSON; whoever comes first makes it."""
    with file.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not file.exists():
            campaign = Campaign(worlds=Ranks(4), mappers=tuple(NAMED))
            rows = [row for _, result in results(campaign, here()) for row in result.rows]
            file.write_bytes(msgspec.json.encode(rows))
    return file.read_bytes()


@pytest.fixture(scope="session")
def small_rows(tmp_path_factory: pytest.TempPathFactory) -> SmallRows:
    """What every algorithm does in every world to four edges."""
    folder = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        folder = folder.parent  # that of all workers
    rows: SmallRows = {name: [] for name in NAMED}
    for row in msgspec.json.decode(_made(folder / "small_rows.json"), type=list[Row]):
        rows[row.mapper].append(row)
    return rows


def costs(rows: list[Row], edges: int) -> list[int]:
    """What the worlds of one size cost, in the order of their ranks."""
    return [row.cost for row in rows if row.edges == edges]
