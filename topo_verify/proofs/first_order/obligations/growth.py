"""S grows into the world: hypotheses are complete, augmentations right, and folding is sound.

A loop joins e and a confirmed h. A new vertex is added when every hypothesis was rejected; no
rejection is false, so the place behind e is no vertex of S. `phi2`, the correspondence afterwards,
maps door k of the entry dart to door k of the place. When no dart is unexplored, the image of phi
is closed under sigma and alpha; the world is connected, so phi is an isomorphism.

**Folding.** A place (sort P) is a visit of the robot and a door there. In a world that shows the
history it is a dart, `pi`. `same` is what folding has identified, `joined` a known edge.

    pturn(p), prot(p,k)  the next place clockwise, the k-th next
    pdeg, pinv0          degree of the visit; did it see the marker?
    ppoints(p)           the marker that was seen there points at p
    ptoroot(p)           the door from p to that place
    pacross(p)           where all is joined: what p is joined with

Sound: places that are `same` are one dart, also under an assumption true in the world; so a
contradiction refutes the assumption. Complete: when no place is open, places that are one dart are
`same`: walk from both to the marker by the same doors; there they are identified, and so, backward,
are the two.

Source: J. R. Stallings, Invent. Math. 71 (1983).
"""

from __future__ import annotations

from functools import partial

from topo_verify.proofs.first_order import theory as t
from topo_verify.proofs.first_order.obligations import *
from topo_verify.proofs.first_order.terms import *

malpha2 = Symbol("malpha2", ("M",), "M")
explored2 = Symbol("explored2", ("M",), BOOL)
ENTRY = constant("entry", "M")

BEHIND_E: dict[str, Term] = {
    "e-unexplored": neg(t.explored(E)),
    "behind-e": eq(B, t.alpha(t.phi(E))),
}
TRUE_LOOP = {"e-ends-in-h": eq(t.alpha(t.phi(E)), t.phi(H))}


def is_posed(dart: Term) -> Term:
    return substitute(t.POSED, {t.e: E, t.h: dart, t.b: B})


def _joined(one: Term, other: Term) -> dict[str, Term]:
    rest = conj(differ(t.x, one), differ(t.x, other))
    return {
        "explored-then": forall(
            t.x, eq(explored2(t.x), disj(t.explored(t.x), eq(t.x, one), eq(t.x, other)))
        ),
        "one-end": eq(malpha2(one), other),
        "other-end": eq(malpha2(other), one),
        "others-as-before": forall(t.x, rest, eq(malpha2(t.x), t.malpha(t.x))),
    }


NEW_VERTEX: dict[str, Term] = {
    "numbered-from-entry": forall(t.k, eq(phi2(t.mrot(ENTRY, t.k)), t.rot(B, t.k))),
    "entry-degree": eq(t.mdeg(ENTRY), t.deg(B)),
    "entry-marker": eq(t.minv0(ENTRY), t.inv0(B)),
}

ENTRY_THERE = eq(phi2(t.mrot(ENTRY, t.k0)), B)
"""The first dart of the new vertex is the dart behind e."""


def _apart(door: Term) -> Term:
    return forall(t.x, differ(t.phi(t.x), t.rot(B, door)))


_maps = partial(Obligation, claims=MAPPED)

