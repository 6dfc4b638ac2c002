"""How much of a run each claim judged: `judged` of `of`, counted from the moves and the decisions.

Trusted. For each crossed edge of the world a mapper owes a decision where it leads. An edge is
**settled** once it was posed and S grew along it; each crossed edge that is not settled adds to
`of` alone in claims 3, 4 and 8.

Source: docs/semantics.md, section 9, "Coverage", with the table.
"""

from __future__ import annotations

from topo_verify.checkers.replayed_trace import ReplayedTrace
from topo_verify.robot.events import SIGHTS, Augment, Confirm, Finish, Pose, Reject

Share = tuple[int, int]


def coverage(run: ReplayedTrace) -> dict[str, Share]:
    """How much of a run each claim judges; of claim 10, how much there is to judge."""
    events = [decision.event for decision in run.rounds]
    declared = [*map(type, events)]
    rejections, confirmations = declared.count(Reject), declared.count(Confirm)
    posed = sum([len(event.hypotheses) for event in events if isinstance(event, Pose)])
    ends = {edge: fate.event for edge, fate in run.fates.items() if isinstance(fate.event, Augment)}
    loops = [end.kind for end in ends.values()].count("loop")
    unsettled = len(run.crossings.keys() - ends.keys())
    left = sum([len(fate.left) for fate in run.fates.values()])
    missing = sum([len(fate.left) for edge, fate in run.fates.items() if edge in ends])
    grown = {run.crossing(run.map.phi[dart]) for dart in run.map.alpha}
    decisions = rejections + confirmations + declared.count(Augment)
    percepts = sum([isinstance(event, SIGHTS) for event in run.followed])
    maps = run.kinds[Finish]
    costs = int(getattr(run.trace[-1], "cost", None) is not None)
    return {
        "percepts-true": (percepts, 1 + run.cost),
        "true-hypothesis-posed": (len(run.crossings.keys() & run.fates), len(run.crossings)),
        "true-hypothesis-kept": (posed - left, posed + unsettled),
        "no-false-confirm": (confirmations, max(confirmations, loops) + unsettled),
        "map-isomorphic": (maps, 1),
        "cost-honest": (costs, costs),
        "cost-within-bound": (1, 1),
        "rejection-justified": (rejections, rejections + missing + unsettled),
        "map-entailed": (maps, 1),
        "decisions-entailed": (decisions, decisions + len(run.crossings.keys() - grown)),
    }
