"""The store of the arena: the runs that are done, in a file from which the next call goes on.

A `LineStore`, whose lines are runs, measurements of memory, and what each mapper rested on when its
runs were made: the files that its TARGET names and all that it had loaded (search/identity.py). A
mapper that has changed since is refused, and so are other limits and other sources of topo-verify,
for their runs must not meet in one table. Mappers may join later; seeds and suites may be other
ones, since a run belongs to a world.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import msgspec

from topo_verify.errors import InputError
from topo_verify.harness.arena.rows import (
    ArenaResult,
    ArenaRun,
    ArenaTask,
    KnownMapper,
    MemoryRun,
)
from topo_verify.harness.line_store import LineStore
from topo_verify.harness.search.identity import (
    Identity,
    merged,
    own_hash,
    require_unchanged,
    source_hash,
)
from topo_verify.programs.loaded import Loaded
from topo_verify.programs.loader import Target
from topo_verify.robot.limits import Limits

FORMAT = "topo-verify/arena-runs"
VERSION = 1


class ArenaHeader(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The first line of a store."""

    format: str
    version: int
    sources: str
    limits: Limits


class ArenaStore(LineStore[ArenaHeader, ArenaRun | MemoryRun | KnownMapper]):
    """The runs in a file. Life cycle: `with` it, which locks the file; `enter` mappers; `put` runs.

    Args:
        path: the file; it is made if it is missing.
        limits: of each run.
    Attributes:
        made: what is done.
    Raises:
        InputError: the file is no store, is of another version, was changed, is in use, or cannot
            be written.
    """

    def __init__(self, path: Path, limits: Limits) -> None:
        self._limits = limits
        header = ArenaHeader(FORMAT, VERSION, own_hash(), limits)
        super().__init__(path, header, ArenaRun | MemoryRun | KnownMapper, "arena")
        self.made: dict[ArenaTask, ArenaRun | MemoryRun] = {}
        self._known: dict[str, KnownMapper] = {}
        for row in self.rows:
            if isinstance(row, KnownMapper):
                self._known[row.mapper] = row
            else:
                self.made[row.task] = row

    def enter(self, mappers: Sequence[Target]) -> None:
        """Let these mappers take part.

        Raises:
            InputError: the runs of one were made with other files than it has now.
        """
        for mapper in mappers:
            sources, known = source_hash([mapper]), self._known.get(mapper.text)
            where = f"store {self.path}: target {mapper.text!r}"
            if known is None:
                self._know(KnownMapper(mapper.text, sources, Loaded()))
                continue
            require_unchanged(known.loaded, Identity([mapper]).loaded(), where)
            if known.sources != sources:
                raise InputError(
                    f"{where}: the source of the mapper has changed since its runs were made: name"
                    " another folder with --out, or remove this store to begin anew"
                )

    def put(self, result: ArenaResult) -> None:
        """Keep a run; one that is undecided is not kept, so the next call makes it again.

        Raises:
            InputError: the file cannot be written; a file that the mapper loaded has changed.
        """
        made = result.made
        if result.loaded is not None:
            known = self._known[made.mapper]
            where = f"store {self.path}: target {made.mapper!r}"
            loaded = self._without_itself(merged(known.loaded, result.loaded, where))
            if loaded != known.loaded:
                self._know(msgspec.structs.replace(known, loaded=loaded))
        self.made[made.task] = made
        if isinstance(made, MemoryRun) or made.undecided is None:
            self.append(made)

    def missing(self, planned: Iterable[ArenaTask]) -> list[ArenaTask]:
        """What is not done yet."""
        return [task for task in planned if task not in self.made]

    def objection(self, found: ArenaHeader) -> str:
        """Why a store with this header, which is not ours, is refused."""
        if found.limits != self._limits:
            return "its runs were made with other limits"
        return super().objection(found)

    def _know(self, known: KnownMapper) -> None:
        self._known[known.mapper] = known
        self.append(known)

    def _without_itself(self, loaded: Loaded) -> Loaded:
        # In this process the store, too, is a file that was opened.
        own = str(self.path.absolute())
        files = {path: made for path, made in loaded.files.items() if path != own}
        return msgspec.structs.replace(loaded, files=files)