GROWTH_OBLIGATIONS: tuple[Obligation, ...] = (
    Obligation(
        name="posed",
        words="if e ends in a dart of S, that dart is among the hypotheses",
        claims=POSED,
        theory=t.CORRESPONDENCE,
        given=BEHIND_E | {"ends-in-S": eq(B, t.phi(X))},
        goal=is_posed(X),
        needs=("e-unexplored", "phi-degree", "phi-marker", "phi-alpha", "alpha-no-fixed-point"),
    ),
    Obligation(
        name="new-is-new",
        words="if all hypotheses are false, the place behind e is no dart of S",
        claims=(*POSED, *MAPPED),
        theory=t.CORRESPONDENCE,
        given=BEHIND_E | {"all-false": forall(t.x, is_posed(t.x), differ(t.phi(t.x), B))},
        goal=differ(t.phi(X), B),
        needs=("e-unexplored", "all-false", "alpha-no-fixed-point", "phi-injective"),
    ),
    _maps(
        name="new-apart-base",
        words="no door of a new vertex is a dart of S: door 0",
        theory=("rot-zero",),
        given={"is-new": forall(t.x, differ(t.phi(t.x), B))},
        goal=_apart(t.k0),
        argued=("induction over doors",),
        needs=("is-new", "rot-zero"),
    ),
    _maps(
        name="new-apart-step",
        words="no door of a new vertex is a dart of S: door k+1, if door k",
        theory=("sigma-injective", "rot-next", "map-sigma-onto", "phi-sigma"),
        given={"for-the-door-before": _apart(D)},
        goal=_apart(t.succ(D)),
        argued=("induction over doors",),
        # `map-sigma-onto` stands for finiteness: no finite structure breaks it.
        needs=("for-the-door-before", "sigma-injective", "phi-sigma", "rot-next"),
    ),
    _maps(
        name="new-injective",
        words="two doors of a new vertex are one dart of S only if they are one dart of the world",
        theory=("doors-wrap", "map-doors-wrap"),
        given=NEW_VERTEX | {"one-dart": eq(phi2(t.mrot(ENTRY, K)), phi2(t.mrot(ENTRY, J)))},
        goal=eq(t.mrot(ENTRY, K), t.mrot(ENTRY, J)),
        needs=("numbered-from-entry", "entry-degree", "one-dart", "doors-wrap", "map-doors-wrap"),
    ),
    _maps(
        name="new-entry",
        words="door 0 of a new vertex, whose first dart is joined with e, is the dart behind e",
        theory=("rot-zero",),
        given=NEW_VERTEX,
        goal=ENTRY_THERE,
        needs=("numbered-from-entry", "rot-zero"),
    ),
    _maps(
        name="new-turns",
        words="doors of the new vertex follow each other as they do at its place in the world",
        theory=("rot-next", "map-rot-next"),
        given=NEW_VERTEX,
        goal=eq(phi2(t.msigma(t.mrot(ENTRY, D))), t.sigma(phi2(t.mrot(ENTRY, D)))),
        needs=("numbered-from-entry", "rot-next", "map-rot-next"),
    ),
    _maps(
        name="new-percept",
        words="the new vertex has the degree and the marker of its place",
        theory=("rot-degree", "rot-marker"),
        given=NEW_VERTEX
        | {
            "one-degree": eq(t.mdeg(t.mrot(ENTRY, D)), t.mdeg(ENTRY)),
            "one-marker": eq(t.minv0(t.mrot(ENTRY, D)), t.minv0(ENTRY)),
        },
        goal=conj(
            eq(t.mdeg(t.mrot(ENTRY, D)), t.deg(phi2(t.mrot(ENTRY, D)))),
            eq(t.minv0(t.mrot(ENTRY, D)), t.inv0(phi2(t.mrot(ENTRY, D)))),
        ),
        needs=("entry-degree", "entry-marker", "rot-degree", "rot-marker", "numbered-from-entry"),
    ),
    _maps(
        name="new-edges",
        words="after a new vertex, explored edges of S are edges of the world",
        theory=("alpha-involution", "phi-alpha", "explored-both-ends", "map-rot-zero"),
        given=BEHIND_E
        | _joined(E, ENTRY)
        | {
            "explored-are-old": forall(t.x, t.explored(t.x), old(t.x)),
            "e-is-old": old(E),
            "nothing-moves": forall(t.x, old(t.x), eq(phi2(t.x), t.phi(t.x))),
            "entry-is-there": ENTRY_THERE,
            "is-explored": explored2(X),
        },
        goal=conj(eq(phi2(malpha2(X)), t.alpha(phi2(X))), explored2(malpha2(X))),
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
        goal=conj(eq(t.phi(malpha2(X)), t.alpha(t.phi(X))), explored2(malpha2(X))),
        needs=("e-ends-in-h", "alpha-involution", "phi-alpha", "explored-both-ends", "other-end"),
    ),
    _maps(
        name="closed-turns",
        words="what S knows of a vertex of the world is the whole vertex",
        theory=("phi-sigma",),
        given={"known": eq(t.phi(X), A)},
        goal=eq(t.phi(t.msigma(X)), t.sigma(A)),
        argued=("a connected world is reached",),
        needs=("known", "phi-sigma"),
    ),
    _maps(
        name="closed-crosses",
        words="when nothing is unexplored, S knows what lies behind every dart it knows",
        theory=("phi-alpha",),
        given={"all-explored": forall(t.x, t.explored(t.x)), "known": eq(t.phi(X), A)},
        goal=eq(t.phi(t.malpha(X)), t.alpha(A)),
        argued=("a connected world is reached", "every round explores two darts"),
        needs=("all-explored", "known", "phi-alpha"),
    ),
)


pturn = Symbol("pturn", ("P",), "P")
prot = Symbol("prot", ("P", "K"), "P")
pdeg = Symbol("pdeg", ("P",), "G")
pinv0 = Symbol("pinv0", ("P",), BOOL)
ppoints = Symbol("ppoints", ("P",), BOOL)
ptoroot = Symbol("ptoroot", ("P",), "K")
pacross = Symbol("pacross", ("P",), "P")
joined = Symbol("joined", ("P", "P"), BOOL)
same = Symbol("same", ("P", "P"), BOOL)
pi = Symbol("pi", ("P",), "W")

