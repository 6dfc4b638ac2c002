"""The compiled twin: the algorithms of the catalogue for numba, over one array of integers.

It is the first faster implementation that the toolkit serves. It is not trusted: tests hold it to
`topo_verify/algorithms/` by every event of every run. Read it beside the reference; each file names
the one that it mirrors, and functions have the names of the reference's.

    kernel.py       what a kernel is; from sources to machine code, and where that is kept
    names.py        names for words: `chart.first[v]`, and the offsets that are written for them
    workspace.py    the one array: which field stands where; the state of an enumeration
    events.py       the words that a run writes, from and to the events of a trace
    faults.py       some mistakes of topo_verify/faults, by number

    robot.py        robot/simulator.py        chart.py        algorithms/chart.py
    motion.py       motion.py, policies.py    evidence.py     enhancement_i, _ii, _iii, planar.py
    folding.py      folding.py                exploration.py  exploration.py
    pruning.py, enumeration.py                world/enumeration/
    judging/        the ten claims                checkers/
    tally.py        a range of worlds, run and judged in one kernel; shard.py for use from Python
    explore.py      one run in one world of any size, for use from Python
    native.py       a native mapper in the place of `explore`: native_call.py, native_run.py

Kernels become one module with one set of constants, so they import the vocabularies whole:
`from topo_verify.compiled.workspace import *`, and so those of `events`, `faults` and
`judging.layout`.

Importing this package, or any file of it, imports neither numba nor numpy.
"""

from __future__ import annotations

from importlib.util import find_spec

from topo_verify.errors import InputError


def available() -> bool:
    """Whether the compiled engine can run here: whether numba is installed."""
    return find_spec("numba") is not None


def require(what: str) -> None:
    """Raise an InputError unless numba is installed.

    Args:
        what: the thing that needs it, as the subject of the sentence.
    """
    if not available():
        raise InputError(f"{what} needs numba: pip install 'topo-verify[fast]'")
