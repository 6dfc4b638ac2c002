"""The SQLite file that keeps finished shards, so that a campaign can resume.

    with Store("search.db") as store:
        memory = store.resumed(campaign, mappers)
        for shard, result in results(campaign, backend, store=memory): ...

`meta` holds versions, each campaign's identity and what its mappers loaded, so that results of
different campaigns are never added up. `shards` has a line for each finished shard, `rows` its
kept rows. If a mapper has changed, its campaign may begin anew; shards before number `begun`
then no longer count.

Each shard is one transaction. An operating system lock, which ends with the process, protects
the open file. Checksums are chained over all shards and verified on opening. They guard against
accidents, not against forgery.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime
from hashlib import sha256
from importlib import metadata
from pathlib import Path
from typing import Any, Self

import msgspec

from topo_verify.campaign.campaign import Campaign, Shard, ShardResult
from topo_verify.campaign.identity import (
    Identity,
    MapperChanged,
    merged,
    own_hash,
    require_unchanged,
    source_hash,
)
from topo_verify.campaign.row import Row
from topo_verify.campaign.tally import Tally, notable
from topo_verify.errors import InputError, WriteError, plural, shown
from topo_verify.programs.loaded import Loaded
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits

FORMAT = "topo-verify/store"
VERSION = 3
"""Versions 1 and 2 were ledgers of `search`, with the format `topo-verify/ledger`."""

_SCHEMA = """
CREATE TABLE meta (
    name TEXT NOT NULL,  -- of a campaign; '' holds what is said of the file
    key TEXT NOT NULL,
    value TEXT NOT NULL,
    PRIMARY KEY (name, key)
) WITHOUT ROWID;
CREATE TABLE shards (
    number INTEGER PRIMARY KEY,  -- 1, 2, … in the order of writing
    name TEXT NOT NULL,
    edges INTEGER NOT NULL,
    start TEXT NOT NULL,  -- ranks have any length
    stop TEXT NOT NULL,
    key TEXT NOT NULL,
    tally TEXT NOT NULL,
    written TEXT NOT NULL,
    sum TEXT NOT NULL
);
CREATE TABLE rows (shard INTEGER NOT NULL, row TEXT NOT NULL);
CREATE INDEX rows_of ON rows (shard)
"""

_FIELDS = "name, edges, start, stop, key, tally, written"

_LOADED = "loaded"
"""The key, in a campaign's `meta`, of what its mappers have loaded; it grows."""

_BEGUN = "begun"
"""The key of the first shard that counts after a change of the mappers."""


