"""Reads files up to a limit and writes them whole or not at all. Failures raise `InputError`.

Texts that gzip packed are unpacked, whatever their name, and none is written packed.
"""

from __future__ import annotations

import gzip
import os
import sys
import zlib
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from io import BytesIO
from os import PathLike
from pathlib import Path
from secrets import token_hex
from typing import IO, TextIO

from topo_verify.errors import InputError, WriteError, shown

LIMIT = 64 * 2**20
"""Bytes: twice a world of a million darts with positions."""


GZIP = b"\x1f\x8b"
"""How a file begins that gzip packed."""

_PACKED = {
    GZIP: "by gzip, once more",
    b"PK\x03\x04": "as zip, as spreadsheets are (save a table as CSV)",
    b"BZh": "by bzip2",
    b"\xfd7zXZ\0": "by xz",
    b"(\xb5/\xfd": "by zstd",
    b"7z\xbc\xaf": "as 7z",
}
"""How a packed file begins, and what packed it."""


def read(path: str | PathLike[str]) -> bytes:
    """The bytes of the file, at most `LIMIT`."""
    with opened(path) as file:
        return read_stream(file, name=shown(path))


@contextmanager
def opened(path: str | PathLike[str]) -> Generator[IO[bytes]]:
    """The file, open for reading inside the block; errors become `InputError`."""
    try:
        with Path(path).open("rb") as file:
            yield file
    except (OSError, ValueError) as error:  # a null character in the path
        if isinstance(error, InputError):
            raise
        name = shown(path) or "''"
        raise InputError(f"cannot read {name}: {_reason(error)}; name a file") from error


def standard_input() -> IO[bytes]:
    """Standard input, as bytes."""
    stream: TextIO | None = sys.stdin
    if stream is None:
        raise InputError("standard input is closed: name a file, or pipe the text in")
    return stream.buffer


def lines(stream: IO[bytes], *, name: str) -> Iterator[bytes]:
    """The lines of a stream of any length, each of at most `LIMIT` bytes."""
    line = stream.readline(LIMIT + 1)
    if line.startswith(tuple(_PACKED)):
        packed = line + stream.read(LIMIT + 1)
        stream = BytesIO(unpacked(read_stream(BytesIO(packed), name=name), name))
        line = stream.readline()
    while line:
        if len(line) > LIMIT:
            raise InputError(too_large(f"a line of {name}"))
        yield line
        line = stream.readline(LIMIT + 1)


def read_stream(stream: IO[bytes], *, name: str) -> bytes:
    """The bytes of the stream, at most `LIMIT`."""
    data = stream.read(LIMIT + 1)
    if len(data) > LIMIT:
        raise InputError(too_large(name))
    return data


def unpacked(data: bytes, name: str) -> bytes:
    """The bytes without gzip, at most `LIMIT`; refuses what another program packed."""
    if data.startswith(GZIP):
        try:
            with gzip.GzipFile(fileobj=BytesIO(data)) as file:
                data = file.read(LIMIT + 1)
        except (OSError, EOFError, zlib.error) as error:
            raise InputError(
                f"{name} is packed by gzip, and damaged: {error}; pack it again"
            ) from error
        if len(data) > LIMIT:
            raise InputError(too_large(f"{name}, unpacked,"))
    for start, how in _PACKED.items():
        if data.startswith(start):
            raise InputError(f"{name} is packed {how}: unpack it; .gz is read as well")
    return data


def unpacked_name(path: str | PathLike[str]) -> str:
    """The file's name without an ending `.gz`."""
    name = os.fspath(path)
    return name[:-3] if name.lower().endswith(".gz") else name


def too_large(name: str) -> str:
    """The error message for more than `LIMIT`."""
    return (
        f"{name} is larger than {LIMIT // 2**20} MiB, the most that is read (a million darts take"
        " less): give a smaller one"
    )


def write(path: str | PathLike[str], text: str | bytes) -> None:
    """Write the bytes, or the text as UTF-8: all of it or nothing.

    A complete temporary file in the same folder replaces the old one. Links are followed,
    permissions kept; a pipe or a terminal is written to directly.
    """
    if isinstance(text, str) and unpacked_name(path) != os.fspath(path):
        raise InputError(f"{shown(path)}: no text is written packed: leave .gz out, then pack it")
    try:
        data = text.encode() if isinstance(text, str) else text
        target = Path(os.path.realpath(path))
        if target.exists() and not target.is_file():
            target.write_bytes(data)
        else:
            _replace(target, data)
    except (OSError, ValueError) as error:
        raise WriteError(
            f"cannot write {shown(path)}: {_reason(error)}; name a file that can be written"
        ) from error


def _replace(target: Path, data: bytes) -> None:
    # on the same file system
    temporary = target.parent / f".topo-verify-{token_hex(8)}"
    try:
        with temporary.open("xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        if target.exists():
            temporary.chmod(target.stat().st_mode & 0o777)
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def stem(path: str | PathLike[str]) -> str:
    """The file's name without its ending, and without `.gz`."""
    return os.fsencode(Path(unpacked_name(path)).stem).decode("utf-8", "replace")


def _reason(error: OSError | ValueError) -> str:
    return (isinstance(error, OSError) and error.strerror) or str(error)
