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
from typing import Any

import msgspec
import pytest

from topo_verify import InputError, InternalError, Limits
from topo_verify.harness import ledger as ledgers
from topo_verify.harness.ledger import Ledger
from topo_verify.harness.search import exhaustive
from topo_verify.harness.search.exhaustive import Search, SearchResult, search
from topo_verify.harness.search.plan import SHARD, Plan, Shard
from topo_verify.harness.search.shard import ShardResult, examine_shard
from topo_verify.harness.tally import Tally
from topo_verify.harness.targets import targets

BASIC = Plan(targets=("basic",), edges=4)
SMALL = Plan(targets=("basic",), edges=3)


@pytest.fixture(autouse=True)
def here(folder: Path) -> Path:
    return folder


def opened(plan: Plan = BASIC, *, path: str = "search.ledger", tool: str = "1") -> Ledger:
    return Ledger(path, plan, targets(",".join(plan.targets)), tool)


def searched(plan: Plan = BASIC, *, workers: int = 0) -> SearchResult:
    """The search of a plan, with the ledger; however much of it the ledger knew."""
    with opened(plan) as ledger:
        work = Search(plan, targets(",".join(plan.targets)), workers=workers, ledger=ledger)
        work.work()
        return msgspec.structs.replace(work.found(), from_ledger=0)


def rows() -> list[tuple[int, str, str, int, int]]:
    base = sqlite3.connect("search.ledger")
    try:
        query = "SELECT edges, start, stop, worlds, failing FROM shards ORDER BY edges, start"
        return base.execute(query).fetchall()
    finally:
        base.close()


# ---------------------------------------------------------------- going on


def test_a_search_that_is_done_is_not_done_again(monkeypatch: pytest.MonkeyPatch) -> None:
    once = searched(SMALL)
    assert once == search("basic", edges=3)
    assert sum(worlds for *_, worlds, _ in rows()) == 86
    monkeypatch.setattr(Ledger, "put", None)
    assert searched(SMALL) == once


def examined_again(monkeypatch: pytest.MonkeyPatch, plan: Plan = BASIC) -> list[Shard]:
    """The shards of the ledger that a search which goes on examines again."""
    again: list[Shard] = []

    def examine(*arguments: Any) -> ShardResult:
        again.append(arguments[2])
        return examine_shard(*arguments)

    with monkeypatch.context() as patch:
        patch.setattr(exhaustive, "examine_shard", examine)
        searched(plan)
    return again


def test_a_search_that_goes_on_examines_shards_of_every_size_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(SHARD, "reference", 5)
    monkeypatch.setattr(ledgers, "AGAIN", 20)
    searched(SMALL)
    again = examined_again(monkeypatch, SMALL)
    assert {shard.edges for shard in again} == {1, 2, 3}
    assert 20 <= sum(shard.stop - shard.start for shard in again) < 40
    assert again == examined_again(monkeypatch, SMALL)
    assert again != examined_again(monkeypatch, msgspec.structs.replace(SMALL, seed=1))


def test_a_row_in_which_a_mapper_was_out_of_time_is_not_compared(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    plan = Plan(targets=("mappers.py:strolls",), edges=1, limits=Limits(world_timeout=0.01))
    searched(plan)
    assert examined_again(monkeypatch, plan) == []


def test_a_mapper_that_does_something_else_now_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """What it depends on is not in any file."""
    plan = Plan(targets=("mappers.py:moody",), edges=2)
    searched(plan)
    monkeypatch.setenv("MOOD", "bad")
    with pytest.raises(InputError, match=r"examined again, some world of m\d/0 … \d has another v"):
        searched(plan)


def test_a_search_that_is_done_goes_on_to_larger_worlds() -> None:
    searched(Plan(targets=("basic",), edges=2))
    assert searched(SMALL) == search("basic", edges=3)


def test_a_counterexample_is_found_in_the_ledger_again() -> None:
    plan = Plan(targets=("mappers.py:forgets",), edges=3)
    once = searched(plan)
    assert once.counterexample is not None
    assert searched(plan) == once == searched(plan, workers=2)


SEARCHER = """
import sys
from topo_verify.harness.search.plan import Plan
from topo_verify.harness.search import exhaustive
from topo_verify.harness.search.exhaustive import Search
from topo_verify.harness import ledger
from topo_verify.harness.ledger import Ledger
from topo_verify.harness.search.plan import SHARD
from topo_verify.harness.targets import targets
SHARD["reference"] = 15
ledger.AGAIN = 20
plan = Plan(targets=("basic",), edges=4)
with Ledger("search.ledger", plan, targets("basic"), "1") as opened:
    Search(plan, targets("basic"), workers=2, ledger=opened).work()
"""


def test_killed_at_random_moments_it_ends_with_the_same_totals(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(SHARD, "reference", 15)
    moments = random.Random(5)
    known = 0
    for _ in range(3):
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


@pytest.mark.parametrize(
    ("version", "words"),
    [
        ("3", "its version 3 is newer than 2, the newest that this"),
        ("1", "version 1 says neither which files .* remove it, and search anew"),
        ("two", "its version is not what topo-verify wrote"),
    ],
)
def test_another_version_is_refused(version: str, words: str) -> None:
    opened().__exit__(None, None, None)
    _change("UPDATE meta SET value = ? WHERE key = 'version'", version)
    with pytest.raises(InputError, match=words):
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
        ("UPDATE shards SET worlds = 3 WHERE edges = 2", "the row 2 is not what topo-verify wrote"),
        ("UPDATE shards SET failing = 1 WHERE edges = 1", "the row 1 is not what"),
        ("UPDATE shards SET tally = replace(tally, 'ok', 'no')", "the row 1 is not what"),
        ("UPDATE shards SET sum = 'x' WHERE edges = 3", "the row 3 is not what"),
        ("DELETE FROM shards WHERE edges = 2", "the row 2 is not what"),
        ("DELETE FROM shards WHERE edges = 3", "the number of its rows is not what"),
        ("UPDATE meta SET value = '{}' WHERE key = 'loaded'", "its table meta is not what"),
        ("UPDATE meta SET value = 'x' WHERE key = 'target'", "the row 1 is not what"),
        # One bit makes a text bytes.
        ("UPDATE meta SET value = CAST(value AS BLOB) WHERE key = 'version'", "its table meta is"),
        ("UPDATE meta SET key = CAST(key AS BLOB) WHERE key = 'sum'", "its table meta is not what"),
        ("DELETE FROM meta WHERE key = 'sum'", "its table meta is not what"),
    ],
)
def test_an_edited_shard_is_noticed(change: str, words: str) -> None:
    searched(SMALL)
    _change(change)
    with pytest.raises(InputError, match=words):
        searched(SMALL)


