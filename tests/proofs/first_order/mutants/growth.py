"""S grows in the wrong place, or folding identifies two darts."""

from __future__ import annotations

from tests.proofs.first_order.mutants import *
from tests.proofs.first_order.scenes import SceneReplay, mfirst
from topo_verify.algorithms.beyond import planar
from topo_verify.algorithms.beyond.folding import NodeDart, PartialFold
from topo_verify.proofs.first_order import theory as t
from topo_verify.proofs.first_order.obligations import *
from topo_verify.proofs.first_order.terms import *


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
    # S joins e with the dart after `behind`.
    behind = world.alpha[e]
    return world.sigma[behind] != behind


_NOT_AT_VK = conj(t.POSED, differ(mfirst(t.h), mfirst(t.e)))
_WHOLE_PERCEPT = conj(t.POSED, substitute(t.ALIKE, {x: mfirst(t.h)}))

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
        scene={**TRUE, "not-alike": neg(t.alike(mfirst(H), t.phi(H)))},
        plays=_plays_not_posed,
    ),
    RuleMutant(
        name="new-though-known",
        size=(2, 4),
        of="new-is-new",
        words="one hypothesis is skipped before a new vertex is added",
        claims=MAPPED,
        rule=conj(t.POSED, neg(t.POSED)),
        scene={**TRUE, **AWAY},
        plays=_plays_not_posed,
    ),
    RuleMutant(
        name="new-numbered-late",
        size=(2, 1),
        of="new-entry",
        words="a new vertex is numbered from the dart after that by which the robot came in",
        claims=MAPPED,
        rule=eq(t.b, t.sigma(t.b)),
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


def _plays_fold(replay: SceneReplay, doors: tuple[str | int, ...], one: int, other: int) -> bool:
    world, at = replay.scene.world, replay.root
    arrivals = [at]
    for door in doors:
        percept = replay.robot.percept
        # A text names a constant; a number is a door.
        taken = door if isinstance(door, int) else replay.door(door, percept.degree)
        for _ in range(taken % percept.degree):
            at = world.sigma[at]
        at = world.alpha[at]
        arrivals.append(at)
        replay.robot.move(taken % percept.degree)
        if replay.robot.percept.degree != world.degrees[world.vertex_of[at]]:
            return False
    return arrivals[one] != arrivals[other]


def _plays_ghost(replay: SceneReplay, _rule: Term) -> bool:
    vu = replay.behind("e")
    partial = PartialFold()
    nodes = [partial.add(replay.chart.percepts[first], known=True) for first in replay.chart.first]
    ghost = partial.add(vu, known=True)  # the fault: it is not known to be a vertex of S

    def place(dart: int) -> NodeDart:
        v = replay.chart.vertex[dart]
        return partial.turn(nodes[v], dart - replay.chart.first[v])

    partial.join(place(replay.dart("e")), ghost)
    refuted = partial.join(place(replay.dart("e")), place(replay.dart("h")))
    return bool(refuted) and replay.truth("e", "h")


_LOOPED = t.beyond(t.root, D)

FOLD_STEPS: tuple[RuleMutant, ...] = (
    RuleMutant(
        name="fold-marker-undirected",
        size=(1, 2),
        of="fold-marker",
        words="visits that saw the marker are identified without turning them",
        claims=ENTAILED,
        rule=eq(_LOOPED, t.root),
        scene={"back-at-v0": conj(t.inv0(_LOOPED), differ(_LOOPED, t.root))},
        plays=lambda replay, _: _plays_fold(replay, ("d1",), 0, 1),
    ),
    RuleMutant(
        name="fold-without-offset",
        size=(1, 2),
        of="fold-offset",
        words="two visits of one vertex are identified door by door, without an offset",
        claims=ENTAILED,
        rule=eq(t.rot(t.root, D), t.root),
        scene={"turned": differ(t.rot(t.root, D), t.root)},
        plays=lambda replay, _: _plays_fold(replay, ("d1", 0), 0, 2),
    ),
    RuleMutant(
        name="fold-next-partner",
        size=(1, 2),
        of="fold-cross",
        words="with a place, the partner of the next place is identified",
        claims=ENTAILED,
        rule=eq(_LOOPED, t.beyond(t.root, t.succ(D))),
        scene={"next": differ(_LOOPED, t.beyond(t.root, t.succ(D)))},
        plays=lambda replay, _: _plays_fold(replay, ("d1", 0, 1), 1, 3),
    ),
    RuleMutant(
        name="fold-ghost-known",
        size=(2, 4),
        of="fold-two-known",
        words="the place behind e counts as a vertex of S before it is known to be one",
        claims=KEPT,
        rule=differ(t.alpha(t.phi(E)), t.phi(H)),
        scene={**TRUE, **AWAY},
        plays=_plays_ghost,
    ),
)


face = Symbol("face", ("M",), BOOL)


def _plays_planar(replay: SceneReplay, _rule: Term) -> bool:
    replay.behind("e")
    on_face = planar.face(replay.chart, replay.dart("e"))
    return replay.dart("h") not in on_face and replay.truth("e", "h")


PLANAR = RuleMutant(
    name="planar-keeps",
    size=(2, 4),
    of="history-keeps",
    words="the prior `planar` rejects no true hypothesis, in any world",
    claims=KEPT,
    rule=face(H),
    scene={
        **TRUE,
        "e-on-its-face": face(E),
        "faces-go-on": forall(x, face(x), face(t.msigma(t.malpha(x)))),
        "rejects": neg(face(H)),
    },
    plays=_plays_planar,
)
"""Not sound, so it must not be provable."""
