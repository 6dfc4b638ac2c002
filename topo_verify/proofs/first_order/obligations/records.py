"""Records: percepts recorded behind unexplored darts are true when written, and stay true.

A record is true if it was sensed at a spot of the world that lies where the record's dart and doors
say. Writing: the sequences are traced from the entry dart, which is known by then. Reading: tracing
leaves S through an unexplored dart and descends the trie. Keeping: S only grows, and growth moves
no dart that was there before.
"""

from __future__ import annotations

from topo_verify.proofs.first_order.axioms import (
    CORRESPONDENCE,
    a,
    alpha,
    cons,
    mrot,
    mwalk,
    nil,
    phi,
    stays,
    walk,
)
from topo_verify.proofs.first_order.obligations.obligation import (
    KEPT,
    WORD,
    B,
    D,
    E,
    H,
    Obligation,
    R,
    X,
)
from topo_verify.proofs.first_order.obligations.traces import BY_WORDS, HERE, WORDS
from topo_verify.proofs.first_order.rules import (
    LEAVES,
    TRUE_RECORDS,
    behind,
    beyond,
    deeper,
    k,
    r,
    record,
    record_alike,
    recorded,
    spot,
    x,
)
from topo_verify.proofs.first_order.terms import (
    BOOL,
    Symbol,
    Term,
    conj,
    differ,
    eq,
    forall,
    substitute,
)

TRUE = (*CORRESPONDENCE, *TRUE_RECORDS)
ON_RECORD = {"corresponds": eq(spot(R), B), "goes-deeper": deeper(R, D)}

# rwalk(r, w) is the place of the trie where w leads from r; rstays(r, w): does the trie go so far?
rwalk = Symbol("rwalk", ("R", "L"), "R")
rstays = Symbol("rstays", ("R", "L"), BOOL)
RECORD_WORDS: dict[str, Term] = {
    "record-walk-nil": forall(r, eq(rwalk(r, nil), r)),
    # For the constant WORD alone: the step speaks of no other word.
    "record-walk-cons": forall((r, k), eq(rwalk(r, cons(k, WORD)), rwalk(behind(r, k), WORD))),
    "record-stays-cons": forall(
        (r, k), eq(rstays(r, cons(k, WORD)), conj(deeper(r, k), rstays(behind(r, k), WORD)))
    ),
}

# A 2 means after the augmentation; `old` are the darts that S had before it.
recorded2 = Symbol("recorded2", ("M",), BOOL)
phi2 = Symbol("phi2", ("M",), "W")
old = Symbol("old", ("M",), BOOL)


def _followed(word: Term) -> Term:
    """From a record, this word leads to the record of the spot where the word leads."""
    return forall((r, a), eq(spot(r), a), rstays(r, word), eq(spot(rwalk(r, word)), walk(a, word)))


OBLIGATIONS: tuple[Obligation, ...] = (
    Obligation(
        name="records-leave",
        words="tracing that leaves S through a dart with a record is at the record's spot",
        claims=KEPT,
        theory=TRUE,
        given=HERE | {"leaves-S": substitute(LEAVES, {x: X, k: D})},
        goal=eq(spot(record(mrot(X, D))), beyond(B, D)),
        needs=("corresponds", "leaves-S", "record-spot", "phi-rot"),
    ),
    Obligation(
        name="records-deeper",
        words="tracing that descends the trie by a door is at the spot of the record there",
        claims=KEPT,
        theory=TRUE,
        given=ON_RECORD,
        goal=eq(spot(behind(R, D)), beyond(B, D)),
        needs=("corresponds", "goes-deeper", "behind-spot"),
    ),
    Obligation(
        name="records-one-level-keep",
        words="rule `records(1)` rejects no true hypothesis",
        claims=KEPT,
        theory=TRUE,
        given=HERE | {"leaves-S": substitute(LEAVES, {x: X, k: D})},
        goal=record_alike(record(mrot(X, D)), beyond(B, D)),
        argued=BY_WORDS,
        needs=("corresponds", "leaves-S", "record-spot", "record-degree", "record-direction"),
    ),
    Obligation(
        name="records-all-levels-keep",
        words="rule `records(∞)` rejects no true hypothesis, however deep its records",
        claims=KEPT,
        theory=TRUE,
        given=ON_RECORD,
        goal=record_alike(behind(R, D), beyond(B, D)),
        argued=BY_WORDS,
        needs=("corresponds", "goes-deeper", "behind-spot", "record-marker"),
    ),
    Obligation(
        name="word-records-base",
        words="the empty word leads from a record to its spot",
        claims=KEPT,
        theory=("walk-nil",),
        given={"record-walk-nil": RECORD_WORDS["record-walk-nil"]},
        goal=_followed(nil),
        argued=BY_WORDS,
        needs=("walk-nil", "record-walk-nil"),
    ),
    Obligation(
        name="word-records-step",
        words="a word with one door more leads to the spot that it names, if the rest does",
        claims=KEPT,
        theory=("walk-cons", "behind-spot"),
        given=RECORD_WORDS | {"for-the-rest": _followed(WORD)},
        goal=_followed(cons(D, WORD)),
        argued=BY_WORDS,
        needs=("for-the-rest", "behind-spot", "record-stays-cons", "record-walk-cons"),
    ),
    Obligation(
        name="records-written",
        words="what is written after validation is true: its spot lies behind the dart it is for",
        claims=KEPT,
        theory=(*CORRESPONDENCE, *WORDS, "trace"),
        given={
            "behind-e": eq(B, alpha(phi(E))),
            "entry-known": eq(phi(H), B),
            "traced-on-S": stays(H, WORD),
        },
        goal=eq(alpha(phi(mrot(mwalk(H, WORD), D))), beyond(walk(B, WORD), D)),
        argued=BY_WORDS,
        needs=("entry-known", "traced-on-S", "trace", "phi-rot"),
    ),
    Obligation(
        name="records-stable-loop",
        words="records stay true when an edge of S is closed",
        claims=KEPT,
        theory=TRUE,
        given={
            "dropped": forall(x, recorded2(x), conj(recorded(x), differ(x, E), differ(x, H))),
            "is-recorded": recorded2(X),
        },
        goal=eq(spot(record(X)), alpha(phi(X))),
        needs=("dropped", "is-recorded", "record-spot"),
    ),
    Obligation(
        name="records-stable-new",
        words="records stay true when S grows by a vertex",
        claims=KEPT,
        theory=("record-spot",),
        given={
            "dropped": forall(x, recorded2(x), conj(recorded(x), old(x), differ(x, E))),
            "nothing-moves": forall(x, old(x), eq(phi2(x), phi(x))),
            "is-recorded": recorded2(X),
        },
        goal=eq(spot(record(X)), alpha(phi2(X))),
        needs=("dropped", "nothing-moves", "is-recorded", "record-spot"),
    ),
)
