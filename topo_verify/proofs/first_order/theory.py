"""The theory: axioms of worlds and of the map S, and one step of each rule as a formula.

    sort   what it is                      letters
    W      darts of the world              a, b
    M      darts of the map S              x, y; e, h as in algorithms/exploration.py
    K      doors: k0, succ(k0), ...        i, j, k
    G      degrees                         only compared
    L      words of doors: nil, cons(k,w)  w
    R      records, places of the tries T  r

    sigma, alpha, root, deg, inv0 (at v0?), rot(a,k) = sigma^k(a): the world
    msigma, malpha, mroot, mdeg, minv0, mrot, explored (is malpha known?): the map S
    phi: M -> W, which dart of the world a dart of S is

Doors are not integers, about which Z3 answers `unknown`. `wraps(g,i,j)`: i = j modulo g.
`toroot(a)`, a door from a to the root within v0, replaces an existential quantifier. The percept at
a is deg(a), inv0(a), and for each door i whether rot(a,i) = root. No axiom says that W is finite or
connected; steps that need it are argued in words (docs/proofs.md).

**Rules.** A term is one step of a rule: dart x of S, door k, dart b where the percept was sensed.

    term             rule             true iff
    ALIKE            all              S shows at x what the robot senses at b
    POSED            H                dart h, seen from e, is a hypothesis behind which b was seen
    MOTION           motion           the percept behind the own door k differs from what is sensed
    PREFIX           prefix           own door and executed door agree, the percepts behind differ
    HISTORY          history          tracing stays on S, and S shows something else
    LEAVES           records          tracing leaves S through a dart with a record
    RECORD_DIFFERS   records          the record r shows something else than is sensed at b

`record(x)` is T[x] if `recorded(x)`; `behind(r,k)` the place behind door k if `deeper(r,k)`;
`spot(r)`, unknown to robots, where it was seen.
"""

from __future__ import annotations

from topo_verify.proofs.first_order.terms import *

sigma = Symbol("sigma", ("W",), "W")
alpha = Symbol("alpha", ("W",), "W")
deg = Symbol("deg", ("W",), "G")
inv0 = Symbol("inv0", ("W",), BOOL)
rot = Symbol("rot", ("W", "K"), "W")
root = Symbol("root", (), "W")()
toroot = Symbol("toroot", ("W",), "K")

k0 = Symbol("k0", (), "K")()
succ = Symbol("succ", ("K",), "K")
plus = Symbol("plus", ("K", "K"), "K")
wraps = Symbol("wraps", ("G", "K", "K"), BOOL)

msigma = Symbol("msigma", ("M",), "M")
mback = Symbol("mback", ("M",), "M")
malpha = Symbol("malpha", ("M",), "M")
mdeg = Symbol("mdeg", ("M",), "G")
minv0 = Symbol("minv0", ("M",), BOOL)
mrot = Symbol("mrot", ("M", "K"), "M")
mroot = Symbol("mroot", (), "M")()
mtoroot = Symbol("mtoroot", ("M",), "K")
explored = Symbol("explored", ("M",), BOOL)
phi = Symbol("phi", ("M",), "W")

nil = Symbol("nil", (), "L")()
cons = Symbol("cons", ("K", "L"), "L")
walk = Symbol("walk", ("W", "L"), "W")
mwalk = Symbol("mwalk", ("M", "L"), "M")
stays = Symbol("stays", ("M", "L"), BOOL)

a, b = Var("a", "W"), Var("b", "W")
x, y = Var("x", "M"), Var("y", "M")
i, j, k = Var("i", "K"), Var("j", "K"), Var("k", "K")
w = Var("w", "L")

