"""Obligations: premises, and a goal that follows from them.

hypotheses.py  rules reject no true and confirm no false hypothesis; records stay true
growth.py      hypotheses are complete, augmentations right, S ends as the world; folding
"""

from __future__ import annotations

from dataclasses import dataclass, field

from topo_verify.proofs.first_order.terms import BOOL, Symbol, Term, constant, neg
from topo_verify.proofs.first_order.theory import AXIOMS, TRUE_RECORDS

# What the modules of this folder import whole.
# fmt: off
__all__ = [
    "CONFIRMED", "ENTAILED", "KEPT", "MAPPED", "OWN", "POSED", "WORD", "A", "B", "D", "E",
    "H", "J", "K", "Obligation", "R", "X", "Y", "old", "phi2",
]
# fmt: on

KEPT = ("true-hypothesis-kept",)
CONFIRMED = ("no-false-confirm",)
MAPPED = ("map-isomorphic",)
POSED = ("true-hypothesis-posed",)
ENTAILED = ("map-entailed", "decisions-entailed")


@dataclass(frozen=True, slots=True, kw_only=True)
class Obligation:
    """A statement for Z3 to prove.

    Attributes:
        name: of the theorem; an induction is two obligations, `…-base` and `…-step`.
        claims: those that rest on it.
        theory: names of axioms, and of lemmas proved earlier.
        given: further premises by name.
        argued: the steps in words that use it, by their names in docs/proofs.md.
        needs: premises without each of which some structure refutes the goal.
    """

    name: str
    words: str
    claims: tuple[str, ...]
    theory: tuple[str, ...] = ()
    given: dict[str, Term] = field(default_factory=dict[str, Term])
    goal: Term
    argued: tuple[str, ...] = ()
    needs: tuple[str, ...]

    def premises(self, *, without: str | None = None) -> dict[str, Term]:
        known = {**AXIOMS, **TRUE_RECORDS}
        row = {name: known[name] for name in self.theory} | self.given
        if without is not None:
            del row[without]
        return row

    def negation(self) -> dict[str, Term]:
        return self.premises() | {"goal-fails": neg(self.goal)}


A, B = constant("a1", "W"), constant("b1", "W")
X, Y = constant("x1", "M"), constant("y1", "M")
E, H = constant("e", "M"), constant("h", "M")
D, J, K = constant("d1", "K"), constant("j1", "K"), constant("k1", "K")
OWN = constant("own1", "K")
WORD = constant("w1", "L")
R = constant("r1", "R")

# A 2 means after an augmentation; `old`: the darts of S before it.
phi2 = Symbol("phi2", ("M",), "W")
old = Symbol("old", ("M",), BOOL)
