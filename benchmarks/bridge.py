"""Mutation test of the bridge: every small change of the algorithms must change a trace.

Each mutant of the files in `MUTATED` (mutations.py) maps the same worlds until its trace differs
from that of the mapper that Coq proves, extracted to OCaml, or takes over 20 s of the processor.
Else it has **survived**.

    .venv/bin/python benchmarks/bridge.py                     every mutant
    .venv/bin/python benchmarks/bridge.py --only motion.py    those of one file
    .venv/bin/python benchmarks/bridge.py --library DIR       the library in Coq, compiled before

Exit code 1 if a mutant survives that is not in `SAME`, or one of `SAME` is killed.
"""

from __future__ import annotations

import argparse
import importlib
import sys
from collections.abc import Iterator, Sequence
from functools import partial
from multiprocessing.connection import Connection
from pathlib import Path
from resource import RLIMIT_AS, RLIMIT_CPU, setrlimit
from tempfile import TemporaryDirectory

from mutations import Mutant, Planted, chosen, in_forks, mutants, report

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from tests.helpers import PAPER, trace_of, worlds  # noqa: E402  the tree is on the path only now
from tests.proofs.mechanised import test_extracted_mappers as bridge  # noqa: E402
from tests.proofs.mechanised.conftest import LIMIT, extracted  # noqa: E402
from tests.proofs.mechanised.written import written  # noqa: E402
from topo_verify.proofs.mechanised import toolchain  # noqa: E402
from topo_verify.world.resolve import resolve_world  # noqa: E402

FOLDER = ROOT / "topo_verify" / "algorithms"
MUTATED = ("rules", "exploration", "motion")

SECONDS = 20
MEMORY = 4 << 30
ENDLESS = "a run without end"

NOT_COMPARED = "it is the number of a sequence in the evidence, which Coq's rules do not give"
NOT_READ = "records are read at unexplored darts only, and both darts are explored by then"
NEVER_AWAY = (
    "only folding may conclude away from vu and from the marker, and in no world that was searched"
    " does it: every world with 5 edges, and about 90 larger ones"
)
ONE_LEVEL = (
    "the catalogue has one level or all of them; with one, nothing deeper is recorded anyway"
)

SAME: dict[str, str] = {
    "rules.py PrefixRule.refute: len(sequences) - 1 -> len(sequences) + 1": NOT_COMPARED,
    "rules.py PrefixRule.refute: 1 -> 2 (4)": NOT_COMPARED,
    "rules.py HistoryRule.refute: len(sequences) - 1 -> len(sequences) + 1": NOT_COMPARED,
    "rules.py HistoryRule.refute: 1 -> 2 (2)": NOT_COMPARED,
    "rules.py RecordsRule.learn: self.records.pop(e, None) -> pass": NOT_READ,
    "rules.py RecordsRule.learn: self.records.pop(entry, None) -> pass": NOT_READ,
    "rules.py RecordsRule._record: step + self.levels -> step - self.levels": ONE_LEVEL,
    "rules.py RecordsRule._record: 1 -> 2": ONE_LEVEL,
    "exploration.py execute: shared < len(h.doors) -> shared <= len(h.doors)": (
        "a way that is shared whole ends where the robot stands, or a rule has refuted it"
    ),
    "exploration.py localise: pilot.back(0) -> pass": NEVER_AWAY,
    "exploration.py localise: 0 -> 1 (2)": NEVER_AWAY,
    "motion.py on_demand: not TYPE_CHECKING -> TYPE_CHECKING": "the base keeps the same value",
    "motion.py Pilot.__init__: 0 -> 1 (2)": "it is set when the robot crosses e, before it is read",
    "motion.py Pilot.forward: return percept -> return None": "its callers do not use it",
}
"""Mutants that change no trace, by their text, with the reason."""


def jobs() -> Iterator[bridge.Job]:
    """The runs; those that expose most mutants come first."""
    listed = [resolve_world(world) for world in (*bridge.FAMILIES, *bridge.TELLING_GENUS)]
    some = [*listed, *worlds(range(4))]
    for name in bridge.PROVED:
        yield from (bridge.Job(name, world) for world in some)
    for pick, order in (("first", "oldest"), ("last", "newest")):
        for name in ("basic", "enhancement-iii-all+i"):
            yield from (bridge.Job(name, world, pick, order) for world in some)
    yield from (bridge.Job(name, resolve_world(bridge.TELLING)) for name in bridge.PROVED)
    yield from (bridge.Job(name, resolve_world(bridge.LONG[0])) for name in PAPER)


def differs(runs: Sequence[tuple[bridge.Job, str]], mutant: Mutant, pipe: Connection) -> None:
    """In a fork: send the run in which the mutant leaves another trace, or ""."""
    setrlimit(RLIMIT_AS, (MEMORY, MEMORY))
    setrlimit(RLIMIT_CPU, (SECONDS, SECONDS))
    for name in [name for name in sys.modules if name.startswith("topo_verify.algorithms")]:
        del sys.modules[name]
    Planted(mutant, "topo_verify.algorithms", FOLDER)
    try:
        catalogue = importlib.import_module("topo_verify.algorithms").CATALOGUE
    except Exception:  # noqa: BLE001  whatever a mutant raises
        pipe.send("the import")
        return
    for job, trace in runs:
        try:
            algorithm = catalogue[job.algorithm].with_policies(pick=job.pick, order=job.order)
            same = written(trace_of(job.world, algorithm)) == trace
        except Exception:  # noqa: BLE001  a mutant may deliver what is no map
            same = False
        if not same:
            pipe.send(f"{job.algorithm}, {job.pick}, {job.order}, in {job.world!r}")
            return
    pipe.send("")


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--only", default="", help="mutants whose file or text has this in it")
    parser.add_argument("--list", action="store_true", help="list them, and do no more")
    parser.add_argument("--library", type=Path, help="a folder with the library in Coq, compiled")
    options = parser.parse_args()
    everyone = [mutant for name in MUTATED for mutant in mutants(FOLDER / f"{name}.py")]
    wanted = chosen(everyone, options, SAME)
    if why := toolchain.missing():
        raise SystemExit(why)
    with TemporaryDirectory() as made, TemporaryDirectory() as folder:
        if options.library is None:
            toolchain.copy_library(Path(made), toolchain.files())
            ran = toolchain.compile_all(Path(made), toolchain.files(), timeout=LIMIT)
            assert ran.accepted, ran.output
        library = options.library or Path(made)
        program = extracted(library.resolve(), Path(folder), "Mappers", "main")
        every = list(jobs())
        traces = bridge.traces_in_coq(program, every)
    runs = list(zip(every, traces, strict=True))
    outcomes = in_forks(wanted, partial(differs, runs), 1)
    return report(((m, ENDLESS if seen is None else seen) for m, seen, _ in outcomes), SAME)


if __name__ == "__main__":
    sys.exit(main())
