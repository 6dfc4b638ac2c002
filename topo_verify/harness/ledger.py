"""The ledger: a file of the finished shards, from which a search that was cut off goes on.

It is a SQLite database. `meta` says what was searched, so that only tallies of the same search are
added up: format and version of the ledger, the version of topo-verify, the targets and a hash of
their sources, the class of worlds, policies, limits; and which files and distributions the mapper
was seen to load. `shards` has a row for each finished shard: its ranks, in how many worlds mappers
ran and in how many a claim fails, and the whole tally as JSON. The size of the worlds is not in
`meta`: a finished search goes on to larger ones.

Nothing is lost: a row is written in a transaction once its shard is finished, and SQLite rolls back
a transaction that was cut off when the file is opened next. Nobody else writes: the file is locked
for as long as it is open, by a lock of the operating system's, which ends with the process.

**Sums.** Each row holds a hash of its fields and of the sum before it, and `meta` one over all.
They are computed again when the file is opened, before anything in it is believed, and that of a
row again when it is read. Sums guard against accidents, not against forgery.

Only the process that searches opens the ledger; workers never do.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Iterator, Sequence
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path
from random import Random
from types import TracebackType
from typing import Any, Self

import msgspec

from topo_verify.errors import InputError, InternalError
from topo_verify.harness.ledger_errors import changed, explained, no_ledger
from topo_verify.harness.search.identity import merged, require_unchanged, source_hash
from topo_verify.harness.search.plan import Plan, Shard
from topo_verify.harness.tally import Tally
from topo_verify.programs.loaded import Loaded
from topo_verify.programs.loader import Target
from topo_verify.text import shown

FORMAT = "topo-verify/ledger"
VERSION = 2

_SCHEMA = """
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE shards (
    number INTEGER PRIMARY KEY,  -- 1, 2, … in the order of writing
    edges INTEGER NOT NULL,
    start TEXT NOT NULL,  -- ranks have any length
    stop TEXT NOT NULL,
    worlds INTEGER NOT NULL,
    failing INTEGER NOT NULL,
    tally TEXT NOT NULL,
    written TEXT NOT NULL,
    sum TEXT NOT NULL
);
"""

_ROWS = "SELECT edges, start, stop, worlds, failing, tally, written, sum FROM shards"

AGAIN = 200
"""In so many worlds at least a search that goes on examines the mapper again."""

_AMONG = ("loaded", "rows", "sum")
"""The keys of `meta` that change with every row."""

Row = tuple[Any, ...]


class Ledger:
    """An open ledger. Life cycle: `with` it, which locks the file; `get` and `put` shards.

    Args:
        path: the file; a new one is made if there is none.
        plan: what is searched.
        mappers: the targets of the plan.
        tool: the version of topo-verify.
        now: what the mappers have loaded until now.
    Attributes:
        shards: those it held when it was opened, in the order of their worlds.
        since: when the first of them was written, and the last; None: it held none.
        loaded: which files and distributions the mappers loaded.
    Raises:
        InputError: the file is not a ledger, is of another search or of another version, was
            changed, is in use, or cannot be written; the message says which, and what to do.
    """

    def __init__(
        self,
        path: str,
        plan: Plan,
        mappers: Sequence[Target],
        tool: str,
        now: Loaded | None = None,
    ) -> None:
        self.path = _require_file_name(path)
        self._now = now or Loaded()
        self._plan = plan
        self._numbers: dict[tuple[int, str], int] = {}
        self._sums: list[str] = []  # that of nothing, then that of each row
        self.loaded = Loaded()
        self.since: tuple[str, str] | None = None
        meta = _meta(plan, mappers, tool)
        with explained(self.path):
            # An absolute path: SQLite takes some relative names for something else than a file.
            self._base = sqlite3.connect(Path(path).absolute(), timeout=0, isolation_level=None)
        try:
            with explained(self.path):
                self._open(meta)
            self._file = self._identity()
        except BaseException:
            self._base.close()
            raise
        self.shards = sorted(
            (Shard(edges, int(start), int(stop)) for edges, start, stop in self._ranks()),
            key=lambda shard: (shard.edges, shard.start),
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._base.close()

    def get(self, shard: Shard) -> Tally | None:
        """The tally of a shard; None if it is not finished.

        Raises:
            InputError: the row is of another shard, or was changed.
            InternalError: the tally has another number of worlds than the shard.
        """
        number = self._numbers.get((shard.edges, str(shard.start)))
        if number is None:
            return None
        with explained(self.path):
            row = self._base.execute(f"{_ROWS} WHERE number = ?", (number,)).fetchone()
        *fields, made = row if row is not None else ("", "")
        if made != self._sums[number] or made != _next_sum(self._sums[number - 1], fields):
            raise changed(self.path, f"the row {number}")
        _, _, stop, worlds, _, text, _ = fields
        tally = self._tally(text)
        if stop != str(shard.stop) or worlds != tally.worlds:
            raise changed(self.path, f"the shard at m{shard.edges}/{shard.start}")
        self._require_count(shard, tally)
        return tally

    def put(self, shard: Shard, tally: Tally, loaded: Loaded | None = None) -> None:
        """Record the tally of a finished shard. Once this returns, it is kept whatever happens.

        Args:
            loaded: what the mappers had loaded when it was finished.
        Raises:
            InputError: the file cannot be written; the disk may be full; it was removed; a file
                that the mappers loaded has changed.
        """
        self._require_count(shard, tally)
        self.require_file()
        loaded = self._without_itself(loaded or self._now)
        self.loaded = merged(self.loaded, loaded, f"ledger {self.path}")
        number, now = len(self._sums), datetime.now(UTC).isoformat(timespec="seconds")
        text = msgspec.json.encode(tally).decode()
        ranks = (shard.edges, str(shard.start), str(shard.stop))
        fields = (*ranks, tally.worlds, tally.failing, text, now)
        made = _next_sum(self._sums[-1], fields)
        with explained(self.path):
            self._base.execute("BEGIN")
            try:
                self._base.execute(
                    "INSERT INTO shards VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
                    (number, *fields, made),
                )
                self._seal(number, made)
            except BaseException:
                self._base.rollback()
                raise
            self._base.execute("COMMIT")
        self._sums.append(made)
        self._numbers[shard.edges, str(shard.start)] = number

    def to_examine_again(self) -> Iterator[Shard]:
        """Shards of every size, drawn by the plan's seed; of `AGAIN` worlds or all there are."""
        drawn = [shard for shard in self.shards if shard.edges <= self._plan.edges]
        Random(f"{self._plan.seed} {len(drawn)}").shuffle(drawn)
        sizes: set[int] = set()
        worlds = 0
        for shard in drawn:
            if shard.edges in sizes and worlds >= AGAIN:
                continue
            tally = self.get(shard)
            # How far a run comes that is out of time is a matter of the machine.
            if tally is not None and tally.worlds and not tally.timeouts:
                sizes.add(shard.edges)
                worlds += tally.worlds
                yield shard

    def require_file(self) -> None:
        """Raise an InputError if the file was removed or replaced since it was opened."""
        if self._identity() != self._file:
            raise InputError(
                f"ledger {self.path}: the file was removed or replaced while the search ran, and"
                " what it recorded is lost: start the search again, and leave the file alone"
            )

    # ------------------------------------------------------------ opening

    def _open(self, meta: dict[str, str]) -> None:
        """Lock the file and require that it is of this search; give a new one its tables."""
        self._base.execute("PRAGMA locking_mode = EXCLUSIVE")
        self._base.execute("BEGIN EXCLUSIVE")  # locks now, and for longer than COMMIT
        if Path(self.path).stat().st_size == 0:  # what was cut off has been rolled back by now
            for statement in _SCHEMA.split(";\n"):
                self._base.execute(statement)
            self._base.executemany("INSERT INTO meta VALUES (?, ?)", meta.items())
            self._sums = [_first_sum(meta)]
            self._seal(0, self._sums[0])
        else:
            self._require_ours()
            known: dict[str, str] = dict(self._base.execute("SELECT key, value FROM meta"))
            # SQLite gives what it finds: the type of a value stands beside it in the file.
            if not all(type(word) is str for pair in known.items() for word in pair):
                raise changed(self.path, "its table meta")
            self._require_version(known)
            self._require_sums(known)
            self._require_same(known, meta)
        self._base.execute("COMMIT")

    def _require_ours(self) -> None:
        tables = {name for (name,) in self._base.execute("SELECT name FROM sqlite_master")}
        if "meta" not in tables:
            raise no_ledger(self.path)
        found = self._base.execute("PRAGMA integrity_check(1)").fetchone()
        if found != ("ok",):
            raise changed(self.path, f"the database ({shown(str(found[0]))})")

    def _require_version(self, known: dict[str, str]) -> None:
        if known.get("format") != FORMAT:
            raise no_ledger(self.path)
        version = known.get("version", "")
        if version == "1":
            raise InputError(
                f"ledger {self.path}: version 1 says neither which files the mapper loaded nor"
                " what happened in each world, and has no sums: remove it, and search anew"
            )
        if version.isdecimal() and int(version) > VERSION:
            raise InputError(
                f"ledger {self.path}: its version {version} is newer than {VERSION}, the newest"
                " that this topo-verify reads: update it"
            )
        if version != str(VERSION):
            raise changed(self.path, "its version")

    def _require_sums(self, known: dict[str, str]) -> None:
        """Compute every sum again; note the sums and the numbers of the rows."""
        fixed = {key: value for key, value in known.items() if key not in _AMONG}
        self._sums = [_first_sum(fixed)]
        for *fields, made in self._base.execute(f"{_ROWS} ORDER BY number"):
            if made != _next_sum(self._sums[-1], fields):
                raise changed(self.path, f"the row {len(self._sums)}")
            edges, start, *_, written = fields
            self._numbers[edges, start] = len(self._sums)
            self._sums.append(made)
            self.since = (self.since[0] if self.since else written, written)
        stated = {key: known.get(key, "") for key in _AMONG}
        if stated["rows"] != str(len(self._sums) - 1):
            raise changed(self.path, "the number of its rows")
        if stated["sum"] != _next_sum(self._sums[-1], [stated["loaded"]]):
            raise changed(self.path, "its table meta")
        try:
            self.loaded = msgspec.json.decode(stated["loaded"], type=Loaded)
        except msgspec.MsgspecError as error:
            raise changed(self.path, f"what the mapper loaded ({error})") from error

    def _require_same(self, known: dict[str, str], meta: dict[str, str]) -> None:
        """Raise an InputError unless the ledger is of this search."""
        for key, value in meta.items():
            if known.get(key) != value:
                raise InputError(
                    f"ledger {self.path} is of another search: {_difference(key, known, meta)};"
                    " name another file, or remove this one to search anew"
                )
        require_unchanged(self.loaded, self._now, f"ledger {self.path}")

    def _seal(self, rows: int, last: str) -> None:
        """Write what changes with every row, and the sum over all."""
        text = msgspec.json.encode(self.loaded).decode()
        values = (text, str(rows), _next_sum(last, [text]))
        self._base.executemany(
            "REPLACE INTO meta VALUES (?, ?)", list(zip(_AMONG, values, strict=True))
        )

    def _ranks(self) -> list[tuple[int, str, str]]:
        with explained(self.path):
            return self._base.execute("SELECT edges, start, stop FROM shards").fetchall()

    def _without_itself(self, loaded: Loaded) -> Loaded:
        # In this process the ledger, too, is a file that was opened.
        own = str(Path(self.path).absolute())
        return msgspec.structs.replace(
            loaded, files={path: made for path, made in loaded.files.items() if path != own}
        )

    def _identity(self) -> tuple[int, int] | None:
        """Which file has the name now; None if none has."""
        try:
            found = Path(self.path).stat()
        except OSError:
            return None
        return found.st_dev, found.st_ino

    # ------------------------------------------------------------ what is in it

    def _tally(self, text: str) -> Tally:
        try:
            return msgspec.json.decode(text, type=Tally)
        except msgspec.MsgspecError as error:
            raise changed(self.path, f"a tally in it ({error})") from error

    def _require_count(self, shard: Shard, tally: Tally) -> None:
        """Raise an InternalError if a shard of class `any` has not a world for each rank."""
        # Both may stop a shard before its end: a failure, and too many time-outs.
        whole = (self._plan.keep_going or not tally.failing) and self._plan.max_timeouts is None
        if self._plan.kind == "any" and whole and tally.worlds != shard.stop - shard.start:
            raise InternalError(
                f"mappers ran in {tally.worlds} worlds of the shard m{shard.edges}/{shard.start} …"
                f" {shard.stop - 1}, and there are {shard.stop - shard.start}"
            )


