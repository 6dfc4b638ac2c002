"""The compiled twin: the algorithms of the catalogue for numba, over one array of integers.

It is not trusted: tests compare every event of every run with `topo_verify/algorithms/`. A function
has the name of the one that it mirrors, whose docstring holds for both.

    kernel.py       from sources to cached machine code
    names.py        names for words: `chart.first[v]`, and their offsets
    workspace.py    the fields of a run, and of an enumeration
    events.py       words of a trace, from and to events
    faults.py       some mistakes of topo_verify/faults, by number
    robot.py        robot/simulator.py        chart.py        algorithms/chart.py
    motion.py       motion.py, policies.py    evidence.py     rules.py, beyond/planar.py
    folding.py      folding.py                exploration.py  exploration.py
    pruning.py, enumeration.py                world/enumeration/
    judging/        the ten claims                checkers/
    tally.py        a range of worlds in one kernel
    explore.py      one run in one world of any size
    native.py       a native mapper in the place of `explore`: native_call.py, native_run.py

Kernels become one module, so they import vocabularies whole: `from …workspace import *`. Importing
this package loads neither numba nor numpy.
"""
