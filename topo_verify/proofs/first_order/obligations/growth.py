"""Growth of S: the hypotheses, both augmentations, and the end of the exploration.

A loop joins e and a confirmed h. A new vertex is added when every hypothesis was rejected; since no
rejection is false, the place behind e is then no vertex of S. Its darts are numbered from the entry
dart on, so `phi2`, the correspondence afterwards, maps door k of the entry dart to door k of the
place. At the start S is v0 alone: such a new vertex, with the root as its entry dart.

When no dart is unexplored, the image of phi is closed under sigma and alpha. Since the world is
connected, S is the world, and phi is an isomorphism that maps root to root.
"""

from __future__ import annotations

from topo_verify.proofs.first_order.axioms import (
    CORRESPONDENCE,
    alpha,
    deg,
    explored,
    inv0,
    k,
    k0,
    malpha,
    mdeg,
    minv0,
    mrot,
    msigma,
    phi,
    rot,
    sigma,
    succ,
)
from topo_verify.proofs.first_order.obligations.obligation import (
    CONFIRMED,
    MAPPED,
    POSED,
    A,
    B,
    D,
    E,
    H,
    J,
    K,
    Obligation,
    X,
)
from topo_verify.proofs.first_order.rules import POSED as IS_POSED
from topo_verify.proofs.first_order.rules import b, e, h, x
from topo_verify.proofs.first_order.terms import (
    BOOL,
    Symbol,
    Term,
    conj,
    constant,
    differ,
    disj,
    eq,
    forall,
    neg,
    substitute,
)

# A 2 means after the augmentation; `old` are the darts that S had before it.
phi2 = Symbol("phi2", ("M",), "W")
malpha2 = Symbol("malpha2", ("M",), "M")
explored2 = Symbol("explored2", ("M",), BOOL)
old = Symbol("old", ("M",), BOOL)
ENTRY = constant("entry", "M")

BEHIND_E: dict[str, Term] = {"e-unexplored": neg(explored(E)), "behind-e": eq(B, alpha(phi(E)))}
TRUE_LOOP = {"e-ends-in-h": eq(alpha(phi(E)), phi(H))}


def is_posed(dart: Term) -> Term:
    """The dart is among the hypotheses for e, behind which b was sensed."""
    return substitute(IS_POSED, {e: E, h: dart, b: B})


def _joined(one: Term, other: Term) -> dict[str, Term]:
    """The edges of S after these two darts were joined."""
    rest = conj(differ(x, one), differ(x, other))
    return {
        "explored-then": forall(x, eq(explored2(x), disj(explored(x), eq(x, one), eq(x, other)))),
        "one-end": eq(malpha2(one), other),
        "other-end": eq(malpha2(other), one),
        "others-as-before": forall(x, rest, eq(malpha2(x), malpha(x))),
    }


NEW_VERTEX: dict[str, Term] = {
    "numbered-from-entry": forall(k, eq(phi2(mrot(ENTRY, k)), rot(B, k))),
    "entry-degree": eq(mdeg(ENTRY), deg(B)),
    "entry-marker": eq(minv0(ENTRY), inv0(B)),
}

ENTRY_THERE = eq(phi2(mrot(ENTRY, k0)), B)
"""Door 0 of the new vertex, which is its first dart, is the dart behind e."""


def _apart(door: Term) -> Term:
    return forall(x, differ(phi(x), rot(B, door)))