class Store:
    """An open store, which locks its file. It may hold several campaigns.

    InputError: the file is no store, has another version, was changed, is in use, or cannot be
    written.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = _require_file_name(str(path))
        self.sums = [""]  # of nothing, then of each shard
        self.meta: dict[tuple[str, str], str] = {}
        self.places: dict[tuple[str, str], int] = {}
        self.written: dict[str, tuple[str, str]] = {}
        with explained(self.path):
            # An absolute path: some relative names mean something else to SQLite.
            self._base = sqlite3.connect(Path(path).absolute(), timeout=0, isolation_level=None)
            try:
                self._open()
            except BaseException:
                self._base.close()
                raise
        self._file = self._inode()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self._base.close()

    def resumed(
        self,
        campaign: Campaign,
        mappers: Sequence[Target] = (),
        depends: Sequence[str] = (),
        *,
        name: str = "",
        all_rows: bool = False,
        renew: Callable[[str], None] | None = None,
    ) -> StoredCampaign:
        """The stored campaign with this identity, sources and files; see `campaign`.

        Catalogue algorithms may be left out of `mappers`; `depends` are further files.
        """
        identity, now = campaign.identity(source_hash(mappers)), Identity(mappers, depends).loaded()
        return self.campaign(identity, now, name=name, all_rows=all_rows, renew=renew)

    def campaign(
        self,
        identity: Mapping[str, str],
        now: Loaded,
        *,
        name: str = "",
        all_rows: bool = False,
        renew: Callable[[str], None] | None = None,
    ) -> StoredCampaign:
        """The campaign of this name, begun if the file does not have it.

        Args:
            now: what the mappers have loaded until now.
            all_rows: keep every row, not only the notable ones.
            renew: if only the mappers have changed, begin anew and pass a sentence to this.
        Raises:
            InputError: the file has another campaign of this name.
        """
        own = {"tool": metadata.version("topo-verify"), "toolkit": own_hash()}
        identity = {**own, **identity}
        whose = f" of {name}" if name else ""
        known = {key: value for (other, key), value in self.meta.items() if other == name}
        loaded = Loaded()
        if _LOADED not in known:
            self.write(name, identity, loaded)
        else:
            try:
                self._require_same(known, identity, whose)
                kept = msgspec.json.decode(known[_LOADED], type=Loaded)
                require_unchanged(kept, now, f"store {self.path}{whose}")
                loaded = kept
            except MapperChanged as error:
                if renew is None:
                    raise
                if shards := self._begin_anew(name, identity):
                    words = f"making {plural(shards, 'run')}{whose} in {self.path} again"
                    renew(f"{words}: {error.change}")
        return StoredCampaign(self, name, loaded, now, all_rows=all_rows)

    def _require_same(
        self, known: Mapping[str, str], identity: Mapping[str, str], whose: str
    ) -> None:
        where = f"store {self.path} holds another campaign{whose}"
        for key, value in identity.items():
            if key != "hash" and known.get(key) != value:
                change = f"its {key} is {known.get(key)}, now it is {value}"
                if key == "limits":
                    change = f"its limits are {_limits(known.get(key))}, now {_limits(value)}"
                elif key == "toolkit":
                    change = "the source of topo-verify has changed since"
                raise InputError(
                    f"{where}: {change}; name another file or folder, or remove this one"
                )
        if known.get("hash") != identity.get("hash"):
            raise MapperChanged(where, "the source of the mapper has changed since")

    def _begin_anew(self, name: str, identity: Mapping[str, str]) -> int:
        """Discount the shards of a campaign; return their number."""
        old = [place for place in self.places if place[0] == name]
        for place in old:
            del self.places[place]
        self.written.pop(name, None)
        self.write(name, {**identity, _BEGUN: str(len(self.sums))}, Loaded())
        return len(old)

    def require_file(self) -> None:
        """Raise a WriteError if the file was removed or replaced meanwhile."""
        if self._inode() != self._file:
            raise WriteError(
                f"store {self.path}: the file was removed or replaced while it was in use, and what"
                " it recorded is lost: start again, and leave the file alone"
            )

    # ------------------------------------------------------------ reading and writing

    def read(self, number: int) -> tuple[tuple[Any, ...], list[str]]:
        """The fields of a shard and its rows; InputError if the checksum is wrong."""
        with explained(self.path):
            ask = f"SELECT {_FIELDS}, sum FROM shards WHERE number = ?"  # noqa: S608  no input in it
            fields = self._base.execute(ask, (number,)).fetchone()
            ask = "SELECT row FROM rows WHERE shard = ? ORDER BY rowid"
            rows = [row for (row,) in self._base.execute(ask, (number,))]
        if fields is None or fields[-1] != checksum(self.sums[number - 1], fields[:-1], rows):
            raise changed(self.path, f"the shard {number}")
        return fields[:-1], rows

    def write(
        self,
        name: str,
        identity: Mapping[str, str],
        loaded: Loaded,
        fields: Sequence[Any] = (),
        rows: Sequence[str] = (),
    ) -> None:
        """Write what is new of a campaign: identity, loaded files, a shard with its rows."""
        self.require_file()
        number, digest = len(self.sums), checksum(self.sums[-1], fields, rows)
        meta = self.meta | {(name, key): value for key, value in identity.items()}
        meta[name, _LOADED] = msgspec.json.encode(loaded).decode()
        new = {pair: value for pair, value in meta.items() if self.meta.get(pair) != value}
        new["", "sum"] = _seal(meta, digest if fields else self.sums[-1])
        with explained(self.path):
            self._base.execute("BEGIN")
            try:
                if fields:
                    self._base.execute(
                        f"INSERT INTO shards VALUES (?,{'?,' * len(fields)}?)",  # noqa: S608
                        (number, *fields, digest),
                    )
                    self._base.executemany(
                        "INSERT INTO rows VALUES (?, ?)", [(number, row) for row in rows]
                    )
                self._base.executemany(
                    "REPLACE INTO meta VALUES (?, ?, ?)",
                    [(*pair, value) for pair, value in new.items()],
                )
            except BaseException:
                self._base.rollback()
                raise
            self._base.execute("COMMIT")
        self.meta = meta
        if fields:
            self.sums.append(digest)
            self._note(number, fields)

    def _note(self, number: int, fields: Sequence[Any]) -> None:
        name, _, _, _, key, _, written = fields
        if number < int(self.meta.get((name, _BEGUN), 0)):
            return
        self.places[name, key] = number
        first, _ = self.written.get(name, (written, written))
        self.written[name] = (first, written)

    # ------------------------------------------------------------ opening

    def _open(self) -> None:
        """Lock the file and verify it; give a new file its tables."""
        self._base.execute("PRAGMA locking_mode = EXCLUSIVE")
        self._base.execute("BEGIN EXCLUSIVE")  # locks now, and for longer than COMMIT
        if Path(self.path).stat().st_size == 0:  # SQLite has rolled back a torn write by now
            for statement in _SCHEMA.split(";\n"):
                self._base.execute(statement)
            self.meta = {("", "format"): FORMAT, ("", "version"): str(VERSION)}
            entries = [(*pair, value) for pair, value in self.meta.items()]
            entries.append(("", "sum", _seal(self.meta, "")))
            self._base.executemany("INSERT INTO meta VALUES (?, ?, ?)", entries)
        else:
            self._require_ours()
            self._require_sums()
        self._base.execute("COMMIT")

    def _require_ours(self) -> None:
        tables = {name for (name,) in self._base.execute("SELECT name FROM sqlite_master")}
        if "meta" not in tables:
            raise no_store(self.path)
        intact = self._base.execute("PRAGMA integrity_check(1)").fetchone()
        if intact != ("ok",):
            raise changed(self.path, f"the database ({shown(str(intact[0]))})")
        columns = [column[1] for column in self._base.execute("PRAGMA table_info(meta)")]
        entries = list(self._base.execute("SELECT * FROM meta"))
        # In SQLite each value has its own type, whatever the column says.
        if not all(type(word) is str for entry in entries for word in entry):
            raise changed(self.path, "its table meta")
        if columns == ["key", "value"]:
            raise _older(self.path, dict(entries))
        self.meta = {(name, key): value for name, key, value in entries}
        if self.meta.get(("", "format")) != FORMAT:
            raise no_store(self.path)
        version = self.meta.get(("", "version"), "")
        if version.isdecimal() and int(version) > VERSION:
            raise InputError(
                f"store {self.path}: its version {version} is newer than {VERSION}, the newest that"
                " this topo-verify reads: update it"
            )
        if version != str(VERSION):
            raise changed(self.path, "its version")

    def _require_sums(self) -> None:
        """Verify every checksum; note checksums and numbers of the shards."""
        stated = self.meta.pop(("", "sum"), "")
        (count,) = self._base.execute("SELECT count(*) FROM shards").fetchone()
        rows: dict[int, list[str]] = {}
        for shard, row in self._base.execute("SELECT shard, row FROM rows ORDER BY rowid"):
            rows.setdefault(shard, []).append(row)
        ask = f"SELECT number, {_FIELDS}, sum FROM shards ORDER BY number"  # noqa: S608  no input in it
        for number, *fields, digest in self._base.execute(ask):
            expected = checksum(self.sums[-1], fields, rows.pop(number, []))
            has_bytes = any(type(field) is bytes for field in fields)  # as JSON, b"" is ""
            if number != len(self.sums) or digest != expected or has_bytes:
                raise changed(self.path, f"the shard {len(self.sums)}")
            self.sums.append(digest)
            self._note(number, fields)
        if rows or count != len(self.sums) - 1:
            raise changed(self.path, "the number of its rows")
        if stated != _seal(self.meta, self.sums[-1]):
            raise changed(self.path, "its table meta")

    def _inode(self) -> tuple[int, int] | None:
        try:
            status = Path(self.path).stat()
        except OSError:
            return None
        return status.st_dev, status.st_ino


class StoredCampaign:
    """The finished shards of one campaign in a store; a `ShardMemory`."""

    def __init__(
        self, store: Store, name: str, loaded: Loaded, now: Loaded, *, all_rows: bool
    ) -> None:
        self._store, self._name, self._now, self._all_rows = store, name, now, all_rows
        self.loaded = loaded
        self._notable: tuple[Row, ...] = ()
        if not all_rows:
            results = filter(None, map(self.get, self.known()))
            self._notable = notable(row for result in results for row in result.rows)

    @property
    def path(self) -> str:
        """The path of its file."""
        return self._store.path

    @property
    def since(self) -> tuple[str, str] | None:
        """When the first and the last shard were written, or None."""
        return self._store.written.get(self._name)

    def known(self) -> list[Shard]:
        """The finished shards of a class, in the order of their worlds."""
        numbers = [number for (name, _), number in self._store.places.items() if name == self._name]
        shards: list[Shard] = []
        for number in numbers:
            (_, edges, start, stop, *_), _ = self._store.read(number)
            if edges:
                shards.append(Shard(edges, int(start), int(stop)))
        return sorted(shards, key=lambda shard: (shard.edges, shard.start))

    def get(self, shard: Shard) -> ShardResult | None:
        """The result of a shard; None if it is not finished; InputError if it was changed."""
        number = self._store.places.get((self._name, shard.key))
        if number is None:
            return None
        fields, rows = self._store.read(number)
        try:
            tally = msgspec.json.decode(fields[5], type=Tally)
            return ShardResult(tally, tuple(msgspec.json.decode(row, type=Row) for row in rows))
        except msgspec.MsgspecError as error:
            raise changed(self.path, f"the shard {number} ({error})") from error

    def put(self, shard: Shard, result: ShardResult) -> None:
        """Record a finished shard durably.

        InputError: the file cannot be written, or a file that the mappers loaded has changed.
        """
        rows = result.rows
        if not self._all_rows:  # drop rows that are not notable beside those of the file
            self._notable = notable([*self._notable, *rows])
            kept = set(map(id, self._notable))
            rows = tuple(row for row in rows if id(row) in kept)
        loaded = result.loaded or self._now
        files = dict(loaded.files)
        files.pop(
            str(Path(self.path).absolute()), None
        )  # the store was opened in this process, too
        loaded = msgspec.structs.replace(loaded, files=files)
        self.loaded = merged(self.loaded, loaded, f"store {self.path}")
        now = datetime.now(UTC).isoformat(timespec="seconds")
        tally = msgspec.json.encode(result.tally).decode()
        place = (self._name, shard.edges, str(shard.start), str(shard.stop), shard.key)
        texts = [msgspec.json.encode(row).decode() for row in rows]
        self._store.write(self._name, {}, self.loaded, (*place, tally, now), texts)


def checksum(before: str, *parts: Sequence[Any]) -> str:
    """The checksum of a shard, given the previous shard's."""
    return sha256(msgspec.json.encode([before, *parts])).hexdigest()


