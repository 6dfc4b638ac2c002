"""A rule with one mistake, and the parts of scenes that several of them share."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from topo_verify.proofs.first_order import axioms as t
from topo_verify.proofs.first_order import rules as r
from topo_verify.proofs.first_order.obligations.obligation import OWN, E, H
from topo_verify.proofs.first_order.scene_replay import SceneReplay
from topo_verify.proofs.first_order.terms import Term, conj, differ, eq, forall, neg, substitute

x, k, b, own, i = r.x, r.k, r.b, r.own, t.i


@dataclass(frozen=True, slots=True, kw_only=True)
class RuleMutant:
    """A rule with one mistake, and a scene in which it fails.

    Attributes:
        name: of the theorem.
        of: the obligation that the right rule meets.
        words: the mistake.
        claims: the claims that it breaks.
        rule: the faulty rule, as in `rules.py`; for a fold step, its wrong conclusion.
        scene: formulas of a scene in which it fails; with the right rule they contradict.
        plays: makes the moves in a replay, and tells whether the rule fails there.
        size: edges of the world and darts of S in the smallest scene.
        without: darts of S whose edges are left for `plays` to cross.
    """

    name: str
    of: str
    words: str
    claims: tuple[str, ...]
    rule: Term
    scene: Mapping[str, Term]
    plays: Callable[[SceneReplay, Term], bool]
    size: tuple[int, int]
    without: tuple[str, ...] = ()


BEHIND = t.alpha(t.phi(E))
"""The robot's reference dart behind e."""

TRUE: dict[str, Term] = {"e-open": neg(t.explored(E)), "e-ends-in-h": eq(BEHIND, t.phi(H))}
AWAY: dict[str, Term] = {"not-at-v0": neg(t.minv0(H))}
FALSE: dict[str, Term] = {
    "e-open": neg(t.explored(E)),
    "h-posed": conj(neg(t.explored(H)), differ(H, E), r.signature_alike(H, BEHIND)),
    "h-is-false": differ(BEHIND, t.phi(H)),
}
HOMEWARD: dict[str, Term] = {
    "way-home": conj(t.explored(t.mrot(H, OWN)), t.minv0(r.arrival(H, OWN))),
    "only-way": forall(
        i,
        t.explored(t.mrot(H, i)),
        t.minv0(r.arrival(H, i)),
        eq(t.mrot(H, i), t.mrot(H, OWN)),
    ),
}
"""The way home of h is the one door `own`, and no other edge leads from h's vertex to v0."""


def at_h(rule: Term, door: Term, sensed: Term) -> Term:
    """A rule at h, for this door, about what is sensed there."""
    return substitute(rule, {x: H, k: door, own: OWN, b: sensed})
