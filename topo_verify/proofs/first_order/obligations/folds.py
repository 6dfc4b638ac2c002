"""Folding is sound: it identifies only what is one dart. A closed fold is the whole world.

A **place** (sort P) is a dart of the fold: a visit of the robot and a door there. In a world that
shows the same history, every place is a dart, `pi`: the visit's reference dart turned by the door.
`same` is what folding has identified, `joined` what it knows to be the two ends of an edge.

    symbol               what it is
    pturn(p), prot(p,k)  the next place clockwise, the k-th next
    pdeg, pinv0          degree of the visit; did it see the marker?
    ppoints(p)           the marker that was seen there points at p
    ptoroot(p)           the door from p to that place
    pacross(p)           where all is joined: what p is joined with

Sound: after each step, and under each assumption that is true in the world, places that are `same`
are one dart. So a contradiction refutes the assumption in every world that fits. Complete: when no
place is open, places that are one dart are `same`. (Walk from each of the two to the marker by the
same turns and crossings; there they are identified, and so, step by step backward, are the two.)
So the fold is the world, and the history proves it.

Source: docs/semantics.md, sections 8 and 11; J. R. Stallings, Invent. Math. 71 (1983).
"""

from __future__ import annotations

from topo_verify.proofs.first_order.axioms import (
    CORRESPONDENCE,
    alpha,
    deg,
    i,
    inv0,
    j,
    k,
    k0,
    phi,
    root,
    rot,
    sigma,
    succ,
    wraps,
)
from topo_verify.proofs.first_order.obligations.growth import BEHIND_E, is_posed
from topo_verify.proofs.first_order.obligations.obligation import (
    CONFIRMED,
    ENTAILED,
    KEPT,
    A,
    B,
    D,
    E,
    H,
    J,
    K,
    Obligation,
    X,
    Y,
)
from topo_verify.proofs.first_order.rules import x
from topo_verify.proofs.first_order.terms import (
    BOOL,
    Symbol,
    Term,
    Var,
    conj,
    constant,
    differ,
    eq,
    forall,
    neg,
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
    "pi-turn": forall(p, eq(pi(pturn(p)), sigma(pi(p)))),
    # Tried: without `tried_at`, fold-closed-home comes back `unknown`.
    "place-rot-zero": forall(p, eq(prot(p, k0), p), tried_at=((prot(p, k0),), (ptoroot(p),))),
    "place-rot-next": forall((p, k), eq(prot(p, succ(k)), pturn(prot(p, k)))),
    "pi-joined": forall((p, q), joined(p, q), eq(alpha(pi(p)), pi(q))),
    "pi-degree": forall(p, eq(pdeg(p), deg(pi(p))), tried_at=((pi(p),),)),
    "pi-marker": forall(p, eq(pinv0(p), inv0(pi(p))), tried_at=((pi(p),),)),
    "pi-points": forall(p, ppoints(p), eq(pi(p), root)),
}
"""The world fits the history: it shows the percepts seen at the doors walked."""

PI_ROT: dict[str, Term] = {"pi-rot": forall((p, k), eq(pi(prot(p, k)), rot(pi(p), k)))}
"""A lemma, proved by `fold-turn-base` and `fold-turn-step`."""

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
        (p, i, j),
        wraps(pdeg(p), i, j),
        eq(prot(p, i), prot(p, j)),
        tried_at=((prot(p, i), prot(p, j)),),
    ),
}
"""Nothing is left to fold, and no place is open."""

AT_MARKER = {name: CLOSED[name] for name in ("marker-folded", "marker-is-seen", "place-doors-wrap")}
"""The part of `CLOSED` that is needed at the marker; the rest would only slow Z3 down."""

FOLDS = KEPT + ENTAILED
BY_STEPS = ("induction over fold steps",)
BY_WAYS = ("induction over ways home", "a connected world is reached")


def _turned(door: Term) -> Term:
    return forall(p, eq(pi(prot(p, door)), rot(pi(p), door)))


TURN = ("rot-zero", "rot-next")
TURN_FITS = {name: FITS[name] for name in ("pi-turn", "place-rot-zero", "place-rot-next")}

