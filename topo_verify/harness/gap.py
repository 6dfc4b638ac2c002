"""How far a rule is from the best possible: what it walked though the history had refuted it.

A false hypothesis that motion rejects was perhaps refuted already by what had been seen before the
robot set out to test it: the fold of the history, with e and h joined, contradicts. The complete
rule (`folding`) never walks such a hypothesis. The **gap** of a run is the share of the false
hypotheses posed that were refutable so and were walked all the same.

Source: docs/semantics.md, section 11.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from topo_verify.checkers import Fold
from topo_verify.robot.events import Augment, Confirm, Event, Move, Pose, Reject, Start


class Gap(NamedTuple):
    """False hypotheses: posed; rejected by motion; of these, refuted before by the fold."""

    false: int
    walked: int
    refutable: int

    @property
    def share(self) -> float:
        """The gap; 0 where no false hypothesis was posed."""
        return self.refutable / self.false if self.false else 0.0


def gap(trace: Sequence[Event]) -> Gap:
    """The gap of a run whose decisions are declared and right (claims 1-8 hold)."""
    assert isinstance(trace[0], Start)
    fold = Fold(trace[0].percept)
    seats = [(0, door) for door in range(trace[0].percept.degree)]  # where the darts of S are
    false = walked = refutable = 0
    refuted: set[int] = set()
    alive: list[int] = []
    edge = 0
    setting_out = False
    for event in trace:
        match event:
            case Move(door, percept):
                if setting_out:  # the history up to here is what the choice was made with
                    e = seats[edge]
                    refuted |= {h for h in alive if not fold.possible(e, seats[h])}
                    setting_out = False
                fold.move(door, percept)
            case Pose(edge, hypotheses):
                alive, refuted, setting_out = list(hypotheses), set[int](), True
                false += len(hypotheses)
            case Reject(_, h, rule):
                alive.remove(h)
                walked += rule == "motion"
                refutable += rule == "motion" and h in refuted
                setting_out = True
            case Confirm():
                false -= 1
            case Augment(e, kind, _, degree):
                alive, setting_out = [], False
                entry = fold.partner(seats[e])
                if kind == "new" and entry is not None:
                    seats += [(entry[0], entry[1] + door) for door in range(degree)]
            case _:
                pass
    return Gap(false, walked, refutable)
