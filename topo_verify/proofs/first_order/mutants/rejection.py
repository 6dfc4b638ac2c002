"""Faulty rules that reject a true hypothesis: by tracing, the common prefix, or the motion."""

from __future__ import annotations

from topo_verify.proofs.first_order import axioms as t
from topo_verify.proofs.first_order import rules as r
from topo_verify.proofs.first_order.mutants.mutant import (
    AWAY,
    HOMEWARD,
    TRUE,
    RuleMutant,
    at_h,
    b,
    i,
    k,
    own,
    x,
)
from topo_verify.proofs.first_order.obligations.obligation import KEPT, OWN, D, H
from topo_verify.proofs.first_order.scene_replay import SceneReplay
from topo_verify.proofs.first_order.scenes import mfirst
from topo_verify.proofs.first_order.terms import Term, conj, differ, eq, forall, neg


def _one(replay: SceneReplay, rule: Term, door: str) -> bool:
    """Whether the rule, after one door behind e, rejects h although it is true."""
    vu = replay.behind("e")
    sensed = replay.forward(door)
    k_, own_ = (replay.scene.constants.get(name, 0) for name in (door, "own1"))
    rejects = replay.says(rule, vu, sensed, x=replay.dart("h"), k=k_, own=own_, b=1)
    return rejects and replay.truth("e", "h")


def _history(name: str, of: str, words: str, rule: Term) -> RuleMutant:
    sensed = r.beyond(t.phi(H), D)
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


_ABSOLUTE = t.mrot(mfirst(x), k)

# As in rules.py, but also where the own door differs from the one that was taken.
_PREFIX = neg(r.alike(r.arrival(x, own), b))
_SHIFTED = neg(r.alike(x, b))
_FROM_FIRST = conj(
    r.signature_alike(x, b),
    forall(i, t.minv0(x), eq(eq(t.mrot(mfirst(x), i), t.mroot), eq(t.rot(b, i), t.root))),
)


def _plays_prefix(replay: SceneReplay, rule: Term) -> bool:
    rejected = _one(replay, rule, "d1")
    (way,) = replay.hypothesis("h").doors
    return rejected and way == replay.door("own1", replay.chart.percepts[replay.dart("h")].degree)


def _plays_unturned(replay: SceneReplay, rule: Term) -> bool:
    vu = replay.behind("e")
    replay.forward("d1")
    # Back, but not by the pilot, which would turn the next door.
    replay.robot.move(0)
    sensed = replay.take("own1")
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
        neg(r.alike(r.arrival(x, k), b)),
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
        conj(t.explored(_ABSOLUTE), neg(r.alike(t.malpha(_ABSOLUTE), b))),
    ),
    _history(
        "history-next-door",
        "phi-keeps-doors-step",
        "rule `history` traces by the next door",
        conj(t.explored(t.mrot(x, t.succ(k))), neg(r.alike(r.arrival(x, t.succ(k)), b))),
    ),
    _history(
        "history-forgets-to-cross",
        "trace-step",
        "rule `history` compares with the dart of departure, not of arrival",
        conj(t.explored(t.mrot(x, k)), neg(r.alike(t.mrot(x, k), b))),
    ),
    RuleMutant(
        name="prefix-one-too-far",
        size=(2, 4),
        of="prefix-keeps",
        words="rule `prefix` also compares behind the first door that is not shared",
        claims=KEPT,
        rule=_PREFIX,
        scene={
            **TRUE,
            **AWAY,
            **HOMEWARD,
            "another-door": differ(t.mrot(H, D), t.mrot(H, OWN)),
            "rejects": at_h(_PREFIX, D, r.beyond(t.phi(H), D)),
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
        scene={**TRUE, **AWAY, **HOMEWARD, "rejects": at_h(_SHIFTED, OWN, r.beyond(t.phi(H), OWN))},
        plays=lambda replay, rule: _one(replay, rule, "own1"),
    ),
    RuleMutant(
        name="motion-forgets-turning",
        size=(2, 4),
        of="retrace-turned",
        words="after a way back, the next door is taken as if the robot were not turned",
        claims=KEPT,
        rule=r.MOTION,
        scene={
            **TRUE,
            **AWAY,
            **HOMEWARD,
            "rejects": at_h(r.MOTION, OWN, r.beyond(t.rot(t.phi(H), D), OWN)),
        },
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