SOUND: tuple[Obligation, ...] = (
    Obligation(
        name="fold-turn-base",
        words="a door of a visit is that door in the world: door 0",
        claims=FOLDS,
        theory=TURN,
        given=TURN_FITS,
        goal=_turned(k0),
        argued=("induction over doors",),
        needs=("rot-zero", "place-rot-zero"),
    ),
    Obligation(
        name="fold-turn-step",
        words="a door of a visit is that door in the world: door k+1, if door k",
        claims=FOLDS,
        theory=TURN,
        given=TURN_FITS | {"for-the-door-before": _turned(D)},
        goal=_turned(succ(D)),
        argued=("induction over doors",),
        needs=("rot-next", "place-rot-next", "pi-turn", "for-the-door-before"),
    ),
    Obligation(
        name="fold-move",
        words="a move joins the two ends of one edge",
        claims=FOLDS,
        theory=(),
        given=PI_ROT | {"moved": eq(pi(Q), alpha(rot(pi(P), D)))},
        goal=eq(alpha(pi(prot(P, D))), pi(Q)),
        argued=BY_STEPS,
        needs=("pi-rot", "moved"),
    ),
    Obligation(
        name="fold-marker",
        words="all visits that saw the marker are v0, turned by its direction",
        claims=FOLDS,
        theory=(),
        given=FITS | {"seen-at-p": ppoints(P), "seen-at-q": ppoints(Q)},
        goal=eq(pi(P), pi(Q)),
        argued=BY_STEPS,
        needs=("pi-points", "seen-at-p", "seen-at-q"),
    ),
    Obligation(
        name="fold-offset",
        words="if two places are one dart, their vertices are one, turned by an offset",
        claims=FOLDS,
        theory=(),
        given=PI_ROT | SAME,
        goal=eq(pi(prot(P, D)), pi(prot(Q, D))),
        argued=BY_STEPS,
        needs=("pi-rot", "identified"),
    ),
    Obligation(
        name="fold-cross",
        words="a dart has one partner: if two places are one dart, so are their partners",
        claims=FOLDS,
        theory=(),
        given=FITS | SAME | {"p-joined": joined(P, P2), "q-joined": joined(Q, Q2)},
        goal=eq(pi(P2), pi(Q2)),
        argued=BY_STEPS,
        needs=("pi-joined", "identified", "p-joined", "q-joined"),
    ),
    Obligation(
        name="fold-signature",
        words="contradiction: one dart would have two degrees, or see the marker and not see it",
        claims=FOLDS,
        theory=(),
        given=FITS | SAME,
        goal=conj(eq(pdeg(P), pdeg(Q)), eq(pinv0(P), pinv0(Q))),
        argued=BY_STEPS,
        needs=("pi-degree", "pi-marker", "identified"),
    ),
    Obligation(
        name="fold-own-partner",
        words="contradiction: a dart would be its own partner",
        claims=FOLDS,
        theory=("alpha-no-fixed-point",),
        given=FITS | SAME,
        goal=neg(joined(P, Q)),
        argued=BY_STEPS,
        needs=("alpha-no-fixed-point", "pi-joined", "identified"),
    ),
    Obligation(
        name="fold-turned-vertex",
        words="contradiction: a vertex would be identified with itself, turned",
        claims=FOLDS,
        theory=("doors-wrap",),
        given=FITS | PI_ROT | {"turned": eq(pi(prot(P, K)), pi(prot(P, J)))},
        goal=wraps(pdeg(P), K, J),
        argued=BY_STEPS,
        needs=("doors-wrap", "pi-degree", "pi-rot", "turned"),
    ),
    Obligation(
        name="fold-two-known",
        words="contradiction: two darts of S would be one",
        claims=FOLDS,
        theory=("phi-injective",),
        given=SAME | {"p-is-x": eq(pi(P), phi(X)), "q-is-y": eq(pi(Q), phi(Y))},
        goal=eq(X, Y),
        argued=BY_STEPS,
        needs=("phi-injective", "identified", "p-is-x", "q-is-y"),
    ),
    Obligation(
        name="fold-hypothesis",
        words="joining e with its true end is a true step, so folding never refutes it",
        claims=FOLDS,
        theory=(),
        given={
            "e-ends-in-h": eq(alpha(phi(E)), phi(H)),
            "p-is-e": eq(pi(P), phi(E)),
            "q-is-h": eq(pi(Q), phi(H)),
        },
        goal=eq(alpha(pi(P)), pi(Q)),
        argued=BY_STEPS,
        needs=("e-ends-in-h", "p-is-e", "q-is-h"),
    ),
    Obligation(
        name="fold-conclude",
        words="if the place behind e is in S and all hypotheses but one are false, that is true",
        claims=CONFIRMED + ENTAILED,
        theory=CORRESPONDENCE,
        given=BEHIND_E
        | {
            "place-is-known": eq(B, phi(Y)),
            "others-false": forall(x, is_posed(x), differ(x, H), differ(phi(x), B)),
        },
        goal=eq(phi(H), B),
        needs=("e-unexplored", "place-is-known", "others-false", "alpha-no-fixed-point"),
    ),
)

COMPLETE: tuple[Obligation, ...] = (
    Obligation(
        name="fold-closed-home",
        words="two places of a closed fold that are both the marked dart are identified",
        claims=ENTAILED,
        theory=("doors-wrap", "root-at-v0"),
        given=FITS | PI_ROT | AT_MARKER | {"p-home": eq(pi(P), root), "q-home": eq(pi(Q), root)},
        goal=same(P, Q),
        argued=BY_WAYS,
        needs=("p-home", "q-home", "marker-folded", "marker-is-seen", "place-doors-wrap"),
    ),
    Obligation(
        name="fold-closed-turn",
        words="backward over a turn: what is identified next to them identifies them",
        claims=ENTAILED,
        theory=(),
        given=CLOSED | {"next-identified": same(pturn(P), pturn(Q))},
        goal=same(P, Q),
        argued=BY_WAYS,
        needs=("next-identified", "turns-folded"),
    ),
    Obligation(
        name="fold-closed-cross",
        words="backward over an edge: what is identified beyond them identifies them",
        claims=ENTAILED,
        theory=(),
        given=CLOSED | {"beyond-identified": same(pacross(P), pacross(Q))},
        goal=same(P, Q),
        argued=BY_WAYS,
        needs=("beyond-identified", "edges-folded", "no-place-open", "joined-both-ways"),
    ),
    Obligation(
        name="fold-closed-onto",
        words="a closed fold is closed under turning and crossing in the world: it is onto",
        claims=ENTAILED,
        theory=(),
        given=FITS | CLOSED | {"met": eq(pi(P), A)},
        goal=conj(eq(pi(pturn(P)), sigma(A)), eq(pi(pacross(P)), alpha(A))),
        argued=BY_WAYS,
        needs=("met", "pi-turn", "pi-joined", "no-place-open"),
    ),
)

OBLIGATIONS = SOUND + COMPLETE
