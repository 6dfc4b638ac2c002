"""Rules with one mistake, each refuted by a scene (scenes.py) and the moves behind its edge.

What this does not show: that the reference policies make these moves. Claims hold for every
history.

hypotheses.py   true hypotheses rejected, records misplaced, false hypotheses confirmed
growth.py       S grows in the wrong place, folding identifies what differs
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from tests.proofs.first_order.scenes import SceneReplay
from topo_verify.proofs.first_order import theory as t
from topo_verify.proofs.first_order.obligations import *
from topo_verify.proofs.first_order.terms import *

# What the modules of this folder import whole.
# fmt: off
__all__ = [
    "AWAY", "BEHIND", "FALSE", "HOMEWARD", "TRUE", "RuleMutant", "at_h", "b", "i", "k",
    "own", "x",
]
# fmt: on

x, k, b, own, i = t.x, t.k, t.b, t.own, t.i


@dataclass(frozen=True, slots=True, kw_only=True)
class RuleMutant:
    """A rule with one mistake, and a scene in which it fails.

    Attributes:
        of: the obligation that the right rule meets.
        words: the mistake.
        rule: the faulty rule, as in `theory.py`; for a fold step, its wrong conclusion.
        scene: formulas that contradict the right rule.
        plays: makes the moves; does the rule fail?
        size: edges of the world and darts of S.
        without: darts of S whose edges are left for `plays`.
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
    "h-posed": conj(neg(t.explored(H)), differ(H, E), t.signature_alike(H, BEHIND)),
    "h-is-false": differ(BEHIND, t.phi(H)),
}
HOMEWARD: dict[str, Term] = {
    "way-home": conj(t.explored(t.mrot(H, OWN)), t.minv0(t.arrival(H, OWN))),
    "only-way": forall(
        i,
        t.explored(t.mrot(H, i)),
        t.minv0(t.arrival(H, i)),
        eq(t.mrot(H, i), t.mrot(H, OWN)),
    ),
}
"""The way home of h is door `own`, its only edge to v0."""


def at_h(rule: Term, door: Term, sensed: Term) -> Term:
    """A rule at h, about what is sensed behind this door."""
    return substitute(rule, {x: H, k: door, own: OWN, b: sensed})
