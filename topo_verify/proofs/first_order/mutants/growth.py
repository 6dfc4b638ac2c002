"""Faulty growth: hypotheses that are not posed, augmentations that join the wrong darts."""

from __future__ import annotations

from topo_verify.proofs.first_order import axioms as t
from topo_verify.proofs.first_order import rules as r
from topo_verify.proofs.first_order.mutants.mutant import AWAY, BEHIND, TRUE, RuleMutant, x
from topo_verify.proofs.first_order.obligations.obligation import MAPPED, POSED, E, H
from topo_verify.proofs.first_order.scene_replay import SceneReplay
from topo_verify.proofs.first_order.scenes import mfirst
from topo_verify.proofs.first_order.terms import Term, conj, differ, eq, forall, neg, substitute


def _plays_not_posed(replay: SceneReplay, rule: Term) -> bool:
    vu = replay.behind("e")
    posed = replay.says(rule, vu, e=replay.dart("e"), h=replay.dart("h"), b=0)
    return not posed and replay.truth("e", "h")


def _plays_first_dart(replay: SceneReplay, _rule: Term) -> bool:
    replay.behind("e")
    other = replay.first(replay.dart("h"))
    return other != replay.dart("h") and replay.truth("e", "h")


def _plays_entered_late(replay: SceneReplay, _rule: Term) -> bool:
    replay.behind("e")
    world, e = replay.scene.world, replay.scene.place[replay.scene.constants["e"]]
    # S joins e with the first dart of the new vertex, and that is the dart after `behind`.
    behind = world.alpha[e]
    return world.sigma[behind] != behind


_NOT_AT_VK = conj(r.POSED, differ(mfirst(r.h), mfirst(r.e)))
_WHOLE_PERCEPT = conj(r.POSED, substitute(r.ALIKE, {x: mfirst(r.h)}))

GROWTH: tuple[RuleMutant, ...] = (
    RuleMutant(
        name="posed-not-at-vk",
        size=(1, 2),
        of="posed",
        words="the darts of the vertex that e leaves are left out of the hypotheses",
        claims=(*POSED, *MAPPED),
        rule=_NOT_AT_VK,
        scene={**TRUE, "at-vk": eq(mfirst(H), mfirst(E))},
        plays=_plays_not_posed,
    ),
    RuleMutant(
        name="posed-by-first-dart",
        size=(1, 2),
        of="posed",
        words="a hypothesis must look like the place behind e from its vertex's first dart",
        claims=(*POSED, *MAPPED),
        rule=_WHOLE_PERCEPT,
        scene={**TRUE, "not-alike": neg(r.alike(mfirst(H), t.phi(H)))},
        plays=_plays_not_posed,
    ),
    RuleMutant(
        name="new-though-known",
        size=(2, 4),
        of="new-is-new",
        words="one hypothesis is skipped before a new vertex is added",
        claims=MAPPED,
        # Never true: the hypothesis is skipped wherever it would be posed.
        rule=conj(r.POSED, neg(r.POSED)),
        scene={**TRUE, **AWAY},
        plays=_plays_not_posed,
    ),
    RuleMutant(
        name="new-numbered-late",
        size=(2, 1),
        of="new-entry",
        words="a new vertex is numbered from the dart after that by which the robot came in",
        claims=MAPPED,
        rule=eq(r.b, t.sigma(r.b)),
        scene={
            "e-open": neg(t.explored(E)),
            "is-new": forall(x, differ(t.phi(x), BEHIND)),
            "turns": differ(t.sigma(BEHIND), BEHIND),
        },
        plays=_plays_entered_late,
    ),
    RuleMutant(
        name="loop-at-first-dart",
        size=(1, 2),
        of="loop-edges",
        words="a loop joins e with the first dart of h's vertex",
        claims=MAPPED,
        rule=eq(x, mfirst(x)),
        scene={**TRUE, "not-first": conj(differ(mfirst(H), H), neg(t.explored(mfirst(H))))},
        plays=_plays_first_dart,
    ),
)
