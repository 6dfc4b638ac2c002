"""The store: a search killed at any moment is resumed and finds the same."""

# A test may look inside.
# pyright: reportPrivateUsage=false

from __future__ import annotations

import random
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import msgspec
import pytest

from tests.helpers import some
from tests.python import python
from tests.studies.search.searching import shards_in
from topo_verify import InputError, Limits
from topo_verify.campaign import campaign as campaigns
from topo_verify.campaign import store as stores
from topo_verify.campaign.backend import pooled
from topo_verify.campaign.campaign import Campaign, ListedWorlds, Shard, ShardResult
from topo_verify.campaign.campaign import examine as examine_shard
from topo_verify.campaign.identity import source_hash
from topo_verify.campaign.store import Store, StoredCampaign
from topo_verify.campaign.tally import Tally
from topo_verify.campaign.targets import targets
from topo_verify.programs.loaded import Loaded
from topo_verify.studies.search.choices import SHARD
from topo_verify.studies.search.search import Search, SearchEntry, search, search_campaign


def planned(target: str = "basic", edges: int = 4, **options: Any) -> Campaign:
    return search_campaign(targets(target), edges=edges, **options)


BASIC = planned()
STORE = Path("search.db")
SMALL = planned(edges=3)


@pytest.fixture(autouse=True)
def here(folder: Path) -> Path:
    return folder


@contextmanager
def opened(campaign: Campaign = BASIC, *, path: str = "search.db") -> Generator[StoredCampaign]:
    with Store(path) as store:
        yield store.campaign(campaign.identity(source_hash(campaign.load())), Loaded())


def refused(words: str, campaign: Campaign = BASIC, *, path: str = "search.db") -> None:
    """Require that the store is not opened for this campaign."""
    with pytest.raises(InputError, match=words), opened(campaign, path=path):
        pass


def searched(campaign: Campaign = BASIC, *, workers: int = 0) -> SearchEntry:
    """The result of a search with the store, however much of it the store knew."""
    with opened(campaign) as known:
        study = Search(campaign, campaign.load(), pooled(workers, ()), known)
        study.work()
        study.run_again()
        return msgspec.structs.replace(study.entry(), from_ledger=0)


def shards() -> list[tuple[int, str, str]]:
    base = sqlite3.connect("search.db")
    try:
        return base.execute(
            "SELECT edges, start, stop FROM shards ORDER BY edges, start"
        ).fetchall()
    finally:
        base.close()


# ---------------------------------------------------------------- going on


def test_a_search_that_is_done_is_not_done_again(monkeypatch: pytest.MonkeyPatch) -> None:
    once = searched(SMALL)
    assert once == search("basic", edges=3)
    assert sum(int(stop) - int(start) for _, start, stop in shards()) == 86
    monkeypatch.setattr(StoredCampaign, "put", None)
    assert searched(SMALL) == once


def examined_again(monkeypatch: pytest.MonkeyPatch, campaign: Campaign) -> list[Shard]:
    """The shards of the store that a resumed search examines again."""
    again: list[Shard] = []

    def examine(*arguments: Any, **options: Any) -> ShardResult:
        again.append(arguments[2])
        return examine_shard(*arguments, **options)

    with monkeypatch.context() as patch:
        patch.setattr(campaigns, "examine", examine)
        searched(campaign)
    return again


