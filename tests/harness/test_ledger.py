"""The ledger: a search killed at any moment goes on and finds the same."""

# A test may look inside.
# pyright: reportPrivateUsage=false

from __future__ import annotations

import os
import random
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import msgspec
import pytest

from topo_verify import InputError, InternalError, Limits
from topo_verify.harness import ledger as ledgers
from topo_verify.harness.ledger import Ledger
from topo_verify.harness.search.exhaustive import Search, SearchResult, search
from topo_verify.harness.search.plan import SHARD, Plan, Shard
from topo_verify.harness.tally import Tally
from topo_verify.harness.targets import targets

BASIC = Plan(targets=("basic",), edges=4)


@pytest.fixture(autouse=True)
def here(folder: Path) -> Path:
    return folder


def opened(plan: Plan = BASIC, *, path: str = "search.ledger", tool: str = "1") -> Ledger:
    return Ledger(path, plan, targets(",".join(plan.targets)), tool)


def searched(plan: Plan = BASIC, *, workers: int = 0) -> SearchResult:
    """The search of a plan, with the ledger."""
    with opened(plan) as ledger:
        work = Search(plan, targets(",".join(plan.targets)), workers=workers, ledger=ledger)
        work.work()
        return work.found()


def rows() -> list[tuple[int, str, str, int, int]]:
    base = sqlite3.connect("search.ledger")
    try:
        query = "SELECT edges, start, stop, worlds, failing FROM shards ORDER BY edges, start"
        return base.execute(query).fetchall()
    finally:
        base.close()


# ---------------------------------------------------------------- going on


def test_a_search_that_is_done_is_not_done_again(monkeypatch: pytest.MonkeyPatch) -> None:
    once = searched()
    assert once == search("basic", edges=4)
    assert sum(worlds for *_, worlds, _ in rows()) == 792
    monkeypatch.setattr("topo_verify.harness.search.exhaustive.examine_shard", None)
    assert searched() == once


def test_a_search_that_is_done_goes_on_to_larger_worlds() -> None:
    searched(Plan(targets=("basic",), edges=2))
    assert searched() == search("basic", edges=4)


def test_a_counterexample_is_found_in_the_ledger_again() -> None:
    plan = Plan(targets=("mappers.py:forgets",), edges=4)
    once = searched(plan)
    assert once.counterexample is not None
    assert searched(plan) == once == searched(plan, workers=2)


SEARCHER = """
import sys
from topo_verify.harness.search.plan import Plan
from topo_verify.harness.search.exhaustive import Search
from topo_verify.harness.ledger import Ledger
from topo_verify.harness.search.plan import SHARD
from topo_verify.harness.targets import targets
SHARD["reference"] = 15
plan = Plan(targets=("basic",), edges=4)
with Ledger("search.ledger", plan, targets("basic"), "1") as ledger:
    Search(plan, targets("basic"), workers=2, ledger=ledger).work()
"""


