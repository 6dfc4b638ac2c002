"""The file of a baseline: gzip without a time stamp, holding JSON Lines.

A header comes first, then a line for each world, with the world itself. Each line ends with
`sum`, a hash of this and all earlier lines: a reader can name the first changed line. Sums guard
against accidents, not against forgery.

Source: docs/semantics.md, section 14; docs/baselines.md.
"""

from __future__ import annotations

import gzip
import re
import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from hashlib import sha256
from io import BytesIO
from os import PathLike
from typing import Any, Literal, TypeVar

import msgspec

from topo_verify.errors import InputError, shown
from topo_verify.programs.protocol import dialect
from topo_verify.robot.events import Policies
from topo_verify.robot.limits import Limits
from topo_verify.world import io
from topo_verify.world.formats import files
from topo_verify.world.rooted_map import World

S = TypeVar("S", bound=msgspec.Struct)

FORMAT: Literal["topo-verify/baseline"] = "topo-verify/baseline"
VERSION: Literal[1] = 1
"""Written, and the newest that is read."""

MOST_BYTES = 2**30
"""Unpacked: some millions of worlds."""

_SUM = re.compile(rb'(.*),"sum":"([0-9a-f]{16})"\}\n', re.DOTALL)


class Header(msgspec.Struct, frozen=True, kw_only=True):
    """The first line of a baseline.

    Attributes:
        tool: the version of topo-verify that recorded it.
        worlds, seed: the arguments that gave the corpus.
        corpus, digest, total: its description, hash and number of worlds.
    """

    format: Literal["topo-verify/baseline"] = FORMAT
    version: Literal[1] = VERSION
    tool: str
    target: str
    policies: Policies | None
    worlds: tuple[str, ...]
    seed: int
    corpus: str
    digest: str
    total: int
    limits: Limits


