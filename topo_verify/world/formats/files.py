"""Reads files up to a limit and writes them whole or not at all. Failures raise `InputError`."""

from __future__ import annotations

import os
import sys
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from secrets import token_hex
from typing import IO, TextIO

from topo_verify.errors import InputError, shown

LIMIT = 64 * 2**20
"""Bytes: twice a world of a million darts with positions."""


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
    while line := stream.readline(LIMIT + 1):
        if len(line) > LIMIT:
            raise InputError(too_large(f"a line of {name}"))
        yield line


def read_stream(stream: IO[bytes], *, name: str) -> bytes:
    """The bytes of the stream, at most `LIMIT`."""
    data = stream.read(LIMIT + 1)
    if len(data) > LIMIT:
        raise InputError(too_large(name))
    return data


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
    try:
        data = text.encode() if isinstance(text, str) else text
        target = Path(os.path.realpath(path))
        if target.exists() and not target.is_file():
            target.write_bytes(data)
        else:
            _replace(target, data)
    except (OSError, ValueError) as error:
        raise InputError(
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
    """The file's name without its ending."""
    return os.fsencode(Path(path).stem).decode("utf-8", "replace")


def _reason(error: OSError | ValueError) -> str:
    return (isinstance(error, OSError) and error.strerror) or str(error)
