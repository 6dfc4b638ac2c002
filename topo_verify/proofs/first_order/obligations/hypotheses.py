"""No rule rejects a true hypothesis, and none confirms a false one.

**Doors.** Door 0 undoes a move but for a turn, which is added to the next door.

**Traces** keep the correspondence with the world. Base: if e ends in h, then vu is h's place. Step:
across an explored edge, S and the world arrive at corresponding places.

**Confirmation**: backward from v0, where equal percepts, with the marker's direction, identify the
dart. Turning and crossing are injective, so h's place is where the robot began.

**Records** are true if sensed where the record's dart and doors say. Writing: sequences are traced
from the entry dart. Reading: tracing leaves S through an unexplored dart and descends the trie.
Keeping: growth moves no dart of S.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from topo_verify.proofs.first_order import theory as t
from topo_verify.proofs.first_order.obligations import *
from topo_verify.proofs.first_order.terms import *
from topo_verify.proofs.first_order.theory import k

BOTH = KEPT + CONFIRMED
DOOR_INDUCTION = ("induction over doors",)


def _induction(
    name: str,
    words: str,
    statement: Callable[[Term], Term],
    theory: tuple[str, ...],
    needs: tuple[tuple[str, ...], tuple[str, ...]],
) -> tuple[Obligation, Obligation]:
    shared = partial(Obligation, claims=BOTH, theory=theory, argued=DOOR_INDUCTION)
    return (
        shared(
            name=f"{name}-base", words=f"{words}: with door 0", goal=statement(t.k0), needs=needs[0]
        ),
        # D is arbitrary, so the step holds for every door.
        shared(
            name=f"{name}-step",
            words=f"{words}: with door k+1, if with door k",
            given={"for-the-door-before": statement(D)},
            goal=statement(t.succ(D)),
            needs=needs[1],
        ),
    )


TURNING = ("rot-zero", "rot-next")

DOOR_OBLIGATIONS: tuple[Obligation, ...] = (
    *_induction(
        "rot-injective",
        "one door, counted from two reference darts, means two darts",
        lambda k: forall((t.a, t.b), eq(t.rot(t.a, k), t.rot(t.b, k)), eq(t.a, t.b)),
        (*TURNING, "sigma-injective"),
        (("rot-zero",), ("rot-next", "sigma-injective", "for-the-door-before")),
    ),
    *_induction(
        "rot-keeps-degree",
        "all doors of a vertex have its degree",
        lambda k: forall(t.a, eq(t.deg(t.rot(t.a, k)), t.deg(t.a))),
        (*TURNING, "degree-of-vertex"),
        (("rot-zero",), ("rot-next", "degree-of-vertex", "for-the-door-before")),
    ),
    *_induction(
        "rot-keeps-marker",
        "the marker is seen from all darts of a vertex or from none",
        lambda k: forall(t.a, eq(t.inv0(t.rot(t.a, k)), t.inv0(t.a))),
        (*TURNING, "marker-of-vertex"),
        (("rot-zero",), ("rot-next", "marker-of-vertex", "for-the-door-before")),
    ),
    *_induction(
        "phi-keeps-doors",
        "a door of S means the same door of the world",
        lambda k: forall(t.x, eq(t.phi(t.mrot(t.x, k)), t.rot(t.phi(t.x), k))),
        (*TURNING, "map-rot-zero", "map-rot-next", "phi-sigma"),
        (("rot-zero", "map-rot-zero"), ("rot-next", "map-rot-next", "phi-sigma")),
    ),
    *_induction(
        "turning-adds",
        "turning by i and then by j is turning by i + j",
        lambda k: eq(t.rot(t.rot(A, K), k), t.rot(A, t.plus(K, k))),
        (*TURNING, "plus-zero", "plus-next"),
        (("rot-zero", "plus-zero"), ("rot-next", "plus-next", "for-the-door-before")),
    ),
    Obligation(
        name="retrace-back",
        words="door 0 undoes a move: the robot is where it was, turned by the door it had taken",
        claims=BOTH,
        theory=("alpha-involution", "rot-zero"),
        goal=eq(t.beyond(t.beyond(A, D), t.k0), t.rot(A, D)),
        argued=("induction over words",),
        needs=("alpha-involution", "rot-zero"),
    ),
    Obligation(
        name="retrace-turned",
        words="after a way back by door k, door i is what door j was, if k + i = j modulo degree",
        claims=BOTH,
        theory=("turning-adds", "doors-wrap"),
        given={"one-door": t.wraps(t.deg(A), t.plus(D, K), J)},
        goal=eq(t.rot(t.rot(A, D), K), t.rot(A, J)),
        needs=("turning-adds", "doors-wrap", "one-door"),
    ),
    Obligation(
        name="no-loop-of-one-dart",
        words="a move never ends at the dart by which it began",
        claims=("true-hypothesis-posed",),
        theory=("alpha-no-fixed-point",),
        goal=differ(t.beyond(A, D), t.rot(A, D)),
        needs=("alpha-no-fixed-point",),
    ),
)


WORDS = ("walk-nil", "walk-cons", "map-walk-nil", "map-walk-cons", "stays-nil", "stays-cons")
BY_WORDS = ("induction over words", "rules compare along words")

_kept = partial(Obligation, claims=KEPT)
_kept_by_words = partial(_kept, argued=BY_WORDS)
_confirms = partial(Obligation, claims=CONFIRMED)
_confirms_by_words = partial(_confirms, argued=BY_WORDS)

HERE = {"corresponds": eq(t.phi(X), B)}

ACROSS = {"on-explored-edges": t.explored(t.mrot(X, D))}


def applied(rule: Term) -> Term:
    """A rule at x, for door D, about the percept behind it."""
    return substitute(rule, {t.x: X, k: D, t.own: OWN, t.b: t.beyond(B, D)})


def _traced(word: Term) -> Term:
    return forall(
        (t.x, t.a),
        eq(t.phi(t.x), t.a),
        t.stays(t.x, word),
        eq(t.phi(t.mwalk(t.x, word)), t.walk(t.a, word)),
    )


TRACE_OBLIGATIONS: tuple[Obligation, ...] = (
    _kept(
        name="percept",
        words="corresponding darts show the same percept, the marker's direction included",
        theory=t.CORRESPONDENCE,
        given=HERE,
        goal=t.alike(X, B),
        needs=("phi-degree", "phi-marker", "phi-rot", "phi-root", "phi-injective", "corresponds"),
    ),
    _kept(
        name="trace-init",
        words="if e does end in h, the robot behind e stands at h's place",
        theory=t.CORRESPONDENCE,
        given={"behind-e": eq(B, t.alpha(t.phi(E))), "hypothesis": eq(t.alpha(t.phi(E)), t.phi(H))},
        goal=conj(eq(t.phi(H), B), t.alike(H, B)),
        needs=("behind-e", "hypothesis"),
    ),
    _kept(
        name="trace-step",
        words="across an explored edge, corresponding places lead to corresponding places",
        theory=t.CORRESPONDENCE,
        given=HERE | ACROSS,
        goal=eq(t.phi(t.arrival(X, D)), t.beyond(B, D)),
        needs=("phi-alpha", "phi-rot", "on-explored-edges", "corresponds"),
    ),
    _kept_by_words(
        name="word-trace-base",
        words="the empty word keeps the correspondence",
        theory=WORDS,
        goal=_traced(t.nil),
        needs=("walk-nil", "map-walk-nil"),
    ),
    _kept_by_words(
        name="word-trace-step",
        words="a word that begins with one door more keeps it, if the rest does",
        theory=(*WORDS, "phi-alpha", "phi-rot"),
        given={"for-the-rest": _traced(WORD)},
        goal=_traced(t.cons(D, WORD)),
        needs=("for-the-rest", "phi-alpha", "phi-rot", "stays-cons", "walk-cons", "map-walk-cons"),
    ),
    _kept_by_words(
        name="motion-keeps",
        words="no motion rejects the true hypothesis (rule `none`, and every other)",
        theory=t.CORRESPONDENCE,
        given=HERE | ACROSS,
        goal=neg(applied(t.MOTION)),
        needs=("on-explored-edges", "corresponds", "phi-alpha"),
    ),
    _kept_by_words(
        name="prefix-keeps",
        words="rule `prefix` rejects no true hypothesis",
        theory=t.CORRESPONDENCE,
        given=HERE | {"own-way-is-explored": t.explored(t.mrot(X, OWN))},
        goal=neg(applied(t.PREFIX)),
        needs=("own-way-is-explored", "corresponds", "phi-alpha"),
    ),
    _kept_by_words(
        name="history-keeps",
        words="rule `history` rejects no true hypothesis",
        theory=t.CORRESPONDENCE,
        given=HERE,
        goal=neg(applied(t.HISTORY)),
        needs=("corresponds", "phi-alpha", "phi-degree"),
    ),
)


def _confirmed(word: Term) -> Term:
    return forall(
        (t.x, t.a),
        t.stays(t.x, word),
        eq(t.phi(t.mwalk(t.x, word)), t.walk(t.a, word)),
        eq(t.phi(t.x), t.a),
    )


CONFIRMATION_OBLIGATIONS: tuple[Obligation, ...] = (
    _confirms(
        name="confirm-final",
        words="if S shows the marker and the robot senses the same percept, they are at one dart",
        theory=t.CORRESPONDENCE,
        given={"at-v0": t.minv0(X), "matches": t.alike(X, B)},
        goal=eq(t.phi(X), B),
        needs=("rot-injective", "phi-root", "phi-rot", "at-v0", "matches"),
    ),
    _confirms(
        name="confirm-back",
        words="if one door, over an explored edge, leads from two darts to one, the two are one",
        theory=t.CORRESPONDENCE,
        given=ACROSS | {"same-behind": eq(t.phi(t.arrival(X, D)), t.beyond(B, D))},
        goal=eq(t.phi(X), B),
        needs=("on-explored-edges", "same-behind", "rot-injective", "alpha-involution"),
    ),
    _confirms(
        name="confirm-conclude",
        words="if h's place is where the robot stood behind e, then e ends in h",
        theory=("alpha-involution",),
        given={"behind-e": eq(B, t.alpha(t.phi(E))), "same-place": eq(t.phi(H), B)},
        goal=eq(t.alpha(t.phi(H)), t.phi(E)),
        needs=("behind-e", "same-place", "alpha-involution"),
    ),
    _confirms_by_words(
        name="word-confirm-base",
        words="if the empty word ends at corresponding darts, it began at corresponding darts",
        theory=WORDS,
        goal=_confirmed(t.nil),
        needs=("walk-nil", "map-walk-nil"),
    ),
    _confirms_by_words(
        name="word-confirm-step",
        words="the same holds for a word with one door more, if it holds for the rest",
        theory=(*WORDS, "phi-alpha", "phi-rot", "alpha-involution", "rot-injective"),
        given={"for-the-rest": _confirmed(WORD)},
        goal=_confirmed(t.cons(D, WORD)),
        needs=("for-the-rest", "phi-alpha", "rot-injective", "alpha-involution", "stays-cons"),
    ),
)


TRUE = (*t.CORRESPONDENCE, *t.TRUE_RECORDS)
ON_RECORD = {"corresponds": eq(t.spot(R), B), "goes-deeper": t.deeper(R, D)}

# rwalk(r, w): where w leads in the trie; rstays(r, w): does the trie go so far?
rwalk = Symbol("rwalk", ("R", "L"), "R")
rstays = Symbol("rstays", ("R", "L"), BOOL)
RECORD_WORDS: dict[str, Term] = {
    "record-walk-nil": forall(t.r, eq(rwalk(t.r, t.nil), t.r)),
    # For the constant WORD alone.
    "record-walk-cons": forall(
        (t.r, k), eq(rwalk(t.r, t.cons(k, WORD)), rwalk(t.behind(t.r, k), WORD))
    ),
    "record-stays-cons": forall(
        (t.r, k),
        eq(rstays(t.r, t.cons(k, WORD)), conj(t.deeper(t.r, k), rstays(t.behind(t.r, k), WORD))),
    ),
}

recorded2 = Symbol("recorded2", ("M",), BOOL)


def _followed(word: Term) -> Term:
    return forall(
        (t.r, t.a),
        eq(t.spot(t.r), t.a),
        rstays(t.r, word),
        eq(t.spot(rwalk(t.r, word)), t.walk(t.a, word)),
    )


RECORD_OBLIGATIONS: tuple[Obligation, ...] = (
    _kept(
        name="records-leave",
        words="tracing that leaves S through a dart with a record is at the record's spot",
        theory=TRUE,
        given=HERE | {"leaves-S": substitute(t.LEAVES, {t.x: X, k: D})},
        goal=eq(t.spot(t.record(t.mrot(X, D))), t.beyond(B, D)),
        needs=("corresponds", "leaves-S", "record-spot", "phi-rot"),
    ),
    _kept(
        name="records-deeper",
        words="tracing that descends the trie by a door is at the spot of the record there",
        theory=TRUE,
        given=ON_RECORD,
        goal=eq(t.spot(t.behind(R, D)), t.beyond(B, D)),
        needs=("corresponds", "goes-deeper", "behind-spot"),
    ),
    _kept_by_words(
        name="records-one-level-keep",
        words="rule `records(1)` rejects no true hypothesis",
        theory=TRUE,
        given=HERE | {"leaves-S": substitute(t.LEAVES, {t.x: X, k: D})},
        goal=t.record_alike(t.record(t.mrot(X, D)), t.beyond(B, D)),
        needs=("corresponds", "leaves-S", "record-spot", "record-degree", "record-direction"),
    ),
    _kept_by_words(
        name="records-all-levels-keep",
        words="rule `records(∞)` rejects no true hypothesis, however deep its records",
        theory=TRUE,
        given=ON_RECORD,
        goal=t.record_alike(t.behind(R, D), t.beyond(B, D)),
        needs=("corresponds", "goes-deeper", "behind-spot", "record-marker"),
    ),
    _kept_by_words(
        name="word-records-base",
        words="the empty word leads from a record to its spot",
        theory=("walk-nil",),
        given={"record-walk-nil": RECORD_WORDS["record-walk-nil"]},
        goal=_followed(t.nil),
        needs=("walk-nil", "record-walk-nil"),
    ),
    _kept_by_words(
        name="word-records-step",
        words="a word with one door more leads to the spot that it names, if the rest does",
        theory=("walk-cons", "behind-spot"),
        given=RECORD_WORDS | {"for-the-rest": _followed(WORD)},
        goal=_followed(t.cons(D, WORD)),
        needs=("for-the-rest", "behind-spot", "record-stays-cons", "record-walk-cons"),
    ),
    _kept_by_words(
        name="records-written",
        words="what is written after validation is true: its spot lies behind the dart it is for",
        theory=(*t.CORRESPONDENCE, *WORDS, "trace"),
        given={
            "behind-e": eq(B, t.alpha(t.phi(E))),
            "entry-known": eq(t.phi(H), B),
            "traced-on-S": t.stays(H, WORD),
        },
        goal=eq(t.alpha(t.phi(t.mrot(t.mwalk(H, WORD), D))), t.beyond(t.walk(B, WORD), D)),
        needs=("entry-known", "traced-on-S", "trace", "phi-rot"),
    ),
    _kept(
        name="records-stable-loop",
        words="records stay true when an edge of S is closed",
        theory=TRUE,
        given={
            "dropped": forall(
                t.x, recorded2(t.x), conj(t.recorded(t.x), differ(t.x, E), differ(t.x, H))
            ),
            "is-recorded": recorded2(X),
        },
        goal=eq(t.spot(t.record(X)), t.alpha(t.phi(X))),
        needs=("dropped", "is-recorded", "record-spot"),
    ),
    _kept(
        name="records-stable-new",
        words="records stay true when S grows by a vertex",
        theory=("record-spot",),
        given={
            "dropped": forall(t.x, recorded2(t.x), conj(t.recorded(t.x), old(t.x), differ(t.x, E))),
            "nothing-moves": forall(t.x, old(t.x), eq(phi2(t.x), t.phi(t.x))),
            "is-recorded": recorded2(X),
        },
        goal=eq(t.spot(t.record(X)), t.alpha(phi2(X))),
        needs=("dropped", "nothing-moves", "is-recorded", "record-spot"),
    ),
)


OBLIGATIONS = DOOR_OBLIGATIONS + TRACE_OBLIGATIONS + CONFIRMATION_OBLIGATIONS + RECORD_OBLIGATIONS
