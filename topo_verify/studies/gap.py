"""The gap of a rule: hypotheses that it walked though the history had refuted them.

The fold of the history, with e and h joined, may contradict a false hypothesis before the robot
tests it. The complete rule (`folding`) never walks such a hypothesis.

Source: docs/semantics.md, section 11.
"""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from topo_verify.checkers import Fold
from topo_verify.checkers.darts import KnownDart
from topo_verify.checkers.map_on_fold import MapOnFold
from topo_verify.robot.events import Augment, Confirm, Event, Move, Pose, Reject, Start


class Gap(msgspec.Struct, frozen=True):
    """The gap of a rule to the best possible one.

    Attributes:
        false: number of false hypotheses posed.
        walked: number of those rejected by motion.
        refutable: number of those walked although the history refuted them before.
        share: refutable / false; 0 without false hypotheses.
    """

    false: int
    walked: int
    refutable: int
    share: float


def gap(trace: Sequence[Event]) -> Gap:
    """The gap of a run whose decisions are declared and right (claims 1-8 hold)."""
    assert isinstance(trace[0], Start)
    fold = Fold(trace[0].percept)
    on_fold = MapOnFold(fold)
    false = walked = refutable = 0
    refuted: set[KnownDart] = set()
    alive: list[KnownDart] = []
    edge = KnownDart(0)
    setting_out = False
    for event in trace:
        match event:
            case Move(door, percept):
                if setting_out:
                    e, ends = on_fold.places[edge], ((h, on_fold.places[h]) for h in alive)
                    refuted |= {h for h, end in ends if any(fold.contradictions(e, end, ()))}
                    setting_out = False
                fold.move(door, percept)
            case Pose(e, hypotheses):
                edge, alive = KnownDart(e), list(map(KnownDart, hypotheses))
                refuted, setting_out = set[KnownDart](), True
                false += len(hypotheses)
            case Reject(_, h, rule):
                alive.remove(KnownDart(h))
                walked += rule == "motion"
                refutable += rule == "motion" and h in refuted
                setting_out = True
            case Confirm():
                false -= 1
            case Augment():
                alive, setting_out = [], False
                on_fold.grow(event)
            case _:
                pass
    return Gap(false, walked, refutable, refutable / false if false else 0.0)