def test_a_search_that_goes_on_examines_shards_of_every_size_again(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(SHARD, "reference", 5)
    monkeypatch.setattr(campaigns, "AGAIN", 20)
    small = planned(edges=3)
    searched(small)
    again = examined_again(monkeypatch, small)
    assert {shard.edges for shard in again} == {1, 2, 3}
    assert 20 <= sum(shard.stop - shard.start for shard in again) < 40
    assert again == examined_again(monkeypatch, small)
    Path("search.db").unlink()
    seeded = msgspec.structs.replace(small, seed=1)
    searched(seeded)
    assert again != examined_again(monkeypatch, seeded)


QUICK = Limits(move_timeout=0.3)


@pytest.mark.parametrize("deed", ["at_8_skip", "at_8_kill", "at_8_hang"])
def test_an_undecided_world_stays_undecided(deed: str) -> None:
    campaign = planned(f"misdeeds.py:{deed}", 2, limits=QUICK, in_process=False)
    once = searched(campaign)
    assert (once.verdict, once.checked) == ("UNKNOWN", 11)
    assert len(shards()) == 2
    assert searched(campaign).verdict == "UNKNOWN"


@pytest.mark.parametrize("name", ["killed_once", "stalls_once"])
def test_a_run_that_was_ended_when_a_search_was_resumed_counts(name: str) -> None:
    campaign = planned(f"mappers.py:{name}", 3, limits=QUICK, in_process=False)
    Path("done").touch()
    assert searched(campaign).verdict == "EXHAUSTED"
    Path("done").unlink()
    resumed = searched(campaign)
    assert (resumed.verdict, [lost.world for lost in resumed.lost]) == ("UNKNOWN", ["m3/21"])


def test_a_mapper_that_does_something_else_now_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """What it depends on is not in any file."""
    campaign = planned("mappers.py:moody", 2)
    searched(campaign)
    monkeypatch.setenv("MOOD", "bad")
    with pytest.raises(InputError, match=r"examined again, some world of m\d/0 … \d has another v"):
        searched(campaign)


def test_a_search_that_is_done_goes_on_to_larger_worlds() -> None:
    searched(planned(edges=2))
    assert searched(SMALL) == search("basic", edges=3)


@pytest.mark.long
def test_a_counterexample_is_found_in_the_ledger_again() -> None:
    campaign = planned("mappers.py:forgets", 3)
    once = searched(campaign)
    assert once.counterexample is not None
    assert searched(campaign) == once == searched(campaign, workers=2)


SEARCHER = """
import sys
from topo_verify.campaign import campaign as campaigns
from topo_verify.campaign.backend import pooled
from topo_verify.campaign.identity import source_hash
from topo_verify.campaign.store import Store
from topo_verify.campaign.targets import targets
from topo_verify.programs.loaded import Loaded
from topo_verify.studies.search.choices import SHARD
from topo_verify.studies.search.search import Search, search_campaign
if __name__ == "__main__":
    SHARD["reference"] = 15
    campaigns.AGAIN = 20
    mappers = targets("basic")
    campaign = search_campaign(mappers, edges=4)
    with Store("search.db") as store:
        known = store.campaign(campaign.identity(source_hash(mappers)), Loaded())
        Search(campaign, mappers, pooled(2, ()), known).work()
"""


@pytest.mark.nightly
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
            if shards_in(STORE) >= known + size or running.poll() is not None:
                break
            time.sleep(0.01)
        time.sleep(moments.random() / 20)
        running.send_signal(signal.SIGKILL)
        running.wait()
        assert shards_in(STORE) >= known
        known = shards_in(STORE)
    assert known > 0
    assert searched(planned(), workers=2) == search("basic", edges=4)


# ---------------------------------------------------------------- what does not belong in it


@pytest.mark.parametrize(
    ("other", "words"),
    [
        (planned("folding"), "its target is basic, now it is folding"),
        (planned(kind="planar"), "its class is any, now it is planar"),
        (planned(choices="all"), "its ways is null, now it is .*:by_name"),
        (planned(keep_going=True), "its stop is .*1.*, now it is .*null"),
        (planned(limits=Limits(9)), "its limits are"),
        (planned(seed=7), "its seed is 0, now it is 7"),
        (msgspec.structs.replace(BASIC, strict=True), "its strict is false, now it is true"),
        (msgspec.structs.replace(BASIC, validate=True), "its validate is false, now it is true"),
        (msgspec.structs.replace(BASIC, pick="last"), "its pick is null, now it is last"),
        (
            msgspec.structs.replace(BASIC, look="a:b"),
            "its look is topo_verify.*:look, now it is a:b",
        ),
        (msgspec.structs.replace(BASIC, engine="compiled"), "its engine is reference, now it is c"),
    ],
)
def test_another_campaign_is_refused(other: Campaign, words: str) -> None:
    with opened():
        pass
    refused("holds another campaign: " + words, other)


def test_another_version_of_the_tool_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    with opened():
        pass

    def version(_name: str) -> str:
        return "9.9"

    monkeypatch.setattr("importlib.metadata.version", version)
    refused(r"its tool is \S+, now it is 9\.9")


def test_how_far_a_campaign_goes_and_what_it_keeps_is_no_part_of_it() -> None:
    with opened():
        pass
    for other in (planned(edges=9), msgspec.structs.replace(BASIC, keep="all", drawn=True)):
        with opened(other):
            pass


def test_runs_in_this_process_do_not_count_for_a_process_apart() -> None:
    """In this process a mapper can replace the checkers, so its results are worth less."""
    campaign = planned("mappers.py:right", 2)
    searched(campaign)
    apart = msgspec.structs.replace(campaign, in_process=False)
    with pytest.raises(InputError, match="its in-process is true, now it is false; name another f"):
        searched(apart)


def test_a_file_holds_several_campaigns_each_under_its_name() -> None:
    world = ((("m1/0", ((1, 1), (1, 0))),), "m1/0")
    shard = Shard(0, 0, 1, world[0])
    with Store("many.db") as store:
        for name in ("one", "other"):
            campaign = msgspec.structs.replace(BASIC, worlds=ListedWorlds(1), seed=len(name))
            known = store.campaign(campaign.identity("hash"), Loaded(), name=name, all_rows=True)
            known.put(shard, ShardResult(Tally(worlds=len(name))))
    with Store("many.db") as store:
        campaign = msgspec.structs.replace(BASIC, worlds=ListedWorlds(1), seed=5)
        known = store.campaign(campaign.identity("hash"), Loaded(), name="other", all_rows=True)
        moved = msgspec.structs.replace(shard, start=7, stop=8)
        for place in (shard, moved):  # a world of a list is known wherever it stands
            result = some(known.get(place))
            assert result.tally.worlds == 5
        with pytest.raises(InputError, match="holds another campaign of one: its seed is 3"):
            store.campaign(campaign.identity("hash"), Loaded(), name="one")


def test_a_campaign_of_a_changed_mapper_begins_anew_and_the_others_stay() -> None:
    world = ((("m1/0", ((1, 1), (1, 0))),), "m1/0")
    shard, more = Shard(0, 0, 1, world[0]), Shard(0, 1, 2, (("m1/1", world[0][0][1]),))
    campaign = planned()

    def campaigns_of(store: Store, *sources: str, **options: Any) -> list[StoredCampaign]:
        return [
            store.campaign(campaign.identity(source), Loaded(), name=name, **options)
            for name, source in zip(("one", "other"), sources, strict=True)
        ]

    changes: list[str] = []
    with Store("runs.db") as store:
        for known in campaigns_of(store, "then", "same"):
            known.put(shard, ShardResult(Tally(worlds=5)))
            known.put(more, ShardResult(Tally(worlds=5)))
    with Store("runs.db") as store:
        one, other = campaigns_of(store, "now", "same", renew=changes.append)
        assert changes == [
            "making 2 runs of one in runs.db again: the source of the mapper has changed since"
        ]
        assert (one.get(shard), one.get(more), one.since) == (None, None, None)
        assert other.get(shard) is not None
        one.put(shard, ShardResult(Tally(worlds=7)))
    with Store("runs.db") as store:
        one, other = campaigns_of(store, "now", "same", renew=changes.append)
        result = some(one.get(shard))
        assert result.tally.worlds == 7
        assert one.get(more) is None, "it was of the mapper before"
        assert other.get(more) is not None
        assert len(changes) == 1
        limited = msgspec.structs.replace(campaign, limits=Limits(9))
        with pytest.raises(InputError, match="holds another campaign of one: its limits are"):
            store.campaign(limited.identity("now"), Loaded(), name="one", renew=changes.append)
        with pytest.raises(InputError, match="of one: the source of the mapper has changed since"):
            store.campaign(campaign.identity("then"), Loaded(), name="one")


def test_another_source_of_the_tool_is_refused_and_begins_nothing_anew(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with opened():
        pass
    monkeypatch.setattr(stores, "own_hash", lambda: "another")
    with Store("search.db") as store, pytest.raises(InputError, match="source of topo-verify has"):
        store.campaign(BASIC.identity("other"), Loaded(), renew=pytest.fail)


def test_the_catalogue_runs_in_this_process_whatever_is_asked() -> None:
    once = searched(SMALL)
    assert searched(msgspec.structs.replace(SMALL, in_process=False)) == once


@pytest.mark.parametrize(
    ("version", "words"),
    [
        ("4", "its version 4 is newer than 3, the newest that this"),
        ("two", "its version is not what topo-verify wrote"),
    ],
)
def test_another_version_is_refused(version: str, words: str) -> None:
    with opened():
        pass
    _change("UPDATE meta SET value = ? WHERE key = 'version'", version)
    refused(words)


@pytest.mark.parametrize(("tool", "by"), [((), "0.1"), (("0.2.0",), "0.2.0")])
def test_a_ledger_of_02_or_before_is_named_and_left_alone(tool: tuple[str, ...], by: str) -> None:
    _change("CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID")
    _change("INSERT INTO meta VALUES ('format', 'topo-verify/ledger')")
    for version in tool:
        _change("INSERT INTO meta VALUES ('tool', ?)", version)
    before = STORE.read_bytes()
    refused(rf"topo-verify {by} wrote this ledger\. .* remove it, or name another file")
    assert STORE.read_bytes() == before


@pytest.mark.parametrize("table", ["meta (key, value)", "other (a)"])
def test_another_database_is_refused_and_left_alone(table: str) -> None:
    _change(f"CREATE TABLE {table}")
    before = Path("search.db").read_bytes()
    refused("is a database, but no store of topo-verify: name another file")
    assert Path("search.db").read_bytes() == before


def test_a_file_that_is_no_database_is_refused_and_left_alone(here: Path) -> None:
    before = (here / "mappers.py").read_bytes()
    refused("it is no store of topo-verify: name another file", path="mappers.py")
    assert (here / "mappers.py").read_bytes() == before


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("UPDATE shards SET stop = '3' WHERE edges = 2", "the shard 2 is not what topo-verify w"),
        ("UPDATE shards SET tally = replace(tally, 'ok', 'no')", "the shard 1 is not what"),
        ("UPDATE shards SET sum = 'x' WHERE edges = 3", "the shard 3 is not what"),
        ("UPDATE rows SET row = replace(row, 'm2/', 'm3/')", "the shard 2 is not what"),
        ("DELETE FROM rows WHERE shard = 2", "the shard 2 is not what"),
        ("INSERT INTO rows VALUES (9, '{}')", "the number of its rows is not what"),
        ("DELETE FROM shards WHERE edges = 2", "the shard 2 is not what"),
        ("DELETE FROM shards WHERE edges = 3", "the number of its rows is not what"),
        ("UPDATE meta SET value = '{}' WHERE key = 'loaded'", "its table meta is not what"),
        ("UPDATE meta SET value = 'x' WHERE key = 'target'", "its table meta is not what"),
        # One bit makes a text bytes.
        ("UPDATE meta SET value = CAST(value AS BLOB) WHERE key = 'version'", "its table meta is"),
        ("UPDATE meta SET key = CAST(key AS BLOB) WHERE key = 'sum'", "its table meta is not what"),
        ("UPDATE shards SET name = CAST(name AS BLOB) WHERE edges = 3", "the shard 3 is not what"),
        ("DELETE FROM meta WHERE key = 'sum'", "its table meta is not what"),
    ],
)
def test_an_edited_shard_is_noticed(change: str, words: str) -> None:
    searched(SMALL)
    _change(change)
    with pytest.raises(InputError, match=words):
        searched(SMALL)


