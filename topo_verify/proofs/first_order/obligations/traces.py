"""Traces on S keep the correspondence with the world, so no rule rejects a true hypothesis.

The rules `prefix` and `history`, and the motion itself, compare the percept that S shows with the
one that is sensed. Base: if e ends in h, then vu is h's place. Step: across an explored edge, S and
the world arrive at corresponding places. So, by induction, the percepts compared are equal along
words of any length.
"""

from __future__ import annotations

from topo_verify.proofs.first_order.axioms import (
    CORRESPONDENCE,
    a,
    alpha,
    cons,
    explored,
    mrot,
    mwalk,
    nil,
    phi,
    stays,
    walk,
)
from topo_verify.proofs.first_order.obligations.obligation import (
    KEPT,
    OWN,
    WORD,
    B,
    D,
    E,
    H,
    Obligation,
    X,
)
from topo_verify.proofs.first_order.rules import (
    HISTORY,
    MOTION,
    PREFIX,
    alike,
    arrival,
    b,
    beyond,
    k,
    own,
    x,
)
from topo_verify.proofs.first_order.terms import Term, conj, eq, forall, neg, substitute

WORDS = ("walk-nil", "walk-cons", "map-walk-nil", "map-walk-cons", "stays-nil", "stays-cons")
BY_WORDS = ("induction over words", "rules compare along words")

HERE = {"corresponds": eq(phi(X), B)}
"""Dart x of S corresponds to dart b of the world, where the robot stands."""

ACROSS = {"on-explored-edges": explored(mrot(X, D))}


def applied(rule: Term) -> Term:
    """A rule at x, for door D, about what is sensed behind that door."""
    return substitute(rule, {x: X, k: D, own: OWN, b: beyond(B, D)})


def _traced(word: Term) -> Term:
    """From corresponding darts, this word leads to corresponding darts."""
    return forall((x, a), eq(phi(x), a), stays(x, word), eq(phi(mwalk(x, word)), walk(a, word)))


OBLIGATIONS: tuple[Obligation, ...] = (
    Obligation(
        name="percept",
        words="corresponding darts show the same percept, the marker's direction included",
        claims=KEPT,
        theory=CORRESPONDENCE,
        given=HERE,
        goal=alike(X, B),
        needs=("phi-degree", "phi-marker", "phi-rot", "phi-root", "phi-injective", "corresponds"),
    ),
    Obligation(
        name="trace-init",
        words="if e does end in h, the robot behind e stands at h's place",
        claims=KEPT,
        theory=CORRESPONDENCE,
        given={"behind-e": eq(B, alpha(phi(E))), "hypothesis": eq(alpha(phi(E)), phi(H))},
        goal=conj(eq(phi(H), B), alike(H, B)),
        needs=("behind-e", "hypothesis"),
    ),
    Obligation(
        name="trace-step",
        words="across an explored edge, corresponding places lead to corresponding places",
        claims=KEPT,
        theory=CORRESPONDENCE,
        given=HERE | ACROSS,
        goal=eq(phi(arrival(X, D)), beyond(B, D)),
        needs=("phi-alpha", "phi-rot", "on-explored-edges", "corresponds"),
    ),
    Obligation(
        name="word-trace-base",
        words="the empty word keeps the correspondence",
        claims=KEPT,
        theory=WORDS,
        goal=_traced(nil),
        argued=BY_WORDS,
        needs=("walk-nil", "map-walk-nil"),
    ),
    Obligation(
        name="word-trace-step",
        words="a word that begins with one door more keeps it, if the rest does",
        claims=KEPT,
        theory=(*WORDS, "phi-alpha", "phi-rot"),
        given={"for-the-rest": _traced(WORD)},
        goal=_traced(cons(D, WORD)),
        argued=BY_WORDS,
        needs=("for-the-rest", "phi-alpha", "phi-rot", "stays-cons", "walk-cons", "map-walk-cons"),
    ),
    Obligation(
        name="motion-keeps",
        words="no motion rejects the true hypothesis (rule `none`, and every other)",
        claims=KEPT,
        theory=CORRESPONDENCE,
        given=HERE | ACROSS,
        goal=neg(applied(MOTION)),
        argued=BY_WORDS,
        needs=("on-explored-edges", "corresponds", "phi-alpha"),
    ),
    Obligation(
        name="prefix-keeps",
        words="rule `prefix` rejects no true hypothesis",
        claims=KEPT,
        theory=CORRESPONDENCE,
        given=HERE | {"own-way-is-explored": explored(mrot(X, OWN))},
        goal=neg(applied(PREFIX)),
        argued=BY_WORDS,
        needs=("own-way-is-explored", "corresponds", "phi-alpha"),
    ),
    Obligation(
        name="history-keeps",
        words="rule `history` rejects no true hypothesis",
        claims=KEPT,
        theory=CORRESPONDENCE,
        given=HERE,
        goal=neg(applied(HISTORY)),
        argued=BY_WORDS,
        needs=("corresponds", "phi-alpha", "phi-degree"),
    ),
)