p, q, p2, q2 = (Var(name, "P") for name in ("p", "q", "p2", "q2"))
P, Q, P2, Q2 = (constant(name, "P") for name in ("p1", "q1", "p3", "q3"))

FITS: dict[str, Term] = {
    "pi-turn": forall(p, eq(pi(pturn(p)), t.sigma(pi(p)))),
    # Tried: without `tried_at`, fold-closed-home comes back `unknown`.
    "place-rot-zero": forall(p, eq(prot(p, t.k0), p), tried_at=((prot(p, t.k0),), (ptoroot(p),))),
    "place-rot-next": forall((p, t.k), eq(prot(p, t.succ(t.k)), pturn(prot(p, t.k)))),
    "pi-joined": forall((p, q), joined(p, q), eq(t.alpha(pi(p)), pi(q))),
    "pi-degree": forall(p, eq(pdeg(p), t.deg(pi(p))), tried_at=((pi(p),),)),
    "pi-marker": forall(p, eq(pinv0(p), t.inv0(pi(p))), tried_at=((pi(p),),)),
    "pi-points": forall(p, ppoints(p), eq(pi(p), t.root)),
}
"""The world shows the percepts of the history."""

PI_ROT: dict[str, Term] = {"pi-rot": forall((p, t.k), eq(pi(prot(p, t.k)), t.rot(pi(p), t.k)))}

SAME: dict[str, Term] = {"identified": eq(pi(P), pi(Q))}

CLOSED: dict[str, Term] = {
    "marker-folded": forall((p, q), ppoints(p), ppoints(q), same(p, q)),
    "turns-folded": forall((p, q), eq(same(pturn(p), pturn(q)), same(p, q))),
    "edges-folded": forall((p, q, p2, q2), same(p, q), joined(p, p2), joined(q, q2), same(p2, q2)),
    "no-place-open": forall(p, joined(p, pacross(p))),
    "joined-both-ways": forall((p, q), joined(p, q), joined(q, p)),
    "marker-is-seen": forall(
        p, pinv0(p), ppoints(prot(p, ptoroot(p))), tried_at=((ptoroot(p),), (pinv0(p),))
    ),
    "place-doors-wrap": forall(
        (p, t.i, t.j),
        t.wraps(pdeg(p), t.i, t.j),
        eq(prot(p, t.i), prot(p, t.j)),
        tried_at=((prot(p, t.i), prot(p, t.j)),),
    ),
}
"""Nothing is left to fold; no place is open."""

AT_MARKER = {name: CLOSED[name] for name in ("marker-folded", "marker-is-seen", "place-doors-wrap")}
"""The part of `CLOSED` needed at the marker; the rest slows Z3 down."""

FOLDS = KEPT + ENTAILED
BY_STEPS = ("induction over fold steps",)
BY_WAYS = ("induction over ways home", "a connected world is reached")

_folds = partial(Obligation, claims=FOLDS, argued=BY_STEPS)
_closes = partial(Obligation, claims=ENTAILED, argued=BY_WAYS)


def _turned(door: Term) -> Term:
    return forall(p, eq(pi(prot(p, door)), t.rot(pi(p), door)))


TURN = ("rot-zero", "rot-next")
TURN_FITS = {name: FITS[name] for name in ("pi-turn", "place-rot-zero", "place-rot-next")}