OBLIGATIONS: tuple[Obligation, ...] = (
    Obligation(
        name="posed",
        words="if e ends in a dart of S, that dart is among the hypotheses",
        claims=POSED,
        theory=CORRESPONDENCE,
        given=BEHIND_E | {"ends-in-S": eq(B, phi(X))},
        goal=is_posed(X),
        needs=("e-unexplored", "phi-degree", "phi-marker", "phi-alpha", "alpha-no-fixed-point"),
    ),
    Obligation(
        name="new-is-new",
        words="if all hypotheses are false, the place behind e is no dart of S",
        claims=(*POSED, *MAPPED),
        theory=CORRESPONDENCE,
        given=BEHIND_E | {"all-false": forall(x, is_posed(x), differ(phi(x), B))},
        goal=differ(phi(X), B),
        needs=("e-unexplored", "all-false", "alpha-no-fixed-point", "phi-injective"),
    ),
    Obligation(
        name="new-apart-base",
        words="no door of a new vertex is a dart of S: door 0",
        claims=MAPPED,
        theory=("rot-zero",),
        given={"is-new": forall(x, differ(phi(x), B))},
        goal=_apart(k0),
        argued=("induction over doors",),
        needs=("is-new", "rot-zero"),
    ),
    Obligation(
        name="new-apart-step",
        words="no door of a new vertex is a dart of S: door k+1, if door k",
        claims=MAPPED,
        theory=("sigma-injective", "rot-next", "map-sigma-onto", "phi-sigma"),
        given={"for-the-door-before": _apart(D)},
        goal=_apart(succ(D)),
        argued=("induction over doors",),
        # Without `map-sigma-onto` no finite structure breaks it: that axiom stands for finiteness.
        needs=("for-the-door-before", "sigma-injective", "phi-sigma", "rot-next"),
    ),
    Obligation(
        name="new-injective",
        words="two doors of a new vertex are one dart of S only if they are one dart of the world",
        claims=MAPPED,
        theory=("doors-wrap", "map-doors-wrap"),
        given=NEW_VERTEX | {"one-dart": eq(phi2(mrot(ENTRY, K)), phi2(mrot(ENTRY, J)))},
        goal=eq(mrot(ENTRY, K), mrot(ENTRY, J)),
        needs=("numbered-from-entry", "entry-degree", "one-dart", "doors-wrap", "map-doors-wrap"),
    ),
    Obligation(
        name="new-entry",
        words="door 0 of a new vertex, whose first dart is joined with e, is the dart behind e",
        claims=MAPPED,
        theory=("rot-zero",),
        given=NEW_VERTEX,
        goal=ENTRY_THERE,
        needs=("numbered-from-entry", "rot-zero"),
    ),
    Obligation(
        name="new-turns",
        words="doors of the new vertex follow each other as they do at its place in the world",
        claims=MAPPED,
        theory=("rot-next", "map-rot-next"),
        given=NEW_VERTEX,
        goal=eq(phi2(msigma(mrot(ENTRY, D))), sigma(phi2(mrot(ENTRY, D)))),
        needs=("numbered-from-entry", "rot-next", "map-rot-next"),
    ),
    Obligation(
        name="new-percept",
        words="the new vertex has the degree and the marker of its place",
        claims=MAPPED,
        theory=("rot-degree", "rot-marker"),
        given=NEW_VERTEX
        | {
            "one-degree": eq(mdeg(mrot(ENTRY, D)), mdeg(ENTRY)),
            "one-marker": eq(minv0(mrot(ENTRY, D)), minv0(ENTRY)),
        },
        goal=conj(
            eq(mdeg(mrot(ENTRY, D)), deg(phi2(mrot(ENTRY, D)))),
            eq(minv0(mrot(ENTRY, D)), inv0(phi2(mrot(ENTRY, D)))),
        ),
        needs=("entry-degree", "entry-marker", "rot-degree", "rot-marker", "numbered-from-entry"),
    ),
    Obligation(
        name="new-edges",
        words="after a new vertex, explored edges of S are edges of the world",
        claims=MAPPED,
        theory=("alpha-involution", "phi-alpha", "explored-both-ends", "map-rot-zero"),
        given=BEHIND_E
        | _joined(E, ENTRY)
        | {
            "explored-are-old": forall(x, explored(x), old(x)),
            "e-is-old": old(E),
            "nothing-moves": forall(x, old(x), eq(phi2(x), phi(x))),
            "entry-is-there": ENTRY_THERE,  # by `new-entry`
            "is-explored": explored2(X),
        },
        goal=conj(eq(phi2(malpha2(X)), alpha(phi2(X))), explored2(malpha2(X))),
        needs=(
            "alpha-involution",
            "phi-alpha",
            "one-end",
            "nothing-moves",
            "entry-is-there",
            "map-rot-zero",
        ),
    ),
    Obligation(
        name="loop-edges",
        words="after a loop, explored edges of S are edges of the world",
        claims=(*CONFIRMED, *MAPPED),
        theory=("alpha-involution", "phi-alpha", "explored-both-ends"),
        given=TRUE_LOOP | _joined(E, H) | {"is-explored": explored2(X)},
        goal=conj(eq(phi(malpha2(X)), alpha(phi(X))), explored2(malpha2(X))),
        needs=("e-ends-in-h", "alpha-involution", "phi-alpha", "explored-both-ends", "other-end"),
    ),
    Obligation(
        name="closed-turns",
        words="what S knows of a vertex of the world is the whole vertex",
        claims=MAPPED,
        theory=("phi-sigma",),
        given={"known": eq(phi(X), A)},
        goal=eq(phi(msigma(X)), sigma(A)),
        argued=("a connected world is reached",),
        needs=("known", "phi-sigma"),
    ),
    Obligation(
        name="closed-crosses",
        words="when nothing is unexplored, S knows what lies behind every dart it knows",
        claims=MAPPED,
        theory=("phi-alpha",),
        given={"all-explored": forall(x, explored(x)), "known": eq(phi(X), A)},
        goal=eq(phi(malpha(X)), alpha(A)),
        argued=("a connected world is reached", "every round explores two darts"),
        needs=("all-explored", "known", "phi-alpha"),
    ),
)