def test_a_shard_that_changes_after_the_store_was_opened_is_noticed() -> None:
    searched(SMALL)
    with opened() as known:
        known._store._base.execute("UPDATE shards SET tally = '{}' WHERE edges = 2")
        with pytest.raises(InputError, match="the shard 2 is not what topo-verify wrote"):
            known.get(Shard(2, 0, 10))


def test_a_flipped_bit_is_refused_or_changes_nothing(here: Path) -> None:
    """Some bits, drawn; `make torture` flips more of them."""
    campaign = planned("mappers.py:forgets", 3, keep_going=True)
    once = searched(campaign)
    file = here / "search.db"
    whole = file.read_bytes()
    sentences: list[str] = []
    drawn = random.Random(3)
    filled = [place for place, byte in enumerate(whole) if byte]  # the rest is padding
    for place in drawn.sample(filled, 40):
        data = bytearray(whole)
        data[place] ^= 1 << drawn.randrange(8)
        file.write_bytes(data)
        try:
            assert searched(campaign) == once
        except InputError as error:
            sentences.append(str(error))
    assert len(sentences) > 30
    assert not any("\n" in sentence for sentence in sentences)


def _change(statement: str, *values: str) -> None:
    base = sqlite3.connect("search.db")
    base.execute(statement, values)
    base.commit()
    base.close()