SOUND: tuple[Obligation, ...] = (
    Obligation(
        name="fold-turn-base",
        words="a door of a visit is that door in the world: door 0",
        claims=FOLDS,
        theory=TURN,
        given=TURN_FITS,
        goal=_turned(t.k0),
        argued=("induction over doors",),
        needs=("rot-zero", "place-rot-zero"),
    ),
    Obligation(
        name="fold-turn-step",
        words="a door of a visit is that door in the world: door k+1, if door k",
        claims=FOLDS,
        theory=TURN,
        given=TURN_FITS | {"for-the-door-before": _turned(D)},
        goal=_turned(t.succ(D)),
        argued=("induction over doors",),
        needs=("rot-next", "place-rot-next", "pi-turn", "for-the-door-before"),
    ),
    _folds(
        name="fold-move",
        words="a move joins the two ends of one edge",
        given=PI_ROT | {"moved": eq(pi(Q), t.alpha(t.rot(pi(P), D)))},
        goal=eq(t.alpha(pi(prot(P, D))), pi(Q)),
        needs=("pi-rot", "moved"),
    ),
    _folds(
        name="fold-marker",
        words="all visits that saw the marker are v0, turned by its direction",
        given=FITS | {"seen-at-p": ppoints(P), "seen-at-q": ppoints(Q)},
        goal=eq(pi(P), pi(Q)),
        needs=("pi-points", "seen-at-p", "seen-at-q"),
    ),
    _folds(
        name="fold-offset",
        words="if two places are one dart, their vertices are one, turned by an offset",
        given=PI_ROT | SAME,
        goal=eq(pi(prot(P, D)), pi(prot(Q, D))),
        needs=("pi-rot", "identified"),
    ),
    _folds(
        name="fold-cross",
        words="a dart has one partner: if two places are one dart, so are their partners",
        given=FITS | SAME | {"p-joined": joined(P, P2), "q-joined": joined(Q, Q2)},
        goal=eq(pi(P2), pi(Q2)),
        needs=("pi-joined", "identified", "p-joined", "q-joined"),
    ),
    _folds(
        name="fold-signature",
        words="contradiction: one dart would have two degrees, or see the marker and not see it",
        given=FITS | SAME,
        goal=conj(eq(pdeg(P), pdeg(Q)), eq(pinv0(P), pinv0(Q))),
        needs=("pi-degree", "pi-marker", "identified"),
    ),
    _folds(
        name="fold-own-partner",
        words="contradiction: a dart would be its own partner",
        theory=("alpha-no-fixed-point",),
        given=FITS | SAME,
        goal=neg(joined(P, Q)),
        needs=("alpha-no-fixed-point", "pi-joined", "identified"),
    ),
    _folds(
        name="fold-turned-vertex",
        words="contradiction: a vertex would be identified with itself, turned",
        theory=("doors-wrap",),
        given=FITS | PI_ROT | {"turned": eq(pi(prot(P, K)), pi(prot(P, J)))},
        goal=t.wraps(pdeg(P), K, J),
        needs=("doors-wrap", "pi-degree", "pi-rot", "turned"),
    ),
    _folds(
        name="fold-two-known",
        words="contradiction: two darts of S would be one",
        theory=("phi-injective",),
        given=SAME | {"p-is-x": eq(pi(P), t.phi(X)), "q-is-y": eq(pi(Q), t.phi(Y))},
        goal=eq(X, Y),
        needs=("phi-injective", "identified", "p-is-x", "q-is-y"),
    ),
    _folds(
        name="fold-hypothesis",
        words="joining e with its true end is a true step, so folding never refutes it",
        given={
            "e-ends-in-h": eq(t.alpha(t.phi(E)), t.phi(H)),
            "p-is-e": eq(pi(P), t.phi(E)),
            "q-is-h": eq(pi(Q), t.phi(H)),
        },
        goal=eq(t.alpha(pi(P)), pi(Q)),
        needs=("e-ends-in-h", "p-is-e", "q-is-h"),
    ),
    Obligation(
        name="fold-conclude",
        words="if the place behind e is in S and all hypotheses but one are false, that is true",
        claims=CONFIRMED + ENTAILED,
        theory=t.CORRESPONDENCE,
        given=BEHIND_E
        | {
            "place-is-known": eq(B, t.phi(Y)),
            "others-false": forall(t.x, is_posed(t.x), differ(t.x, H), differ(t.phi(t.x), B)),
        },
        goal=eq(t.phi(H), B),
        needs=("e-unexplored", "place-is-known", "others-false", "alpha-no-fixed-point"),
    ),
)

COMPLETE: tuple[Obligation, ...] = (
    _closes(
        name="fold-closed-home",
        words="two places of a closed fold that are both the marked dart are identified",
        theory=("doors-wrap", "root-at-v0"),
        given=FITS
        | PI_ROT
        | AT_MARKER
        | {"p-home": eq(pi(P), t.root), "q-home": eq(pi(Q), t.root)},
        goal=same(P, Q),
        needs=("p-home", "q-home", "marker-folded", "marker-is-seen", "place-doors-wrap"),
    ),
    _closes(
        name="fold-closed-turn",
        words="backward over a turn: what is identified next to them identifies them",
        given=CLOSED | {"next-identified": same(pturn(P), pturn(Q))},
        goal=same(P, Q),
        needs=("next-identified", "turns-folded"),
    ),
    _closes(
        name="fold-closed-cross",
        words="backward over an edge: what is identified beyond them identifies them",
        given=CLOSED | {"beyond-identified": same(pacross(P), pacross(Q))},
        goal=same(P, Q),
        needs=("beyond-identified", "edges-folded", "no-place-open", "joined-both-ways"),
    ),
    _closes(
        name="fold-closed-onto",
        words="a closed fold is closed under turning and crossing in the world: it is onto",
        given=FITS | CLOSED | {"met": eq(pi(P), A)},
        goal=conj(eq(pi(pturn(P)), t.sigma(A)), eq(pi(pacross(P)), t.alpha(A))),
        needs=("met", "pi-turn", "pi-joined", "no-place-open"),
    ),
)

OBLIGATIONS = GROWTH_OBLIGATIONS + SOUND + COMPLETE