def _require_file_name(path: str) -> str:
    if path in ("", ":memory:"):
        raise InputError(
            f"--ledger {path!r}: expected the name of a file, which keeps finished work; got what"
            " SQLite takes for a database in memory"
        )
    return path


def _meta(plan: Plan, mappers: Sequence[Target], tool: str) -> dict[str, str]:
    """What must be equal for a search to go on with a ledger."""
    return {
        "format": FORMAT,
        "version": str(VERSION),
        "tool": tool,
        "target": ",".join(plan.targets),
        "class": plan.kind,
        "policies": plan.choices,
        "keep-going": "yes" if plan.keep_going else "no",
        "limits": msgspec.json.encode(plan.limits).decode(),
        "engine": plan.engine,
        "shard": str(plan.shard),
        "hash": source_hash(mappers),
    }


def _first_sum(meta: dict[str, str]) -> str:
    return _next_sum("", [text for pair in sorted(meta.items()) for text in pair])


def _next_sum(before: str, fields: Sequence[object]) -> str:
    return sha256(msgspec.json.encode([before, *fields])).hexdigest()


def _difference(key: str, known: dict[str, str], meta: dict[str, str]) -> str:
    if key == "hash":
        return "the source of the mapper, or of topo-verify, has changed since"
    return f"its {key} is {known.get(key)}, now it is {meta[key]}"
