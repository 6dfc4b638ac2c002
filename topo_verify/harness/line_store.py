"""A file of finished runs, from which the next call goes on: JSON Lines, each with a sum.

The first line says what the file is; a file with another first line is refused. Each further line
holds a run and a sum over its text, which guards against accidents, not against forgery. A line is
written with one call once its run is judged. If the process is killed in the midst of it, the next
call finds half a line at the end, cuts it off, and makes that run again.
"""

from __future__ import annotations

import fcntl
from collections.abc import Iterator
from hashlib import sha256
from pathlib import Path
from types import TracebackType
from typing import Any, Generic, Self, TypeVar

import msgspec

from topo_verify.errors import InputError
from topo_verify.text import shown

RowT = TypeVar("RowT")
HeaderT = TypeVar("HeaderT", bound=msgspec.Struct)


class StoredLine(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A further line: a run as JSON, and the sum of that text."""

    sum: str
    run: msgspec.Raw


class LineStore(Generic[HeaderT, RowT]):
    """An open store. Life cycle: `with` it, which locks the file; `append` rows.

    Args:
        path: the file; it is made if it is missing.
        header: what the first line must hold; its field `format` names the kind of store.
        row: the type of a row.
        command: the command whose store it is.
    Attributes:
        rows: what it held when it was opened, in the order of writing.
        repaired: half a line was cut off at its end.
    Raises:
        InputError: the file is no such store, was changed, is in use, or cannot be written.
    """

    def __init__(self, path: Path, header: HeaderT, row: Any, command: str) -> None:
        self.path, self.header, self.command = path, header, command
        self.rows: list[RowT] = []
        self.repaired = False
        self._decoder = msgspec.json.Decoder(row)
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

    def append(self, row: RowT) -> None:
        """Write a row behind the others. Once this returns, it is kept.

        Raises:
            InputError: the file cannot be written.
        """
        text = msgspec.json.encode(row)
        self._write(StoredLine(_sum(text), msgspec.Raw(text)))

    def objection(self, found: HeaderT) -> str:
        """Why a store with this header, which is not ours, is refused."""
        del found
        return "its runs were made by another version of topo-verify"

    def refused(self, why: str) -> InputError:
        """The error of a store that cannot be used, with the mend."""
        return InputError(
            f"store {self.path}: {why}: remove it to begin anew, or name another folder with --out"
        )

    # ------------------------------------------------------------ the file

    def _open(self) -> None:
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise InputError(
                f"store {self.path}: another {self.command} has it open: wait for its end, or name"
                " another folder with --out"
            ) from error
        self._file.seek(0)
        data = self._file.read()
        whole = data[: data.rfind(b"\n") + 1]
        if not whole and line_of(self.header).startswith(data):  # new, or killed over this line
            self._file.truncate(0)
            self._write(self.header)
            return
        first, *lines = whole.split(b"\n")[:-1] or [b""]
        self._require(first)
        self.rows += self._read(lines)
        if len(whole) < len(data):
            self._file.truncate(len(whole))
            self.repaired = True

    def _require(self, line: bytes) -> None:
        try:
            found = msgspec.json.decode(line, type=type(self.header))
        except msgspec.MsgspecError as error:
            raise self.refused(f"it is no store of {self.command}") from error
        kind, ours = (getattr(header, "format", "") for header in (found, self.header))
        if kind != ours:
            raise self.refused(f"it is {shown(kind)}, no store of {self.command}")
        if found != self.header:
            raise self.refused(self.objection(found))

    def _read(self, lines: list[bytes]) -> Iterator[RowT]:
        for number, line in enumerate(lines, 2):
            try:
                stored = msgspec.json.decode(line, type=StoredLine)
                if _sum(bytes(stored.run)) != stored.sum:
                    raise self.refused(f"line {number} is not what topo-verify wrote")
                yield self._decoder.decode(stored.run)
            except msgspec.MsgspecError as error:
                raise self.refused(f"line {number} is not what topo-verify wrote") from error

    def _write(self, line: msgspec.Struct) -> None:
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
