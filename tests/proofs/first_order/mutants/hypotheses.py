"""Faulty rules and records that reject a true hypothesis, or confirm a false one."""

from __future__ import annotations

from collections.abc import Callable

from tests.proofs.first_order.conformance import DescribedRule, structure
from tests.proofs.first_order.mutants import *
from tests.proofs.first_order.scenes import SceneReplay, mfirst
from topo_verify.proofs.first_order import theory as t
from topo_verify.proofs.first_order.obligations import *
from topo_verify.proofs.first_order.terms import *
from topo_verify.robot.percept import Percept


def _one(replay: SceneReplay, rule: Term, door: str) -> bool:
    vu = replay.behind("e")
    sensed = replay.forward(door)
    k_, own_ = (replay.scene.constants.get(name, 0) for name in (door, "own1"))
    rejects = replay.says(rule, vu, sensed, x=replay.dart("h"), k=k_, own=own_, b=1)
    return rejects and replay.truth("e", "h")


def _history(name: str, of: str, words: str, rule: Term) -> RuleMutant:
    sensed = t.beyond(t.phi(H), D)
    return RuleMutant(
        name=name,
        of=of,
        words=words,
        claims=KEPT,
        size=(2, 4),
        rule=rule,
        scene={**TRUE, **AWAY, "rejects": at_h(rule, D, sensed)},
        plays=lambda replay, rule: _one(replay, rule, "d1"),
    )


_TRUE_HOMEWARD = {**TRUE, **AWAY, **HOMEWARD}
_FALSE_HOMEWARD = {**FALSE, **AWAY, **HOMEWARD}
_ABSOLUTE = t.mrot(mfirst(x), k)

# Also where the own door differs from the one taken.
_PREFIX = neg(t.alike(t.arrival(x, own), b))
_SHIFTED = neg(t.alike(x, b))
_FROM_FIRST = conj(
    t.signature_alike(x, b),
    forall(i, t.minv0(x), eq(eq(t.mrot(mfirst(x), i), t.mroot), eq(t.rot(b, i), t.root))),
)


def _plays_prefix(replay: SceneReplay, rule: Term) -> bool:
    rejected = _one(replay, rule, "d1")
    (way,) = replay.hypothesis("h").doors
    return rejected and way == replay.door("own1", replay.chart.percepts[replay.dart("h")].degree)


def _unturned(replay: SceneReplay) -> tuple[Percept, Percept]:
    vu = replay.behind("e")
    replay.forward("d1")
    # Back, but not by the pilot, which would turn the next door.
    replay.robot.move(0)
    return vu, replay.take("own1")


def _plays_unturned(replay: SceneReplay, rule: Term) -> bool:
    vu, sensed = _unturned(replay)
    own_ = replay.scene.constants["own1"]
    rejects = replay.says(rule, vu, sensed, x=replay.dart("h"), k=own_, b=1)
    return rejects and replay.truth("e", "h")


def _plays_at_v0(replay: SceneReplay, rule: Term) -> bool:
    vu = replay.behind("e")
    return not replay.says(rule, vu, x=replay.dart("h"), b=0) and replay.truth("e", "h")


