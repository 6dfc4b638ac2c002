"""The ledger: a file of the finished shards, from which a search that was cut off goes on.

It is a SQLite database. `meta` says what was searched, so that only tallies of the same search are
added up: format and version of the ledger, the version of topo-verify, the targets and a hash of
their sources, the class of worlds, policies, limits. `shards` has a row for each finished shard:
its ranks, in how many worlds mappers ran and in how many a claim fails, and the whole tally as
JSON. The size of the worlds is not in `meta`: a finished search goes on to larger ones.

Nothing is lost: a row is written in a transaction once its shard is finished, and SQLite rolls back
a transaction that was cut off when the file is opened next. Nobody else writes: the file is locked
for as long as it is open, by a lock of the operating system's, which ends with the process.

Only the process that searches opens the ledger; workers never do.
"""

from __future__ import annotations

import sqlite3
from collections.abc import Generator, Sequence
from contextlib import contextmanager
from types import TracebackType
from typing import Self

import msgspec

from topo_verify.errors import InputError, InternalError
from topo_verify.harness.search.identity import source_hash
from topo_verify.harness.search.plan import SHARD, Plan, Shard
from topo_verify.harness.tally import Tally
from topo_verify.programs.loader import Target

FORMAT = "topo-verify/ledger"
VERSION = 1

_SCHEMA = """
CREATE TABLE meta (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE shards (
    edges INTEGER NOT NULL,
    start TEXT NOT NULL,  -- ranks have any length
    stop TEXT NOT NULL,
    worlds INTEGER NOT NULL,
    failing INTEGER NOT NULL,
    tally TEXT NOT NULL,
    PRIMARY KEY (edges, start)
) WITHOUT ROWID;
"""


class Ledger:
    """An open ledger. Life cycle: `with` it, which locks the file; `get` and `put` shards.

    Args:
        path: the file; a new one is made if there is none.
        plan: what is searched.
        mappers: the targets of the plan.
        tool: the version of topo-verify.
    Raises:
        InputError: the file is not a ledger, is of another search or of a newer version, is in use,
            or cannot be written; the message says which, and what to do.
    """

    def __init__(self, path: str, plan: Plan, mappers: Sequence[Target], tool: str) -> None:
        self.path = path
        self._plan = plan
        meta = _meta(plan, mappers, tool)
        with self._explained():
            self._base = sqlite3.connect(path, timeout=0, isolation_level=None)
        try:
            with self._explained():
                self._open(meta)
        except BaseException:
            self._base.close()
            raise

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
            InputError: the row is of another shard.
            InternalError: the tally has another number of worlds than the shard.
        """
        with self._explained():
            row = self._base.execute(
                "SELECT stop, worlds, tally FROM shards WHERE edges = ? AND start = ?",
                (shard.edges, str(shard.start)),
            ).fetchone()
        if row is None:
            return None
        stop, worlds, text = row
        tally = self._tally(text)
        if stop != str(shard.stop) or worlds != tally.worlds:
            raise InputError(
                f"ledger {self.path}: the shard at m{shard.edges}/{shard.start} is not what this"
                " topo-verify wrote: remove the file, and search anew"
            )
        self._require_count(shard, tally)
        return tally

    def put(self, shard: Shard, tally: Tally) -> None:
        """Record the tally of a finished shard. Once this returns, it is kept whatever happens.

        Raises:
            InputError: the file cannot be written; the disk may be full.
        """
        self._require_count(shard, tally)
        ranks = (shard.edges, str(shard.start), str(shard.stop))
        text = msgspec.json.encode(tally).decode()
        with self._explained():
            self._base.execute(
                "INSERT INTO shards VALUES (?, ?, ?, ?, ?, ?)",
                (*ranks, tally.worlds, tally.failing, text),
            )

    # ------------------------------------------------------------ opening

    def _open(self, meta: dict[str, str]) -> None:
        """Lock the file and require that it is of this search; give a new one its tables."""
        self._base.execute("PRAGMA locking_mode = EXCLUSIVE")
        self._base.execute("BEGIN EXCLUSIVE")  # locks now, and for longer than COMMIT
        tables = {name for (name,) in self._base.execute("SELECT name FROM sqlite_master")}
        if not tables:
            for statement in _SCHEMA.split(";\n"):
                self._base.execute(statement)
            self._base.executemany("INSERT INTO meta VALUES (?, ?)", meta.items())
        elif "meta" not in tables:
            raise InputError(f"{self.path} is a database, but no ledger: name another file")
        else:
            self._require_same(meta)
        self._base.execute("COMMIT")

    def _require_same(self, meta: dict[str, str]) -> None:
        """Raise an InputError unless the ledger is of this search."""
        known: dict[str, str] = dict(self._base.execute("SELECT key, value FROM meta"))
        if known.get("format") != FORMAT:
            raise InputError(f"{self.path} is a database, but no ledger: name another file")
        version = known.get("version", "")
        if version.isdigit() and int(version) > VERSION:
            raise InputError(
                f"ledger {self.path}: its version {version} is newer than {VERSION}, the newest"
                " that this topo-verify reads: update it"
            )
        for key, value in meta.items():
            if known.get(key) != value:
                raise InputError(
                    f"ledger {self.path} is of another search: {_difference(key, known, meta)};"
                    " name another file, or remove this one to search anew"
                )

    @contextmanager
    def _explained(self) -> Generator[None]:
        """Turn an error of SQLite's into an InputError that says what to do."""
        try:
            yield
        except sqlite3.Error as error:
            message = str(error)
            if "locked" in message:
                message = "another search has it open: wait for its end, or name another file"
            elif "not a database" in message:
                message = "it is no ledger: name another file"
            elif "readonly" in message or "read-only" in message:
                message = "it cannot be written: name a file that can"
            elif "unable to open" in message:
                message = "it cannot be opened: name a file in a folder that can be written"
            elif "full" in message or "I/O" in message:
                message += "; what was recorded before is kept: make room and start again"
            else:
                message += "; name another file"
            raise InputError(f"ledger {self.path}: {message}") from error

    # ------------------------------------------------------------ what is in it

    def _tally(self, text: str) -> Tally:
        try:
            return msgspec.json.decode(text, type=Tally)
        except msgspec.MsgspecError as error:
            raise InputError(
                f"ledger {self.path}: a tally in it cannot be read ({error}): remove the file, and"
                " search anew"
            ) from error

    def _require_count(self, shard: Shard, tally: Tally) -> None:
        """Raise an InternalError if a shard of class `any` has not a world for each rank."""
        # Both may stop a shard before its end: a failure, and too many time-outs.
        whole = (self._plan.keep_going or not tally.failing) and self._plan.max_timeouts is None
        if self._plan.kind == "any" and whole and tally.worlds != shard.stop - shard.start:
            raise InternalError(
                f"mappers ran in {tally.worlds} worlds of the shard m{shard.edges}/{shard.start} …"
                f" {shard.stop - 1}, and there are {shard.stop - shard.start}"
            )


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
        "shard": str(SHARD[plan.choices]),
        "hash": source_hash(mappers),
    }


def _difference(key: str, known: dict[str, str], meta: dict[str, str]) -> str:
    if key == "hash":
        return "the source of the mapper, or of topo-verify, has changed since"
    return f"its {key} is {known.get(key)}, now it is {meta[key]}"
