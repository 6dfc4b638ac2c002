"""How much of a run each claim judged: `judged` of `of`, counted from the moves and the decisions.

Trusted. What a mapper owes follows from where it walked, not from what it says: of each edge of the
world that the robot crossed, a decision where it leads. An edge is **settled** once it was posed
and S grew along it. In claims 3, 4 and 8 each crossed edge that is not settled adds one to `of` and
nothing to `judged`; in claim 10 each along which S did not grow.

| claim | `of`, beside these edges | `judged` |
| --- | --- | --- |
| 1 | percepts | those up to a door that is not there |
| 2 | edges crossed | those that were posed |
| 3 | hypotheses posed | all but those left without a fate |
| 4 | confirmations: declared, or missing where an edge leads to a known vertex | declared |
| 5, 9 | one map | the delivered one |
| 6 | costs reported | the same |
| 7 | one cost | the same |
| 8 | rejections: declared, or missing where an edge leads to a new vertex | declared |
| 10 | decisions declared | those up to the first that does not follow |

Source: docs/semantics.md, section 9, "Coverage".
"""

from __future__ import annotations

from collections import Counter

from topo_verify.checkers.replayed_trace import ReplayedTrace
from topo_verify.robot.events import Augment, Confirm, Finish, Move, Pose, Reject, Start

Share = tuple[int, int]
"""How many things were judged, and of how many."""


def coverage(run: ReplayedTrace) -> dict[str, Share]:
    """How much of a run each claim judges; of claim 10, how much there is to judge."""
    events = [decision.event for decision in run.rounds]
    declared = Counter(map(type, events))
    rejections, confirmations = declared[Reject], declared[Confirm]
    posed = sum(len(event.hypotheses) for event in events if isinstance(event, Pose))
    ends = {edge: fate.event for edge, fate in run.fates.items() if isinstance(fate.event, Augment)}
    loops = sum(end.kind == "loop" for end in ends.values())
    unsettled = len(run.crossings.keys() - ends.keys())
    left = sum(len(fate.left) for fate in run.fates.values())
    missing = sum(len(fate.left) for edge, fate in run.fates.items() if edge in ends)
    grown = {run.crossing(run.map.phi[dart]) for dart in run.map.alpha}
    decisions = rejections + confirmations + declared[Augment]
    percepts = sum(isinstance(event, (Start, Move)) for event in run.followed)
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
