"""Rules that confirm what is false."""

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
from topo_verify.proofs.first_order.scene_replay import Stage
from topo_verify.proofs.first_order.terms import Term, eq, forall, substitute

_DEGREES = eq(t.mdeg(x), t.deg(b))


def _plays_confirm(stage: Stage, rule: Term, doors: tuple[str, ...] = ()) -> bool:
    """Is the false h confirmed by its way home?"""
    at, seen = stage.dart("h"), [stage.behind("e")]
    matches = stage.says(rule, *seen, x=at, b=0)
    for name in doors:
        seen.append(stage.forward(name))
        at = stage.chart.across(stage.chart.turn(at, stage.scene.constants[name]))
        matches = matches and stage.says(rule, *seen, x=at, b=len(seen) - 1)
    whole = len(stage.hypothesis("h").doors) == len(doors)
    return matches and whole and not stage.truth("e", "h")


def _plays_taken(stage: Stage, rule: Term) -> bool:
    """Is the false h taken for true behind e, where the rule lets it?"""
    vu = stage.behind("e")
    darts = range(len(stage.chart.alpha))
    posed = [h for h in darts if stage.says(r.POSED, vu, e=stage.dart("e"), h=h, b=0)]
    taken = stage.says(rule, vu, x=stage.dart("h"), b=0)
    return taken and stage.dart("h") in posed and not stage.truth("e", "h")


def _plays_only(stage: Stage, rule: Term) -> bool:
    vu = stage.behind("e")
    darts = range(len(stage.chart.alpha))
    posed = [h for h in darts if stage.says(rule, vu, e=stage.dart("e"), h=h, b=0)]
    return posed == [stage.dart("h")] and not stage.truth("e", "h")


def _plays_confirm_unturned(stage: Stage, rule: Term) -> bool:
    vu = stage.behind("e")
    stage.forward("d1")
    stage.robot.move(0)
    sensed = stage.take("own1")
    at = stage.dart("h")
    end = stage.chart.across(stage.chart.turn(at, stage.scene.constants["own1"]))
    matches = stage.says(rule, vu, x=at, b=0) and stage.says(rule, vu, sensed, x=end, b=1)
    return matches and not stage.truth("e", "h")


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
        plays=lambda stage, rule: _plays_confirm(stage, rule, ("own1",)),
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
