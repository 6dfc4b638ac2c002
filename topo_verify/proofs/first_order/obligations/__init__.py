"""The inductive obligations, by theme: each true in worlds of any size.

doors.py         what turning keeps, the way back    growth.py    hypotheses, augmentations, the end
traces.py        no true hypothesis is rejected      folds.py     folding, sound and complete
confirmation.py  no false one is confirmed           records.py   records are true, and stay true
"""

from __future__ import annotations

from topo_verify.proofs.first_order.obligations import (
    confirmation,
    doors,
    folds,
    growth,
    records,
    traces,
)
from topo_verify.proofs.first_order.obligations.obligation import Obligation

OBLIGATIONS: tuple[Obligation, ...] = (
    *doors.OBLIGATIONS,
    *traces.OBLIGATIONS,
    *confirmation.OBLIGATIONS,
    *records.OBLIGATIONS,
    *growth.OBLIGATIONS,
    *folds.OBLIGATIONS,
)
"""All of them; a lemma comes before what uses it."""

__all__ = ["OBLIGATIONS", "Obligation"]
