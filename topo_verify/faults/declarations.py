"""Mistakes in what is declared: the mapper is right, its account of itself is not."""

from __future__ import annotations

from topo_verify.algorithms import CATALOGUE
from topo_verify.faults.fault import Fault, ForwardingRobot
from topo_verify.robot.events import Decision, Evidence, Reject
from topo_verify.robot.percept import Percept

basic = CATALOGUE["basic"]


class _SilentOnRejections(ForwardingRobot):
    def declare(self, event: Decision) -> None:
        if not isinstance(event, Reject):
            super().declare(event)


leaves_out_every_reject = Fault(
    name="leaves-out-every-reject",
    part="declarations",
    why="no rejection is declared, so hypotheses are posed and never heard of again",
    claim="true-hypothesis-kept",
    mapper=lambda robot: basic(_SilentOnRejections(robot)),
)


class _SilentOnEverySecond(ForwardingRobot):
    rejections = 0

    def declare(self, event: Decision) -> None:
        self.rejections += isinstance(event, Reject)
        if not isinstance(event, Reject) or self.rejections % 2:
            super().declare(event)


leaves_out_every_second_reject = Fault(
    name="leaves-out-every-second-reject",
    part="declarations",
    why="every second rejection is not declared",
    claim="true-hypothesis-kept",
    mapper=lambda robot: basic(_SilentOnEverySecond(robot)),
)


class _CitesNonsense(ForwardingRobot):
    def declare(self, event: Decision) -> None:
        if isinstance(event, Reject):
            seen = Percept(424242, None)
            event = Reject(event.edge, event.hypothesis, "folding", Evidence(999, seen, seen))
        super().declare(event)


calls_every_rejection_folding = Fault(
    name="calls-every-rejection-folding",
    part="declarations",
    why="each rejection by walking is declared as one by folding, with evidence that is made up",
    claim="rejection-justified",
    mapper=lambda robot: basic(_CitesNonsense(robot)),
)


class _CitesNothing(ForwardingRobot):
    def declare(self, event: Decision) -> None:
        if isinstance(event, Reject):
            event = Reject(event.edge, event.hypothesis, "folding", Evidence(999))
        super().declare(event)


rejects_under_another_label = Fault(
    name="rejects-under-another-label",
    part="declarations",
    why="each rejection by walking is declared as one by folding, with evidence of nothing",
    claim="rejection-justified",
    mapper=lambda robot: basic(_CitesNothing(robot)),
)
