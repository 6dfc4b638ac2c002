"""The store of `reproduce`: the runs that are done, in a file from which the next call goes on.

A `LineStore` whose first line holds a hash of topo-verify's sources, since runs of two versions
must not meet in one figure, and the engine that made the runs.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import msgspec

from topo_verify.harness.engines import Engine
from topo_verify.harness.line_store import LineStore
from topo_verify.harness.reproduce.measuring import MeasuredRun, PlannedRun
from topo_verify.harness.search.identity import source_hash

FORMAT = "topo-verify/reproduce-runs"
VERSION = 1


class StoreHeader(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """The first line of a store."""

    format: str
    version: int
    sources: str
    engine: Engine = "reference"


class RunStore(LineStore[StoreHeader, MeasuredRun]):
    """The runs in a file. Life cycle: `with` it, which locks the file; `put` runs.

    Args:
        path: the file; it is made if it is missing.
        engine: what makes the runs; a store never mixes engines.
    Attributes:
        runs: what is done.
    Raises:
        InputError: the file is no store, is of another version, was changed, is in use, or cannot
            be written.
    """

    def __init__(self, path: Path, engine: Engine = "reference") -> None:
        self.engine: Engine = engine
        header = StoreHeader(FORMAT, VERSION, source_hash(()), engine)
        super().__init__(path, header, MeasuredRun, "reproduce")
        self.runs: dict[PlannedRun, MeasuredRun] = {made.run: made for made in self.rows}

    def put(self, made: MeasuredRun) -> None:
        """Keep a run; one that is undecided is not kept, so the next call makes it again.

        Raises:
            InputError: the file cannot be written.
        """
        self.runs[made.run] = made
        if made.undecided is None:
            self.append(made)

    def missing(self, planned: Iterable[PlannedRun]) -> list[PlannedRun]:
        """The runs that are not done yet."""
        return [run for run in planned if run not in self.runs]

    def objection(self, found: StoreHeader) -> str:
        """Why a store with this header, which is not ours, is refused."""
        if found.engine != self.engine:
            return f"the {found.engine} engine made its runs, not the {self.engine}"
        return super().objection(found)