REJECTIONS: tuple[RuleMutant, ...] = (
    _history(
        "history-through-unexplored",
        "history-keeps",
        "rule `history` traces through an unexplored dart, as if it led back",
        neg(t.alike(t.arrival(x, k), b)),
    ),
    _history(
        "history-shifted-by-one",
        "history-keeps",
        "rule `history` compares the percept before the door with the one behind it",
        conj(t.explored(t.mrot(x, k)), _SHIFTED),
    ),
    _history(
        "history-absolute-door",
        "trace-step",
        "rule `history` counts doors from the vertex's first dart, not from the dart of arrival",
        conj(t.explored(_ABSOLUTE), neg(t.alike(t.malpha(_ABSOLUTE), b))),
    ),
    _history(
        "history-next-door",
        "phi-keeps-doors-step",
        "rule `history` traces by the next door",
        conj(t.explored(t.mrot(x, t.succ(k))), neg(t.alike(t.arrival(x, t.succ(k)), b))),
    ),
    _history(
        "history-forgets-to-cross",
        "trace-step",
        "rule `history` compares with the dart of departure, not of arrival",
        conj(t.explored(t.mrot(x, k)), neg(t.alike(t.mrot(x, k), b))),
    ),
    RuleMutant(
        name="prefix-one-too-far",
        size=(2, 4),
        of="prefix-keeps",
        words="rule `prefix` also compares behind the first door that is not shared",
        claims=KEPT,
        rule=_PREFIX,
        scene={
            **_TRUE_HOMEWARD,
            "another-door": differ(t.mrot(H, D), t.mrot(H, OWN)),
            "rejects": at_h(_PREFIX, D, t.beyond(t.phi(H), D)),
        },
        plays=_plays_prefix,
    ),
    RuleMutant(
        name="motion-shifted-by-one",
        size=(2, 4),
        of="motion-keeps",
        words="the motion expects behind a door what was expected before it",
        claims=KEPT,
        rule=_SHIFTED,
        scene={**_TRUE_HOMEWARD, "rejects": at_h(_SHIFTED, OWN, t.beyond(t.phi(H), OWN))},
        plays=lambda replay, rule: _one(replay, rule, "own1"),
    ),
    RuleMutant(
        name="motion-forgets-turning",
        size=(2, 4),
        of="retrace-turned",
        words="after a way back, the next door is taken as if the robot were not turned",
        claims=KEPT,
        rule=t.MOTION,
        scene={**_TRUE_HOMEWARD, "rejects": at_h(t.MOTION, OWN, t.beyond(t.rot(t.phi(H), D), OWN))},
        plays=_plays_unturned,
    ),
    RuleMutant(
        name="marker-from-first-dart",
        size=(1, 2),
        of="trace-init",
        words="the marker's direction is expected as seen from the vertex's first dart",
        claims=KEPT,
        rule=_FROM_FIRST,
        scene={**TRUE, "at-v0": t.minv0(H), "rejects": neg(at_h(_FROM_FIRST, D, t.phi(H)))},
        plays=_plays_at_v0,
    ),
)


_DEGREES = eq(t.mdeg(x), t.deg(b))


def _plays_confirm(replay: SceneReplay, rule: Term, doors: tuple[str, ...] = ()) -> bool:
    at, percepts = replay.dart("h"), [replay.behind("e")]
    matches = replay.says(rule, *percepts, x=at, b=0)
    for name in doors:
        percepts.append(replay.forward(name))
        at = replay.chart.across(replay.chart.turn(at, replay.scene.constants[name]))
        matches = matches and replay.says(rule, *percepts, x=at, b=len(percepts) - 1)
    whole = len(replay.hypothesis("h").doors) == len(doors)
    return matches and whole and not replay.truth("e", "h")


def _posed(replay: SceneReplay, rule: Term, vu: Percept) -> list[int]:
    darts = range(len(replay.chart.alpha))
    return [h for h in darts if replay.says(rule, vu, e=replay.dart("e"), h=h, b=0)]


def _plays_taken(replay: SceneReplay, rule: Term) -> bool:
    vu = replay.behind("e")
    taken = replay.says(rule, vu, x=replay.dart("h"), b=0)
    posed = _posed(replay, t.POSED, vu)
    return taken and replay.dart("h") in posed and not replay.truth("e", "h")


def _plays_only(replay: SceneReplay, rule: Term) -> bool:
    posed = _posed(replay, rule, replay.behind("e"))
    return posed == [replay.dart("h")] and not replay.truth("e", "h")


def _plays_confirm_unturned(replay: SceneReplay, rule: Term) -> bool:
    vu, sensed = _unturned(replay)
    at = replay.dart("h")
    end = replay.chart.across(replay.chart.turn(at, replay.scene.constants["own1"]))
    matches = replay.says(rule, vu, x=at, b=0) and replay.says(rule, vu, sensed, x=end, b=1)
    return matches and not replay.truth("e", "h")


