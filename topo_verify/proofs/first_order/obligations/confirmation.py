"""Confirmation: a full match is never false, by induction backward from v0.

The way home ends at v0, where the direction of the marker identifies the dart: equal percepts there
mean that S and the world are at the same dart. Backward over each door, corresponding darts came
from corresponding darts, since turning and crossing are injective. So h's place is where the robot
began. The percepts in between are not needed for this; they only reject earlier.
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
    """If this word ends at corresponding darts, it began at corresponding darts."""
    return forall((x, a), stays(x, word), eq(phi(mwalk(x, word)), walk(a, word)), eq(phi(x), a))


OBLIGATIONS: tuple[Obligation, ...] = (
    Obligation(
        name="confirm-final",
        words="if S shows the marker and the robot senses the same percept, they are at one dart",
        claims=CONFIRMED,
        theory=CORRESPONDENCE,
        given={"at-v0": minv0(X), "matches": alike(X, B)},
        goal=eq(phi(X), B),
        needs=("rot-injective", "phi-root", "phi-rot", "at-v0", "matches"),
    ),
    Obligation(
        name="confirm-back",
        words="if one door, over an explored edge, leads from two darts to one, the two are one",
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
        words="if the empty word ends at corresponding darts, it began at corresponding darts",
        claims=CONFIRMED,
        theory=WORDS,
        goal=_confirmed(nil),
        argued=BY_WORDS,
        needs=("walk-nil", "map-walk-nil"),
    ),
    Obligation(
        name="word-confirm-step",
        words="the same holds for a word with one door more, if it holds for the rest",
        claims=CONFIRMED,
        theory=(*WORDS, "phi-alpha", "phi-rot", "alpha-involution", "rot-injective"),
        given={"for-the-rest": _confirmed(WORD)},
        goal=_confirmed(cons(D, WORD)),
        argued=BY_WORDS,
        needs=("for-the-rest", "phi-alpha", "rot-injective", "alpha-involution", "stays-cons"),
    ),
)