def test_killed_at_random_moments_it_ends_with_the_same_totals(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(SHARD, "reference", 15)
    moments = random.Random(5)
    known = 0
    for _ in range(4):
        running = subprocess.Popen([sys.executable, "-c", SEARCHER], stderr=subprocess.DEVNULL)
        size = moments.randrange(2, 12)
        for _ in range(3000):
            if Path("search.ledger").exists() and _shards() >= known + size:
                break
            if running.poll() is not None:
                break
            time.sleep(0.01)
        time.sleep(moments.random() / 20)
        running.send_signal(signal.SIGKILL)
        running.wait()
        assert _shards() >= known
        known = _shards()
    assert known > 0
    assert searched(workers=2) == search("basic", edges=4)


def _shards() -> int:
    """How many shards are in the ledger of a search at work: read without its lock, from a copy."""
    Path("copy").write_bytes(Path("search.ledger").read_bytes())
    base = sqlite3.connect("copy")
    try:
        return int(base.execute("SELECT count(*) FROM shards").fetchone()[0])
    except sqlite3.Error:  # in the middle of a transaction
        return 0
    finally:
        base.close()


# ---------------------------------------------------------------- what does not belong in it


@pytest.mark.parametrize(
    ("plan", "tool", "words"),
    [
        (BASIC, "2", "its tool is 1, now it is 2"),
        (Plan(targets=("folding",), edges=4), "1", "its target is basic, now it is folding"),
        (Plan(targets=("basic",), edges=4, kind="planar"), "1", "its class is any"),
        (Plan(targets=("basic",), edges=4, choices="all"), "1", "its policies is reference"),
        (Plan(targets=("basic",), edges=4, keep_going=True), "1", "its keep-going is no"),
        (Plan(targets=("basic",), edges=4, limits=Limits(9)), "1", "its limits is"),
    ],
)
def test_another_search_is_refused(plan: Plan, tool: str, words: str) -> None:
    opened().__exit__(None, None, None)
    with pytest.raises(InputError, match="is of another search: " + words):
        opened(plan, tool=tool)


def test_a_changed_source_is_refused(here: Path) -> None:
    plan = Plan(targets=("mappers.py:right",), edges=2)
    searched(plan)
    with (here / "mappers.py").open("a") as file:
        file.write("changed = True\n")
    with pytest.raises(InputError, match="the source of the mapper, or of topo-verify, has change"):
        searched(plan)


def test_a_newer_version_is_refused() -> None:
    opened().__exit__(None, None, None)
    _change("UPDATE meta SET value = '2' WHERE key = 'version'")
    with pytest.raises(InputError, match="its version 2 is newer than 1, the newest that this"):
        opened()


@pytest.mark.parametrize("table", ["meta (key, value)", "other (a)"])
def test_another_database_is_refused_and_left_alone(table: str) -> None:
    _change(f"CREATE TABLE {table}")
    before = Path("search.ledger").read_bytes()
    with pytest.raises(InputError, match="is a database, but no ledger: name another file"):
        opened()
    assert Path("search.ledger").read_bytes() == before


def test_a_file_that_is_no_database_is_refused_and_left_alone(here: Path) -> None:
    before = (here / "mappers.py").read_bytes()
    with pytest.raises(InputError, match="it is no ledger: name another file"):
        opened(path="mappers.py")
    assert (here / "mappers.py").read_bytes() == before


def test_a_shard_with_a_wrong_count_is_an_error() -> None:
    with (
        opened() as ledger,
        pytest.raises(InternalError, match="mappers ran in 1 worlds of the sh"),
    ):
        ledger.put(Shard(2, 0, 10), Tally(worlds=1))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("UPDATE shards SET worlds = 3 WHERE edges = 1", "is not what this topo-verify wrote"),
        ("UPDATE shards SET stop = '7' WHERE edges = 1", "is not what this topo-verify wrote"),
        ("UPDATE shards SET tally = '{' WHERE edges = 1", "a tally in it cannot be read"),
    ],
)
def test_an_edited_shard_is_noticed(change: str, words: str) -> None:
    searched()
    _change(change)
    with pytest.raises(InputError, match=words):
        searched()


def _change(statement: str) -> None:
    base = sqlite3.connect("search.ledger")
    base.execute(statement)
    base.commit()
    base.close()


# ---------------------------------------------------------------- files that do not do


def test_two_searches_do_not_share_a_ledger() -> None:
    with opened(), pytest.raises(InputError, match="another search has it open"):
        opened()
    with opened():
        second = subprocess.run(
            [sys.executable, "-c", SEARCHER], capture_output=True, text=True, check=False
        )
    assert "another search has it open: wait for its end" in second.stderr


def test_a_full_disk_is_told_and_loses_nothing() -> None:
    with opened() as ledger:
        ledger.put(Shard(1, 0, 2), Tally(worlds=2))
        (pages,) = ledger._base.execute("PRAGMA page_count").fetchone()
        ledger._base.execute(f"PRAGMA max_page_count = {pages}")
        large = Tally(worlds=10, statuses={"x" * 10_000: {"ok": 1}})
        with pytest.raises(InputError, match="is full; what was recorded before is kept: make roo"):
            ledger.put(Shard(2, 0, 10), large)
    assert [row[:3] for row in rows()] == [(1, "0", "2")]


def test_a_ledger_that_cannot_be_written_is_told() -> None:
    with opened() as ledger:
        ledger._base.execute("PRAGMA query_only = 1")
        with pytest.raises(InputError, match="it cannot be written: name a file that can"):
            ledger.put(Shard(1, 0, 2), Tally(worlds=2))


@pytest.mark.parametrize("path", ["no/folder/ledger", "."])
def test_a_place_where_no_file_can_be_is_told(path: str) -> None:
    with pytest.raises(InputError, match="it cannot be opened: name a file in a folder that can"):
        opened(path=path)


def test_whatever_else_the_database_objects_to_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ledgers, "_SCHEMA", "CREATE NONSENSE")
    with pytest.raises(InputError, match=r"ledger search.ledger: .*syntax error; name another"):
        opened()


def test_the_ledger_is_described_by_its_own_tables() -> None:
    searched()
    base = sqlite3.connect("search.ledger")
    meta = dict(base.execute("SELECT key, value FROM meta"))
    base.close()
    assert (meta["format"], meta["version"]) == ("topo-verify/ledger", "1")
    assert (meta["target"], meta["class"], len(meta["hash"])) == ("basic", "any", 64)
    assert msgspec.json.decode(meta["limits"])["move_timeout"] == 5
    assert os.path.getsize("search.ledger") < 100_000  # noqa: PTH202
