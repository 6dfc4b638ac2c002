"""Doors: what turning by any number of them preserves, by induction over doors.

Also the way back: door 0 undoes a move but for a turn, which is added to the next door.
"""

from __future__ import annotations

from collections.abc import Callable

from topo_verify.proofs.first_order.axioms import (
    a,
    b,
    deg,
    inv0,
    k0,
    mrot,
    phi,
    plus,
    rot,
    succ,
    wraps,
    x,
)
from topo_verify.proofs.first_order.obligations.obligation import (
    CONFIRMED,
    KEPT,
    A,
    D,
    J,
    K,
    Obligation,
)
from topo_verify.proofs.first_order.rules import beyond
from topo_verify.proofs.first_order.terms import Term, differ, eq, forall

BOTH = KEPT + CONFIRMED
DOOR_INDUCTION = ("induction over doors",)


def _induction(
    name: str,
    words: str,
    statement: dict[str, Term],
    theory: tuple[str, ...],
    needs: tuple[tuple[str, ...], tuple[str, ...]],
) -> tuple[Obligation, Obligation]:
    """Base and step of an induction over doors, given the statement at k0, D and succ(D)."""
    base = Obligation(
        name=f"{name}-base",
        words=f"{words}: with door 0",
        claims=BOTH,
        theory=theory,
        goal=statement["base"],
        argued=DOOR_INDUCTION,
        needs=needs[0],
    )
    step = Obligation(
        name=f"{name}-step",
        words=f"{words}: with door k+1, if with door k",
        claims=BOTH,
        theory=theory,
        given={"for-the-door-before": statement["before"]},
        goal=statement["step"],
        argued=DOOR_INDUCTION,
        needs=needs[1],
    )
    return base, step


def _at(statement: Callable[[Term], Term]) -> dict[str, Term]:
    # Nothing is known of the constant D, so the step holds for every door.
    return {"base": statement(k0), "before": statement(D), "step": statement(succ(D))}


TURNING = ("rot-zero", "rot-next")

OBLIGATIONS: tuple[Obligation, ...] = (
    *_induction(
        "rot-injective",
        "one door, counted from two reference darts, means two darts",
        _at(lambda k: forall((a, b), eq(rot(a, k), rot(b, k)), eq(a, b))),
        (*TURNING, "sigma-injective"),
        (("rot-zero",), ("rot-next", "sigma-injective", "for-the-door-before")),
    ),
    *_induction(
        "rot-keeps-degree",
        "all doors of a vertex have its degree",
        _at(lambda k: forall(a, eq(deg(rot(a, k)), deg(a)))),
        (*TURNING, "degree-of-vertex"),
        (("rot-zero",), ("rot-next", "degree-of-vertex", "for-the-door-before")),
    ),
    *_induction(
        "rot-keeps-marker",
        "the marker is seen from all darts of a vertex or from none",
        _at(lambda k: forall(a, eq(inv0(rot(a, k)), inv0(a)))),
        (*TURNING, "marker-of-vertex"),
        (("rot-zero",), ("rot-next", "marker-of-vertex", "for-the-door-before")),
    ),
    *_induction(
        "phi-keeps-doors",
        "a door of S means the same door of the world",
        _at(lambda k: forall(x, eq(phi(mrot(x, k)), rot(phi(x), k)))),
        (*TURNING, "map-rot-zero", "map-rot-next", "phi-sigma"),
        (("rot-zero", "map-rot-zero"), ("rot-next", "map-rot-next", "phi-sigma")),
    ),
    *_induction(
        "turning-adds",
        "turning by i and then by j is turning by i + j",
        _at(lambda k: eq(rot(rot(A, K), k), rot(A, plus(K, k)))),
        (*TURNING, "plus-zero", "plus-next"),
        (("rot-zero", "plus-zero"), ("rot-next", "plus-next", "for-the-door-before")),
    ),
    Obligation(
        name="retrace-back",
        words="door 0 undoes a move: the robot is where it was, turned by the door it had taken",
        claims=BOTH,
        theory=("alpha-involution", "rot-zero"),
        goal=eq(beyond(beyond(A, D), k0), rot(A, D)),
        argued=("induction over words",),
        needs=("alpha-involution", "rot-zero"),
    ),
    Obligation(
        name="retrace-turned",
        words="after a way back by door k, door i is what door j was, if k + i = j modulo degree",
        claims=BOTH,
        theory=("turning-adds", "doors-wrap"),
        given={"one-door": wraps(deg(A), plus(D, K), J)},
        goal=eq(rot(rot(A, D), K), rot(A, J)),
        needs=("turning-adds", "doors-wrap", "one-door"),
    ),
    Obligation(
        name="no-loop-of-one-dart",
        words="a move never ends at the dart by which it began",
        claims=("true-hypothesis-posed",),
        theory=("alpha-no-fixed-point",),
        goal=differ(beyond(A, D), rot(A, D)),
        needs=("alpha-no-fixed-point",),
    ),
)
