"""The rules of the algorithms as terms: one step of each.

A term says what one step of a rule decides about a dart of S (x), a door (k) and the dart of the
world where the robot sensed the percept that it compares (b). Z3 proves theorems about these terms,
and `conformance.py` evaluates the same terms on real runs and compares every decision with that of
the code in algorithms/. A rule that is changed there and not here makes a test fail.

    term             rule             true iff
    ALIKE            all              S shows at x what the robot senses at b
    POSED            H                dart h, seen from e, is a hypothesis behind which b was seen
    MOTION           motion           the percept behind the own door k differs from what is sensed
    PREFIX           prefix           own door and executed door agree, the percepts behind differ
    HISTORY          history          tracing stays on S, and S shows something else
    LEAVES           records          tracing leaves S through a dart with a record
    RECORD_DIFFERS   records          the record r shows something else than is sensed at b

Records (sort R) are the places of the tries T: `record(x)` is T[x], where `recorded(x)`;
`behind(r,k)` is the place recorded behind door k, where `deeper(r,k)`. `spot(r)` is the dart of the
world at which the record was seen. No robot knows it; a record is true if it exists.

Source: docs/semantics.md, sections 4, 6 and 7.
"""

from __future__ import annotations

from topo_verify.proofs.first_order import axioms as t
from topo_verify.proofs.first_order.terms import (
    BOOL,
    Symbol,
    Term,
    Var,
    conj,
    differ,
    eq,
    forall,
    neg,
)

recorded = Symbol("recorded", ("M",), BOOL)
record = Symbol("record", ("M",), "R")
deeper = Symbol("deeper", ("R", "K"), BOOL)
behind = Symbol("behind", ("R", "K"), "R")
rdeg = Symbol("rdeg", ("R",), "G")
rinv0 = Symbol("rinv0", ("R",), BOOL)
rpoints = Symbol("rpoints", ("R", "K"), BOOL)
spot = Symbol("spot", ("R",), "W")

x, b, i, k, r = t.x, t.b, t.i, t.k, Var("r", "R")
own = Var("own", "K")
e, h = Var("e", "M"), Var("h", "M")


def signature_alike(x: Term, b: Term) -> Term:
    """The parts of the percepts that do not depend on the reference dart are equal."""
    return conj(eq(t.mdeg(x), t.deg(b)), eq(t.minv0(x), t.inv0(b)))


def marker_alike(x: Term, b: Term) -> Term:
    """The marker, where it is present, points at the same door."""
    same = eq(eq(t.mrot(x, i), t.mroot), eq(t.rot(b, i), t.root))
    return forall(i, t.minv0(x), same)


def alike(x: Term, b: Term) -> Term:
    """S shows at x the percept sensed at b: degree, presence and direction of the marker."""
    return conj(signature_alike(x, b), marker_alike(x, b))


def arrival(x: Term, door: Term) -> Term:
    """The dart of S where a door of x leads."""
    return t.malpha(t.mrot(x, door))


def beyond(b: Term, door: Term) -> Term:
    """The dart of the world where a door of b leads."""
    return t.alpha(t.rot(b, door))


def record_alike(r: Term, b: Term) -> Term:
    """The recorded percept is the one sensed at b."""
    same = eq(rpoints(r, i), eq(t.rot(b, i), t.root))
    return conj(eq(rdeg(r), t.deg(b)), eq(rinv0(r), t.inv0(b)), forall(i, rinv0(r), same))


ALIKE = alike(x, b)
POSED = conj(neg(t.explored(h)), differ(h, e), signature_alike(h, b))
# MOTION and PREFIX follow the way home, which takes explored edges only: that is a premise where
# they are used. HISTORY follows any door, so it must ask.
MOTION = neg(alike(arrival(x, k), b))
PREFIX = conj(eq(own, k), neg(alike(arrival(x, own), b)))
HISTORY = conj(t.explored(t.mrot(x, k)), neg(alike(arrival(x, k), b)))
LEAVES = conj(neg(t.explored(t.mrot(x, k))), recorded(t.mrot(x, k)))
RECORD_DIFFERS = neg(record_alike(r, b))

RULES: dict[str, Term] = {
    "alike": ALIKE,
    "posed": POSED,
    "motion": MOTION,
    "prefix": PREFIX,
    "history": HISTORY,
    "leaves": LEAVES,
    "record-differs": RECORD_DIFFERS,
}

TRUE_RECORDS: dict[str, Term] = {
    "record-spot": forall(x, recorded(x), eq(spot(record(x)), t.alpha(t.phi(x)))),
    "behind-spot": forall((r, k), deeper(r, k), eq(spot(behind(r, k)), beyond(spot(r), k))),
    "record-degree": forall(r, eq(rdeg(r), t.deg(spot(r)))),
    "record-marker": forall(r, eq(rinv0(r), t.inv0(spot(r)))),
    "record-direction": forall((r, i), eq(rpoints(r, i), eq(t.rot(spot(r), i), t.root))),
}
"""The axioms that the records are true."""
