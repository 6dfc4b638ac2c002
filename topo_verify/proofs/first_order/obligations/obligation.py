"""What an obligation is: premises, a goal, and the premises without which it is false."""

from __future__ import annotations

from dataclasses import dataclass, field

from topo_verify.proofs.first_order.axioms import AXIOMS
from topo_verify.proofs.first_order.rules import TRUE_RECORDS
from topo_verify.proofs.first_order.terms import Term, constant, neg

KEPT = ("true-hypothesis-kept",)
CONFIRMED = ("no-false-confirm",)
MAPPED = ("map-isomorphic",)
POSED = ("true-hypothesis-posed",)
ENTAILED = ("map-entailed", "decisions-entailed")


@dataclass(frozen=True, slots=True, kw_only=True)
class Obligation:
    """One thing for Z3 to prove, about constants that may be anything the premises allow.

    Attributes:
        name: of the theorem; an induction is two obligations, `…-base` and `…-step`.
        claims: the claims that rest on it.
        theory: names of axioms and of lemmas that other obligations prove.
        given: what is assumed beside the theory, under names of its own.
        goal: what follows.
        argued: the steps in words that carry it further, by their names in docs/proofs.md.
        needs: premises each of which is needed. Without it a structure refutes the goal, and that
            is a theorem of its own, a mutant.
    """

    name: str
    words: str
    claims: tuple[str, ...]
    theory: tuple[str, ...]
    given: dict[str, Term] = field(default_factory=dict[str, Term])
    goal: Term
    argued: tuple[str, ...] = ()
    needs: tuple[str, ...]

    def premises(self, *, without: str | None = None) -> dict[str, Term]:
        """All premises by name; one may be left out."""
        known = {**AXIOMS, **TRUE_RECORDS}
        row = {name: known[name] for name in self.theory} | self.given
        if without is not None:
            del row[without]
        return row

    def negation(self) -> dict[str, Term]:
        """What must be impossible: the premises, and the goal false."""
        return self.premises() | {"goal-fails": neg(self.goal)}


# The constants that obligations speak of.
A, B = constant("a1", "W"), constant("b1", "W")
X, Y = constant("x1", "M"), constant("y1", "M")
E, H = constant("e", "M"), constant("h", "M")
D, J, K = constant("d1", "K"), constant("j1", "K"), constant("k1", "K")
OWN = constant("own1", "K")
WORD = constant("w1", "L")
R = constant("r1", "R")
