"""Every false statement, as a theorem that must be refuted."""

from __future__ import annotations

from tests.proofs.bounded.mutants import MUTANTS, NEGATIVES
from tests.proofs.first_order.refuted import AXIOM_MUTANTS, FAULTY_RULES, PLANAR
from topo_verify.proofs.theorem import Theorem

FALSE_STATEMENTS: tuple[Theorem, ...] = (
    *NEGATIVES,
    PLANAR,
    *AXIOM_MUTANTS,
    *FAULTY_RULES,
    *MUTANTS,
)
"""The catalogue has two of them, as controls."""