class BaselineEntry(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """A line of the file: one world, and the mapper's run in it.

    Attributes:
        world: its id; beyond 200 edges, its JSON.
        name: its name in the corpus, if that differs.
        moves, decisions: hashes of doors and of declared decisions.
        map: the id of the valid delivered map; beyond 200 edges a hash of its code.
        undecided: out of time while it still moved, or declined.
    """

    world: str
    name: str = ""
    cost: int
    moves: str
    decisions: str | None
    map: str | None
    failed: tuple[str, ...] = ()
    undecided: bool = False

    @property
    def right(self) -> bool:
        """Whether every claim was judged and none failed."""
        return not self.failed and not self.undecided

    @property
    def called(self) -> str:
        """Its name for people."""
        return self.name or self.world


@dataclass(frozen=True, slots=True)
class Baseline:
    """A header, and an entry for each world in the order of the corpus."""

    header: Header
    entries: tuple[BaselineEntry, ...]


# ---------------------------------------------------------------- writing


def encode(baseline: Baseline) -> bytes:
    """The bytes of the file: the same for the same baseline and the same zlib.

    InputError: there are fewer entries than the header says.
    """
    header, entries = baseline.header, baseline.entries
    if len(entries) != header.total:
        raise InputError(
            f"the baseline has {len(entries)} of {header.total} worlds: a mapper that runs out of"
            " time has no baseline; give it more time or fewer worlds"
        )
    packed = BytesIO()
    # No file name and no time, for equal bytes.
    with gzip.GzipFile("", "wb", fileobj=packed, mtime=0) as file:
        file.writelines(_summed([header, *entries]))
    return packed.getvalue()


def _summed(lines: Iterable[msgspec.Struct]) -> Iterator[bytes]:
    total = ""
    for line in lines:
        body = msgspec.json.encode(line)[:-1]
        total = _next_sum(total, body)
        yield body + f',"sum":"{total}"}}\n'.encode()


def _next_sum(before: str, body: bytes) -> str:
    return sha256(before.encode() + body).hexdigest()[:16]


# ---------------------------------------------------------------- reading


def load(path: str | PathLike[str]) -> Baseline:
    """The baseline in the file; InputError if it cannot be read."""
    return decode(files.read(path), name=shown(path))


def decode(data: bytes, *, name: str = "baseline") -> Baseline:
    """The baseline in these bytes, called `name` in messages.

    InputError: they are no baseline, one of a newer version, or were changed.
    """
    lines = _require_sums(_unpacked(data, name), name)
    first = next(lines, None)
    if first is None:
        raise InputError(f"{name} is empty: name a file that topo-verify record wrote")
    header = _line(first, Header, f"{name}, line 1")
    entries = tuple(
        _line(line, BaselineEntry, f"{name}, line {number}") for number, line in enumerate(lines, 2)
    )
    if len(entries) != header.total:
        raise InputError(
            f"{name}, line {len(entries) + 2}: the file has {len(entries)} worlds, its header"
            f" promises {header.total}; copy it whole, or record a new one"
        )
    return Baseline(header, entries)


def world_of(entry: BaselineEntry, *, name: str, line: int) -> World:
    """The world of the entry at this line; InputError if its text names none."""
    try:
        return io.from_text(entry.world)
    except InputError as error:
        raise InputError(f"{name}, line {line}: {error}; record a new baseline") from error


def _unpacked(data: bytes, name: str) -> Iterator[bytes]:
    """Lazy, so that a huge file is refused before it fills memory."""
    number, size = 1, 0
    try:
        with gzip.GzipFile(fileobj=BytesIO(data)) as file:
            # The first piece of a longer line has no valid sum.
            while line := file.readline(files.LIMIT):
                size += len(line)
                if size > MOST_BYTES:
                    raise InputError(
                        f"{name}, line {number}: more than {MOST_BYTES // 2**20} MiB unpacked, the"
                        " most that is read: record fewer worlds"
                    )
                yield line
                number += 1
    except gzip.BadGzipFile as error:
        raise InputError(
            f"{name}, line {number}: expected gzip data ({error}); name a file that topo-verify"
            " record wrote, or copy it again"
        ) from error
    except (EOFError, zlib.error) as error:
        raise InputError(
            f"{name}, line {number}: the file ends or breaks here; copy it whole, or record a new"
            " one"
        ) from error


def _require_sums(lines: Iterable[bytes], name: str) -> Iterator[bytes]:
    """The lines without their checked sums."""
    total = ""
    for number, line in enumerate(lines, 1):
        # A newer version may sum otherwise.
        if number == 1:
            _require_version(line, name)
        match = _SUM.fullmatch(line)
        body, stated = (match[1], match[2].decode()) if match else (line, "")
        total = _next_sum(total, body)
        if stated != total:
            raise InputError(
                f"{name}, line {number}: not as it was written (expected the sum {total}, got"
                f" {stated or 'none'}): undo the change, copy the file again, or record a new one"
            )
        yield body + b"}"


class _Head(msgspec.Struct):
    """Decoded first, since newer versions may differ."""

    format: str
    version: int


def _require_version(line: bytes, name: str) -> None:
    head = _line(line, _Head, f"{name}, line 1")
    if head.format != FORMAT:
        raise InputError(
            f"{name}, line 1: expected the format {FORMAT!r}, got {shown(head.format)!r}: name a"
            " file that topo-verify record wrote"
        )
    if head.version > VERSION:
        raise InputError(
            f"{name}, line 1: baseline version {head.version} is newer than {VERSION}, the newest"
            " that this topo-verify reads: update it"
        )


def _line(line: bytes, kind: type[S], where: str) -> S:
    try:
        return msgspec.json.decode(line, type=kind)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        raise InputError(
            f"{where}: expected a line of a baseline: {error}; name a file that topo-verify record"
            " wrote"
        ) from error


# ---------------------------------------------------------------- the schema


def schema() -> dict[str, Any]:
    """The JSON Schema of a line."""
    references, components = msgspec.json.schema_components([Header, BaselineEntry])
    for name in ("Header", "BaselineEntry"):
        components[name]["properties"]["sum"] = {"type": "string", "pattern": "^[0-9a-f]{16}$"}
        components[name]["required"].append("sum")
    components["Header"]["required"] += ["format", "version"]
    title = "a line of a topo-verify baseline: first the header, then an entry a world"
    return dialect({"title": title, "anyOf": list(references), "$defs": components})
