"""The ten claims inside the kernel: what `checkers/` would say of a run, without its sentences.

    layout.py       what is asked, the verdict, what the judge remembers, by names;
                    the world and the words of a trace, read with every range checked
    truth.py        claims 1 to 7: the trace replayed in its world    checkers/replayed_trace.py
    justified.py    claim 8: the evidence, recomputed                 checkers/excursions.py
    fold.py         the fold of a history, with rollback              checkers/folding.py
    entailed.py     claims 9 and 10                                   checkers/entailment.py
    verdict.py      status and share of each claim; `judge`           claims.py, coverage.py

The mapper is not trusted: the judge reads the world, the words of the trace and the map that is
delivered, and nothing else of the workspace. It is not trusted either: tests hold status and share
of every claim to `checkers/`, right and wrong mappers, in every small world.

Where a buffer is full, a number is out of range, or a planar witness would have to be looked for,
the verdict is **open**: no claim is said to hold, and the checkers must be asked.
"""