def _seal(meta: Mapping[tuple[str, str], str], last: str) -> str:
    return checksum(last, sorted((*pair, value) for pair, value in meta.items()))


# ---------------------------------------------------------------- errors


def _limits(known: str | None) -> str:
    """The options that set kept limits, in words."""
    if known is None:
        return "unknown"
    return " ".join(msgspec.json.decode(known, type=Limits).options) or "the usual ones"


def _require_file_name(path: str) -> str:
    if path in ("", ":memory:"):
        raise InputError(
            f"store {path!r}: expected the name of a file, which keeps finished work; got what"
            " SQLite takes for a database in memory"
        )
    return path


def _older(path: str, known: Mapping[str, str]) -> InputError:
    """The error for a ledger of 0.2 or before: other checkers judged, so it is not converted."""
    if known.get("format") != "topo-verify/ledger":
        return no_store(path)
    return InputError(
        f"store {path}: topo-verify {known.get('tool', '0.1')} wrote this ledger. Verdicts of"
        " different versions are never added up: remove it, or name another file, and start anew"
    )


def no_store(path: str) -> InputError:
    """The error for another database."""
    return InputError(f"{path} is a database, but no store of topo-verify: name another file")


def changed(path: str, part: str) -> InputError:
    """The error for a changed part of the store."""
    return InputError(
        f"store {path}: {part} is not what topo-verify wrote: copy the file again, or remove it and"
        " start anew"
    )