# ---------------------------------------------------------------- files that do not do


@pytest.mark.parametrize("path", ["", ":memory:"])
def test_a_database_in_memory_is_refused(path: str) -> None:
    refused("expected the name of a file", path=path)


@pytest.mark.parametrize("replaced", [False, True])
def test_a_store_that_is_removed_midway_is_noticed(here: Path, *, replaced: bool) -> None:
    with opened() as known:
        known.put(Shard(1, 0, 2), ShardResult(Tally(worlds=2)))
        (here / "search.db").rename("away")
        if replaced:
            (here / "search.db").touch()
        with pytest.raises(InputError, match="the file was removed or replaced while it"):
            known.put(Shard(2, 0, 10), ShardResult(Tally(worlds=10)))


def test_two_searches_do_not_share_a_store() -> None:
    words = "another process has it open: wait for its end"
    with opened():
        refused(words)
        second = python("-c", SEARCHER)
    assert words in second.stderr


def test_a_full_disk_is_told_and_loses_nothing() -> None:
    with opened() as known:
        known.put(Shard(1, 0, 2), ShardResult(Tally(worlds=2)))
        base = known._store._base
        (pages,) = base.execute("PRAGMA page_count").fetchone()
        base.execute(f"PRAGMA max_page_count = {pages}")
        large = Tally(worlds=10, statuses={"x" * 10_000: {"ok": 1}})
        with pytest.raises(InputError, match="is full; what was recorded before is kept: make roo"):
            known.put(Shard(2, 0, 10), ShardResult(large))
    assert shards() == [(1, "0", "2")]


def test_a_store_that_cannot_be_written_is_told() -> None:
    with opened() as known:
        known._store._base.execute("PRAGMA query_only = 1")
        with pytest.raises(InputError, match="it cannot be written: name a file that can"):
            known.put(Shard(1, 0, 2), ShardResult(Tally(worlds=2)))


@pytest.mark.parametrize("path", ["no/folder/store", "."])
def test_a_place_where_no_file_can_be_is_told(path: str) -> None:
    refused("it cannot be opened: name a file in a folder that can", path=path)


def test_whatever_else_the_database_objects_to_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stores, "_SCHEMA", "CREATE NONSENSE")
    refused(r"store search.db: .*syntax error; name another")


def test_the_store_is_described_by_its_own_tables() -> None:
    searched(SMALL)
    base = sqlite3.connect("search.db")
    meta = dict(base.execute("SELECT key, value FROM meta"))
    base.close()
    assert (meta["format"], meta["version"]) == ("topo-verify/store", "3")
    assert (meta["target"], meta["class"], len(meta["hash"])) == ("basic", "any", 64)
