"""Faulty rules that confirm a false hypothesis."""

from __future__ import annotations

from topo_verify.proofs.first_order import axioms as t
from topo_verify.proofs.first_order import rules as r
from topo_verify.proofs.first_order.mutants.mutant import (
    AWAY,
    BEHIND,
    FALSE,
    HOMEWARD,
    RuleMutant,
    b,
    x,
)
from topo_verify.proofs.first_order.obligations.obligation import CONFIRMED, ENTAILED, OWN, D, E, H
from topo_verify.proofs.first_order.scene_replay import SceneReplay
from topo_verify.proofs.first_order.terms import Term, eq, forall, substitute

_DEGREES = eq(t.mdeg(x), t.deg(b))


def _plays_confirm(replay: SceneReplay, rule: Term, doors: tuple[str, ...] = ()) -> bool:
    """Whether h is confirmed by its way home although it is false."""
    at, seen = replay.dart("h"), [replay.behind("e")]
    matches = replay.says(rule, *seen, x=at, b=0)
    for name in doors:
        seen.append(replay.forward(name))
        at = replay.chart.across(replay.chart.turn(at, replay.scene.constants[name]))
        matches = matches and replay.says(rule, *seen, x=at, b=len(seen) - 1)
    whole = len(replay.hypothesis("h").doors) == len(doors)
    return matches and whole and not replay.truth("e", "h")


def _plays_taken(replay: SceneReplay, rule: Term) -> bool:
    """Whether h is posed and taken for true behind e although it is false."""
    vu = replay.behind("e")
    darts = range(len(replay.chart.alpha))
    posed = [h for h in darts if replay.says(r.POSED, vu, e=replay.dart("e"), h=h, b=0)]
    taken = replay.says(rule, vu, x=replay.dart("h"), b=0)
    return taken and replay.dart("h") in posed and not replay.truth("e", "h")


def _plays_only(replay: SceneReplay, rule: Term) -> bool:
    vu = replay.behind("e")
    darts = range(len(replay.chart.alpha))
    posed = [h for h in darts if replay.says(rule, vu, e=replay.dart("e"), h=h, b=0)]
    return posed == [replay.dart("h")] and not replay.truth("e", "h")


def _plays_confirm_unturned(replay: SceneReplay, rule: Term) -> bool:
    vu = replay.behind("e")
    replay.forward("d1")
    # Back, but not by the pilot, which would turn the next door.
    replay.robot.move(0)
    sensed = replay.take("own1")
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
        rule=r.signature_alike(x, b),
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
            **FALSE,
            **AWAY,
            **HOMEWARD,
            "matches": eq(t.mdeg(r.arrival(H, OWN)), t.deg(r.beyond(BEHIND, OWN))),
        },
        plays=lambda replay, rule: _plays_confirm(replay, rule, ("own1",)),
    ),
    RuleMutant(
        name="confirm-before-home",
        size=(3, 4),
        of="word-confirm-base",
        words="the last percept of the way home is not waited for",
        claims=CONFIRMED,
        rule=r.ALIKE,
        scene={**FALSE, **AWAY, **HOMEWARD},
        plays=_plays_taken,
    ),
    RuleMutant(
        name="confirm-unturned",
        size=(3, 5),
        of="retrace-back",
        words="after a way back the way home is walked as if the robot were not turned",
        claims=CONFIRMED,
        rule=r.ALIKE,
        scene={
            **FALSE,
            **AWAY,
            **HOMEWARD,
            "matches": r.alike(r.arrival(H, OWN), r.beyond(t.rot(BEHIND, D), OWN)),
        },
        plays=_plays_confirm_unturned,
    ),
    RuleMutant(
        name="conclude-the-last",
        size=(3, 4),
        of="fold-conclude",
        words="the only hypothesis is taken for true, though the place behind e may be new",
        claims=(*CONFIRMED, *ENTAILED),
        rule=r.POSED,
        scene={
            **FALSE,
            "only-one": forall(x, substitute(r.POSED, {r.e: E, r.h: x, b: BEHIND}), eq(x, H)),
        },
        plays=_plays_only,
    ),
)
