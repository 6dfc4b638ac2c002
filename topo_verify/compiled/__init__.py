"""The compiled twin: the algorithms of the catalogue for numba, over one array of integers.

It is the first faster implementation that the toolkit serves. It is not trusted: tests hold it to
`topo_verify/algorithms/` by every event of every run. Read it beside the reference; each file names
the one that it mirrors, and functions have the names of the reference's.

    kernel.py       what a kernel is; from sources to machine code, and where that is kept
    workspace.py    the one array: which field stands where
    events.py       the words that a run writes, from and to the events of a trace
    robot.py        robot/simulator.py        chart.py        algorithms/chart.py
    motion.py       algorithms/motion.py      policies.py     algorithms/policies.py
    prefix.py       enhancement_i.py          history.py      enhancement_ii.py
    records.py      enhancement_iii.py        partial_fold.py and folding.py   folding.py
    planar.py       planar.py                 exploration.py  exploration.py
    faults.py       some mistakes of topo_verify/faults, by number
    explore.py      one run in one world of any size, for use from Python

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
