"""Confirmation: a full match is never false. The induction runs backward from v0.

The way home ends at v0, where the marker tells more than a signature: its direction names the dart.
So there S and the world are at the same dart. Backward over each door: what leads to corresponding
darts came from corresponding darts, since neither an edge nor a turn has two beginnings. So h's
place is where the robot began. The percepts in between are not needed for this; they only reject
early.
"""

from __future__ import annotations

from topo_verify.proofs.first_order.axioms import (
    CORRESPONDENCE,
    a,
    alpha,
    cons,
    minv0,
    mwalk,
    nil,
    phi,
    stays,
    walk,
)
from topo_verify.proofs.first_order.obligations.obligation import (
    CONFIRMED,
    WORD,
    B,
    D,
    E,
    H,
    Obligation,
    X,
)
from topo_verify.proofs.first_order.obligations.traces import ACROSS, BY_WORDS, WORDS
from topo_verify.proofs.first_order.rules import alike, arrival, beyond, x
from topo_verify.proofs.first_order.terms import Term, eq, forall


def _confirmed(word: Term) -> Term:
    """A word that ends at corresponding places began at corresponding places."""
    return forall((x, a), stays(x, word), eq(phi(mwalk(x, word)), walk(a, word)), eq(phi(x), a))


OBLIGATIONS: tuple[Obligation, ...] = (
    Obligation(
        name="confirm-final",
        words="where S shows the marker and the robot senses just that, they are at the same dart",
        claims=CONFIRMED,
        theory=CORRESPONDENCE,
        given={"at-v0": minv0(X), "matches": alike(X, B)},
        goal=eq(phi(X), B),
        needs=("rot-injective", "phi-root", "phi-rot", "at-v0", "matches"),
    ),
    Obligation(
        name="confirm-back",
        words="what leads to the same dart by the same door, over an edge of S, came from the same",
        claims=CONFIRMED,
        theory=CORRESPONDENCE,
        given=ACROSS | {"same-behind": eq(phi(arrival(X, D)), beyond(B, D))},
        goal=eq(phi(X), B),
        needs=("on-explored-edges", "same-behind", "rot-injective", "alpha-involution"),
    ),
    Obligation(
        name="confirm-conclude",
        words="if h's place is where the robot stood behind e, then e ends in h",
        claims=CONFIRMED,
        theory=("alpha-involution",),
        given={"behind-e": eq(B, alpha(phi(E))), "same-place": eq(phi(H), B)},
        goal=eq(alpha(phi(H)), phi(E)),
        needs=("behind-e", "same-place", "alpha-involution"),
    ),
    Obligation(
        name="word-confirm-base",
        words="backward over the empty word",
        claims=CONFIRMED,
        theory=WORDS,
        goal=_confirmed(nil),
        argued=BY_WORDS,
        needs=("walk-nil", "map-walk-nil"),
    ),
    Obligation(
        name="word-confirm-step",
        words="backward over a word with one door more, if over the rest",
        claims=CONFIRMED,
        theory=(*WORDS, "phi-alpha", "phi-rot", "alpha-involution", "rot-injective"),
        given={"for-the-rest": _confirmed(WORD)},
        goal=_confirmed(cons(D, WORD)),
        argued=BY_WORDS,
        needs=("for-the-rest", "phi-alpha", "rot-injective", "alpha-involution", "stays-cons"),
    ),
)