AXIOMS: dict[str, Term] = {
    # the world
    "sigma-injective": forall((a, b), eq(sigma(a), sigma(b)), eq(a, b)),
    "alpha-involution": forall(a, eq(alpha(alpha(a)), a)),
    # A loop has two darts.
    "alpha-no-fixed-point": forall(a, differ(alpha(a), a)),
    "degree-of-vertex": forall(a, eq(deg(sigma(a)), deg(a))),
    "marker-of-vertex": forall(a, eq(inv0(sigma(a)), inv0(a))),
    "root-at-v0": inv0(root),
    "v0-sees-root": forall(a, inv0(a), eq(rot(a, toroot(a)), root)),
    "rot-zero": forall(a, eq(rot(a, k0), a)),
    "rot-next": forall((a, k), eq(rot(a, succ(k)), sigma(rot(a, k)))),
    # `tried_at` tells Z3 at which terms to instantiate.
    # Tried: without it here, fold-closed-home comes back `unknown`.
    "doors-wrap": forall(
        (a, i, j),
        eq(eq(rot(a, i), rot(a, j)), wraps(deg(a), i, j)),
        tried_at=((rot(a, i), rot(a, j)), (rot(a, i), wraps(deg(a), i, j))),
    ),
    # doors
    "plus-zero": forall(i, eq(plus(i, k0), i)),
    "plus-next": forall((i, j), eq(plus(i, succ(j)), succ(plus(i, j)))),
    # the map S
    "map-degree-of-vertex": forall(x, eq(mdeg(msigma(x)), mdeg(x))),
    "map-marker-of-vertex": forall(x, eq(minv0(msigma(x)), minv0(x))),
    "map-root-at-v0": minv0(mroot),
    "map-v0-sees-root": forall(x, minv0(x), eq(mrot(x, mtoroot(x)), mroot)),
    "map-rot-zero": forall(x, eq(mrot(x, k0), x)),
    "map-rot-next": forall((x, k), eq(mrot(x, succ(k)), msigma(mrot(x, k)))),
    # S is finite, so the injective msigma is onto.
    # Tried: without `tried_at`, new-apart-step comes back `unknown`.
    "map-sigma-onto": forall(x, eq(msigma(mback(x)), x), tried_at=((phi(x),),)),
    "map-doors-wrap": forall(
        (x, i, j),
        eq(eq(mrot(x, i), mrot(x, j)), wraps(mdeg(x), i, j)),
        tried_at=((mrot(x, i), mrot(x, j)),),
    ),
    # the invariant: S is a part of the world
    "phi-root": eq(phi(mroot), root),
    "phi-injective": forall((x, y), eq(phi(x), phi(y)), eq(x, y)),
    "phi-sigma": forall(x, eq(phi(msigma(x)), sigma(phi(x)))),
    "phi-degree": forall(x, eq(mdeg(x), deg(phi(x)))),
    "phi-marker": forall(x, eq(minv0(x), inv0(phi(x)))),
    # Every use of malpha has `explored` as a premise.
    "phi-alpha": forall(x, explored(x), eq(phi(malpha(x)), alpha(phi(x)))),
    "explored-both-ends": forall(x, explored(x), explored(malpha(x))),
    # words
    "walk-nil": forall(a, eq(walk(a, nil), a)),
    "walk-cons": forall((a, k, w), eq(walk(a, cons(k, w)), walk(alpha(rot(a, k)), w))),
    "map-walk-nil": forall(x, eq(mwalk(x, nil), x)),
    "map-walk-cons": forall((x, k, w), eq(mwalk(x, cons(k, w)), mwalk(malpha(mrot(x, k)), w))),
    "stays-nil": forall(x, stays(x, nil)),
    "stays-cons": forall(
        (x, k, w),
        eq(stays(x, cons(k, w)), conj(explored(mrot(x, k)), stays(malpha(mrot(x, k)), w))),
    ),
    # lemmas, by induction over doors
    "rot-injective": forall((a, b, k), eq(rot(a, k), rot(b, k)), eq(a, b)),
    "rot-degree": forall((a, k), eq(deg(rot(a, k)), deg(a))),
    "rot-marker": forall((a, k), eq(inv0(rot(a, k)), inv0(a))),
    "phi-rot": forall((x, k), eq(phi(mrot(x, k)), rot(phi(x), k))),
    "turning-adds": forall((a, i, j), eq(rot(rot(a, i), j), rot(a, plus(i, j)))),
    # lemmas, by induction over words
    "trace": forall((x, w), stays(x, w), eq(phi(mwalk(x, w)), walk(phi(x), w))),
}
"""Every axiom and lemma. A lemma is proved before it is used."""

