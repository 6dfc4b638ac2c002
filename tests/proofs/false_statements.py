"""Every false statement, as a theorem that must be refuted, and its world replayed.

They show that the theorems can fail. To add one:

- Mutant of an inductive theorem: list in `needs` of its `Obligation` each premise without which the
  obligation is false. The most telling one becomes a theorem here; the nightly test of
  first_order/test_theorems.py tries all of them.
- Mutant of a rule: a `RuleMutant` in first_order/mutants/, with one mistake, a scene and the moves
  that show it. For whole words: a `RuleFault` in topo_verify/proofs/bounded/encoding.py, and its
  row in bounded/mutants.py.
- Negative: a `Negative` in `SMALLEST`, topo_verify/proofs/bounded/confirmations.py, with the fewest
  edges that refute it.
"""

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