CONFIRMATIONS: tuple[RuleMutant, ...] = (
    RuleMutant(
        name="confirm-undirected",
        size=(2, 3),
        of="confirm-final",
        words="at v0 the marker's presence is compared, not its direction",
        claims=CONFIRMED,
        rule=t.signature_alike(x, b),
        scene={**FALSE, "at-v0": t.minv0(H)},
        plays=_plays_confirm,
    ),
    RuleMutant(
        name="confirm-unmarked",
        size=(3, 4),
        of="confirm-final",
        words="only degrees are compared, not the marker",
        claims=CONFIRMED,
        rule=_DEGREES,
        scene={
            **_FALSE_HOMEWARD,
            "matches": eq(t.mdeg(t.arrival(H, OWN)), t.deg(t.beyond(BEHIND, OWN))),
        },
        plays=lambda replay, rule: _plays_confirm(replay, rule, ("own1",)),
    ),
    RuleMutant(
        name="confirm-before-home",
        size=(3, 4),
        of="word-confirm-base",
        words="the last percept of the way home is not waited for",
        claims=CONFIRMED,
        rule=t.ALIKE,
        scene=_FALSE_HOMEWARD,
        plays=_plays_taken,
    ),
    RuleMutant(
        name="confirm-unturned",
        size=(3, 5),
        of="retrace-back",
        words="after a way back the way home is walked as if the robot were not turned",
        claims=CONFIRMED,
        rule=t.ALIKE,
        scene={
            **_FALSE_HOMEWARD,
            "matches": t.alike(t.arrival(H, OWN), t.beyond(t.rot(BEHIND, D), OWN)),
        },
        plays=_plays_confirm_unturned,
    ),
    RuleMutant(
        name="conclude-the-last",
        size=(3, 4),
        of="fold-conclude",
        words="the only hypothesis is taken for true, though the place behind e may be new",
        claims=(*CONFIRMED, *ENTAILED),
        rule=t.POSED,
        scene={
            **FALSE,
            "only-one": forall(x, substitute(t.POSED, {t.e: E, t.h: x, b: BEHIND}), eq(x, H)),
        },
        plays=_plays_only,
    ),
)


E1, H1, D1 = constant("e_before", "M"), constant("h_before", "M"), constant("d_before", "K")

_ENTERED_BY = forall(x, neg(t.minv0(x)), conj(differ(mfirst(x), E1), differ(mfirst(x), H1)))
BEFORE: dict[str, Term] = {
    "loop-before": conj(t.explored(E1), eq(t.malpha(E1), H1), neg(t.minv0(H1))),
    "loop-finds-nothing": _ENTERED_BY,
}
"""e_before was validated as a loop to h_before, after a door behind it."""

SEEN_BEFORE = t.beyond(t.phi(H1), D1)


def _unlike(one: Term, other: Term) -> Term:
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
    vu = replay.behind("e_before")
    sensed = replay.forward("d_before")
    replay.close("e_before", "h_before")
    recorded = [vu, vu if early else sensed]
    described = DescribedRule("records", levels=1, trie=replay.trie)
    doors = [replay.door("d_before", vu.degree)]
    described.learn(replay.chart, replay.dart("e_before"), entry(replay), [(doors, recorded)])
    vu = replay.behind("e")
    word, percepts = [replay.door("d1", vu.degree)], [vu, replay.forward("d1")]
    if late:
        percepts[1] = replay.forward("own1")
    place = structure(replay.chart, percepts, replay.trie)
    decided = described.refuted(place, replay.hypothesis("h"), word)
    return decided is not None and decided.rule == "records" and replay.truth("e", "h")


def _recording(
    name: str, of: str, words: str, under: Term, kept: Term, met: Term, **how: int
) -> RuleMutant:
    # Kept under another dart than the crossed one.
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
        rule=t.RECORD_DIFFERS,
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


_MET = t.beyond(t.phi(H), D)

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
        t.beyond(_MET, OWN),
        late=1,
    ),
)
