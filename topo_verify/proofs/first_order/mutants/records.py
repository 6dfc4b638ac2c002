"""Faulty records: written or read in the wrong place, so that they reject a true hypothesis."""

from __future__ import annotations

from collections.abc import Callable

from topo_verify.proofs.first_order import axioms as t
from topo_verify.proofs.first_order import rules as r
from topo_verify.proofs.first_order.conformance import DescribedRule
from topo_verify.proofs.first_order.mutants.mutant import AWAY, TRUE, RuleMutant, i, x
from topo_verify.proofs.first_order.obligations.obligation import KEPT, OWN, D, H
from topo_verify.proofs.first_order.scene_replay import SceneReplay
from topo_verify.proofs.first_order.scenes import mfirst
from topo_verify.proofs.first_order.terms import Term, conj, constant, differ, eq, forall, neg

E1, H1, D1 = constant("e_before", "M"), constant("h_before", "M"), constant("d_before", "K")

_ENTERED_BY = forall(x, neg(t.minv0(x)), conj(differ(mfirst(x), E1), differ(mfirst(x), H1)))
BEFORE: dict[str, Term] = {
    "loop-before": conj(t.explored(E1), eq(t.malpha(E1), H1), neg(t.minv0(H1))),
    "loop-finds-nothing": _ENTERED_BY,
}
"""Edge e_before was validated as a loop to h_before, and a door was executed behind it."""

SEEN_BEFORE = r.beyond(t.phi(H1), D1)


def _unlike(one: Term, other: Term) -> Term:
    """The formula that two darts of the world show different percepts."""
    same = eq(eq(t.rot(one, i), t.root), eq(t.rot(other, i), t.root))
    return neg(
        conj(
            eq(t.deg(one), t.deg(other)),
            eq(t.inv0(one), t.inv0(other)),
            forall(i, t.inv0(one), same),
        )
    )


def _plays_records(
    replay: SceneReplay, *, entry: Callable[[SceneReplay], int], late: int, early: int
) -> bool:
    """Whether records made behind e_before reject h behind e although it is true."""
    vu = replay.behind("e_before")
    sensed = replay.forward("d_before")
    replay.close("e_before", "h_before")
    seen = [vu, vu if early else sensed]
    described = DescribedRule("records", levels=1, trie=replay.trie)
    doors = [replay.door("d_before", vu.degree)]
    described.learn(replay.chart, replay.dart("e_before"), entry(replay), [(doors, seen)])
    vu = replay.behind("e")
    word, percepts = [replay.door("d1", vu.degree)], [vu, replay.forward("d1")]
    if late:
        percepts[1] = replay.forward("own1")
    decided = described.refuted(replay.chart, replay.hypothesis("h"), word, percepts)
    return decided is not None and decided.rule == "records" and replay.truth("e", "h")


def _recording(
    name: str, of: str, words: str, under: Term, kept: Term, met: Term, **how: int
) -> RuleMutant:
    """A mutant of records: kept under a dart, with the percept at `kept`, compared at `met`."""
    # The record is kept under another dart than the one that was crossed.
    stale = under != t.mrot(H1, D1)

    def entry(replay: SceneReplay) -> int:
        h = replay.dart("h_before")
        return replay.first(h) if stale else h

    return RuleMutant(
        name=name,
        of=of,
        words=words,
        claims=KEPT,
        size=(4, 7) if stale else (3, 6),
        rule=r.RECORD_DIFFERS,
        scene={
            **TRUE,
            **AWAY,
            **BEFORE,
            "recorded-open": conj(neg(t.explored(t.mrot(H1, D1))), neg(t.explored(under))),
            "crosses-it": eq(t.mrot(H, D), under),
            "rejects": _unlike(kept, met),
        },
        plays=lambda replay, _: _plays_records(
            replay, entry=entry, late=how.get("late", 0), early=how.get("early", 0)
        ),
        without=("e_before", "h_before"),
    )


_MET = r.beyond(t.phi(H), D)

RECORDS: tuple[RuleMutant, ...] = (
    _recording(
        "records-stale-root",
        "records-written",
        "a loop is traced from its vertex's first dart, not from h, when records are written",
        t.mrot(mfirst(H1), D1),
        SEEN_BEFORE,
        _MET,
    ),
    _recording(
        "records-written-early",
        "records-written",
        "what was sensed before the crossing is recorded as lying behind it",
        t.mrot(H1, D1),
        t.phi(H1),
        _MET,
        early=1,
    ),
    _recording(
        "records-read-late",
        "records-leave",
        "a record is compared with what is sensed one door further",
        t.mrot(H1, D1),
        SEEN_BEFORE,
        r.beyond(_MET, OWN),
        late=1,
    ),
)