def test_a_row_that_changes_after_the_ledger_was_opened_is_noticed() -> None:
    searched(SMALL)
    with opened() as ledger:
        ledger._base.execute("UPDATE shards SET failing = 7 WHERE edges = 2")
        with pytest.raises(InputError, match="the row 2 is not what topo-verify wrote"):
            ledger.get(Shard(2, 0, 10))


def test_a_row_of_other_ranks_is_noticed() -> None:
    searched(SMALL)
    with opened() as ledger, pytest.raises(InputError, match="the shard at m2/0 is not what"):
        ledger.get(Shard(2, 0, 9))


@pytest.mark.parametrize("text", ["{", '{"files": 3}'])
def test_what_was_loaded_must_be_readable(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    with monkeypatch.context() as patch:
        patch.setattr(Ledger, "_seal", _seal_nonsense(text))
        opened().__exit__(None, None, None)
    with pytest.raises(InputError, match=r"what the mapper loaded .* is not what topo-verify wrot"):
        opened()


def _seal_nonsense(text: str) -> Any:
    def seal(ledger: Ledger, rows: int, last: str) -> None:
        values = (text, str(rows), ledgers._next_sum(last, [text]))
        pairs = list(zip(ledgers._AMONG, values, strict=True))
        ledger._base.executemany("REPLACE INTO meta VALUES (?, ?)", pairs)

    return seal


def test_a_flipped_bit_is_refused_or_changes_nothing(here: Path) -> None:
    """Some bits, drawn; `make torture` flips more of them."""
    plan = Plan(targets=("mappers.py:forgets",), edges=3, keep_going=True)
    once = searched(plan)
    file = here / "search.ledger"
    whole = file.read_bytes()
    sentences: list[str] = []
    drawn = random.Random(3)
    filled = [place for place, byte in enumerate(whole) if byte]  # the rest is padding
    for place in drawn.sample(filled, 40):
        data = bytearray(whole)
        data[place] ^= 1 << drawn.randrange(8)
        file.write_bytes(data)
        try:
            assert searched(plan) == once
        except InputError as error:
            sentences.append(str(error))
    assert len(sentences) > 30
    assert not any("\n" in sentence for sentence in sentences)


def _change(statement: str, *values: str) -> None:
    base = sqlite3.connect("search.ledger")
    base.execute(statement, values)
    base.commit()
    base.close()


# ---------------------------------------------------------------- files that do not do


@pytest.mark.parametrize("path", ["", ":memory:"])
def test_a_database_in_memory_is_refused(path: str) -> None:
    with pytest.raises(InputError, match="expected the name of a file"):
        opened(path=path)


@pytest.mark.parametrize("replaced", [False, True])
def test_a_ledger_that_is_removed_midway_is_noticed(here: Path, *, replaced: bool) -> None:
    with opened() as ledger:
        ledger.put(Shard(1, 0, 2), Tally(worlds=2))
        (here / "search.ledger").rename("away")
        if replaced:
            (here / "search.ledger").touch()
        with pytest.raises(InputError, match="the file was removed or replaced while the search"):
            ledger.put(Shard(2, 0, 10), Tally(worlds=10))
        with pytest.raises(InputError, match="the file was removed or replaced while the search"):
            Search(BASIC, targets("basic"), ledger=ledger).work()


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
    searched(SMALL)
    base = sqlite3.connect("search.ledger")
    meta = dict(base.execute("SELECT key, value FROM meta"))
    base.close()
    assert (meta["format"], meta["version"]) == ("topo-verify/ledger", "2")
    assert (meta["target"], meta["class"], len(meta["hash"])) == ("basic", "any", 64)
    assert msgspec.json.decode(meta["limits"])["move_timeout"] == 5
    assert os.path.getsize("search.ledger") < 100_000  # noqa: PTH202