@contextmanager
def explained(path: str) -> Generator[None]:
    """Turn SQLite's errors into an InputError that says the mend."""
    try:
        yield
    except InputError:  # it is a ValueError, too
        raise
    # A changed file may hold invalid text and huge numbers.
    except (UnicodeError, ValueError, OverflowError, MemoryError) as error:
        raise changed(path, f"the database ({shown(str(error))})") from error
    except sqlite3.Error as error:
        refusal, message = _REFUSALS.get(
            getattr(error, "sqlite_errorcode", 0) & 0xFF,
            (InputError, "{}; name another file or folder, or remove this one"),
        )
        raise refusal(f"store {path}: {message.format(shown(str(error)))}") from error


_KEPT = "{}; what was recorded before is kept: make room and start again"

_REFUSALS: dict[int, tuple[type[InputError | WriteError], str]] = {
    sqlite3.SQLITE_BUSY: (
        InputError,
        "another process has it open: wait for its end, or name another file",
    ),
    sqlite3.SQLITE_LOCKED: (InputError, "a table is locked by another process: wait for its end"),
    sqlite3.SQLITE_NOTADB: (InputError, "it is no store of topo-verify: name another file"),
    sqlite3.SQLITE_READONLY: (WriteError, "it cannot be written: name a file that can"),
    sqlite3.SQLITE_CANTOPEN: (
        InputError,
        "it cannot be opened: name a file in a folder that can be written",
    ),
    sqlite3.SQLITE_FULL: (WriteError, _KEPT),
    sqlite3.SQLITE_IOERR: (WriteError, _KEPT),
}
"""What is said of an error of SQLite, by its primary code."""
