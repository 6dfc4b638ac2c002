"""Searches in one call, with what the result alone does not tell: rows and tallies."""

from __future__ import annotations

import sqlite3
import time
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any

import msgspec

from topo_verify.campaign.backend import here, pooled
from topo_verify.campaign.campaign import ShardMemory, Stop
from topo_verify.campaign.targets import one_target, targets
from topo_verify.programs.loader import Mapper, Target
from topo_verify.studies.search.search import Search, SearchEntry, search_campaign


def search_of(
    target: Mapper | str | Target,
    *,
    workers: int = 0,
    stop: Stop | None = None,
    store: ShardMemory | None = None,
    **options: Any,
) -> Search:
    """A search that has not begun; `options` are those of `search_campaign`."""
    in_process = options.get("in_process", True)
    mappers = (
        targets(target, in_process=in_process) if isinstance(target, str) else (one_target(target),)
    )
    campaign = search_campaign(mappers, **options)
    if stop is not None:
        campaign = msgspec.structs.replace(campaign, stop=stop)
    return Search(campaign, mappers, pooled(workers) if workers else here(mappers), store)


def searched(target: Mapper | str | Target, **options: Any) -> Search:
    """A search that has gone to its end; see `search_of`."""
    study = search_of(target, **options)
    study.work()
    return study


def json(entry: SearchEntry) -> bytes:
    """What a search found, to be compared byte for byte."""
    return msgspec.json.encode(entry)


def wait_for(there: Callable[[], bool]) -> None:
    """Wait until something is there."""
    for _ in range(6000):
        if there():
            return
        time.sleep(0.01)
    raise AssertionError("nothing came of it in 60 s")


def shards_in(store: Path) -> int:
    """How many shards are in the store of a search at work: read without its lock, from a copy."""
    if not store.exists():
        return 0
    Path("copy").write_bytes(store.read_bytes())
    with closing(sqlite3.connect("copy")) as base:
        try:
            return int(base.execute("SELECT count(*) FROM shards").fetchone()[0])
        except sqlite3.Error:  # in the middle of a transaction
            return 0
