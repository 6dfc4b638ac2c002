"""The store of `reproduce`: the runs that are done, in a file from which the next call goes on.

JSON Lines. The first line says what the file is: format, version, and a hash of topo-verify's
sources, since runs of two versions must not meet in one figure. Each further line is a run with a
sum over its text, which guards against accidents, not against forgery. A line is written with one
call once its run is judged. If the process is killed in the midst of it, the next call finds half a
line at the end, cuts it off, and makes that run again.
"""

from __future__ import annotations

import fcntl
from collections.abc import Iterable
from hashlib import sha256
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import msgspec

from topo_verify.errors import InputError
from topo_verify.harness.engines import Engine
from topo_verify.harness.reproduce.measuring import MeasuredRun, PlannedRun
from topo_verify.harness.search.identity import source_hash
from topo_verify.text import shown

FORMAT = "topo-verify/reproduce-runs"
VERSION = 1


class StoreHeader(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The first line of a store."""

    format: str
    version: int
    sources: str
    engine: Engine = "reference"


class StoredLine(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A further line: a run as JSON, and the sum of that text."""

    sum: str
    run: msgspec.Raw


class RunStore:
    """The runs in a file. Life cycle: `with` it, which locks the file; `put` runs.

    Args:
        path: the file; it is made if it is missing.
        engine: what makes the runs; a store never mixes engines.
    Attributes:
        runs: what is done.
        repaired: half a line was cut off at its end.
    Raises:
        InputError: the file is no store, is of another version, was changed, is in use, or cannot
            be written.
    """

    def __init__(self, path: Path, engine: Engine = "reference") -> None:
        self.path = path
        self.engine: Engine = engine
        self.runs: dict[PlannedRun, MeasuredRun] = {}
        self.repaired = False
        try:
            self._file = path.open("a+b", buffering=0)
        except OSError as error:
            raise InputError(
                f"store {path}: it cannot be opened ({error.strerror}): name another folder with"
                " --out"
            ) from error
        try:
            self._open()
        except BaseException:
            self._file.close()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._file.close()

    def put(self, made: MeasuredRun) -> None:
        """Keep a run; one that is undecided is not kept, so the next call makes it again.

        Raises:
            InputError: the file cannot be written.
        """
        self.runs[made.run] = made
        if made.undecided is None:
            text = msgspec.json.encode(made)
            self._write(StoredLine(_sum(text), msgspec.Raw(text)))

    def missing(self, planned: Iterable[PlannedRun]) -> list[PlannedRun]:
        """The runs that are not done yet."""
        return [run for run in planned if run not in self.runs]

    # ------------------------------------------------------------ the file

    def _open(self) -> None:
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise InputError(
                f"store {self.path}: another reproduce has it open: wait for its end, or name"
                " another folder with --out"
            ) from error
        self._file.seek(0)
        data = self._file.read()
        whole = data[: data.rfind(b"\n") + 1]
        header = StoreHeader(FORMAT, VERSION, source_hash(()), self.engine)
        if not whole and line_of(header).startswith(data):  # new, or killed over its first line
            self._file.truncate(0)
            self._write(header)
            return
        first, *lines = whole.split(b"\n")[:-1] or [b""]
        self._require(first, header)
        for number, line in enumerate(lines, 2):
            made = self._read(line, number)
            self.runs[made.run] = made
        if len(whole) < len(data):
            self._file.truncate(len(whole))
            self.repaired = True

    def _require(self, line: bytes, header: StoreHeader) -> None:
        try:
            found = msgspec.json.decode(line, type=StoreHeader)
        except msgspec.MsgspecError as error:
            raise self._refused("it is no store of reproduce") from error
        if found.format != FORMAT:
            raise self._refused(f"it is {shown(found.format)}, no store of reproduce")
        if found.engine != header.engine:
            raise self._refused(f"the {found.engine} engine made its runs, not the {self.engine}")
        if found != header:
            raise self._refused("its runs were made by another version of topo-verify")

    def _read(self, line: bytes, number: int) -> MeasuredRun:
        try:
            stored = msgspec.json.decode(line, type=StoredLine)
            if _sum(bytes(stored.run)) == stored.sum:
                return msgspec.json.decode(stored.run, type=MeasuredRun)
        except msgspec.MsgspecError as error:
            raise self._refused(f"line {number} is not what topo-verify wrote") from error
        raise self._refused(f"line {number} is not what topo-verify wrote")

    def _refused(self, why: str) -> InputError:
        return InputError(
            f"store {self.path}: {why}: remove it to begin anew, or name another folder with --out"
        )

    def _write(self, line: Any) -> None:
        try:
            self._file.write(line_of(line))
        except OSError as error:
            raise InputError(
                f"store {self.path}: it cannot be written ({error.strerror}): make room, or name"
                " another folder with --out"
            ) from error


def line_of(line: Any) -> bytes:
    """A line of the file."""
    return msgspec.json.encode(line) + b"\n"


def _sum(text: bytes) -> str:
    return sha256(text).hexdigest()[:16]
