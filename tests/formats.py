"""Stored files of each version of a file format, and the tests that every format must pass."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import pytest


class Format(NamedTuple):
    """A format with a version.

    Attributes:
        name: the beginning of the names of its stored files: NAME_VERSION.ENDING.
        version: the version that is written today, from the source of topo-verify.
        read: reads a stored file and asserts what it holds.
        refused: for each version that `read` refuses, how the error says to make the file anew.
    """

    name: str
    version: int
    read: Callable[[Path], None]
    refused: Mapping[int, str] = MappingProxyType({})


def stored(folder: Path, name: str, version: int) -> list[Path]:
    """The stored files of a version of a format."""
    return sorted(folder.glob(f"{name}_{version}.*"))


def missing(folder: Path, kinds: Sequence[Format]) -> list[str]:
    """What `folder` lacks: a stored file for each version of each format."""
    return [
        f"store a file of version {version} of the format as {folder.name}/{kind.name}_{version}.*"
        for kind in kinds
        for version in range(1, kind.version + 1)
        if not stored(folder, kind.name, version)
    ]


def files_of(folder: Path, kinds: Sequence[Format], *, without: Sequence[str] = ()) -> list[Any]:
    """Parameters of a test: a format, a version and a stored file; not these endings."""
    return [
        pytest.param(kind, version, path, id=path.name)
        for kind in kinds
        for version in range(1, kind.version + 1)
        for path in stored(folder, kind.name, version)
        if path.suffix not in without
    ]