LEMMAS = {
    "rot-injective": "rot-injective",
    "rot-degree": "rot-keeps-degree",
    "rot-marker": "rot-keeps-marker",
    "phi-rot": "phi-keeps-doors",
    "turning-adds": "turning-adds",
    "trace": "word-trace",
}
"""The induction (`-base` and `-step`) of each lemma."""

WORLD = (
    "sigma-injective",
    "alpha-involution",
    "alpha-no-fixed-point",
    "degree-of-vertex",
    "marker-of-vertex",
    "root-at-v0",
    "v0-sees-root",
)
DOORS = ("rot-zero", "rot-next")
MAP = ("map-degree-of-vertex", "map-marker-of-vertex", "map-root-at-v0", "map-v0-sees-root")
MAP_DOORS = ("map-rot-zero", "map-rot-next")
INVARIANT = (
    "phi-root",
    "phi-injective",
    "phi-sigma",
    "phi-degree",
    "phi-marker",
    "phi-alpha",
    "explored-both-ends",
)
ALL_DOORS = ("rot-injective", "rot-degree", "rot-marker", "phi-rot")
"""The lemmas on doors without addition."""

CORRESPONDENCE = (*WORLD, *DOORS, *MAP, *MAP_DOORS, *INVARIANT, *ALL_DOORS)
"""The axioms of a world with a map S, and the lemmas on doors."""


recorded = Symbol("recorded", ("M",), BOOL)
record = Symbol("record", ("M",), "R")
deeper = Symbol("deeper", ("R", "K"), BOOL)
behind = Symbol("behind", ("R", "K"), "R")
rdeg = Symbol("rdeg", ("R",), "G")
rinv0 = Symbol("rinv0", ("R",), BOOL)
rpoints = Symbol("rpoints", ("R", "K"), BOOL)
spot = Symbol("spot", ("R",), "W")

r = Var("r", "R")
own = Var("own", "K")
e, h = Var("e", "M"), Var("h", "M")


def signature_alike(x: Term, b: Term) -> Term:
    """The percepts are equal but for the reference dart."""
    return conj(eq(mdeg(x), deg(b)), eq(minv0(x), inv0(b)))


def marker_alike(x: Term, b: Term) -> Term:
    """A present marker points at the same door."""
    same = eq(eq(mrot(x, i), mroot), eq(rot(b, i), root))
    return forall(i, minv0(x), same)


def alike(x: Term, b: Term) -> Term:
    return conj(signature_alike(x, b), marker_alike(x, b))


def arrival(x: Term, door: Term) -> Term:
    """The dart of S behind a door of x."""
    return malpha(mrot(x, door))


def beyond(b: Term, door: Term) -> Term:
    """The dart of the world behind a door of b."""
    return alpha(rot(b, door))


def record_alike(r: Term, b: Term) -> Term:
    same = eq(rpoints(r, i), eq(rot(b, i), root))
    return conj(eq(rdeg(r), deg(b)), eq(rinv0(r), inv0(b)), forall(i, rinv0(r), same))


ALIKE = alike(x, b)
POSED = conj(neg(explored(h)), differ(h, e), signature_alike(h, b))
# For MOTION and PREFIX, explored edges are a premise where
# they are used. HISTORY follows any door.
MOTION = neg(alike(arrival(x, k), b))
PREFIX = conj(eq(own, k), neg(alike(arrival(x, own), b)))
HISTORY = conj(explored(mrot(x, k)), neg(alike(arrival(x, k), b)))
LEAVES = conj(neg(explored(mrot(x, k))), recorded(mrot(x, k)))
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
    "record-spot": forall(x, recorded(x), eq(spot(record(x)), alpha(phi(x)))),
    "behind-spot": forall((r, k), deeper(r, k), eq(spot(behind(r, k)), beyond(spot(r), k))),
    "record-degree": forall(r, eq(rdeg(r), deg(spot(r)))),
    "record-marker": forall(r, eq(rinv0(r), inv0(spot(r)))),
    "record-direction": forall((r, i), eq(rpoints(r, i), eq(rot(spot(r), i), root))),
}
"""The axioms that records are true."""
