"""The inductive obligations, by theme: each true in worlds of any size.

doors.py       what turning keeps, the way back     growing.py   hypotheses, augmentations, the end
tracing.py     no true hypothesis is rejected       folded.py    folding, sound and complete
confirming.py  no false one is confirmed            records.py   records are true, and stay true
"""

from __future__ import annotations

from topo_verify.proofs.first_order.obligations import (
    confirming,
    doors,
    folded,
    growing,
    records,
    tracing,
)
from topo_verify.proofs.first_order.obligations.obligation import Obligation

OBLIGATIONS: tuple[Obligation, ...] = (
    *doors.OBLIGATIONS,
    *tracing.OBLIGATIONS,
    *confirming.OBLIGATIONS,
    *records.OBLIGATIONS,
    *growing.OBLIGATIONS,
    *folded.OBLIGATIONS,
)
"""All of them; a lemma comes before what uses it."""

__all__ = ["OBLIGATIONS", "Obligation"]
