"""How much of a run each claim judged: `judged` of `of`, counted from the moves and the decisions.

Trusted. For each crossed edge of the world a mapper owes a decision where it leads. An edge is
**settled** once it was posed and S grew along it; each crossed edge that is not settled adds to
`of` alone in claims 3, 4 and 8.

Source: docs/semantics.md, section 9, "Coverage", with the table.
"""

from __future__ import annotations

from topo_verify.checkers.replayed_trace import ReplayedTrace
from topo_verify.robot.events import Augment, Confirm, Finish, Move, Pose, Reject


def coverage(run: ReplayedTrace) -> dict[str, tuple[int, int]]:
    """How much of a run each claim judges; of claim 10, how much there is to judge."""
    events = [decision.event for decision in run.rounds]
    declared = [*map(type, events)]
    rejections, confirmations = declared.count(Reject), declared.count(Confirm)
    posed = sum([len(event.hypotheses) for event in events if type(event) is Pose])
    ends = {edge: fate.event for edge, fate in run.fates.items() if type(fate.event) is Augment}
    loops = [end.kind for end in ends.values()].count("loop")
    unsettled = len(run.crossings.keys() - ends.keys())
    left = sum(map(len, run.left.values()))
    missing = sum([len(run.left[edge]) for edge in ends])
    grown = [edge for edge in run.crossings if run.map.number.get(edge) in run.map.alpha]
    decisions = rejections + confirmations + declared.count(Augment)
    unfollowed = [*map(type, run.trace[len(run.positions) :])].count(Move)
    maps = int(Finish in run.kinds)
    costs = int(getattr(run.trace[-1], "cost", None) is not None)
    return {
        "percepts-true": (1 + run.cost - unfollowed, 1 + run.cost),
        "true-hypothesis-posed": (len(run.crossings.keys() & run.fates), len(run.crossings)),
        "true-hypothesis-kept": (posed - left, posed + unsettled),
        "no-false-confirm": (confirmations, max(confirmations, loops) + unsettled),
        "map-isomorphic": (maps, 1),
        "cost-honest": (costs, costs),
        "cost-within-bound": (1, 1),
        "rejection-justified": (rejections, rejections + missing + unsettled),
        "map-entailed": (maps, 1),
        "decisions-entailed": (decisions, decisions + len(run.crossings) - len(grown)),
    }
