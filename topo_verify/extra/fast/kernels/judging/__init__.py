"""The ten claims inside the kernel: what `checkers/` would say of a run, without sentences.

    layout.py       the fields; world and trace, read with every range checked
    truth.py        claims 1 to 7: the trace replayed in its world    checkers/replayed_trace.py
    justified.py    claim 8: the evidence, recomputed                 checkers/excursions.py
    fold.py         the fold of a history, with rollback              checkers/folding.py
    entailed.py     claims 9 and 10                                   checkers/entailment.py
    verdict.py      status and share of each claim; `judge`           claims.py, coverage.py

Tests compare the judge with `checkers/`. Where a buffer is full, a number is out of range, or a
planar witness is needed, the verdict is **open**: the checkers must be asked.
"""
