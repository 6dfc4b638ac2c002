"""The obligations by theme; each holds in worlds of any size.

doors.py         turning by doors, and the way back
traces.py        rules reject no true hypothesis
confirmation.py  a full match confirms no false hypothesis
records.py       records are true when they are written, and stay true
growth.py        hypotheses are complete, augmentations are right, and S ends as the world
folds.py         folding is sound, and complete when no place is open
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
"""All obligations; a lemma comes before those that use it."""

__all__ = ["OBLIGATIONS", "Obligation"]
